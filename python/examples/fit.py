"""Finds the bend resistance that gives a strip of cloth a measured sag, without gradients (scipy)."""

import math

from scipy.optimize import minimize_scalar

import nucleus

# A strip held at one end, 8 cm long and 2 cm wide, heavily damped so that it comes to rest.
SCENE = nucleus.Scene({
    "time": {"start": 1, "end": 60, "fps": 24},
    "nodes": {
        "nucleus1": {"type": "nucleus", "spaceScale": 0.01},
        "sheet": {"type": "polyPlane", "width": 8, "height": 2, "subdivisions": (8, 2)},
        "strip": {"type": "nCloth", "inputMesh": "sheet", "damp": 5, "drag": 0.2, "selfCollide": False},
        "clamp": {
            "type": "dynamicConstraint",
            "constraintType": "transform",
            "components": [f"strip.vtx[{row * 9 + column}]" for row in range(3) for column in range(2)],
        },
    },
})


def sag(bend_resistance: float) -> float:
    """How far the free end hangs below the clamp in the last frame, in centimetres."""
    SCENE["strip"]["bendResistance"] = bend_resistance
    simulation = nucleus.Simulation(SCENE)
    for _ in simulation:
        pass
    positions = simulation.positions("strip")
    return float(positions[0, 1] - positions[8, 1])


def fit(measured: float) -> tuple[float, float]:
    """The bend resistance for a measured sag, and the sag that it gives."""
    found = minimize_scalar(
        lambda exponent: (sag(math.exp(exponent)) - measured) ** 2,
        bounds=(math.log(0.3), math.log(60)),
        method="bounded",
        options={"maxiter": 14, "xatol": 1e-3},
    )
    resistance = math.exp(found.x)
    return resistance, sag(resistance)


if __name__ == "__main__":
    target = sag(6.0)
    resistance, reached = fit(target)
    print(f"measured sag {target:.3f} cm; bendResistance {resistance:.3f} gives {reached:.3f} cm")
