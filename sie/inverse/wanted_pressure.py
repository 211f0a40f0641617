"""The profile that is pressed with a wanted pressure.

By equation (1), with t = m - r cos θ on each patch and x likewise of θ_x,

    h'(x) = 2/(π E*) PV∫ p(t)/(x - t) dt
          = -1/(π E*) PV∫ p (cot((θ - θ_x)/2) + cot((θ + θ_x)/2)) dθ

A pressure that ends like a square root, or with any value, is smooth in θ. It is a polynomial p_k
on each panel k of θ, no longer than a right angle. Near a pole a its own polynomial is taken out,
which leaves a smooth integrand and a logarithm; elsewhere the panel's rule is exact to rounding:

    ∫_k (p_k(θ) - p_k(a)) cot((θ - a)/2) dθ + 2 p_k(a) ln(sin((hi - a)/2)/sin((lo - a)/2))

Beside a patch θ_x is complex, and the poles are a conjugate pair.
Between patches the surface falls and rises by the integral of the same h'. Lundberg's roller, an
even pressure, is 2p/(π E*) ln((b + x)/(b - x)).

Reference: G. Lundberg (1939), Forsch. Ing.-Wes. 10; Johnson (1985), § 5.8.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie import arguments
from sie.numerics import chebyshev
from sie.profiles.base import Profile
from sie.profiles.from_function import FromFunction
from sie.profiles.resolution import resolved
from sie.profiles.row import Row

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

NODES = 40  # of a panel, whose rule serves outside of this Bernstein ellipse
CLOSE = 1.56
TOLERANCE = 1e-15
TINY = 1e-300
SPARED = 1e-13  # half-widths: so far before an edge ends a slope that is infinite there
VANISHES = 1e-12  # of the peak: a pressure that is 0 at an edge
PLACES = 1 << 9  # evaluated together


def _gauss(n: int) -> tuple[Array, Array]:
    node, weight = chebyshev.gauss_legendre(n)
    return 2.0 * node - 1.0, 2.0 * weight


@dataclass(frozen=True, eq=False)
class Panels:
    """A pressure on the panels of one patch.

    lo, hi   (K,), angles
    series   (D, K), Chebyshev coefficients of p
    m, r     centre and half-width of the patch, lengths
    vanishes whether p is 0 at each edge
    """

    lo: Array
    hi: Array
    series: Array
    m: float
    r: float
    vanishes: tuple[bool, ...] = (False, False)

    def integral(self, x: Array) -> Array:
        """PV∫ p(t)/(x - t) dt at x (n,)."""
        pole = np.arccos((self.m - x.astype(complex)) / self.r)
        image = np.where(pole.real < 0.5 * np.pi, -pole, 2.0 * np.pi - pole)
        return np.asarray(-0.5 * (self._of_pole(pole) + self._of_pole(image)))

    def _of_pole(self, a: Complex) -> Array:
        """PV∫ p cot((θ - a)/2) dθ for poles a (n,), its real part."""
        node, weight = _gauss(NODES)
        middle, half = 0.5 * (self.hi + self.lo), 0.5 * (self.hi - self.lo)
        theta = middle[:, None] + half[:, None] * node
        s = (a[:, None] - middle) / half
        near = np.abs(s + np.sqrt(s - 1.0) * np.sqrt(s + 1.0)) <= CLOSE
        total = np.zeros(a.shape)
        i, k = np.nonzero(~near)
        p = chebyshev.evaluate(self.series[:, :, None], node)[k]
        np.add.at(total, i, half[k] * ((p / np.tan(0.5 * (theta[k] - a[i, None]))).real @ weight))
        i, k = np.nonzero(near)
        u = 0.5 * (theta[k] - a[i, None])
        divided = self._divided(k, node, s[i, k]) * np.cos(u) / np.sinc(u / np.pi)
        own = chebyshev.evaluate(self.series[:, k], s[i, k])
        lo, hi = (np.sin(0.5 * (end[k] - a[i])) for end in (self.lo, self.hi))
        ends = np.log(np.where(hi == 0.0, TINY, hi)) - np.log(np.where(lo == 0.0, TINY, lo))
        # on the surface the logarithm is that of the size
        ends = np.where(a[i].imag == 0.0, ends.real, ends)
        np.add.at(total, i, 2.0 * (divided.real @ weight + (own * ends).real))
        return total

    @property
    def at_ends(self) -> Array:
        """p at both edges."""
        first, last = self.series[:, 0], self.series[:, -1]
        return np.array([first @ (-1.0) ** np.arange(len(first)), last.sum()])

    @property
    def edges(self) -> tuple[float, float]:
        """The edges of the patch."""
        return self.m - self.r, self.m + self.r

    def cleaned(self) -> Panels:
        """The same without the rounding of a pressure that vanishes at an edge."""
        series, size = self.series.copy(), np.abs(self.series).max()
        for k, end, value in zip((0, -1), (-1.0, 1.0), self.at_ends.tolist(), strict=True):
            if abs(value) <= VANISHES * size and len(series) > 1:
                series[0, k] -= 0.5 * value
                series[1, k] -= 0.5 * value * end
        return replace(self, series=series, vanishes=tuple(np.abs(self.at_ends) <= VANISHES * size))

    def _divided(self, k: Any, node: Array, s: Complex) -> Complex:
        """(p_k(node) - p_k(s))/(node - s), (pairs, nodes), by the recurrence of T_n[node, s]."""
        s = s[:, None] + 0.0 * node
        t = node
        before, now = np.zeros_like(s), np.ones_like(s)  # T_n[t, s]
        last, here = np.ones_like(s), s  # T_n(s)
        total = np.zeros_like(s)
        for c in self.series[1:, k]:
            total = total + c[:, None] * now
            before, now = now, 2.0 * t * now - before + 2.0 * here
            last, here = here, 2.0 * s * here - last
        return total


@dataclass(frozen=True, eq=False)
class WantedSlope:
    """h' of the profile at x, on its patches and between them."""

    patches: tuple[Panels, ...]
    modulus: float

    def __call__(self, x: Array) -> Array:
        """h' at an array of x."""
        flat = np.ravel(np.asarray(x, dtype=float))
        out = np.empty(flat.shape)
        for k in range(0, len(flat), PLACES):
            part = flat[k : k + PLACES]
            out[k : k + PLACES] = sum(patch.integral(part) for patch in self.patches)
        return np.asarray(2.0 / (np.pi * self.modulus) * out.reshape(np.shape(x)))


