"""Units of length of a scene."""


def name(units_per_metre: float) -> str:
    """The name of the unit: ``cm`` for 100 units per metre."""
    names = {1.0: "m", 10.0: "dm", 100.0: "cm", 1000.0: "mm"}
    return names.get(round(units_per_metre, 9), f"{1 / units_per_metre:g} m")
