"""Refinement of approximate edges to the rounding of their own equations.

With T = P/G, F1 = r K1 - T and F2 = r K2 - T of `edges`, both vanish where both edges are smooth.
For any [x1, x2] of a convex profile

    dF2/dx1 = dF1/dx2 = -I0/2,    dF2/dx2 = r JR + I0/2,    dF1/dx1 = -r JL + I0/2,    JR, JL >= 0

so I0 = (F2 - F1)/(2r) grows with either edge, and max(F1, F2) with the contact. Hence every
evaluation bounds one edge of the contact sought:

    I0 > 0, F2 > 0: x2 is too far right      I0 > 0, F2 < 0: x1 is too far right
    I0 < 0, F1 < 0: x2 is too far left       I0 < 0, F1 > 0: x1 is too far left

(Were x2 not too far right in the first, then x1 would be by I0 > 0; this contact would lie in the
one sought, and carry less: F2 < 0.) Newton's steps stay between these bounds, and are replaced by
their middle where two of them have not halved the residual. So every second step halves the
residual or a bracket, and MAX_POLISHING steps are enough.

Newton's method alone converges slowly, or oscillates, where an edge is next to a break at which H
or H' jumps: at a distance d behind the break, to leading order,

    dF/dd = A + B d^(-1/2) + C d^(1/2),      B = sqrt(2r) [H],      C = 2 sqrt(2r) [H']

There a step leads to the root of this model, on whichever side of the break that is.

The search ends where each residual is within the rounding of its terms: ROUNDINGS times the sum of
their sizes (`size1` and `size2` of the edge integrals), and the rounding of a function's values.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from sie.numerics.interval import EPS, Interval, two_sum
from sie.numerics.root_finding import Bracket
from sie.profiles.resolution import rounding_noise

if TYPE_CHECKING:
    from sie.profiles.slope import Slope

    from .edge_integrals import EdgeIntegrals

# A residual is rounding below so many units of its terms: the roots and the angle of each piece,
# its sines, its weights, Horner's rule and the sum round it once or twice each.
ROUNDINGS = 16.0 * EPS
# r JR may vary like a power of the distance to the next break, or to where the profile touches
# first.
VARIES = 4.0
SMALL_STEP = 4.0 * EPS  # of r: after a last step of at most that the integrals are as before
# A step longer than this part of the distance to the next break follows what the break adds; a
# quarter of the part is what Newton's step leaves of the residual
CLOSE = 1e-3
FARTHEST = 0.75  # of r, a step inwards
STEPS_TO_A_BREAK = 20  # of Newton, for the root of a cubic: no edge integrals are evaluated
# The residual is halved 53 times from the size of the load to rounding, either bracket 106 times
# from r to the rounding of two doubles.
MAX_POLISHING = 2 * (53 + 2 * 106)
LEFT, RIGHT = 0, 1


@dataclass
class Polish:
    """Newton's method for the edges of one slope; `evaluate` integrates over a contact."""

    slope: Slope
    evaluate: Callable[[Interval], EdgeIntegrals]
    epsilon: float = 0.0

    # -- one of two edges is given, or none --------------------------------------------------------

    def both(
        self, contact: Interval, target: float, left_sharp: bool, touch: tuple[float, float]
    ) -> tuple[Interval, EdgeIntegrals, bool]:
        """The contact that carries target = P/G, its edge integrals, and whether Newton settled.

        It has settled if the residuals came down to rounding. The contact holds all of `touch`, but
        for rounding where that is no break.
        """
        (lo, hi), breaks = self.slope.domain, self.slope.break_points
        z1, z2 = ((z, 0.0) if z in breaks else None for z in touch)
        left = Bracket((lo, 0.0), z1 or (contact.x2, contact.tail2))
        right = Bracket(z2 or (contact.x1, contact.tail1), (hi, 0.0))
        for _ in range(MAX_POLISHING):
            k, r = self.evaluate(contact), contact.r
            over1, over2 = r * (k.I1 - k.I0) - target, r * (k.I1 + k.I0) - target
            rise1, rise2 = r * k.JL, r * k.JR + ((0.5 - self.epsilon) * k.I0 if left_sharp else 0.0)
            if not rise2 > 0.0 or (not rise1 > 0.0 and not left_sharp):
                break  # not convex here
            out1 = 0.0 if left_sharp else self.outwards(contact, LEFT, over1, rise1)
            wanted = contact.moved(-out1, self.outwards(contact, RIGHT, over2, rise2))
            rounding1, rounding2 = self.rounding(contact, k, target)
            missed = max(0.0 if left_sharp else abs(over1) / rounding1, abs(over2) / rounding2)
            if missed <= 1.0:
                return wanted, self.settled(k, contact, wanted, target, left_sharp), True
            # Signs within rounding bound nothing; where that of I0 is, both edges are too far out
            # or in
            askew = not left_sharp and abs(over2 - over1) > rounding1 + rounding2
            outside = (over2 if k.I0 > 0.0 else over1) > 0.0
            if abs(over2) > rounding2 and (not askew or (k.I0 > 0.0) == outside):
                right.cut((contact.x2, contact.tail2), above=over2 < 0.0)
            if abs(over1) > rounding1 and not left_sharp and (not askew or (k.I0 < 0.0) == outside):
                left.cut((contact.x1, contact.tail1), above=over1 > 0.0)
            x1, tail1 = contact.x1, contact.tail1
            if not left_sharp:
                x1, tail1 = left.place((wanted.x1, wanted.tail1), missed, (x1, tail1))
            here = contact.x2, contact.tail2
            x2, tail2 = right.place((wanted.x2, wanted.tail2), missed, here)
            moved = _kept_apart(contact, Interval(x1, x2, tail1, tail2))
            if moved == contact:
                break
            contact = moved
        return contact, k, False

    def symmetric(self, contact: Interval, target: float, z: float) -> Interval:
        """The symmetric contact that carries target = P/G: one unknown.

        With r JR changing by no more than VARIES times itself over the distance to the next break
        or to z, what a step leaves is known. Of functions JR is less exact.
        """
        exact = not self.slope.functions
        bracket = Bracket((z, 0.0), (self.slope.domain[1], 0.0))
        for _ in range(MAX_POLISHING):
            k, r = self.evaluate(contact), contact.r
            over, rise = r * k.I1 - target, r * k.JR
            if not rise > 0.0:
                break
            out = -over / rise
            missed = abs(over) / self.rounding(contact, k, target)[1]
            room = min(abs(self.nearest(contact, RIGHT)[1]), (contact.x2 - z) + contact.tail2)
            if abs(out) > CLOSE * room:
                out = self.outwards(contact, RIGHT, over, rise)
            wanted = contact.moved(-out, out)
            left = VARIES * missed * abs(out)
            if missed <= 1.0 or (exact and 2.0 * abs(out) <= room and left <= room):
                return wanted
            bracket.cut((contact.x2, contact.tail2), above=over < 0.0)
            place = bracket.place((wanted.x2, wanted.tail2), missed)
            if place != (wanted.x2, wanted.tail2):
                out = (place[0] - contact.x2) + (place[1] - contact.tail2)
                wanted = contact.moved(-out, out)
            if wanted == contact:
                break
            contact = wanted
        return contact

    def centred(self, contact: Interval, low: float, high: float) -> tuple[Interval, EdgeIntegrals]:
        """The contact of the same half-width whose centre balances the slope: I0 = 0.

        The centre is between low and high.
        """
        bracket, r = Bracket((low, 0.0), (high, 0.0), (True, True)), contact.r
        m = contact.m, 0.0
        for _ in range(MAX_POLISHING):
            k = self.evaluate(contact)
            over, rise = r * k.I0, 0.5 * r * (k.JR + k.JL)
            step = self._sideways(contact, over, rise) if rise > 0.0 else math.inf
            missed = abs(over) / sum(self.rounding(contact, k, 0.0))
            if missed <= 1.0:  # a slope that does not rise gives no direction, and no step is left
                rises = math.isfinite(step)
                return (contact.moved(step, step), k.balanced(contact.r)) if rises else (contact, k)
            bracket.cut(m, above=over < 0.0)
            wanted = two_sum(m[0], step + m[1]) if math.isfinite(step) else (math.inf, 0.0)
            place = bracket.place(wanted, missed)
            if place == m:
                break
            step = (place[0] - m[0]) + (place[1] - m[1])
            m, contact = place, contact.moved(step, step)
        return contact, k

    def _sideways(self, contact: Interval, over: float, rise: float) -> float:
        """The distance by which both edges move right so that over = r I0 vanishes.

        It follows from the edge that is next to a break.
        """
        to_left = abs(self.nearest(contact, LEFT)[1])
        to_right = abs(self.nearest(contact, RIGHT)[1])
        if abs(over) <= CLOSE * rise * min(to_left, to_right):
            return -over / rise
        if to_right <= to_left:
            return self.outwards(contact, RIGHT, over, rise, 0.5)
        return -self.outwards(contact, LEFT, -over, rise, 0.5)

    def settled(
        self, k: EdgeIntegrals, contact: Interval, moved: Interval, target: float, left_sharp: bool
    ) -> EdgeIntegrals:
        """The integrals after the last step, whose first order is enough where no edge is sharp."""
        if not left_sharp and not self.epsilon:
            return k.settled(contact, moved, target)
        steps = (
            abs((moved.x1 - contact.x1) + (moved.tail1 - contact.tail1)),
            abs((moved.x2 - contact.x2) + (moved.tail2 - contact.tail2)),
        )
        return self.evaluate(moved) if max(steps) > SMALL_STEP * contact.r else k

    # -- a step ------------------------------------------------------------------------------------

    def nearest(self, contact: Interval, side: int) -> tuple[float, float]:
        """The break nearest to an edge, and its distance behind it, negative if it is ahead."""
        breaks, x, distance = self.slope.break_points, contact.x2, contact.from_right
        if side == LEFT:
            x, distance = contact.x1, contact.from_left
        k, best, b = bisect_left(breaks, x), math.inf, 0.0
        for j in (k - 1, k):
            if 0 <= j < len(breaks) and abs(d := distance(breaks[j])) < abs(best):
                best, b = d, breaks[j]
        return b, best

    def outwards(
        self, contact: Interval, side: int, over: float, rise: float, share: float = 1.0
    ) -> float:
        """The distance by which an edge moves outwards so that its residual vanishes.

        The residual `over` grows by `rise`.

        `share` is the part of a break's contribution at this edge that enters the residual.
        """
        newton = -over / rise
        b, d = self.nearest(contact, side)
        if abs(newton) <= CLOSE * abs(d):
            return newton
        jump, kink = self.slope.corner(b)
        B = share * math.sqrt(2.0 * contact.r) * jump
        C = share * math.sqrt(8.0 * contact.r) * (kink if side == RIGHT else -kink)
        A, behind = rise, -over + rise * d
        if d > 0.0:
            root = math.sqrt(d)
            A -= B / root + C * root
            behind = A * d + 2.0 * B * root + C * d * root / 1.5 - over
        if not A > 0.0:
            return newton
        if behind <= 0.0:
            return behind / A - d
        v = math.sqrt(behind / A) if B <= 0.0 else behind / (B + math.sqrt(B * B + A * behind))
        if C > 0.0 and B >= 0.0:  # beyond the root by either of them; steps from far beyond creep
            v = min(v, math.cbrt(1.5 * behind / C))
        for _ in range(STEPS_TO_A_BREAK):
            slope = 2.0 * (B + v * (A + C * v))
            step = (
                (behind - v * (2.0 * B + v * (A + C * v / 1.5))) / slope
                if slope > 0.0
                else math.inf
            )
            if not 0.0 < v + step < math.inf:
                return newton
            v += step
            if abs(step) <= EPS * v:
                break
        return v * v - d

    # -- rounding ----------------------------------------------------------------------------------

    def rounding(self, contact: Interval, k: EdgeIntegrals, target: float) -> tuple[float, float]:
        """The rounding of F1 and F2."""
        r = contact.r
        least = ROUNDINGS * target + (
            math.pi * self.noise(contact) * r if self.slope.functions else 0.0
        )
        return least + ROUNDINGS * r * k.size1, least + ROUNDINGS * r * k.size2

    def noise(self, contact: Interval) -> float:
        """The rounding error of the values of functions."""
        if self._noise is None:
            self._noise = rounding_noise(self.slope.inside, contact.x1, contact.x2)
        return self._noise

    _noise: float | None = None


def _kept_apart(contact: Interval, moved: Interval) -> Interval:
    """The moved contact, its edges at most FARTHEST half-widths inwards: they must not cross."""
    x1, x2, tail1, tail2 = moved
    most = FARTHEST * contact.r
    if contact.from_left(x1) + tail1 > most:
        x1, tail1 = two_sum(contact.x1, most + contact.tail1)
    if contact.from_right(x2) - tail2 > most:
        x2, tail2 = two_sum(contact.x2, contact.tail2 - most)
    return Interval(x1, x2, tail1, tail2)
