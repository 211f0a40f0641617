"""A crack normal to the surface of the half-plane, 0 < y < a, in the stress of the uncracked body.

With B = U' the slope of the opening U (the faces move apart by 4/E' U, E' the modulus in plane
strain or stress), the faces are free of the stress σ where

    1/π PV∫ B(t) [1/(t - y) - 1/(t + y) + 6y/(t + y)² - 4y²/(t + y)³] dt = -σ(y),      U >= 0

and the same kernel gives the sliding of the faces under τ. Its regular part is singular at the
mouth, where B is finite: a generalised kernel of `CauchyEquation`. At the tip

    B ~ -K / sqrt(2π (a - y)),      K_I of σ = σ_xx,  K_II of τ = σ_xy

Where the faces touch, B = 0 and they press on each other; an end of contact inside the crack is
smooth, with K = 0 there. The faces are without friction, so that contact does not change K_II, and
the crack does not change the stress of the contact on the surface.

Which faces touch is a linear complementarity problem on cells of constant opening. A cell that is
open by U has a dislocation at either end. Their stress on the faces is -A U, A with a positive
diagonal and negative other entries, so that

    U >= 0,      A U - σ >= 0,      U (A U - σ) = 0

has one solution, and policy iteration, which solves for the open cells and then opens what is in
tension and closes what overlaps, ends after a few steps. Cells are graded towards mouth and tip.

Tada, Paris & Irwin, The Stress Analysis of Cracks Handbook; Hills, Kelly, Dai & Korsunsky, Solution
of Crack Problems (1996), ch. 2-3.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.cauchy.density import JacobiDensity
from sie.cauchy.equation import CauchyEquation
from sie.errors import ContactError

Array = NDArray[np.float64]
Zones = tuple[tuple[float, float], ...]
Load = Callable[[Array], Any] | float

# Newton's steps for the ends of the open zones, the step of their difference quotients, as part of
# the depth of the end, and the last change, as part of the depth of the crack: its square is left
STEPS, DIFFERENCE, SETTLED = 30, 1e-6, 1e-5
# The shortest zone and contact, as part of the depth: K of shorter ones is not found
SHORT = 1e-5
# Points of the certificate on each zone, and what it lets pass, of the largest stress
CHECKED, TOLERATED = 61, 1e-8
# Cells that are open or closed: their number, and the least next to the mouth, of the depth
CELLS, SHORTEST = 72, 1e-4
ROUNDS = 200  # of opening and closing cells
TOL = 5e-9  # of the equations: the stress beside an edge of contact has rounding


class CrackCertificate(NamedTuple):
    """How well the density of a crack meets its equation and its inequalities.

    Parameters
    ----------
    residual : float
        The largest stress left on open faces, at points that no equation used, over the largest
        stress; for sliding faces too.
    lowest_opening, lowest_pressure : float
        0 where faces do not overlap, and where closed ones press on each other; otherwise negative,
        over the largest opening and the largest stress.
    """

    residual: float
    lowest_opening: float
    lowest_pressure: float

    @property
    def ok(self) -> bool:
        """Whether all three are zero to 1e-8."""
        return self.residual <= TOLERATED and min(self[1:]) >= -TOLERATED


def regular_kernel(y: Array, t: Array) -> Array:
    """What the free surface adds to the kernel 1/π(t - y) of a dislocation."""
    s = t + y
    share = y / s
    out: Array = (-1.0 + share * (6.0 - 4.0 * share)) / (np.pi * s)
    return out


@dataclass(frozen=True)
class EdgeCrack:
    """A crack from the surface into the body, normal to the surface, under any stress.

    Parameters
    ----------
    depth : float
        Length a > 0 of the crack.
    normal : callable or float
        σ_xx on the line of the crack in the body without it, a stress, tension positive: a function
        of an array of depths 0 < y < a, or a number.
    shear : callable or float, optional
        σ_xy there.

    Raises
    ------
    ValueError
        For a depth that is not positive.

    Notes
    -----
    Faces that touch are without friction. A stress that is infinite at the surface like 1/sqrt(y),
    as at a sharp edge, leaves 2e-7 of K in doubt: the last 1e-14 of the depth are left out.

    References
    ----------
    Hills, Kelly, Dai & Korsunsky, Solution of Crack Problems (1996), ch. 2-3.

    Examples
    --------
    >>> import math, sie
    >>> crack = sie.EdgeCrack(depth=2.0, normal=1.0)
    >>> round(crack.mode_1 / math.sqrt(math.pi * 2.0), 9)
    1.121522255
    """

    depth: float
    normal: Load
    shear: Load = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "depth", arguments.positive("depth", self.depth))
        for name in ("normal", "shear"):
            value = getattr(self, name)
            if not callable(value):
                object.__setattr__(self, name, arguments.finite(name, value))

    # -- answers -----------------------------------------------------------------------------------

    @cached_property
    def mode_1(self) -> float:
        """K_I, stress times root of length; 0 where the faces touch at the tip."""
        zones = self.open
        tip = zones and zones[-1][1] == self.depth
        return max(self._K(self._opened, -1), 0.0) if tip else 0.0

    @cached_property
    def mode_2(self) -> float:
        """K_II, stress times root of length; positive for a positive σ_xy."""
        return self._K(self._slid, -1) if self._slid is not None else 0.0

    @property
    def open(self) -> Zones:
        """The zones (y1, y2) of depth where the faces are apart; () if nowhere."""
        return self._state[0]

    def opening(self, y: ArrayLike) -> Array:
        """U, by which the faces are apart times E'/4, stress times length.

        Parameters
        ----------
        y : array_like of float
            Depths, length.

        Returns
        -------
        ndarray of float
            Of the shape of y; 0 beyond the tip, and where the faces touch.
        """
        y = arguments.reals("y", y)
        density = self._opened
        flat = y.ravel()
        out = np.zeros(flat.shape)
        if density is not None:
            for part in density.parts:
                out += _integral_to_end(part, flat)
        return out.reshape(y.shape)

    def check(self) -> CrackCertificate:
        """The certificate: the equation at other points, and the inequalities of closure.

        Returns
        -------
        CrackCertificate
            `.ok` sums it up.
        """
        angle = np.pi * (np.arange(CHECKED) + 0.5) / CHECKED
        inner = 0.5 - 0.5 * np.cos(angle)
        apart = [y1 + (y2 - y1) * inner for y1, y2 in self.open]
        ends = [0.0, *(y for zone in self.open for y in zone), self.depth]
        touching = [y1 + (y2 - y1) * inner for y1, y2 in zip(ends[::2], ends[1::2], strict=True)]
        everywhere = self.depth * inner
        stress = np.abs(self._values(self.normal, everywhere)).max(initial=1e-300)
        left = [np.abs(self._left(self.normal, self._opened, y)).max() / stress for y in apart]
        if self._slid is not None:
            sheared = np.abs(self._values(self.shear, everywhere)).max(initial=1e-300)
            left.append(np.abs(self._left(self.shear, self._slid, everywhere)).max() / sheared)
        U = self.opening(np.concatenate(apart)) if apart else np.zeros(1)
        pull = [
            self._left(self.normal, self._opened, y).max() / stress
            for y in touching
            if y[-1] - y[0] > SHORT * self.depth
        ]
        return CrackCertificate(
            float(max(left, default=0.0)),
            min(0.0, float(U.min() / max(U.max(), 1e-300))),
            -max(0.0, float(max(pull, default=0.0))),
        )

    # -- the equations -----------------------------------------------------------------------------

    @cached_property
    def _state(self) -> tuple[Zones, JacobiDensity | None]:
        """The open zones and B on them.

        Cells show which zones there are; Newton's method moves their ends until K = 0 there.
        """
        a = self.depth
        ends = a * np.ravel(open_zones(lambda y: self._values(self.normal, a * y)))
        moved = math.inf
        for _ in range(STEPS):
            if not ends.size:
                return (), None
            density = self._solved(self.normal, zones := _pairs(ends))
            free = np.flatnonzero((ends > 0.0) & (ends < a))
            if moved <= SETTLED * a or not free.size:
                return zones, density
            change = self._change(ends, free, density)
            # none goes more than half the way to a neighbour
            halves = 0.5 * np.diff(np.concatenate(([0.0], ends[free], [a])))
            room = np.minimum(halves[:-1], halves[1:])
            ends[free] += np.clip(change, -room, room)
            moved = float(np.abs(change).max())
            while (short := np.flatnonzero(np.diff(ends) <= SHORT * a)).size:
                ends = np.delete(ends, [short[0], short[0] + 1])  # a zone or a contact vanishes
            if ends.size and a - ends[-1] <= SHORT * a:
                ends[-1] = a  # so does contact at the tip
        raise ContactError(
            f"the ends of contact of the faces of a crack of depth {a:g} are not found: the stress "
            "changes its sign too often along it; ask for other depths",
            zones=_pairs(ends),
        )

    def _change(self, ends: Array, free: NDArray[np.intp], density: JacobiDensity) -> Array:
        """Newton's step for the free ends of the open zones; towards contact only where K < 0."""
        K = np.ravel(density.intensities)[free]
        slopes = np.empty((len(free), len(free)))
        for column, j in enumerate(free):
            moved = ends.copy()
            moved[j] *= 1.0 + DIFFERENCE
            other = np.ravel(self._solved(self.normal, _pairs(moved)).intensities)[free]
            slopes[:, column] = (other - K) / (DIFFERENCE * ends[j])
        change = np.linalg.solve(slopes, -K)
        astray = (change * K > 0.0) & (np.abs(change) > SETTLED * self.depth)
        return np.asarray(np.where(astray, -np.sign(K) * self.depth, change))

    def _solved(self, load: Load, zones: Zones) -> JacobiDensity:
        """B with free faces on the zones, singular at their ends but for the mouth."""
        mouth = zones[0][0] == 0.0
        ends = [("singular", "singular")] * len(zones)
        if mouth:
            ends[0] = ("finite", "singular")
        totals = tuple(None if mouth and i == 0 else 0.0 for i in range(len(zones)))
        equation = CauchyEquation(
            zones,
            g=lambda y: -self._values(load, y),
            k=regular_kernel,
            ends=ends,
            total=totals if any(t is not None for t in totals) else None,
        )
        return equation.solve(TOL)

    @property
    def _opened(self) -> JacobiDensity | None:
        return self._state[1]

    @cached_property
    def _slid(self) -> JacobiDensity | None:
        if not callable(self.shear) and self.shear == 0.0:
            return None
        return self._solved(self.shear, ((0.0, self.depth),))

    def _K(self, density: JacobiDensity | None, zone: int) -> float:
        assert density is not None
        return -math.sqrt(2.0 * math.pi) * float(density.intensities[zone][1])

    def _values(self, load: Load, y: Array) -> Array:
        if not callable(load):
            return np.full(y.shape, load)
        return arguments.real_values("the stress on the crack", load, y)

    def _left(self, load: Load, density: JacobiDensity | None, y: Array) -> Array:
        """The stress on the faces at y, without that of the tip beyond the crack."""
        out = self._values(load, y)
        if density is not None:
            out = out - density.hilbert(y)
            for part in density.parts:
                _, from_left, _, weights = part.nodes
                out = out + regular_kernel(y[:, None], part.map.x1 + from_left) @ weights
        return out


