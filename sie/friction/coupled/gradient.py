"""The slip gradient that normal loading leaves in the contact of dissimilar bodies.

γ = E*/2 g' = 1/π PV∫q/(x - t) dt + β p is what a point that sticks keeps. With P'(s) = dP/ds and
the slip gradient γ̂(τ) of the flat punch under P = 1 on |t| < 1,

    γ(y) = ∫ P'(s) γ̂(y/s) ds/s,        a < s < min(b, y/c),

as γ̂ = 0 for τ < c. A point y < s slips before it is touched, s < y, too. On c < τ the shear is f p
beside a function that is regular there, so that (docs/derivations/coupled_slip.md)

    γ̂ = (1 - β²) cos(πθ) χ S/β  next to c,    β (1 + f²) φ - J  for τ < 1,    f D - J  for τ > 1,

and ∫_a^y P' D(y/s) ds/s = E*/2 h' by (1).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

from .load_rate import GrowthPanel
from .panels import graded, totals
from .profile import Kernel, Superposition
from .tables import Table
from .traction import ROUGH, SAME

Array = NDArray[np.float64]

DEGREE = 16
RESOLVED = 1e-12  # of the size of the functions: the last coefficients of a panel
FAINT = 1e-16  # of that size times the interval: what a short panel may miss
SHORTEST = 1e-11  # of the interval: no panel is cut that is as short; a corner's p is infinite
HALVINGS = 14  # of the last panel, before its functions are evaluated
APART = 1e-9  # of the interval: marks that are nearer are one


class SlipGradient:
    """γ at 0 <= y <= b, from E*/2 h' and P' up to origin + ahead."""

    def __init__(self, superposition: Superposition, ahead: float) -> None:
        self.flat, self.growth = superposition.flat, superposition.growth
        self.superposition, self.ahead = superposition, ahead

    def __call__(self, y: Array, H: Array) -> Array:
        """γ; H is E*/2 h' at y."""
        flat, origin = self.flat, self.growth[0].origin
        gamma = np.zeros(len(y))
        slipped = (y > flat.c * origin) & (y > 0.0)
        at = y[slipped]
        top = np.minimum(self.ahead, at / flat.c - origin)
        gamma[slipped] = flat.friction * H[slipped] - self._beside_shear(at, top)
        whole = np.full(len(at), self.ahead)
        gamma[slipped] += self.superposition._sum(self._kernels, at, whole, over_s=True)
        return gamma

    def beside(self, y: Array, H: Array) -> Array:
        """γ beside the contact, y > b; H is 1/π ∫p/(y - t) dt there."""
        gamma: Array = self.flat.friction * H - self._beside_shear(y, np.full(len(y), self.ahead))
        return gamma

    @cached_property
    def _kernels(self) -> tuple[Kernel, ...]:
        """γ̂ next to c, and its part that is infinite at τ = 1."""
        f, of = self.flat, self.superposition
        beside = (1.0 - f.beta**2) * f.sine / f.beta
        strength = f.beta * (1.0 + f.friction**2) * f.sine
        chi, S, Psi = f.weight, f.S, f.Psi
        return (
            of._near_edge(lambda t, e, d: strength * chi(t, e, d) * Psi(t, e), -f.h),
            of._beside_c(lambda t, e, d: beside * chi(t, e, d) * S(t, e), f.h),
        )

    @cached_property
    def _J(self) -> Table:
        """J(τ) τ as a function of c^(1/2)/τ from 0 to 1."""
        f = self.flat

        def J(part: Array, rest: Array) -> Array:
            values = f._J(f.middle / part, (f.beyond - rest) / part, f._S_in_stick)
            return values * f.middle / part

        # J is not smooth at τ = c and at τ = -1, the other edge
        return Table((0.0, 1.0), (1.0, 0.0), (f.middle, f.beyond / f.middle), J)

    def _beside_shear(self, y: Array, top: Array) -> Array:
        """∫P' J(y/s) ds/s up to y/c^(1/2) or origin + top."""
        total = np.zeros(len(y))
        for panel in self.growth:
            far = y / self.flat.middle - panel.origin
            end = np.minimum(np.minimum(far, top), panel.hi)
            k = np.flatnonzero(end > panel.lo)
            if k.size:
                total[k] += self._on_panel(panel, y[k], end[k], (far - end)[k])
        return total

    def _on_panel(self, panel: GrowthPanel, y: Array, end: Array, before: Array) -> Array:
        """The same on one panel up to `end`, which lies `before` y/c^(1/2)."""
        f, z = self.flat, panel.origin
        to_c = np.maximum(y * (f.beyond / f.c), (y / f.c - z) - end)
        kink = np.minimum(y + (z + panel.lo), panel.behind)
        owner, ahead, left, weight = graded(end - panel.lo, kink, to_c, (panel.at_start, 0.0))
        scale = (f.middle / y[owner])[:, None]
        # Next to its end J varies over distances as short as the slip zone: 1 - part would lose
        # their digits
        remaining = scale * (before[owner][:, None] + left)
        values = self._J(scale * ((z + panel.lo) + ahead), remaining) * panel(ahead) * weight
        return totals(owner, values, len(y)) / y


