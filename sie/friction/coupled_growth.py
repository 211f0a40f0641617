"""How the load of a symmetric convex profile grows with its contact, where pressure and shear are
coupled.

Beside the contact of half-width x, at its edge, equation (1) reads, with P'(s) = dP/ds,

    ∫_a^x P'(s) D(x/s) ds/s = E*/2 h'(x),        D = χ Ψ of the flat outside (`coupled_functions`),

a Volterra equation with D(ρ) ~ (ρ - 1)^-h; a is the half-width of a flat base, else 0. It is
solved panel by panel from a outwards, P' = (s - a)^h times a polynomial on the first (a jump of
h' there makes that h - 1) and a polynomial on the others, by collocation. A panel whose series
does not decay is cut towards its beginning, where kinks of the profile leave powers of the
distance.

A power law h = A|x|^m has P' = E* A m s^(m-1)/(2 M), M(m) = ∫_1^∞ D ρ^-m dρ, in closed form.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.elliptic import elliptic_functions
from sie.numerics.gauss_jacobi import with_weight
from sie.numerics.interval import EPS

from .coupled_functions import FlatFunctions
from .coupled_profile import NODES, GrowthPanel, _graded, _rules

Array = NDArray[np.float64]

DEGREE = 20
DECAYED = 2e-13  # of a series, its last coefficients
# Part of the load: rounding of the integrals, which a short panel has to compensate
NEGLIGIBLE = 256.0 * EPS
NO_LESS = 0.7  # of what a panel missed before it was cut
MOST = 300  # panels: beyond, none is cut
CUT = 0.4  # of a panel: where it is cut
NEAR = 0.5  # of a panel's length: nearer it is integrated on panels that shrink towards x


class Piece(NamedTuple):
    """E*/2 h' on lo <= x <= hi as a function of x - lo; whether it jumps at lo, and is not smooth
    there.
    """

    lo: float
    hi: float
    slope: Callable[[Array], Array]
    jumps: bool
    kinked: bool = True


def power_law_moment(flat: FlatFunctions, m: float) -> float:
    """M(m) = ∫_1^∞ D ρ^-m dρ."""
    modulus = flat.punch.modulus
    x, rest, w = with_weight(len(flat.punch.weight) + NODES, 2.0 * flat.theta, m - 1.0)
    sn, cn, dn = elliptic_functions(modulus, x, rest)
    D = flat.outside(sn, cn * cn / (1.0 + sn))
    return float((w * modulus.K * cn * dn) @ (sn ** (m - 1.0) * D))


def power_law_growth(flat: FlatFunctions, m: float, slope: float, b: float) -> GrowthPanel:
    """P' of the slope E*/2 h' = slope (x/b)^(m-1)."""
    factor = slope / power_law_moment(flat, m) * b ** (1.0 - m)
    return GrowthPanel(0.0, 0.0, b, m - 1.0, np.array([factor]))


def solved_growth(flat: FlatFunctions, pieces: list[Piece]) -> tuple[GrowthPanel, ...]:
    """P' on panels, from the first place where h' is not zero outwards."""
    solved: list[GrowthPanel] = []
    load, origin = 0.0, pieces[0].lo
    for k, piece in enumerate(pieces):
        power = _first_power(flat.h, piece, k == 0)
        parts = _panels(origin, piece.lo, piece.hi)
        start = parts[0][0]
        todo = [(lo, hi, math.inf) for lo, hi in reversed(parts)]
        while todo:
            lo, hi, before = todo.pop()
            panel = GrowthPanel(origin, lo, hi, power if lo == start else 0.0, np.zeros(DEGREE))
            panel = _collocated(flat, solved, piece, panel)
            more, missed = panel.load(math.inf), _missed(panel)
            negligible = missed <= NEGLIGIBLE * abs(load + more)
            # A shorter panel misses as much, by rounding
            if negligible or missed > NO_LESS * before or len(solved) > MOST:
                solved.append(panel)
                load += more
                continue
            middle = lo + CUT * (hi - lo)
            todo += [(middle, hi, missed), (lo, middle, missed)]
    return tuple(solved)


def _missed(panel: GrowthPanel) -> float:
    """The load that the last coefficients of a series carry, 0 where they are small beside the
    others.
    """
    size, length = np.abs(panel.series), panel.hi - panel.lo
    tail = float(size[-3:].max())
    return tail * length ** (1.0 + panel.power) if tail > DECAYED * float(size.max()) else 0.0


def _first_power(h: float, piece: Piece, first: bool) -> float:
    """The exponent of P' at the beginning of a piece; from the axis it is regular."""
    if piece.lo == 0.0 or not (first or piece.jumps):
        return 0.0
    return h - 1.0 if piece.jumps else h