def _integral_to_end(part: Any, y: Array) -> Array:
    """-∫ B from y to the end of a part, whose square root at the end a substitution removes."""
    x1, x2 = part.map.x1, part.map.x2
    inside = y < x2
    start = np.clip(y[inside], x1, x2)
    g, w = np.polynomial.legendre.leggauss(60)
    # x2 - t = (x2 - y) sin²: smooth at the end, and dense at y
    angle = 0.25 * np.pi * (g + 1.0)
    length = (x2 - start)[:, None]
    to_right = length * np.cos(angle) ** 2
    to_left = (start - x1)[:, None] + length * np.sin(angle) ** 2
    values = part.value(to_right.ravel(), to_left.ravel()).reshape(to_right.shape)
    out = np.zeros(y.shape)
    out[inside] = -(values * length) @ (0.5 * np.pi * w * np.sin(angle) * np.cos(angle))
    return out


def _pairs(ends: Array) -> Zones:
    return tuple((float(y1), float(y2)) for y1, y2 in ends.reshape(-1, 2))


# -- which faces touch ----------------------------------------------------------------------------


def open_zones(stress: Callable[[Array], Array]) -> Zones:
    """The zones of a crack of depth 1 whose faces are apart under a stress, to a cell."""
    edges, middles, A = cells()
    return _zones(opened(A, stress(middles)), edges)


