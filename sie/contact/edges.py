"""The edges of the contact.

With G = E*/2, t = m + r sin φ and the integrals of `edge_integrals`, a contact [x1, x2] of a
profile with slope H needs

    K2 = I1 + I0 = ∫H (1 + sin φ) dφ,      K1 = I1 - I0 = -∫H (1 - sin φ) dφ
    P  = G r K2 if the right edge is smooth,   P = G r K1 if the left edge is   (both: I0 = 0)
    M  = m P - G r² ∫H cos²φ dφ

and an edge where P exceeds that value is square-root singular: only the end of the indenter can be.
For a convex profile K1 and K2 grow with the contact, each edge has an equation of its own, and
along the solution the Jacobian is diagonal:

    d(r K2)/dx2 = r JR + I0/2,     d(r K1)/dx1 = -r JL + I0/2,     dM/d(tilt) = -π/2 G r²

the last at constant P.
So the search is one-dimensional and monotone, in the logarithm of the edge's distance from where
the profile touches first (a power law there is a straight line, solved in one step); then both
edges are refined together (`edge_refinement`), with steps added to unrounded edges. Where the
moment is given in place of the tilt, `tilt_of_moment` searches for that.

Sources: Muskhelishvili (1953) § 116; Shtaerman (1949); Johnson, Contact Mechanics (1985) § 5.5 for
smooth and sharp edges.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from sie.errors import ContactError, LoadError
from sie.numerics.interval import EPS, Interval, interval_about, two_sum
from sie.numerics.root_finding import ROUGH, logarithmic_root
from sie.profiles.lowest_points import lowest_points

from .edge_integrals import EdgeIntegrals, edge_integrals
from .edge_refinement import Polish
from .first_guess import first_guess, of_linear_rise
from .known_contact import Edges

if TYPE_CHECKING:
    from sie.profiles.slope import Slope

MISSED = 1e-6  # of the load: a search that ends with more has not found a contact
HUGE = 1e300
UNEVEN = 1e-30  # the left side is not sought nearer than this fraction of the right one


class Found(NamedTuple):
    """A contact, which of its edges are sharp, and its edge integrals if they are known.

    They are known but for the rounding of its edges.
    """

    contact: Interval
    sharp: tuple[bool, bool] = (False, False)
    integrals: EdgeIntegrals | None = None

    def mirrored(self) -> Found:
        """The same of h(-x)."""
        k = self.integrals
        return Found(self.contact.mirrored(), self.sharp[::-1], k.mirrored() if k else None)


@dataclass
class Search:
    """One profile's slope under one modulus; counts how often the edge integrals were evaluated."""

    slope: Slope
    half_modulus: float
    axis: float | None = None  # of a symmetric profile: half the unknowns and half the pieces
    keep_zero: bool = False
    # of the edges' exponents in full sliding (`on_panels`); half_modulus is then E*/2 cos πε
    epsilon: float = 0.0
    mirrored: bool = False  # whether slope is that of h(-x): messages name the places in x
    evaluations: int = field(default=0)
    # of the last contact, which the search often ends with
    _last: tuple[Interval, EdgeIntegrals] | None = field(default=None, init=False, repr=False)

    # -- evaluation --------------------------------------------------------------------------------

    def integrals(self, contact: Interval) -> EdgeIntegrals:
        if self._last is None or self._last[0] != contact:
            self.evaluations += 1
            self._last = contact, self._edge_integrals(contact)
        return self._last[1]

    def _edge_integrals(self, contact: Interval) -> EdgeIntegrals:
        if self.axis is None:
            return edge_integrals(self.slope, contact, None, self.keep_zero, self.epsilon)
        # The symmetry makes the others zero.
        half = edge_integrals(self.slope, contact, self.axis, self.keep_zero)
        J0 = half.JR + half.JL
        size = half.size1 + half.size2
        return EdgeIntegrals(0.0, 2.0 * half.I1, 0.0, J0, J0, 0.0, 0.0, size, size)

    def load(self, contact: Interval, k: EdgeIntegrals) -> float:
        """P of the contact whose edges are smooth wherever they can be.

        It is the larger of G r K1 and G r K2.
        """
        return self.half_modulus * contact.r * (k.I1 + abs(k.I0))

    def finished(self, found: Found, load: float | None, tilt: float) -> Edges:
        contact, sharp, k = found
        contact = contact.rounded(self.slope.break_points)
        G, r = self.half_modulus, contact.r
        if self.axis is not None and load is not None and not any(sharp):
            return Edges(
                contact, load, contact.m * load, tilt, sharp, 0.0, 0.0, 0.0, self.evaluations
            )
        k = k or self.integrals(contact)
        I0 = k.I0 if any(sharp) else 0.0
        P = self.load(contact, k) if load is None else load
        k1, k2 = self._singular_ends(contact, P, sharp, k)
        # F(z) ~ P/(πz) + M/(πz²) far away, with X(z) of `edge_functions` expanded there
        e = self.epsilon
        ends = k2 * (1.0 + 2.0 * e) ** 2 - k1 * (1.0 - 2.0 * e) ** 2
        about_centre = -G * r * r * (k.C2 - 0.5 * k.I0)
        if any(sharp):
            about_centre += np.pi * r * r / (4.0 * math.cos(math.pi * e)) * ends
        M = contact.m * P + about_centre
        return Edges(contact, P, M, tilt, sharp, k1, k2, I0, self.evaluations)

    def _singular_ends(
        self, contact: Interval, P: float, sharp: tuple[bool, bool], k: EdgeIntegrals
    ) -> tuple[float, float]:
        """(k1, k2), 0 at a smooth edge: their difference from I0, their weighted sum from P."""
        G, r, e, cos = self.half_modulus, contact.r, self.epsilon, math.cos(math.pi * self.epsilon)
        difference = 2.0 * G * cos * k.I0 / np.pi  # k1 - k2
        if not all(sharp):
            return max(difference, 0.0) if sharp[0] else 0.0, (
                max(-difference, 0.0) if sharp[1] else 0.0
            )
        # (1 - 2ε) k1 + (1 + 2ε) k2
        weighted = 2.0 * cos / (np.pi * r) * (P - G * r * (k.I1 + 2.0 * e * k.I0))
        k1 = 0.5 * (weighted + (1.0 + 2.0 * e) * difference)
        return max(k1, 0.0), max(k1 - difference, 0.0)

    # -- where the profile touches first -----------------------------------------------------------

    def touch(self) -> tuple[float, float]:
        """[z1, z2] where H = 0: the lowest points of the profile."""
        if self.axis is None:
            return self._lowest
        z = next((lo for lo, hi, _, _ in self.slope.rows if hi > self.axis), self.slope.domain[1])
        z = max(z, self.axis)
        if math.isinf(z):
            raise LoadError(
                "the profile is flat without end: its contact has no edges; give a profile that "
                "rises"
            )
        return 2.0 * self.axis - z, z

    @cached_property
    def _lowest(self) -> tuple[float, float]:
        return lowest_points(self.slope)

    # -- symmetric contact -------------------------------------------------------------------------

    def symmetric(self, load: float) -> Found:
        axis, z = self.axis, self.touch()[1]
        assert axis is not None
        hi = self.slope.domain[1]

        def at(distance: float) -> Interval:
            r, tail = two_sum(z - axis, distance)
            contact = interval_about(axis, r)
            return contact.moved(-tail, tail) if tail else contact

        if math.isfinite(hi):
            whole = Interval(*self.slope.domain)
            if self.load(whole, self.integrals(whole)) <= load:
                return Found(whole, (True, True))

        def excess(distance: float) -> tuple[float, float]:
            contact = at(distance)
            k = self.integrals(contact)
            return k.I1 * contact.r, distance * contact.r * k.JR

        target = load / self.half_modulus
        guess = of_linear_rise(self.slope, axis, z, target) or first_guess(self.slope, z, target)
        distance = logarithmic_root(excess, target, guess, hi - z, self.too_much(load))
        return Found(self.polish.symmetric(at(distance), target, z))

    @property
    def polish(self) -> Polish:
        return Polish(self.slope, self.integrals, self.epsilon)

    def too_much(self, load: float) -> Callable[[float, float], ContactError]:
        def error(distance: float, reached: float) -> ContactError:
            P = reached * self.half_modulus
            return LoadError(
                f"the load {load:.6g} exceeds what this profile carries in one patch of contact, "
                f"{P:.6g}: beyond it the slope no longer rises enough towards the edge; lower the "
                "load or extend the profile",
                load=P,
            )

        return error

    # -- general contact ---------------------------------------------------------------------------

    def general(self, load: float) -> Found:
        """Both edges for a given load and tilt.

        Each is smooth, or sharp at the end of the indenter.
        """
        right = self._right_edge(load)
        if right is not None:
            return right
        mirrored = not self.mirrored
        flipped = replace(
            self,
            slope=self.slope.mirrored(),
            epsilon=-self.epsilon,
            mirrored=mirrored,
            evaluations=0,
        )
        left = flipped._right_edge(load)
        self.evaluations += flipped.evaluations
        if left is None:
            return Found(Interval(*self.slope.domain), (True, True))
        return left.mirrored()

    def _right_edge(self, load: float) -> Found | None:
        """The contact whose right edge is smooth, and whose left edge may be sharp.

        None if the right edge is sharp too.
        """
        z1, z2 = self.touch()
        lo, hi = self.slope.domain
        target = load / self.half_modulus
        if hi <= z2:
            return None  # lowest at its end: all contact has a sharp edge there
        # Broken where it changes sign, the slope's positive and negative parts are integrated apart
        split = replace(self, slope=self.slope.split_at(z1).split_at(z2), evaluations=0)
        guess = first_guess(self.slope, z2, target)
        # Distances of the right edge from z2 and of the left edge from z1 that belong together
        last = [guess, guess]

        def contact_at(distance: float) -> tuple[Interval, EdgeIntegrals]:
            contact, k, left = split._left_edge(
                (z1, z2), distance, max(last[1] / last[0], UNEVEN) * distance
            )
            last[:] = distance, left
            return contact, k

        if math.isfinite(hi):
            whole, k = contact_at(hi - z2)
            if whole.r * (k.I1 + k.I0) <= target:
                self.evaluations += split.evaluations
                return None

        def excess(distance: float) -> tuple[float, float]:
            contact, k = contact_at(distance)
            return contact.r * (k.I1 + k.I0), distance * (
                contact.r * k.JR + (0.5 - self.epsilon) * max(k.I0, 0.0)
            )

        distance = logarithmic_root(excess, target, guess, hi - z2, self.too_much(load))
        contact, _ = contact_at(distance)
        self.evaluations += split.evaluations
        left_sharp = bool(contact.x1 == lo and contact.tail1 == 0.0)
        return self.polished(contact, target, left_sharp)

    def _left_edge(
        self, z: tuple[float, float], right: float, guess: float
    ) -> tuple[Interval, EdgeIntegrals, float]:
        """x1 with I0 = 0 for x2 = z2 + right, its edge integrals, and z1 - x1.

        Where I0 >= 0 even at the end of the indenter, x1 is that end (a sharp edge).
        """
        lo = self.slope.domain[0]
        x2, tail2 = two_sum(z[1], right)
        if math.isfinite(lo):
            contact = Interval(lo, x2, 0.0, tail2)
            k = self.integrals(contact)
            if k.I0 >= 0.0:
                return contact, k, max(z[0] - lo, right)
        found: dict[float, tuple[Interval, EdgeIntegrals]] = {}

        def balance(left: float) -> tuple[float, float]:
            """∫ of -H left of z1 over ∫ of H right of z2, which is 1 at the root."""
            x1, tail1 = two_sum(z[0], -left)
            contact = Interval(x1, x2, tail1, tail2)
            k = self.integrals(contact)
            found[left] = contact, k
            if k.positive <= 0.0:
                return HUGE, HUGE
            return min(k.negative / k.positive, HUGE), min(0.5 * left * k.JL / k.positive, HUGE)

        def error(distance: float, reached: float) -> ContactError:
            one, other = (
                (f"begins at x1 = {-x2:.6g}", "right")
                if self.mirrored
                else (f"ends at x2 = {x2:.6g}", "left")
            )
            return LoadError(
                f"a contact that {one} finds no {other} edge: the profile does not rise enough to "
                f"the {other}; prescribe less tilt or load, or a profile that rises on both sides",
                edge=-x2 if self.mirrored else x2,
            )

        left = logarithmic_root(
            balance, 1.0, min(guess, z[0] - lo), z[0] - lo, error, rough=0.1 * ROUGH
        )
        at = left if left in found else next(reversed(found))
        return *found[at], at

    def polished(self, contact: Interval, target: float, left_sharp: bool) -> Found:
        """Both edges at once, to rounding.

        Raises LoadError if that ends where the load is not carried: between two bumps of a profile.
        """
        contact, k, settled = self.polish.both(contact, target, left_sharp, self.touch())
        carried, askew = contact.r * (k.I1 + k.I0), 0.0 if left_sharp else contact.r * abs(k.I0)
        if not settled and not abs(carried - target) + askew <= MISSED * target:
            seen = contact.mirrored() if self.mirrored else contact
            raise LoadError(
                "no single patch of contact was found that carries the load "
                f"{target * self.half_modulus:.6g}: the search ended at [{seen.x1:.6g}, "
                f"{seen.x2:.6g}] with {carried * self.half_modulus:.6g}, between bumps or in too "
                "narrow a contact; change the load, or smooth the profile",
                load=carried * self.half_modulus,
            )
        return Found(contact, (left_sharp, False), k)

    def near(self, contact: Interval, sharp: tuple[bool, bool], load: float) -> Found | None:
        """The contact under a load near one that is known; None where no step comes nearer."""
        if all(sharp):
            return Found(contact, sharp)
        if sharp[1]:
            flipped = replace(self, slope=self.slope.mirrored(), epsilon=-self.epsilon)
            found = flipped.near(contact.mirrored(), (True, False), load)
            return found and found.mirrored()
        closer, k, settled = self.polish.both(
            contact, load / self.half_modulus, sharp[0], self.touch()
        )
        return Found(closer, sharp, k) if settled else None

    # -- a prescribed half-width -------------------------------------------------------------------

    def of_half_width(self, r: float) -> Found:
        lo, hi = self.slope.domain
        if 2.0 * r > (hi - lo) * (1.0 + 4.0 * EPS):
            raise LoadError(
                f"the half-width {r:.6g} exceeds that of the indenter, {0.5 * (hi - lo):.6g}: "
                "give at most that, or a normal_load",
                widest=0.5 * (hi - lo),
            )
        z1, z2 = self.touch()
        if 2.0 * r <= z2 - z1:
            larger = "" if (z1, z2) == (lo, hi) else "a larger half_width, or "
            raise LoadError(
                f"the half-width {r:.6g} does not reach beyond the flat base [{z1:.6g}, {z2:.6g}], "
                f"which touches as a whole under any load: give {larger}a normal_load"
            )
        if self.axis is not None:
            return Found(interval_about(self.axis, r))
        low, high = max(lo + r, z1 - r), min(hi - r, z2 + r)
        for m, side in ((high, 1), (low, 0)):
            # One edge is sharp if the balance would move the other beyond the end of the indenter.
            if (m == hi - r) if side else (m == lo + r):
                contact = Interval(hi - 2.0 * r, hi) if side else Interval(lo, lo + 2.0 * r)
                k = self.integrals(contact)
                if k.I0 == 0.0:
                    return Found(contact, integrals=k)
                if (k.I0 < 0.0) == bool(side):
                    return Found(contact, (not side, bool(side)), k)
        contact, k = self.polish.centred(interval_about(0.5 * (low + high), r), low, high)
        return Found(contact, integrals=k)
