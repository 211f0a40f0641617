"""The growth of the load of a symmetric convex profile with its contact.

Pressure and shear are coupled.

Beside the contact of half-width x, at its edge, equation (1) reads, with P'(s) = dP/ds,

    ∫_a^x P'(s) D(x/s) ds/s = E*/2 h'(x),        D = χ Ψ of the flat outside (`functions`),

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

from .functions import FlatFunctions
from .load_rate import GrowthPanel, Stack
from .panels import LONGEST, NODES, graded, totals

Array = NDArray[np.float64]

DEGREE = 20
DECAYED = 2e-13  # of a series, its last coefficients
# Part of the load: rounding of the integrals, which a short panel has to compensate
NEGLIGIBLE = 256.0 * EPS
NO_LESS = 0.7  # of what a panel missed before it was cut
MOST = 300  # panels: beyond, none is cut
CUT = 0.4  # of a panel: where it is cut
# Of the distance from a kink: how much it grows on a panel, as a logarithm, how much more so away
# from the half-width and from the slip zone at the kink, and the last panel at most, in such panels
FOLDS, LONGER, ALMOST = 3.0, 0.5, 1.25
SHORTER = 0.5 * LONGEST  # of a panel of v: beside the kernel its integrand has all of the series
NEAR = 0.5  # of a panel's length: nearer it is integrated on panels that shrink towards x


class Piece(NamedTuple):
    """E*/2 h' on lo <= x <= hi as a function of x - lo.

    With it comes whether it jumps at lo, and whether it is not smooth there.
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
        panels = _panels(flat, origin, piece, _first_power(flat.h, piece, k == 0))
        todo = [(*own, math.inf) for own in reversed(_with_matrices(flat, panels))]
        while todo:
            empty, matrix, before = todo.pop()
            panel = _collocated(flat, solved, piece, empty, matrix)
            more, missed = panel.load(math.inf), _missed(panel)
            # From a kink P' grows with its power; elsewhere it falls at most as the root of the
            # distance from a corner grows
            ratio = (piece.hi - piece.lo) / (panel.hi - panel.lo)
            later = ratio ** max(0.5, 1.0 + panel.power if panel.power else 0.0)
            negligible = missed <= NEGLIGIBLE * abs(load + more) * max(later, 1.0)
            negligible |= panel.hi - panel.lo <= 1.01 * _narrowest(panel.power) * piece.lo
            # Of rounding a shorter panel misses as much
            if negligible or missed > NO_LESS * before or len(solved) > MOST:
                solved.append(panel)
                load += more
                continue
            parts = _with_matrices(flat, _halves(empty))
            todo += [(*part, missed) for part in reversed(parts)]
    return tuple(solved)


def _missed(panel: GrowthPanel) -> float:
    """The load that the last coefficients of a series carry.

    It is 0 where they are small beside the others.
    """
    size, length = np.abs(panel.series), panel.hi - panel.lo
    tail = float(size[-3:].max())
    return tail * length * panel.factor(length) if tail > DECAYED * float(size.max()) else 0.0


def _first_power(h: float, piece: Piece, first: bool) -> float:
    """The exponent of P' at the beginning of a piece; from the axis it is regular."""
    if piece.lo == 0.0 or not (first or piece.jumps):
        return 0.0
    return h - 1.0 if piece.jumps else h


def _panels(flat: FlatFunctions, origin: float, piece: Piece, power: float) -> list[GrowthPanel]:
    """Panels of a piece, still without their series.

    From a place where P' begins with a power of the distance they grow with this distance, beyond
    that in which the slip zones move through the place. P' over that power varies with the
    logarithm of the distance where this is about that of the slip zones, or the half-width, only.
    """
    lo, hi = piece.lo - origin, piece.hi - origin
    if not power:
        n = 1 if piece.lo == 0.0 else max(1, math.ceil(math.log2(piece.hi / piece.lo)))
        ends = [
            lo,
            *(piece.lo * (piece.hi / piece.lo) ** (k / n) - origin for k in range(1, n)),
            hi,
        ]
        return [_panel(origin, lo, hi) for lo, hi in itertools.pairwise(ends)]
    layer = piece.lo * min(flat.rest / flat.c, 1.0)
    ends, first = [hi - lo], min(max(layer, piece.lo * _narrowest(power)), hi - lo)
    while ends[-1] > first:
        end = ends[-1]
        fold = min(_fold(end / layer), _fold(end / piece.lo))
        ends.append(first if math.log(end / first) < ALMOST * fold else end * math.exp(-fold))
    ends.reverse()
    later = [_panel(origin, lo + d, lo + e, power, d) for d, e in itertools.pairwise(ends)]
    return [_panel(origin, lo, lo + ends[0], power), *later]


def _fold(ratio: float) -> float:
    """How much the distance may grow on a panel that ends at this ratio to a place of P'."""
    folds = math.log(ratio)
    return FOLDS - LONGER * folds if folds < 0.0 else (FOLDS + LONGER * folds) / (1.0 + LONGER)


def _narrowest(power: float) -> float:
    """The part of the half-width on which P' from a kink (power > 0) or a corner carries nothing.

    Its power is 1/2 and -1/2 there, as far as the slip zone is narrower.
    """
    return EPS**0.75 if power > 0.0 else EPS


def _panel(
    origin: float, lo: float, hi: float, power: float = 0.0, behind: float = math.inf
) -> GrowthPanel:
    return GrowthPanel(origin, lo, hi, power, np.zeros(DEGREE), behind)