@lru_cache(maxsize=1)
def cells() -> tuple[Array, Array, Array]:
    """The edges of the cells, their middles, and A."""
    half = CELLS // 2
    deep = 1.0 - 0.5 * np.linspace(1.0, 0.0, half + 1) ** 2
    edges = np.concatenate(([0.0], np.geomspace(SHORTEST, 0.5, half)[:-1], deep))
    middles = 0.5 * (edges[1:] + edges[:-1])
    y, t = middles[:, None], edges[None, :]
    s = t + y
    of_dislocation = (1.0 / (t - y) - 1.0 / s + 6.0 * y / s**2 - 4.0 * y**2 / s**3) / np.pi
    return edges, middles, of_dislocation[:, 1:] - of_dislocation[:, :-1]


def opened(A: Array, stress: Array) -> NDArray[np.bool_]:
    """Whether each cell is open under the stresses at their middles."""
    apart = np.ones(stress.shape, dtype=bool)
    for _ in range(ROUNDS):
        U = np.zeros(len(stress))
        U[apart] = np.linalg.solve(A[np.ix_(apart, apart)], stress[apart])
        found = np.where(apart, U > 0.0, stress - A @ U > 0.0)
        if (found == apart).all():
            break
        apart = found
    return apart


def _zones(apart: NDArray[np.bool_], edges: Array) -> Zones:
    change = np.flatnonzero(np.diff(np.concatenate(([False], apart, [False])).astype(int)))
    return tuple((float(edges[i]), float(edges[j])) for i, j in change.reshape(-1, 2))
