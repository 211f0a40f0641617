"""The profile that is pressed with a wanted pressure.

By equation (1), with t = m - r cos θ on each patch and x likewise of θ_x,

    h'(x) = 2/(π E*) PV∫ p(t)/(x - t) dt
          = -1/(π E*) PV∫ p (cot((θ - θ_x)/2) + cot((θ + θ_x)/2)) dθ

A pressure that ends like a square root, or with any value, is smooth in θ. It is a polynomial p_k
on each panel k of θ, no longer than a right angle. Near a pole a its own polynomial is taken out,
which leaves a smooth integrand and a logarithm; elsewhere the panel's rule is exact to rounding:

    ∫_k (p_k(θ) - p_k(a)) cot((θ - a)/2) dθ + 2 p_k(a) ln(sin((hi - a)/2)/sin((lo - a)/2))

Beside a patch θ_x is complex, and the poles are a conjugate pair. A table is joined by monotone
cubics of the angle, one a panel. Between patches the surface falls and rises by the integral of the
same h'. Lundberg's roller, an even pressure, is 2p/(π E*) ln((b + x)/(b - x)).

Reference: G. Lundberg (1939), Forsch. Ing.-Wes. 10; Johnson (1985), § 5.8.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator

from sie import arguments
from sie.numerics import chebyshev
from sie.profiles.base import Profile, function_slope
from sie.profiles.from_function import FromFunction
from sie.profiles.pieces import Pieces, from_slope
from sie.profiles.row import Row

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Pressure = Callable[[Array], Any]

NODES = 40  # of a panel, whose rule serves outside of this Bernstein ellipse
CLOSE = 1.56
TOLERANCE, OF_TABLE = 1e-15, 1e-12  # of the slope, where p is a function, and of a table
TINY = 1e-300
SPARED = 1e-13  # half-widths: so far before an edge ends a slope that is infinite there
VANISHES = 1e-12  # of the peak: a pressure that is 0 at an edge
PLACES = 1 << 12  # evaluated together
SHOWN = 17  # places of a piece at which tension is looked for


def _on_pieces(function: Callable[[Array], Array], cuts: Array, tolerance: float) -> Pieces:
    """The series of a function that is smooth between the cuts."""
    return from_slope(function_slope(cuts.tolist(), function), (cuts[0], cuts[-1]), tolerance)


@dataclass(frozen=True, eq=False)
class Patch:
    """A pressure on the patch m ± r, on panels of θ; whether it vanishes at each edge."""

    m: float
    r: float
    pressure: Pieces
    vanishes: tuple[bool, ...]

    @property
    def edges(self) -> tuple[float, float]:
        """The edges of the patch."""
        return self.m - self.r, self.m + self.r

    def integral(self, x: Array) -> Array:
        """PV∫ p(t)/(x - t) dt at x (n,)."""
        pole = np.arccos((self.m - x.astype(complex)) / self.r)
        image = np.where(pole.real < 0.5 * np.pi, -pole, 2.0 * np.pi - pole)
        both, total = np.concatenate((pole, image)), np.zeros(2 * len(x))
        for (lo, hi), c in zip(pairwise(self.pressure.breaks), self.pressure.series, strict=True):
            total += _of_panel(lo, hi, c, both)
        return -0.5 * (total[: len(x)] + total[len(x) :])


def _of_panel(lo: float, hi: float, c: Array, a: Complex) -> Array:
    """PV∫ p cot((θ - a)/2) dθ over a panel, for poles a (n,), its real part."""
    node, weight = chebyshev.gauss_legendre(NODES)
    node, weight = 2.0 * node - 1.0, 2.0 * weight
    middle, half = 0.5 * (hi + lo), 0.5 * (hi - lo)
    theta, s = middle + half * node, (a - middle) / half
    near = np.abs(s + np.sqrt(s - 1.0) * np.sqrt(s + 1.0)) <= CLOSE
    total = np.empty(a.shape)
    p = half * weight * chebyshev.evaluate(c, node)
    total[~near] = (1.0 / np.tan(0.5 * (theta - a[~near, None]))).real @ p
    u = 0.5 * (theta - a[near, None])
    divided = chebyshev.quotient(c, *np.broadcast_arrays(s[near, None], node + 0.0j))
    rest = (divided * np.cos(u) / np.sinc(u / np.pi)).real @ weight
    ends = [np.sin(0.5 * (end - a[near])) for end in (lo, hi)]
    low, high = (np.log(np.where(end == 0.0, TINY, end)) for end in ends)
    # on the surface the logarithm is that of the size
    logarithm = np.where(a[near].imag == 0.0, (high - low).real, high - low)
    total[near] = 2.0 * (rest + (chebyshev.evaluate(c, s[near]) * logarithm).real)
    return total


@dataclass(frozen=True, eq=False)
class WantedSlope:
    """h' of the profile at x, on its patches and between them."""

    patches: tuple[Patch, ...]
    modulus: float

    def __call__(self, x: Array) -> Array:
        """h' at an array of x."""
        flat = np.ravel(np.asarray(x, dtype=float))
        parts = (flat[k : k + PLACES] for k in range(0, len(flat), PLACES))
        total = [sum(patch.integral(part) for patch in self.patches) for part in parts]
        H: Array = 2.0 / (np.pi * self.modulus) * np.concatenate(total)
        return H.reshape(np.shape(x))


