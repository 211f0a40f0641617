"""The answers of a sweep as arrays over its grid, or as a Dataset where xarray is installed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import numpy as np

from .unit_labels import PARAMETERS, QUANTITIES, UNITS, attributes

Answer = tuple[dict[str, Any], str]  # values by name, and why there are none ("" if there are)

# Quantities with other names in a result; these are nan where no point has an answer.
PARTS = {
    "edges": ("x1", "x2"),
    "elastic_limit": ("elastic_limit", "elastic_limit_load", "elastic_limit_x", "elastic_limit_y"),
    "peak_tension": ("peak_tension", "peak_tension_x"),
}


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
            attributes(QUANTITIES, named.get(name, ""), units),
        )
        for name, a in data.items()
    }
    along = {
        name: (name, values, attributes(PARAMETERS, name, units))
        for name, values in coordinates.items()
    }
    return xarray.Dataset({**variables, "reason": (dims, reasons)}, coords=along)


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
    """The answers without values whose rank differs from that of most points.

    One array holds a quantity of all points, and has as many dimensions everywhere.
    """
    ranks: dict[str, Counter[int]] = {}
    for values, _ in answers:
        for name, value in values.items():
            ranks.setdefault(name, Counter())[value.ndim] += 1
    usual = {name: count.most_common(1)[0][0] for name, count in ranks.items() if len(count) > 1}
    return [_without_odd(answer, usual) for answer in answers] if usual else answers


def _without_odd(answer: Answer, usual: dict[str, int]) -> Answer:
    values, reason = answer
    odd = {
        name: values[name].ndim
        for name in usual
        if name in values and values[name].ndim != usual[name]
    }
    told = "; ".join(
        f"{name} has {rank} dimensions here and {usual[name]} at most other points"
        for name, rank in odd.items()
    )
    return {name: value for name, value in values.items() if name not in odd}, told or reason


def _coordinate(values: list[Any]) -> Any:
    if all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in values):
        with suppress(OverflowError):  # an integer beyond all floats: its points say so
            return np.array(values, dtype=float)
    return np.array([repr(v) for v in values], dtype=object)
