"""Slip zones at both ends of a stick zone: their lengths, and the shear between them.

On the contact q = s1 f p left of the stick zone [c1, c2] and q = s2 f p right of it, s = ±1.
Inside, 1/π PV∫q/(x - t) dt = τ, the strain that a bulk stress causes, as a stress. Let c = (c1 +
c2)/2, ρ = (c2 - c1)/2, R(z) = sqrt(z - c1) sqrt(z - c2), and w = |R| on the stick zone. (Fq - τ)/R
is continuous across it and vanishes far away like 1/z, so that (Muskhelishvili 1953, § 107)

    Fq(z) = τ + R(z)/π ∫_slip q(s) / (R(s) (z - s)) ds

and in the stick zone

    q(x)  = f w(x)/π [ s1 ∫_left p/(|R| |s - x|) ds + s2 ∫_right p/(|R| |s - x|) ds ]

The behaviour at infinity, Fq -> Q/(π z), gives two conditions for c1 and c2. In the combinations
that belong to one end each they are

    s2 ∫_right p sqrt((s-c1)/(s-c2)) ds + s1 ∫_left  p sqrt((c1-s)/(c2-s)) ds = (Q - π ρ τ)/f
    s1 ∫_left  p sqrt((c2-s)/(c1-s)) ds + s2 ∫_right p sqrt((s-c2)/(s-c1)) ds = (Q + π ρ τ)/f

With s1 = s2 this is Cattaneo (1938) and Mindlin (1949), and q/f is the difference of two pressures
(`partial_slip`). With s1 = -s2 slip is reversed on one side by a large bulk stress (Nowell & Hills
1987). All integrands are positive: nothing cancels, however short the zones are. The pressure next
to an edge is needed as a function of the distance from it, which a double x does not resolve. So it
is evaluated in coordinates whose origin is that edge (`EdgeFrame`).

The same argument gives the shear of a further load step while nothing else slips,
dq = [dQ/π - dτ (x - c)] / sqrt(ρ² - (x - c)²): slip zones grow at both ends as long as
s2 (dQ - π ρ dτ) >= 0 and s1 (dQ + π ρ dτ) >= 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.graded_rule import graded, on_panels
from sie.numerics.interval import EPS, Interval
from sie.numerics.root_finding import increasing_root
from sie.profiles.slope import Slope
from sie.traction.of_slope import SlopeDensity

Array = NDArray[np.float64]

# Towards a corner, and towards the end of the zone where q is wanted: GRADING**LEVELS is rounding.
LEVELS = 26
ROWS = 4096  # abscissae at a time
GATHERED = 22  # terms of 1/(d + s), 0 <= s <= length <= d: they fall like (3 + sqrt 8)^-n
MAX_SWEEPS = 60
SETTLED, STALLED = 8.0 * EPS, 1e-12
TINY = 1e-300


# -- the contact seen from one of its edges --------------------------------------------------------


@dataclass(frozen=True, eq=False)
class EdgeFrame:
    """The contact in coordinates of one of its edges: distance inwards, to relative accuracy.

    `density` and `slope` are the contact's, moved so that the edge is at 0; `side` is +1 for the
    right edge.
    """

    density: SlopeDensity
    slope: Slope
    side: float
    origin: tuple[float, float]  # what was added to x: -edge and -tail

    def pressure(self, distance: Array) -> Array:
        return self.density(-self.side * distance)

    @cached_property
    def breaks(self) -> Array:
        """Distances of the profile's breaks inside the contact, ascending."""
        b = -self.side * self.slope.breaks
        return np.sort(b[(b > 0.0) & (b < 2.0 * self.density.contact.r)])

    @property
    def width(self) -> float:
        return 2.0 * self.density.contact.r

    def zone(self, length: float) -> SlipZone:
        return slip_zone(self, length)


class SeenFromEdge(Protocol):
    """What acts at distances from an edge, and the distances at which it is not smooth."""

    @property
    def breaks(self) -> Array: ...
    def pressure(self, distance: Array) -> Array: ...


class Frame(Protocol):
    """An edge at which a slip zone of any length can begin."""

    def zone(self, length: float) -> SlipZone: ...


def edge_frame(density: SlopeDensity, slope: Slope, side: float) -> EdgeFrame:
    contact = density.contact
    edge, tail = (contact.x2, contact.tail2) if side > 0.0 else (contact.x1, contact.tail1)
    width = 2.0 * contact.r
    seen = Interval(-width, 0.0) if side > 0.0 else Interval(0.0, width)
    return EdgeFrame(
        density.moved(seen, -edge, -tail), slope.shifted(-edge).shifted(-tail), side, (-edge, -tail)
    )