def _panels(origin: float, lo: float, hi: float) -> list[tuple[float, float]]:
    """Parts of lo <= s <= hi no longer than their distance from the axis, counted from the
    origin.
    """
    n = 1 if lo == 0.0 else max(1, math.ceil(math.log2(hi / lo)))
    ends = [lo - origin, *(lo * (hi / lo) ** (k / n) - origin for k in range(1, n)), hi - origin]
    return list(itertools.pairwise(ends))


def _collocated(
    flat: FlatFunctions, solved: list[GrowthPanel], piece: Piece, panel: GrowthPanel
) -> GrowthPanel:
    """The panel with its series."""
    length = panel.hi - panel.lo
    ahead = 0.5 * length * (1.0 + chebyshev.points(DEGREE))
    x = panel.lo + ahead  # from the origin
    known = (panel.origin + x) * piece.slope((panel.lo - (piece.lo - panel.origin)) + ahead)
    near = [other for other in solved if panel.lo - other.hi < NEAR * (other.hi - other.lo)]
    for other in near:
        known -= _beside(flat, other, x, (panel.lo - other.hi) + ahead)
    known -= _far(flat, [other for other in solved if other not in near], x)
    series = np.asarray(np.linalg.solve(_own(flat, panel, x, ahead), known), dtype=float)
    return replace(panel, series=series)


def _far(flat: FlatFunctions, panels: list[GrowthPanel], x: Array) -> Array:
    """∫P' ρ D(ρ) ds over panels that are as far from x as half their length."""
    if not panels:
        return np.zeros(len(x))
    s, weight = (np.concatenate(column) for column in zip(*(p.places for p in panels), strict=True))
    origin = panels[0].origin
    t, e = (origin + s) / (origin + x[:, None]), (x[:, None] - s) / (origin + x[:, None])
    integral: Array = flat.outside(t, e) @ weight
    return integral


def _beside(flat: FlatFunctions, panel: GrowthPanel, x: Array, beyond: Array) -> Array:
    """∫P' ρ D(ρ) ds over a panel that ends before x, by `beyond`."""
    return _up_to(flat, panel, panel.hi - panel.lo, x, beyond)


def _up_to(flat: FlatFunctions, panel: GrowthPanel, part: float, x: Array, beyond: Array) -> Array:
    """The same over a part of the panel."""
    length = np.full(len(x), part)
    owner, start, size, left, kind = _graded(length, np.full(len(x), np.inf), beyond)
    z, rest, w = _rules(panel.power, 0.0)
    ahead = start[:, None] + size[:, None] * z[kind]
    to_x = beyond[owner][:, None] + (left[:, None] + size[:, None] * rest[kind])
    at = panel.origin + x[owner][:, None]
    values = flat.outside((panel.origin + panel.lo + ahead) / at, to_x / at) * panel(ahead)
    integral = size * (values * w[kind]).sum(axis=1)
    total: Array = np.bincount(owner, integral, minlength=len(x)).astype(float)
    return total


def load_slope(
    flat: FlatFunctions, growth: tuple[GrowthPanel, ...], ahead: float, x: Array
) -> Array:
    """∫P' D(x/s) ds/s up to b = origin + ahead for each x > b: 1/π ∫p/(x - t) dt beside the
    contact.
    """
    total = np.zeros(len(x))
    for panel in growth:
        length = min(panel.hi, ahead) - panel.lo
        if length > 0.0:
            # Next to the edge rounding may leave x on it, or behind it
            beyond = np.maximum((x - panel.origin) - (panel.lo + length), EPS * x)
            total += _up_to(flat, panel, length, x - panel.origin, beyond)
    return total / x


def _own(flat: FlatFunctions, panel: GrowthPanel, x: Array, ahead: Array) -> Array:
    """The matrix that takes the series to ∫P' ρ D(ρ) ds from lo to each x of the panel."""
    owner, start, size, left, kind = _graded(
        ahead, np.full(len(x), np.inf), (panel.origin + x) * (flat.rest / flat.c)
    )
    z, rest, w = _rules(panel.power, -flat.h)
    inside = start[:, None] + size[:, None] * z[kind]
    to_x = left[:, None] + size[:, None] * rest[kind]
    at = panel.origin + x[owner][:, None]
    values = flat.outside((panel.origin + panel.lo + inside) / at, to_x / at) * (
        size[:, None] * w[kind]
    )
    if panel.power:
        values *= inside**panel.power
    y = 2.0 / (panel.hi - panel.lo) * inside - 1.0
    terms = np.einsum("kij,ij->ik", chebyshev.polynomials(DEGREE, y), values)
    matrix = np.zeros((len(x), DEGREE))
    for row, term in zip(owner.tolist(), terms, strict=True):
        matrix[row] += term
    return matrix
