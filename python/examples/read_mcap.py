"""Reads positions from a cache with mcap and numpy alone, without the nucleus package.

The schema of the messages is text in the file itself: `python read_mcap.py run.mcap --schema` prints it.
"""

import sys

import numpy as np
from mcap.reader import make_reader

ENCODING = "nucleus.points.v1"
HEAD = np.dtype([
    ("frame", "<i4"),
    ("substep", "<u4"),
    ("substeps", "<u4"),
    ("count", "<u4"),
    ("flags", "<u4"),
    ("mesh", "<u4"),
    ("time", "<f8"),
])


def positions(data: bytes) -> tuple[int, np.ndarray]:
    """The frame of a message, and its positions in scene units: four planes with one byte of every number each."""
    head = np.frombuffer(data, HEAD, count=1)[0]
    numbers = 3 * int(head["count"])
    planes = np.frombuffer(data, np.uint8, count=4 * numbers, offset=HEAD.itemsize)
    floats = np.ascontiguousarray(planes.reshape(4, numbers).T).view("<f4")
    return int(head["frame"]), floats.reshape(-1, 3)


def read(path: str, name: str) -> dict[int, np.ndarray]:
    """The positions of an object at the end of every recorded frame."""
    frames = {}
    with open(path, "rb") as file:
        for _, channel, message in make_reader(file).iter_messages(topics=[f"/{name}/points"]):
            if channel.message_encoding == ENCODING:
                frame, points = positions(message.data)
                frames[frame] = points
    return frames


if __name__ == "__main__":
    path, name = sys.argv[1:3]
    if name == "--schema":
        with open(path, "rb") as file:
            for schema in make_reader(file).get_summary().schemas.values():
                print(f"{schema.name}\n{schema.data.decode()}")
    else:
        for frame, points in read(path, name).items():
            print(f"frame {frame}: {len(points)} points, lowest at {points[:, 1].min():.3f}")