# -- one zone --------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class SlipZone:
    """Quadrature over a slip zone.

    It is given by distances from the stick zone's end and from the edge of contact, and the forces
    p ds there.
    """

    length: float
    from_stick: Array
    from_edge: Array
    weight: Array
    force: Array

    def strong(self, rho: float) -> float:
        """∫p sqrt((s - c_far)/(s - c_near)) ds."""
        return float(self.force @ (np.sqrt(self.from_stick + 2.0 * rho) / np.sqrt(self.from_stick)))

    def weak(self, rho: float) -> float:
        """∫p sqrt((s - c_near)/(s - c_far)) ds."""
        return float(self.force @ np.sqrt(self.from_stick / (self.from_stick + 2.0 * rho)))

    def pull(self, distance: Array, rho: float) -> Array:
        """∫p/(|R| |s - x|) ds for x at these distances (1-d) from the stick zone's near end.

        The places x lie beyond that end, away from the slip zone.
        """
        weight = self.force / np.sqrt(self.from_stick * (self.from_stick + 2.0 * rho))
        out = np.empty(distance.shape)
        far = distance >= self.length
        places, strength = self._gathered(weight) if far.any() else (self.from_stick, weight)
        for at, nodes, charge in (
            (np.flatnonzero(far), places, strength),
            (np.flatnonzero(~far), self.from_stick, weight),
        ):
            for start in range(0, len(at), ROWS):
                rows = at[start : start + ROWS]
                out[rows] = np.reciprocal(distance[rows, None] + nodes) @ charge
        return out

    def _gathered(self, weight: Array) -> tuple[Array, Array]:
        """A few places in the zone, and weights that act beyond its length like all of them.

        1/(d + s) is a short series in s.
        """
        u = chebyshev.points(GATHERED)
        series = chebyshev.polynomials(GATHERED, 2.0 * self.from_stick / self.length - 1.0)
        series *= np.where(np.arange(GATHERED) == 0, 1.0, 2.0)[:, None] / GATHERED
        strength: Array = chebyshev.polynomials(GATHERED, u).T @ (series @ weight)
        return 0.5 * self.length * (1.0 + u), strength


def slip_zone(frame: SeenFromEdge, length: float, at_edge: int = 0) -> SlipZone:
    """The slip zone of this length at an edge: s = edge - length cos²(ψ/2).

    It is graded towards the stick zone and towards breaks, and by so many levels towards the edge.

    In ψ a smooth edge and a sharp one are both harmless.
    """
    if length <= 0.0:
        none = np.zeros(0)
        return SlipZone(0.0, none, none, none, none)
    inner = frame.breaks[frame.breaks < length]
    at_breaks = 2.0 * np.arctan2(np.sqrt(length - inner), np.sqrt(inner))[::-1]
    marks = np.concatenate(([0.0], at_breaks, [np.pi]))
    ratios = graded(LEVELS)
    cuts = [marks]
    for k, (lo, hi) in enumerate(pairwise(marks)):
        cuts += [lo + (hi - lo) * ratios, lo + (hi - lo) * np.array([0.5, 0.75])]
        levels = LEVELS if k < len(marks) - 2 else at_edge
        cuts.append(hi - (hi - lo) * graded(levels)[:-1])
    angle, step = on_panels(np.unique(np.concatenate(cuts)))
    half = 0.5 * angle.ravel()
    from_stick, from_edge = length * np.sin(half) ** 2, length * np.cos(half) ** 2
    weight = step.ravel() * length * np.sin(half) * np.cos(half)
    p = frame.pressure(from_edge)
    return SlipZone(
        length, from_stick, from_edge, weight, weight * np.where(np.isfinite(p), p, 0.0)
    )


# -- both zones ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Drive:
    """The loads that open the slip zones, Q/f and π τ/f, and the signs of slip at both edges."""

    load: float
    strain: float
    left: float
    right: float