class Tabulated(NamedTuple):
    """Chebyshev series of an even function on panels of 0 < y < b, ascending."""

    lo: Array
    hi: Array
    series: Array

    def __call__(self, x: Array) -> Array:
        """The values at |x| <= b."""
        y = np.abs(x)
        k = np.minimum(np.searchsorted(self.hi, y), len(self.hi) - 1)
        lo, hi = self.lo[k], self.hi[k]
        values: Array = chebyshev.evaluate(self.series.T[:, k], 2.0 * (y - lo) / (hi - lo) - 1.0)
        return values

    @property
    def cuts(self) -> Array:
        """Ends of the panels on both sides of the axis."""
        return np.concatenate((-self.hi[::-1], self.lo[:1], self.hi))


def tabulated(
    function: Callable[[Array], Array],
    companions: tuple[Callable[[Array], Array], ...],
    marks: tuple[float, ...],
    size: float,
) -> Tabulated:
    """The function on panels on which its companions are resolved as well, to parts of `size`.

    All are smooth between the marks; the last of these is where the panels end.
    """
    b = marks[-1]
    kept = [m for m in marks[:-1] if APART * b < m < (1.0 - APART) * b]
    ends = [0.0, *(m for k, m in enumerate(kept) if m - (0.0, *kept)[k] > APART * b), b]
    # Next to the end all of them have a power of the distance
    ends[-1:] = [b - (b - ends[-2]) * 0.5**k for k in range(1, HALVINGS)] + [b]
    part = 0.5 * (1.0 + chebyshev.points(DEGREE))
    todo = [(lo, hi, np.inf) for lo, hi in itertools.pairwise(ends)]
    done: list[tuple[float, float, Array]] = []
    while todo:
        lo, hi, before = (np.array(column) for column in zip(*todo, strict=True))
        y = (lo[:, None] + (hi - lo)[:, None] * part).ravel()
        f = np.stack([v(y).reshape(len(lo), DEGREE) for v in (function, *companions)])
        series = chebyshev.transform(f)
        tail = np.abs(series[..., -2:]).max(axis=(0, 2)) / size
        settled = (tail <= RESOLVED) | (tail * (hi - lo) <= FAINT * b)
        settled |= (tail < ROUGH) & (tail > SAME * before) | (hi - lo <= SHORTEST * b)
        done += [(lo[k], hi[k], series[0, k]) for k in np.flatnonzero(settled)]
        todo = []
        for k in np.flatnonzero(~settled).tolist():
            middle = 0.5 * (lo[k] + hi[k])
            todo += [(lo[k], middle, tail[k]), (middle, hi[k], tail[k])]
    done.sort(key=lambda panel: panel[0])
    return Tabulated(*(np.array(column) for column in zip(*done, strict=True)))
