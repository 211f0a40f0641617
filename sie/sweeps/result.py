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
    answers = _of_one_rank(answers)
    shape = tuple(map(len, axes.values()))
    shapes = _shapes(answers) or {
        part: ()
        for name, of in wanted.items()
        for part in (PARTS.get(name, (name,)) if of == name else (name,))
    }
    data = {
        name: _joined(name, inner, answers).reshape(shape + inner)
        for name, inner in shapes.items()
        if name not in axes  # the parameters of the sweep are known
    }
    reasons = np.array([reason for _, reason in answers], dtype=object).reshape(shape)
    return dataset(axes, wanted, data, reasons, units)


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


def _shapes(answers: list[Answer]) -> dict[str, tuple[int, ...]]:
    """The least shape of each quantity that holds its values at all points."""
    shapes: dict[str, tuple[int, ...]] = {}
    for values, _ in answers:
        for name, value in values.items():
            known = shapes.get(name, value.shape)
            shapes[name] = tuple(map(max, zip(known, value.shape, strict=True)))
    return shapes


def _joined(name: str, inner: tuple[int, ...], answers: list[Answer]) -> Any:
    """The values of a quantity at all points, (points, *inner), nan where there are none."""
    array = np.full((len(answers), *inner), np.nan)
    for k, (values, _) in enumerate(answers):
        if name in values:
            place: Any = (k, *(slice(n) for n in values[name].shape)) if inner else k
            array[place] = values[name]
    return array


def _of_one_rank(answers: list[Answer]) -> list[Answer]:
    """The answers without values whose rank differs from that of an earlier point.

    One array holds a quantity of all points, and has as many dimensions everywhere.
    """
    ranks: dict[str, int] = {}
    kept = []
    for values, reason in answers:
        odd = [n for n, value in values.items() if ranks.setdefault(n, value.ndim) != value.ndim]
        told = "; ".join(
            f"{name} has {values[name].ndim} dimensions here and {ranks[name]} at an earlier point"
            for name in odd
        )
        kept.append(({n: v for n, v in values.items() if n not in odd}, told or reason))
    return kept


def _coordinate(values: list[Any]) -> Any:
    if all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in values):
        with suppress(OverflowError):  # an integer beyond all floats: its points say so
            return np.array(values, dtype=float)
    return np.array([repr(v) for v in values], dtype=object)