@dataclass(frozen=True, eq=False)
class Extended:
    """h' of one patch, with straight lines beyond both edges: they open the gap."""

    inside: Pieces
    steepness: float

    def __call__(self, x: Array) -> Array:
        """h' at an array of x."""
        within = np.clip(x, *self.inside.domain)
        return self.inside(within) + self.steepness * (x - within)


def profile_for_pressure(
    p: Pressure | tuple[ArrayLike, ArrayLike],
    *,
    modulus: float,
    half_width: float | None = None,
    domain: Sequence[Any] | None = None,
    breaks: Sequence[float] = (),
) -> Profile:
    """The profile whose contact has a wanted pressure under the load ∫p dx.

    Parameters
    ----------
    p : callable or (array_like, array_like)
        The pressure at an array of x, stress; or a table (x, p), whose points are joined in the
        angle θ of x = m - r cos θ by monotone cubics.
    modulus : float
        E*, stress.
    half_width : float, optional
        b: the contact is [-b, b], length.
    domain : (float, float) or sequence of such pairs, optional
        The contact, or several patches, in place of the half-width; if neither is given, a table
        is one patch from its first to its last point.
    breaks : sequence of float, optional
        Places where p has a kink or a jump.

    Returns
    -------
    Profile
        Beyond an edge at which p vanishes it goes on as a straight slope; else it ends there. With
        several patches it is a row of indenters.

    Raises
    ------
    ValueError
        If p is negative somewhere, neither a function nor a table, or the contact is not given
        once.

    Notes
    -----
    Solved again, with ∫p dx as load, the profile has the pressure p to some 1e-13 of its peak. A
    pressure that does not vanish at an edge needs a slope that is infinite there like a logarithm:
    the profile ends 1e-13 half-widths before, and the pressure is met to some 1e-11; so is that of
    a table, and one that vanishes at an edge by another power than a half. Where p has a kink or a
    jump h' is infinite: the profile is right, but `solve` may refuse it, as several patches.

    References
    ----------
    G. Lundberg (1939), Forsch. Ing.-Wes. 10.

    Examples
    --------
    >>> import numpy as np
    >>> import sie
    >>> pad = sie.profile_for_pressure(lambda x: np.sqrt(1.0 - x**8), half_width=1.0, modulus=1.0)
    >>> solution = sie.solve(sie.Scene(profile=pad, modulus=1.0, half_width=1.0))
    >>> round(float(solution.pressure(0.5)), 10) == round((1.0 - 0.5**8) ** 0.5, 10)
    True
    """
    modulus = arguments.positive("modulus", modulus)
    table = None if callable(p) else _table(p)
    if table is not None and half_width is None and domain is None:
        domain = table[0, 0], table[0, -1]
    wanted: Any = p if table is None else table
    contact = _contact(half_width, domain)
    slope = WantedSlope(tuple(_patch(wanted, lo, hi, breaks) for lo, hi in contact), modulus)
    joints = [*breaks] if table is None else table[0].tolist()
    pads = _pads(slope, joints, TOLERANCE if table is None else OF_TABLE)
    return pads[0] if len(pads) == 1 else _in_row(slope, pads)


# -- the pressure ----------------------------------------------------------------------------------


def _contact(half_width: float | None, domain: Any) -> list[tuple[float, float]]:
    """The patches, ascending."""
    if (half_width is None) == (domain is None):
        raise ValueError("give exactly one of half_width and domain, the contact of the pressure")
    if half_width is not None:
        b = arguments.positive("half_width", half_width)
        return [(-b, b)]
    pairs = np.atleast_2d(np.array(arguments.reals("domain", domain)))
    flat = pairs.ravel()
    if pairs.shape[1:] != (2,) or not np.isfinite(flat).all() or not (np.diff(flat) > 0.0).all():
        raise ValueError(
            f"domain = {domain!r} is no contact: give (x1, x2), or such pairs that ascend"
        )
    return [(float(lo), float(hi)) for lo, hi in pairs]