@dataclass(frozen=True, eq=False)
class SlipZones:
    """The stick zone and the slip zones beside it."""

    stick: Interval
    left: SlipZone
    right: SlipZone
    drive: Drive
    unheld: float = 0.0  # of π τ/f: what a stick zone that has no width does not hold back

    def shear(self, x: Array) -> Array:
        """q/f inside the stick zone, x 1-d."""
        c, d = self.stick, self.drive
        from_left, from_right = np.maximum(c.from_left(x), 0.0), np.maximum(c.from_right(x), 0.0)
        pulls = d.left * self.left.pull(from_left, c.r) + d.right * self.right.pull(from_right, c.r)
        q: Array = np.sqrt(from_left) * np.sqrt(from_right) / np.pi * pulls
        return q

    @cached_property
    def moment(self) -> float:
        """∫q x dx / f about x = 0: the next term of Fq far away."""
        c, d = self.stick, self.drive
        total = 0.0
        for sign, zone, outward in ((d.left, self.left, -1.0), (d.right, self.right, 1.0)):
            lever = c.r + zone.from_stick
            # Σ q (lever² - ρ²/2)/R with R = outward |R|
            weight = zone.force / np.sqrt(zone.from_stick * (zone.from_stick + 2.0 * c.r))
            total += outward * sign * float(weight @ (lever * lever - 0.5 * c.r * c.r))
        return total + c.m * d.load


def slip_zones(
    frames: tuple[Frame, Frame], contact: Interval, drive: Drive, guess: tuple[float, float]
) -> SlipZones:
    """The zones that the drive opens, from a guess of their lengths (left, right).

    Raises ContactError if there are none.

    Each end has an equation of its own, in which the other one matters only to second order: they
    are solved in turn.
    """
    lengths = list(guess)
    previous = np.inf
    for _ in range(MAX_SWEEPS):
        before = tuple(lengths)
        for k in (0, 1):
            lengths[k] = _length(frames, contact.r, drive, lengths, k)
        change = max(abs(new - old) / new for new, old in zip(lengths, before, strict=True))
        # Of a narrow stick zone the width is a difference of the lengths
        stuck = max(2.0 * contact.r - sum(lengths), EPS * contact.r)
        rounding = max(STALLED, SETTLED * contact.r / stuck)
        if change <= SETTLED or (change >= 0.5 * previous and change < rounding):
            break
        previous = change
    else:
        raise ContactError(
            "the ends of the stick zone do not settle: another zone of slip opens inside it",
            lengths=tuple(lengths),
        )
    left, right = (r.zone(length) for r, length in zip(frames, lengths, strict=True))
    return SlipZones(contact.moved(lengths[0], -lengths[1]), left, right, drive)


def _length(
    frames: tuple[Frame, Frame], r: float, drive: Drive, lengths: list[float], k: int
) -> float:
    """The length of zone k (0 left, 1 right) for the other one as it is."""
    other = frames[1 - k].zone(lengths[1 - k])

    def missed(length: float) -> float:
        return excess(frames[k].zone(length), other, r, drive, k)

    return increasing_root(missed, lengths[k], 2.0 * r - other.length)


def excess(zone: SlipZone, other: SlipZone, r: float, drive: Drive, k: int) -> float:
    """By what two zones fail the equation of the first one, zone k (0 left, 1 right)."""
    sign, others, outward = (drive.right, drive.left, -1.0) if k else (drive.left, drive.right, 1.0)
    rho = r - 0.5 * (zone.length + other.length)
    return zone.strong(rho) + sign * (
        others * other.weak(rho) - drive.load - outward * rho * drive.strain
    )


def opening(zone: SlipZone, other: SlipZone, rho: float) -> tuple[float, float]:
    """E*/(2f) times the slip at the edge where a zone begins: the shares of both, over their signs.

    With y and t the distances of x and of a force from the end of the zone, t and R(t) negative
    across the stick zone, and L = ∫dy/R, a share is the sum of the forces p ds over π R(t) times

        PV∫R(y)/(y - t) dy = R(d) + (t + ρ) L + R(t) ln|(U - V)/(U + V)|

    from y = 0 to d, the length of the zone, U² = d/(d + 2ρ) and V² = t/(t + 2ρ). The logarithm is
    infinite at t = d, towards which the zone has to be graded.
    """
    a, d = 2.0 * rho, zone.length
    until, U, L = np.sqrt(d * (d + a)), np.sqrt(d / (d + a)), 2.0 * np.arcsinh(np.sqrt(d / a))
    s, t = zone.from_stick, other.from_stick
    near, far = np.sqrt(s / (s + a)), np.sqrt(t / (t + a))
    own = (until + (s + rho) * L) / np.sqrt(s * (s + a))
    across = (until - (t + rho) * L) / np.sqrt(t * (t + a))
    # (U - V)/(U + V) is (U² - V²)/(U + V)², without cancellation
    own += np.log(np.maximum(a / (d + a) * zone.from_edge / (s + a) / (U + near) ** 2, TINY))
    across -= np.log(a / (d + a) * (d + t + a) / (t + a) / (1.0 + U * far) ** 2)
    return float(zone.force @ own) / np.pi, -float(other.force @ across) / np.pi
