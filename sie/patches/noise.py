"""What errors of the slope change on several patches, to first order.

The conditions of the edges and the pressure are linear in the slope. With δH in place of H they
give the point charges y that make up for it, and from them

    δp = (E*/2π) |T_i| δD_i,    δD_i of δH and y             edge e moves by 2 y_e / D(e)

Next to a smooth edge that moves by δ the pressure changes as that at the distance δ from it, which
is no first order. The first error is known and counts in full; the others are samples of an unknown
one, which counts as so many standard deviations.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.profiles.base import Profile
from sie.profiles.pieces import of_profile

from .density import PatchPressure
from .newton import conditions, conditions_of, missed
from .operator import Found, Operator, operator_of
from .state import Given, State

Array = NDArray[np.float64]

INNER = 0.9  # of each patch
PLACES = 16  # on each patch
TOLERANCE = 1e-15  # to which an error that is a function is resolved


class PatchErrors(NamedTuple):
    """The changes by errors of the slope.

    pressure    the largest of the pressure, over its peak
    inner       the same on the inner part of each patch
    edges       of the outermost two edges, lengths
    unsure      the number of patches of which an edge moves by more than their half-width
    """

    pressure: float
    inner: float
    edges: tuple[float, float]
    unsure: int


def changes(
    found: Found, pressure: PatchPressure, errors: Sequence[Profile], spread: float, moment: bool
) -> PatchErrors:
    """The changes where the profile changes by the first error, and by `spread` times the others.

    All are of the same period. `moment`: whether that is given, and the tilt changes.
    """
    P, half_modulus = found.state.patches, pressure.half_modulus
    angle = np.pi * (np.arange(PLACES) + 0.5) / PLACES
    places = P.c[:, None] - INNER * P.r[:, None] * np.cos(angle)
    changed = (_changed(found, half_modulus, one, places, moment) for one in errors)
    p, charge = (_together(spread, *parts) for parts in zip(*changed, strict=True))
    sharp, intensity = found.state.sharp, np.abs(conditions_of(found).intensity)
    moved = np.where(sharp, 0.0, 2.0 * charge / np.where(sharp, 1.0, intensity))
    peak = float(pressure(places).max())
    inner = float(p.max()) / peak
    edges = moved.reshape(-1, 2)
    capped = np.minimum(edges, P.r[:, None])
    beside = np.where(edges > 0.0, pressure(np.stack((P.a, P.b), axis=1) + capped * (1, -1)), 0.0)
    largest = float(beside.max()) / peak
    unsure = int((edges.max(axis=1) > P.r).sum())
    return PatchErrors(
        max(inner, largest), inner, (float(edges[0, 0]), float(edges[-1, 1])), unsure
    )


def _together(spread: float, first: Array, *others: Array) -> Array:
    return np.abs(first) + spread * np.sqrt(np.mean(np.square(others), axis=0))


def _changed(
    found: Found, half_modulus: float, error: Profile, places: Array, moment: bool
) -> tuple[Array, Array]:
    """δp at places and the point charges at the edges (2N,) by an error."""
    P = found.state.patches
    pieces = of_profile(error, found.operator.pieces.domain, TOLERANCE)
    none = Given(0.0, 0.0, 0.0 if moment else None)
    still = State(P, np.ones(2 * P.number, dtype=bool), np.zeros(2 * P.number), 0.0)
    o = operator_of(still, pieces)
    linear = conditions(still, o, none)
    y = linear.charged(-missed(still, o, none, linear)[:, None])[:, 0]
    charged = Operator(P, pieces, y[:-1])
    return PatchPressure(charged, half_modulus, float(y[-1]), 0.0)(places), y[:-1]