def _table(p: Any) -> Array:
    """x and p, (2, n). ValueError for what is no table of a pressure."""
    rows = [arguments.reals("p", row) for row in p] if isinstance(p, (tuple, list)) else []
    if [row.shape for row in rows] != [(max(map(np.size, rows), default=0),)] * 2:
        raise ValueError(
            f"p = {p!r} is not a function of an array of x, and no table: give (x, p), two arrays"
        )
    table = np.array(rows)
    if not np.isfinite(table).all() or not (np.diff(table[0]) > 0.0).all():
        raise ValueError("p = (x, p) has places that do not ascend, or numbers that are none")
    return table


def _patch(p: Any, lo: float, hi: float, breaks: Sequence[float]) -> Patch:
    """The pressure on a patch. ValueError where it is a tension."""
    m, r = 0.5 * (lo + hi), 0.5 * (hi - lo)
    of_angle: Pressure
    if callable(p):
        places = np.array([b for b in breaks if lo < b < hi])
        of_angle = lambda t: arguments.real_values("p", p, np.clip(m - r * np.cos(t), lo, hi))  # noqa: E731
    else:
        places, given = p[:, (p[0] >= lo) & (p[0] <= hi)]
        if len(places) < 4 or (places[0], places[-1]) != (lo, hi):
            raise ValueError(
                f"the table has no values from edge to edge of ({lo:g}, {hi:g}): give p at both "
                "edges and at two places or more between them"
            )
    knots = np.arccos(np.clip((m - places) / r, -1.0, 1.0))
    if not callable(p):
        of_angle = PchipInterpolator(knots, given)
    pressure = _on_pieces(of_angle, np.unique([0.0, 0.5 * np.pi, np.pi, *knots]), TOLERANCE)
    ends, series = pressure.breaks, pressure.series
    theta = np.linspace(ends[:-1], ends[1:], SHOWN)
    values = of_angle(theta)
    if values.min() < -VANISHES * np.abs(values).max():
        x = float(m - r * np.cos(theta.flat[np.argmin(values)]))
        raise ValueError(f"p = {values.min():.6g} at x = {x:.6g} is a tension: give p >= 0")
    # without the rounding of a pressure that vanishes at an edge
    at_edges = series[0] @ (-1.0) ** np.arange(len(series[0])), series[-1].sum()
    vanishes = tuple(abs(value) <= VANISHES * np.abs(series).max() for value in at_edges)
    for k, value, held in zip((0, -1), at_edges, vanishes, strict=True):
        if held:
            series[k, :2] -= 0.5 * value * np.array([1.0, 1.0 if k else -1.0])[: len(series[k])]
    return Patch(m, r, pressure, vanishes)


# -- the profile -----------------------------------------------------------------------------------


def _pads(slope: WantedSlope, breaks: Sequence[float], tolerance: float) -> list[Profile]:
    """A profile for each patch, up to the middle of the gaps beside it.

    Where the pressure does not vanish at an edge, the slope is infinite there, and it ends before.
    """
    edges = [patch.edges for patch in slope.patches]
    middles = [0.5 * (hi + lo) for (_, hi), (lo, _) in pairwise(edges)]
    limits = zip([-np.inf, *middles], [*middles, np.inf], strict=True)
    pads: list[Profile] = []
    for patch, (lo, hi), room in zip(slope.patches, edges, limits, strict=True):
        spared, held = SPARED * patch.r, patch.vanishes
        first, last = lo if held[0] else lo + spared, hi if held[1] else hi - spared
        H = slope(np.array([lo + 0.25 * patch.r, lo + spared, hi - spared, hi - 0.25 * patch.r]))
        steepness = float(np.abs([H[1] - H[0], H[3] - H[2]]).max()) / (0.25 * patch.r)
        cuts = np.array([first, *(b for b in breaks if first < b < last), last])
        line = Extended(_on_pieces(slope, cuts, tolerance), steepness)
        domain = room[0] if held[0] else first, room[1] if held[1] else last
        inner = [b for b in (lo, *cuts[1:-1].tolist(), hi) if domain[0] < b < domain[1]]
        pads.append(FromFunction(line, inner, domain))
    return pads


def _in_row(slope: WantedSlope, pads: list[Profile]) -> Profile:
    """The pads at the heights at which the surface meets them, which falls and rises between."""
    node, weight = (2.0 * v for v in chebyshev.gauss_legendre(2 * NODES))
    placed = [pads[0]]
    for pad, (one, other) in zip(pads[1:], pairwise(slope.patches), strict=True):
        b, a = one.edges[1], other.edges[0]
        # the square roots of the edges are smooth in the angle
        angle = 0.5 * np.pi * node
        x = 0.5 * (a + b) - 0.5 * (a - b) * np.cos(angle)
        rise = 0.25 * np.pi * (a - b) * float((weight * np.sin(angle)) @ slope(x))
        placed.append(pad.raised(float(placed[-1].height(b) - pad.height(a)) + rise))
    return Row(placed)