def _halves(panel: GrowthPanel) -> list[GrowthPanel]:
    """The panel in two; the first is shorter, as kinks of the profile leave powers there."""
    ahead = CUT * (panel.hi - panel.lo) if panel.behind == math.inf else panel.nodes(0.5)
    middle, behind = panel.lo + ahead, panel.behind + ahead
    power = 0.0 if panel.behind == math.inf else panel.power
    return [replace(panel, hi=middle), replace(panel, lo=middle, power=power, behind=behind)]


def _collocated(
    flat: FlatFunctions,
    solved: list[GrowthPanel],
    piece: Piece,
    panel: GrowthPanel,
    matrix: Array,
) -> GrowthPanel:
    """The panel with its series, given the matrix of its own integrals."""
    ahead = panel.nodes(0.5 * (1.0 + chebyshev.points(DEGREE)))
    x = panel.lo + ahead  # from the origin
    known = (panel.origin + x) * piece.slope((panel.lo - (piece.lo - panel.origin)) + ahead)
    near = [other for other in solved if panel.lo - other.hi < NEAR * (other.hi - other.lo)]
    for other in near:
        known -= _beside(flat, other, x, (panel.lo - other.hi) + ahead)
    known -= _far(flat, [other for other in solved if other not in near], panel, ahead)
    return replace(panel, series=np.asarray(np.linalg.solve(matrix, known), dtype=float))


def _far(flat: FlatFunctions, panels: list[GrowthPanel], panel: GrowthPanel, ahead: Array) -> Array:
    """∫P' ρ D(ρ) ds over panels half their length or more before x = panel.lo + ahead."""
    if not panels:
        return np.zeros(len(ahead))
    inside, weight = (
        np.concatenate(column) for column in zip(*(p.places for p in panels), strict=True)
    )
    lo = np.repeat([p.lo for p in panels], [len(p.places[0]) for p in panels])
    x = (panel.origin + panel.lo + ahead)[:, None]
    # Differences of x and s themselves would be rounded to the half-width
    apart = (panel.lo - lo) - inside + ahead[:, None]
    integral: Array = flat.outside((panel.origin + lo + inside) / x, apart / x) @ weight
    return integral


def _beside(flat: FlatFunctions, panel: GrowthPanel, x: Array, beyond: Array) -> Array:
    """∫P' ρ D(ρ) ds over a panel that ends before x, by `beyond`."""
    return _up_to(flat, panel, panel.hi - panel.lo, x, beyond)


def _up_to(flat: FlatFunctions, panel: GrowthPanel, part: float, x: Array, beyond: Array) -> Array:
    """The same over a part of the panel."""
    length = np.full(len(x), part)
    kink = np.full(len(x), panel.behind)
    owner, ahead, left, weight = graded(
        length, kink, beyond, (panel.at_start, 0.0), longest=SHORTER, near=0.0
    )
    at = panel.origin + x[owner][:, None]
    t, rest = (panel.origin + panel.lo + ahead) / at, (beyond[owner][:, None] + left) / at
    return totals(owner, flat.outside(t, rest) * panel(ahead) * weight, len(x))


def load_slope(
    flat: FlatFunctions, growth: tuple[GrowthPanel, ...], ahead: float, x: Array
) -> Array:
    """∫P' D(x/s) ds/s up to b = origin + ahead for each x > b.

    It is 1/π ∫p/(x - t) dt beside the contact.
    """
    total = np.zeros(len(x))
    for panel in growth:
        end = min(panel.hi, ahead)
        if end > panel.lo:
            # Next to the edge rounding may leave x on it, or behind it
            beyond = np.maximum((x - panel.origin) - end, EPS * x)
            total += _up_to(flat, panel, end - panel.lo, x - panel.origin, beyond)
    return total / x


def _with_matrices(
    flat: FlatFunctions, panels: list[GrowthPanel]
) -> list[tuple[GrowthPanel, Array]]:
    """Panels, each with its matrix of `_own`."""
    first = [panel for panel in panels[:1] if panel.at_start]
    same = [_own(flat, alike) for alike in (first, panels[len(first) :]) if alike]
    return list(zip(panels, itertools.chain.from_iterable(same), strict=True))


def _own(flat: FlatFunctions, panels: list[GrowthPanel]) -> Array:
    """Matrices that take series to ∫P' ρ D(ρ) ds from lo to each x of a panel.

    The panels begin with one power.
    """
    stack, part = Stack(panels), 0.5 * (1.0 + chebyshev.points(DEGREE))
    ahead = np.concatenate([panel.nodes(part) for panel in panels])
    panel = np.repeat(np.arange(len(panels)), DEGREE)
    at = stack.origin + stack.lo[panel] + ahead
    powers = panels[0].at_start, -flat.h
    owner, inside, left, weight = graded(
        ahead, stack.behind[panel], at * (flat.rest / flat.c), powers, longest=SHORTER, near=0.0
    )
    panel, at = panel[owner], at[owner][:, None]
    s = (stack.origin + stack.lo[panel])[:, None] + inside
    values = stack.times_power(panel, inside, flat.outside(s / at, left / at) * weight)
    terms = chebyshev.polynomials(DEGREE, stack.variable(panel, inside))
    sums = np.einsum("kij,ij->ik", terms, values)
    rows = np.add.reduceat(sums, np.searchsorted(owner, np.arange(len(ahead))))
    return rows.reshape(len(panels), DEGREE, DEGREE)