@dataclass(frozen=True, eq=False)
class Extended:
    """h' of one patch as series, with straight lines beyond both edges: they open the gap.

    breaks      (N + 1,), ascending, from edge to edge
    series      (D, N), Chebyshev coefficients on the pieces between
    steepness   of the lines
    """

    breaks: Array
    series: Array
    steepness: float

    def __call__(self, x: Array) -> Array:
        """h' at an array of x."""
        ends = self.breaks
        inside = np.clip(x, ends[0], ends[-1])
        k = np.clip(np.searchsorted(ends, inside, "right") - 1, 0, len(ends) - 2)
        s = ((inside - ends[k]) - (ends[k + 1] - inside)) / (ends[k + 1] - ends[k])
        H = chebyshev.evaluate(self.series[:, k], s)
        return np.asarray(H + self.steepness * (x - inside))


def profile_for_pressure(
    p: Callable[[Array], Any],
    *,
    modulus: float,
    half_width: float | None = None,
    domain: Sequence[Any] | None = None,
    breaks: Sequence[float] = (),
) -> Profile:
    """The profile whose contact has a wanted pressure under the load ∫p dx.

    Parameters
    ----------
    p : callable
        The pressure at an array of x, stress.
    modulus : float
        E*, stress.
    half_width : float, optional
        b: the contact is [-b, b], length.
    domain : (float, float) or sequence of such pairs, optional
        The contact, or several patches,, in place of the half-width.
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
        If p is negative somewhere or no function, or the contact is not given once.

    Notes
    -----
    Solved again, with ∫p dx as load, the profile has the pressure p to some 1e-13 of its peak. A
    pressure that does not vanish at an edge needs a slope that is infinite there like a logarithm:
    the profile ends 1e-13 half-widths before, and the pressure is met to some 1e-11.

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
    if not callable(p):
        raise ValueError(f"p = {p!r} is not a function: give one of an array of x")
    patches = tuple(_of_function(p, lo, hi, breaks) for lo, hi in _contact(half_width, domain))
    slope = WantedSlope(tuple(patch.cleaned() for patch in patches), modulus)
    pads = _pads(slope, breaks)
    return pads[0] if len(pads) == 1 else _in_row(slope, pads)


def _pads(slope: WantedSlope, breaks: Sequence[float]) -> list[Profile]:
    """A profile for each patch, up to the middle of the gaps beside it.

    Where the pressure does not vanish at an edge, the slope is infinite there, and it ends before.
    """
    edges = [patch.edges for patch in slope.patches]
    middles = [0.5 * (hi + lo) for (_, hi), (lo, _) in pairwise(edges)]
    limits = zip([-np.inf, *middles], [*middles, np.inf], strict=True)
    pads: list[Profile] = []
    for patch, (lo, hi), room in zip(slope.patches, edges, limits, strict=True):
        vanishes = patch.vanishes
        ends = lo + SPARED * patch.r, hi - SPARED * patch.r
        H = slope(np.array([lo + 0.25 * patch.r, *ends, hi - 0.25 * patch.r]))
        chords = np.abs([H[1] - H[0], H[3] - H[2]]) / (0.25 * patch.r)
        first, last = (edge if held else end for edge, held, end in zip((lo, hi), vanishes, ends))
        cuts = np.array([first, *(b for b in breaks if lo < b < hi), last])
        line = Extended(*_series(slope, cuts), float(chords.max()))
        domain = tuple(room[k] if vanishes[k] else ends[k] for k in (0, 1))
        inner = [b for b in (lo, *breaks, hi) if domain[0] < b < domain[1] and lo <= b <= hi]
        pads.append(FromFunction(line, inner, (domain[0], domain[1])))
    return pads


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


def _of_function(p: Callable[[Array], Any], lo: float, hi: float, breaks: Any) -> Panels:
    m, r = 0.5 * (lo + hi), 0.5 * (hi - lo)

    def of_angle(theta: Array) -> Array:
        x = np.clip(m - r * np.cos(theta), lo, hi)
        return arguments.real_values("p", p, x)

    inner = sorted(float(np.arccos((m - b) / r)) for b in breaks if lo < b < hi)
    ends, degrees = resolved(
        of_angle, np.array(sorted({0.0, *inner, 0.5 * np.pi, np.pi})), TOLERANCE
    )
    s = chebyshev.points(int(degrees.max()) + 1)
    middle, half = 0.5 * (ends[1:] + ends[:-1])[:, None], 0.5 * np.diff(ends)[:, None]
    values = of_angle(middle + half * s)
    if values.min() < 0.0:
        k = np.unravel_index(np.argmin(values), values.shape)
        x = float(m - r * np.cos((middle + half * s)[k]))
        raise ValueError(f"p = {values[k]:.6g} at x = {x:.6g} is a tension: give p >= 0")
    return Panels(ends[:-1], ends[1:], chebyshev.transform(values).T, m, r)


def _series(slope: WantedSlope, cuts: Array) -> tuple[Array, Array]:
    """Pieces that resolve the slope, which is asked for often, and its coefficients there."""
    ends, degrees = resolved(slope, cuts, TOLERANCE)
    s = chebyshev.points(int(degrees.max()) + 1)
    middle, half = 0.5 * (ends[1:] + ends[:-1])[:, None], 0.5 * np.diff(ends)[:, None]
    return ends, chebyshev.transform(slope(middle + half * s)).T


def _in_row(slope: WantedSlope, pads: list[Profile]) -> Profile:
    """The pads at the heights at which the surface meets them, which falls and rises between."""
    node, weight = _gauss(2 * NODES)
    placed = [pads[0]]
    for pad, (one, other) in zip(pads[1:], pairwise(slope.patches), strict=True):
        b, a = one.edges[1], other.edges[0]
        # the square roots of the edges are smooth in the angle
        angle = 0.5 * np.pi * (1.0 + node)
        x = 0.5 * (a + b) - 0.5 * (a - b) * np.cos(angle)
        rise = 0.25 * np.pi * (a - b) * float((weight * np.sin(angle)) @ slope(x))
        placed.append(pad.raised(float(placed[-1].height(b) - pad.height(a)) + rise))
    return Row(placed)
