"""The answers of a sweep as arrays over its grid, or as a Dataset where xarray is installed.

What the package names has a long name and a unit there.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import numpy as np

Answer = tuple[dict[str, Any], str]  # values by name, and why there are none ("" if there are)

# Quantities with other names in a result; these are nan where no point has an answer.
PARTS = {
    "edges": ("x1", "x2"),
    "elastic_limit": ("elastic_limit", "elastic_limit_load", "elastic_limit_x", "elastic_limit_y"),
    "peak_tension": ("peak_tension", "peak_tension_x"),
}


# Labels of consistent units, as those of scene files.
UNITS = {"length": "mm", "force": "N/mm", "stress": "MPa"}
PURE, LENGTH, FORCE, STRESS = "1", "{length}", "{force}", "{stress}"
MOMENT, AREA = "{force} {length}", "{length}^2"

# What the package names, and its unit.
LABELS = {
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
    "peak_pressure": ("largest pressure", STRESS),
    "shear_load": ("tangential load Q", FORCE),
    "elastic_limit": ("P/(bk) at first yield", PURE),
    "elastic_limit_load": ("P/k at first yield", LENGTH),
    "elastic_limit_x": ("x of first yield", LENGTH),
    "elastic_limit_y": ("depth of first yield", LENGTH),
    "peak_tension": ("largest tension on the surface", STRESS),
    "peak_tension_x": ("x of the largest tension", LENGTH),
    "error": ("estimated relative error of the pressure", PURE),
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


def labelled(
    axes: dict[str, list[Any]],
    wanted: dict[str, Any],
    answers: list[Answer],
    units: Mapping[str, str] = UNITS,
) -> Any:
    """The answers over the axes, an xarray Dataset with units where xarray is installed."""
    shape, reasons = tuple(map(len, axes.values())), [reason for _, reason in answers]
    names = dict.fromkeys(name for values, _ in answers for name in values) or [
        part
        for name, of in wanted.items()
        for part in (PARTS.get(name, (name,)) if of == name else (name,))
    ]
    data = {name: _joined(name, answers, reasons) for name in names if name not in axes}
    data = {name: array.reshape(shape + array.shape[1:]) for name, array in data.items()}
    return dataset(axes, wanted, data, np.array(reasons, dtype=object).reshape(shape), units)


def _joined(name: str, answers: list[Answer], reasons: list[str]) -> Any:
    """The values of a quantity at all points, (points, ...), nan where there are none.

    One array holds them all: its inner shape is the least that does, and a value with other
    dimensions than that of an earlier point leaves its reason.
    """
    found = {k: values[name] for k, (values, _) in enumerate(answers) if name in values}
    rank = next((value.ndim for value in found.values()), 0)
    for k in [k for k, value in found.items() if value.ndim != rank]:
        told = f"{name} has {found.pop(k).ndim} dimensions here and {rank} at an earlier point"
        reasons[k] = f"{reasons[k]}; {told}" if reasons[k] else told
    inner = map(max, zip(*(value.shape for value in found.values()), strict=True))
    array = np.full((len(answers), *inner), np.nan)
    for k, value in found.items():
        place: Any = (k, *map(slice, value.shape))
        array[place] = value
    return array


def dataset(
    axes: dict[str, list[Any]],
    wanted: dict[str, Any],
    data: dict[str, Any],
    reasons: Any,
    units: Mapping[str, str],
) -> Any:
    """Arrays over the axes, an xarray Dataset with units where xarray is installed."""
    coordinates = {name: _coordinate(values) for name, values in axes.items()}
    try:
        import xarray  # type: ignore[import-not-found, unused-ignore]  # noqa: PLC0415
    except ImportError:
        return {**coordinates, **data, "reason": reasons}
    dims = tuple(axes)
    named = {name: of for name, of in wanted.items() if isinstance(of, str)}
    named |= {part: part for of in {*named.values()} for part in PARTS.get(of, ())}
    variables = {
        name: (
            (*dims, *(f"{name}_{i}" for i in range(a.ndim - len(dims)))),
            a,
            _attributes(named.get(name, ""), units),
        )
        for name, a in data.items()
    }
    along = {name: (name, values, _attributes(name, units)) for name, values in coordinates.items()}
    return xarray.Dataset({**variables, "reason": (dims, reasons)}, coords=along)


def _attributes(name: str, units: Mapping[str, str]) -> dict[str, str]:
    """`long_name` and `units`, by which xarray prints and plots; {} for what is not known."""
    if name not in LABELS:
        return {}
    said, unit = LABELS[name]
    return {"long_name": said, "units": unit.format(**units)}


def _coordinate(values: list[Any]) -> Any:
    if all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in values):
        with suppress(OverflowError):  # an integer beyond all floats: its points say so
            return np.array(values, dtype=float)
    return np.array([repr(v) for v in values], dtype=object)
