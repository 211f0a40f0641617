"""Names and units of what a sweep holds, as attributes that xarray prints and plots by."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

# Labels of consistent units, as those of scene files.
UNITS = {"length": "mm", "force": "N/mm", "stress": "MPa"}
PURE, LENGTH, FORCE, STRESS = "1", "{length}", "{force}", "{stress}"
MOMENT, AREA = "{force} {length}", "{length}^2"

QUANTITIES = {
    "half_width": ("half-width of the contact", LENGTH),
    "centre": ("centre of the contact", LENGTH),
    "normal_load": ("normal load P", FORCE),
    "moment": ("moment about x = 0", MOMENT),
    "tilt": ("tilt", PURE),
    "contact_length": ("length in contact", LENGTH),
    "gap_volume": ("area of the gaps between patches", AREA),
    "patches": ("number of patches", PURE),
    "x1": ("left edge of the contact", LENGTH),
    "x2": ("right edge of the contact", LENGTH),
    "shear_load": ("tangential load Q", FORCE),
    "elastic_limit": ("P/(bk) at first yield", PURE),
    "elastic_limit_load": ("P/k at first yield", LENGTH),
    "elastic_limit_x": ("x of first yield", LENGTH),
    "elastic_limit_y": ("depth of first yield", LENGTH),
    "peak_tension": ("largest tension on the surface", STRESS),
    "peak_tension_x": ("x of the largest tension", LENGTH),
    "error": ("estimated relative error of the pressure", PURE),
}
PARAMETERS = QUANTITIES | {
    "friction": ("coefficient of friction", PURE),
    "tangential_load": ("tangential load Q", FORCE),
    "bulk_stress": ("bulk stress", STRESS),
    "sliding": ("direction of sliding", PURE),
    "modulus": ("modulus E*", STRESS),
    "dundurs": ("Dundurs' constant beta", PURE),
    "poisson": ("Poisson's ratio", PURE),
    "profile.radius": ("radius", LENGTH),
    "profile.half_flat": ("half of the flat base", LENGTH),
    "profile.half_width": ("half-width of the punch", LENGTH),
    "profile.exponent": ("exponent", PURE),
}


def labels(units: Any) -> dict[str, str]:
    """The labels of units, those that are not given by default. ValueError for others."""
    given = {} if units is None else units
    texts = isinstance(given, Mapping) and all(isinstance(v, str) for v in given.values())
    if not texts or not given.keys() <= UNITS.keys():
        raise ValueError(f"units = {units!r} are no labels of units: give some of {UNITS!r}")
    return UNITS | given


def attributes(
    known: Mapping[str, tuple[str, str]], name: str, units: Mapping[str, str]
) -> dict[str, str]:
    """`long_name` and `units` of a quantity, {} for one that is not known."""
    if name not in known:
        return {}
    said, unit = known[name]
    return {"long_name": said, "units": unit.format(**units)}
