"""Reads a cache of Nucleus with the `mcap` package of others: what every export is held against."""

import json
import struct

import numpy as np
from mcap.reader import make_reader


class Cache:
    def __init__(self, path, substeps=False):
        self.objects = {}
        stamps, moments = {}, {}
        with open(path, "rb") as file:
            reader = make_reader(file, validate_crcs=True)
            metadata = {record.name: record.metadata for record in reader.iter_metadata()}
            for _, channel, message in reader.iter_messages():
                name = channel.topic.removeprefix("/").rsplit("/", 1)[0]
                if channel.message_encoding == "nucleus.topology.v1":
                    self.objects[name] = read_topology(message.data)
                elif channel.message_encoding == "nucleus.points.v1":
                    frame, substep, count_of, points = read_points(message.data)
                    at = frame - 1 + substep / count_of if substep else float(frame)
                    stamps[message.log_time] = at
                    moments.setdefault(name, {})[message.log_time] = points
        run = metadata["nucleus.run"]
        self.fps = float(run["fps"])
        self.units = float(run["units_per_metre"])
        times = sorted(time for time, at in stamps.items() if substeps or at == int(at))
        self.at = [stamps[time] for time in times]
        for name, of_object in moments.items():
            self.objects[name]["positions"] = np.array([latest(of_object, time) for time in times])


def latest(moments, time):
    """What does not move has no new message: the last one holds."""
    return moments[max(known for known in moments if known <= time)]


def read_topology(data):
    kind, points, faces, corners = struct.unpack_from("<4I", data)
    starts = np.frombuffer(data, "<u4", faces + 1, 16)
    all_corners = np.frombuffer(data, "<u4", corners, 16 + 4 * (faces + 1))
    cut = [all_corners[a:b].tolist() for a, b in zip(starts, starts[1:])]
    return {"kind": ["cloth", "collider", "particles"][kind], "points": points, "faces": cut}


def read_points(data):
    frame, substep, substeps, count = struct.unpack_from("<iIII", data)
    planes = np.frombuffer(data, np.uint8, 12 * count, 32).reshape(4, -1)
    floats = np.ascontiguousarray(planes.T).view("<f4").reshape(count, 3)
    return frame, substep, substeps, floats


def plain(name, digits_first=False):
    """The name as files and nodes have it."""
    kept = "".join(c if c.isascii() and (c.isalnum() or c in "_-." and not digits_first or c == "_") else "_" for c in name)
    return kept if kept[:1].isalpha() or kept[:1] == "_" else "_" + kept


class Verdicts:
    """Collects what was found; an error is relative to the size of what is shown."""

    LIMIT = 1e-6

    def __init__(self):
        self.rows = []

    def compare(self, what, reader, expected, found):
        expected, found = np.asarray(expected, np.float64), np.asarray(found, np.float64)
        if expected.shape != found.shape:
            self.add(what, reader, None, f"shape {found.shape} instead of {expected.shape}")
            return
        size = max(1.0, float(np.abs(expected).max(initial=0.0)))
        self.add(what, reader, float(np.abs(expected - found).max(initial=0.0)) / size)

    def same(self, what, reader, expected, found):
        self.add(what, reader, None, None if expected == found else f"{found!r} instead of {expected!r}")

    def add(self, what, reader, error, trouble=None):
        if error is not None and not error <= self.LIMIT:
            trouble = trouble or f"error above {self.LIMIT}"
        self.rows.append({"what": what, "reader": reader, "error": error, "trouble": trouble})

    def tell(self):
        print(json.dumps(self.rows))
