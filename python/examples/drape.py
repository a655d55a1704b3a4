"""Drapes a cloth over a ball, plots how its height and its strain change, and draws the last frame."""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import nucleus

SCENE = {
    "time": {"start": 1, "end": 36, "fps": 24},
    "nodes": {
        "nucleus1": {"type": "nucleus", "spaceScale": 0.01, "subSteps": 2},
        "sheet": {"type": "polyPlane", "width": 60, "height": 60, "subdivisions": (16, 16), "translate": (0, 22, 0)},
        "cloth1": {"type": "nCloth", "inputMesh": "sheet", "thickness": 0.5, "bendResistance": 0.2},
        "ball": {"type": "polySphere", "radius": 20},
        "rigid1": {"type": "nRigid", "inputMesh": "ball", "friction": 0.4},
    },
}


def main(out: str) -> None:
    """Writes the plot to a file."""
    simulation = nucleus.Simulation(nucleus.Scene(SCENE))
    frames, heights, strains = [], [], []
    for report in simulation:
        frames.append(simulation.frame)
        heights.append(simulation.positions("cloth1")[:, 1].mean())
        strains.append(100 * report["max_strain"])
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    left.plot(frames, heights)
    left.set(xlabel="frame", ylabel=f"mean height ({simulation.units})")
    twin = left.twinx()
    twin.plot(frames, strains, color="tab:red")
    twin.set_ylabel("largest strain (%)", color="tab:red")
    points = simulation.positions("cloth1")
    side = int(np.sqrt(len(points)))
    for line in (*points.reshape(side, side, 3), *points.reshape(side, side, 3).transpose(1, 0, 2)):
        right.plot(line[:, 0], line[:, 1], color="tab:blue", linewidth=0.5)
    right.set(xlabel=f"x ({simulation.units})", ylabel=f"y ({simulation.units})", aspect="equal")
    figure.tight_layout()
    figure.savefig(out, dpi=120)
    print(f"frame {simulation.frame}: mean height {heights[-1]:.2f} {simulation.units}, plot in {out}")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "drape.png")
