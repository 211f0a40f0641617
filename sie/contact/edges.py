"""Where contact begins and ends.

With G = E*/2, t = m + r sin φ and the integrals of `moments`, a contact [x1, x2] of a profile with slope H needs

    K2 = I1 + I0 = ∫H (1 + sin φ) dφ,      K1 = I1 - I0 = -∫H (1 - sin φ) dφ
    P  = G r K2  if the right edge is smooth,      P = G r K1  if the left edge is smooth          (both: I0 = 0)
    M  = m P - G r² ∫H cos²φ dφ

and an edge where P exceeds that value is square-root singular: only the end of the indenter can be. Of a convex profile K1 and K2 grow
with the contact, each edge has an equation of its own, and along the solution the Jacobian is diagonal:

    d(r K2)/dx2 = r JR + I0/2,        d(r K1)/dx1 = -r JL + I0/2,        dM/d(tilt) = -π/2 G r²  at constant P.

So the search is one-dimensional and monotone, in the logarithm of the edge's distance from where the profile touches first (a power law
there is a straight line, solved in one step); then both edges are polished together (`polish`), with steps added to unrounded edges.
Given the moment in place of the tilt, both edges and the tilt are found in one such search.

Sources: Muskhelishvili (1953) § 116; Shtaerman (1949); Johnson, Contact Mechanics (1985) § 5.5 for smooth and sharp edges.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from sie.errors import ContactError, LoadError
from sie.numerics.interval import EPS, Interval, interval_about, two_sum
from sie.profiles.lowest_points import lowest_points
from sie.profiles.slope import Slope
from sie.traction.sliding_panels import sliding_moments

from .edge_integrals import Moments, moments
from .edge_refinement import MAX_POLISHING, ROUNDINGS, Bracket, Place, Polish

# The logarithmic search ends at this relative error of the load, after one more step: Newton squares it then and twice in polishing.
ROUGH = 1e-2
MISSED = 1e-6  # of the load: a search that ends with more has not found a contact
MAX_STEPS = 200
# Newton from a neighbouring contact is given up unless its first step is below this fraction of the distance, and so many steps settle it.
NEAR, NEAR_STEPS = 0.25, 5
# Steps of the logarithmic search are capped at a factor e^20, so that one bad derivative cannot throw it out of range.
MAX_LOG_STEP = 20.0
SMALLEST, HUGE = 1e-300, 1e300
LEAP = 1e12  # where a load underflows, or falls before it was ever large enough
PLACES = 64.0  # fewer places in a half-width do not show the pressure
NEAR_CENTRE = 4.0  # half-widths from a centre an origin loses no digits
# Where a centre is looked for: the first step over the half-width, and what the next are longer by.
FIRST_STEP, GROWTH = 2.0**-6, 1.5
UNEVEN = 1e-30  # the left side is not looked for nearer than this fraction of the right one
# While the root is not bracketed and the load is wrong by more than the factor OPEN, a step is at least the factor OPEN_STEP.
OPEN = 0.1
OPEN_STEP = 4.0


@dataclass(frozen=True)
class Edges:
    """An answered question: contact, load, moment about x = 0, tilt; which edges are sharp, and the stresses k1, k2 of these."""

    contact: Interval
    normal_load: float
    moment: float
    tilt: float
    sharp: tuple[bool, bool]
    k1: float
    k2: float
    I0: float
    evaluations: int


class Found(NamedTuple):
    """A contact, which edges are sharp, and its moments if they are known (but for the rounding of its edges)."""

    contact: Interval
    sharp: tuple[bool, bool] = (False, False)
    moments: Moments | None = None


@dataclass
class Search:
    """One profile's slope under one modulus; counts how often the moments were evaluated."""

    slope: Slope
    half_modulus: float
    axis: float | None = None  # of a symmetric profile: half the unknowns and half the pieces
    keep_zero: bool = False
    epsilon: float = (
        0.0  # of the edges' exponents in full sliding (`sliding`); half_modulus is then E*/2 cos πε
    )
    mirrored: bool = False  # whether slope is that of h(-x): messages name the places in x
    evaluations: int = field(default=0)

    # -- evaluation ---------------------------------------------------------------------------------------------------

    def moments(self, contact: Interval) -> Moments:
        self.evaluations += 1
        if self.epsilon:
            return sliding_moments(self.slope, contact, self.epsilon, self.keep_zero)
        if self.axis is None:
            return moments(self.slope, contact, keep_zero=self.keep_zero)
        half = moments(
            self.slope, contact, self.axis, self.keep_zero
        )  # the symmetry makes the others zero
        J0 = half.JR + half.JL
        size = half.size1 + half.size2
        return Moments(0.0, 2.0 * half.I1, 0.0, J0, J0, 0.0, 0.0, size, size)

    def load(self, contact: Interval, k: Moments) -> float:
        """P of the contact whose edges are smooth wherever they can be: the larger of G r K1 and G r K2."""
        return self.half_modulus * contact.r * (k.I1 + abs(k.I0))

    def finished(self, found: Found, load: float | None, tilt: float) -> Edges:
        contact, sharp, k = found
        contact = contact.rounded(self.slope.break_points)
        G, r = self.half_modulus, contact.r
        if self.axis is not None and load is not None and not any(sharp):
            return Edges(
                contact, load, contact.m * load, tilt, sharp, 0.0, 0.0, 0.0, self.evaluations
            )
        k = k or self.moments(contact)
        I0 = k.I0 if any(sharp) else 0.0
        P = self.load(contact, k) if load is None else load
        if self.epsilon:
            return self._finished_sliding(contact, P, tilt, sharp, k)
        g0 = G * I0 / np.pi
        C = (P / r - G * k.I1) / np.pi if any(sharp) else 0.0
        k1, k2 = (max(C + g0, 0.0) if sharp[0] else 0.0), (max(C - g0, 0.0) if sharp[1] else 0.0)
        return Edges(
            contact, P, contact.m * P - G * r * r * k.C2, tilt, sharp, k1, k2, I0, self.evaluations
        )

    def _finished_sliding(
        self, contact: Interval, P: float, tilt: float, sharp: tuple[bool, bool], k: Moments
    ) -> Edges:
        """From F(z) ~ P/(πz) + M/(πz²) far away, with X(z) of `sliding` expanded there; M about the centre first."""
        G, r, e, cos = self.half_modulus, contact.r, self.epsilon, math.cos(math.pi * self.epsilon)
        I0 = k.I0 if any(sharp) else 0.0
        difference = 2.0 * G * cos * I0 / np.pi  # k1 - k2
        if all(sharp):
            weighted = (
                2.0 * cos / (np.pi * r) * (P - G * r * (k.I1 + 2.0 * e * I0))
            )  # (1 - 2ε) k1 + (1 + 2ε) k2
            k1 = 0.5 * (weighted + (1.0 + 2.0 * e) * difference)
            k1, k2 = max(k1, 0.0), max(k1 - difference, 0.0)
        else:
            k1, k2 = (
                (max(difference, 0.0) if sharp[0] else 0.0),
                (max(-difference, 0.0) if sharp[1] else 0.0),
            )
        M = -G * r * r * k.C2 + np.pi * r * r / (4.0 * cos) * (
            k2 * (1.0 + 2.0 * e) ** 2 - k1 * (1.0 - 2.0 * e) ** 2
        )
        return Edges(contact, P, contact.m * P + M, tilt, sharp, k1, k2, I0, self.evaluations)

    # -- where the profile touches first --------------------------------------------------------------------------------

    def touch(self) -> tuple[float, float]:
        """[z1, z2] where H = 0: the lowest points of the profile."""
        return self._touch

    @cached_property
    def _touch(self) -> tuple[float, float]:
        if self.axis is not None:
            z = next(
                (lo for lo, hi, _, _ in self.slope.rows if hi > self.axis), self.slope.domain[1]
            )
            z = max(z, self.axis)
            if math.isinf(z):
                raise LoadError(
                    "the profile is flat without end: its contact has no edges; give a profile that rises"
                )
            return 2.0 * self.axis - z, z
        return lowest_points(self.slope)

    # -- symmetric contact --------------------------------------------------------------------------------------------

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
            if self.load(whole, self.moments(whole)) <= load:
                return Found(whole, (True, True))

        def excess(distance: float) -> tuple[float, float]:
            contact = at(distance)
            k = self.moments(contact)
            return k.I1 * contact.r, distance * contact.r * k.JR

        target = load / self.half_modulus
        distance = _logarithmic_root(
            excess, target, self._first_guess(z, hi, target), hi - z, self._too_much(load)
        )
        return Found(self._polish.symmetric(at(distance), target, z, MAX_POLISHING)[0])

    def symmetric_near(self, load: float, contact: Interval) -> Interval | None:
        """The same by Newton alone, from the contact under a load that is not much different; None if that does not settle at once."""
        z = self.touch()[1]
        reach = NEAR * ((contact.x2 - z) + contact.tail2) / contact.r
        contact, settled = self._polish.symmetric(
            contact, load / self.half_modulus, z, NEAR_STEPS, reach
        )
        return contact if settled else None

    @cached_property
    def _polish(self) -> Polish:
        return Polish(self.slope, self.moments, self.epsilon)

    def _first_guess(self, z: float, hi: float, target: float) -> float:
        if math.isfinite(hi):
            return 0.5 * (hi - z)
        breaks = self.slope.break_points
        ahead = bisect_right(breaks, z)
        if ahead < len(breaks):
            return breaks[ahead] - z
        # Not within rounding of z, where the load would be noise
        return (
            max(z - breaks[0], abs(z))
            if breaks and breaks[0] < z
            else max(target, math.sqrt(EPS) * abs(z))
        )

    def _too_much(self, load: float) -> Callable[[float, float], ContactError]:
        def error(distance: float, reached: float) -> ContactError:
            P = reached * self.half_modulus
            return LoadError(
                f"the load {load:.6g} exceeds what this profile carries in one patch of contact, {P:.6g}: "
                "beyond it the slope no longer rises enough towards the edge; lower the load or extend the profile",
                load=P,
            )

        return error

    # -- general contact ------------------------------------------------------------------------------------------------

    def general(self, load: float) -> Found:
        """Both edges, for a given load and tilt; each is smooth, or sharp at the end of the indenter."""
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
        return Found(
            left.contact.mirrored(),
            left.sharp[::-1],
            left.moments.mirrored() if left.moments else None,
        )

    def _right_edge(self, load: float) -> Found | None:
        """The contact whose right edge is smooth, and its left edge may be sharp; None if the right edge is sharp too."""
        z1, z2 = self.touch()
        lo, hi = self.slope.domain
        target = load / self.half_modulus
        if hi <= z2:
            return None  # lowest at its end: all contact has a sharp edge there
        # Broken where it changes sign, the slope's positive and negative parts are integrated apart
        split = replace(self, slope=self.slope.split_at(z1).split_at(z2), evaluations=0)
        guess = self._first_guess(z2, hi, target)
        last = [
            guess,
            guess,
        ]  # distances of the right edge from z2 and of the left edge from z1 that belonged together

        def contact_at(distance: float) -> tuple[Interval, Moments]:
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

        distance = _logarithmic_root(excess, target, guess, hi - z2, self._too_much(load))
        contact, _ = contact_at(distance)
        self.evaluations += split.evaluations
        left_sharp = bool(contact.x1 == lo and contact.tail1 == 0.0)
        return self.polished(contact, target, left_sharp)

    def _left_edge(
        self, z: tuple[float, float], right: float, guess: float
    ) -> tuple[Interval, Moments, float]:
        """x1 with I0 = 0 for x2 = z2 + right, or the end of the indenter where I0 >= 0 even there (a sharp edge); and z1 - x1."""
        lo = self.slope.domain[0]
        x2, tail2 = two_sum(z[1], right)
        if math.isfinite(lo):
            contact = Interval(lo, x2, 0.0, tail2)
            k = self.moments(contact)
            if k.I0 >= 0.0:
                return contact, k, max(z[0] - lo, right)
        found: dict[float, tuple[Interval, Moments]] = {}

        def balance(left: float) -> tuple[float, float]:
            """∫ of -H left of z1 over ∫ of H right of z2, which is 1 at the root."""
            x1, tail1 = two_sum(z[0], -left)
            contact = Interval(x1, x2, tail1, tail2)
            k = self.moments(contact)
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
                f"a contact that {one} finds no {other} edge: the profile does not rise enough to the {other}; "
                "prescribe less tilt or load, or a profile that rises on both sides",
                edge=-x2 if self.mirrored else x2,
            )

        left = _logarithmic_root(
            balance, 1.0, min(guess, z[0] - lo), z[0] - lo, error, rough=0.1 * ROUGH
        )
        at = left if left in found else next(reversed(found))
        return *found[at], at

    def polished(self, contact: Interval, target: float, left_sharp: bool) -> Found:
        """Both edges at once, to rounding. Raises LoadError if that ends where the load is not carried: between two bumps of a profile."""
        contact, k, settled = self._polish.both(contact, target, left_sharp)
        carried, askew = contact.r * (k.I1 + k.I0), 0.0 if left_sharp else contact.r * abs(k.I0)
        if not settled and not abs(carried - target) + askew <= MISSED * target:
            seen = contact.mirrored() if self.mirrored else contact
            raise LoadError(
                f"no single patch of contact was found that carries the load {target * self.half_modulus:.6g}: "
                f"the search ended at [{seen.x1:.6g}, {seen.x2:.6g}] with {carried * self.half_modulus:.6g}; "
                "the profile has several bumps, or doubles there do not resolve so narrow a contact: "
                "raise the load, lower it, or smooth the profile",
                load=carried * self.half_modulus,
            )
        return Found(contact, (left_sharp, False), k)

    # -- a prescribed moment --------------------------------------------------------------------------------------------

    def under_moment(self, load: float, moment: float) -> Edges | None:
        """The contact and the tilt where both edges are smooth; None if none was found, or an edge is at the end of the indenter."""
        target, lever = load / self.half_modulus, moment / load
        lo, hi = self.slope.domain

        def carried(r: float) -> tuple[float, float]:
            k = self.moments(interval_about(lever, r))
            rounding = ROUNDINGS * (k.size1 + k.size2)
            # A straight part of the profile carries nothing
            return (r * k.I1, 0.5 * r * r * (k.JR + k.JL)) if rounding < k.I1 else (0.0, 0.0)

        def tilted(contact: Interval, tilt: float) -> Moments:
            self.evaluations += 1
            return moments(self.slope.tilted(tilt), contact, keep_zero=self.keep_zero)

        lost = LoadError(
            f"the moment {moment:.6g} puts the load at x = M/P = {lever:.6g}, where rounding of the slope is more than the load shows: "
            "lower the moment, or move the profile to where the load acts (shifted)"
        )
        if not math.isfinite(float(self.slope(lever))):
            raise lost
        limit = min(lever - lo, hi - lever)
        try:
            r = _logarithmic_root(
                carried, target, self._first_guess(lever, hi, target), limit, self._too_much(load)
            )
        except LoadError:
            return None
        guess = interval_about(lever, r)
        if not sum(self._polish.rounding(guess, self.moments(guess), target)) <= target:
            raise lost
        found = self._polish.balanced(guess, target, lever, tilted)
        if found is None:
            return None
        contact, k, tilt = found
        return replace(self.finished(Found(contact, moments=k), load, tilt), moment=moment)

    def of_half_width_under_moment(self, r: float, moment: float) -> Edges | None:
        """The contact of half-width r with smooth edges, and its tilt, of those that have the moment the nearest to where the untilted
        profile touches; None if none was found.

        Whatever the centre m, the tilt -I0/π balances the slope. Then M = G r (m I1 - r (C2 - I0/2)) and
        dM/dm = G r (r (JR + JL)/4 + m (JR - JL)/2): one unknown. M need not grow with m, because P changes too.
        """
        (lo, hi), (z1, z2), scale = self.slope.domain, self.touch(), self.half_modulus * r
        most = r / (PLACES * EPS)
        low, high = max(lo + r, -most), min(hi - r, most)
        if not low < high:
            return None

        def at(m: Place) -> tuple[float, float, Interval, Moments]:
            """Of M/(G r): how much it exceeds what is given, and its derivative."""
            contact = interval_about(m[0], r).moved(m[1], m[1])
            # Far from x = 0 the slope is nearly constant, which carries nothing
            level, slope = self.slope.less_level(m[0], NEAR_CENTRE * r)
            k, centre = replace(self, slope=slope).moments(contact), contact.m
            self.evaluations += 1
            excess = centre * k.I1 - r * (k.C2 - 0.5 * k.I0) - moment / scale
            k = k._replace(I0=k.I0 + math.pi * level, C2=k.C2 + 0.5 * math.pi * level)
            return excess, 0.25 * r * (k.JR + k.JL) + 0.5 * centre * (k.JR - k.JL), contact, k

        centre = min(max(0.5 * (z1 + z2), low), high)
        bracket = self._first_change(lambda m: at((m, 0.0)), centre, (low, high), r)
        if bracket is None:
            return None
        m, slope, earlier = (
            bracket.middle(),
            math.copysign(1.0, at(bracket.high)[0]),
            [math.inf, math.inf],
        )
        for _ in range(MAX_POLISHING):
            excess, rise, contact, k = at(m)
            size = k.size1 + k.size2
            rounding = ROUNDINGS * ((abs(m[0]) + r) * size + abs(moment) / scale)
            missed = abs(excess) / rounding
            wanted = two_sum(m[0], m[1] - excess / rise) if rise * slope > 0.0 else (math.inf, 0.0)
            if missed > 1.0:
                bracket.cut(m, above=excess * slope < 0.0)
            place = bracket.place(wanted, missed > max(0.5 * earlier[-2], 1.0))
            if missed <= 1.0:  # the signs that bound it are rounding
                place = wanted if low < wanted[0] < high else m
            earlier.append(missed)
            if place == m or earlier[-2] <= 1.0:  # after one more step, if there is one
                break
            m = place
        if not (ROUNDINGS * size < k.I1 and rounding < abs(rise) * r):
            return None  # nothing but rounding carries the load, or tells the centre
        tilt = -k.I0 / math.pi
        k = k._replace(I0=0.0, C2=k.C2 - 0.5 * k.I0)
        return replace(self.finished(Found(contact, moments=k), None, tilt), moment=moment)

    @staticmethod
    def _first_change(
        at: Callable[[float], tuple[float, float, Interval, Moments]],
        centre: float,
        bounds: tuple[float, float],
        r: float,
    ) -> Bracket | None:
        """Two places, as near to the centre as growing steps to both sides tell, between which the excess changes its sign under load."""
        last = {side: (centre, *at(centre)) for side in (-1.0, 1.0)}
        step = FIRST_STEP * r
        while last:
            for side in [*last]:
                place, excess, _, _, before = last[side]
                new = min(max(centre + side * step, bounds[0]), bounds[1])
                if new == place:
                    del last[side]
                    continue
                last[side] = new, *at(new)
                loaded = _pressing(before), _pressing(last[side][4])
                if excess * last[side][1] <= 0.0 and max(loaded) > 0.0 <= min(loaded):
                    return Bracket((min(place, new), 0.0), (max(place, new), 0.0), (True, True))
            step *= GROWTH
        return None

    # -- a prescribed half-width ----------------------------------------------------------------------------------------

    def of_half_width(self, r: float) -> Found:
        lo, hi = self.slope.domain
        if 2.0 * r > (hi - lo) * (1.0 + 4.0 * EPS):
            raise LoadError(
                f"the half-width {r:.6g} exceeds that of the indenter, {0.5 * (hi - lo):.6g}: give at most that, or a normal_load"
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
            # At the end of the indenter one edge is sharp if the other wants to be there
            if (m == hi - r) if side else (m == lo + r):
                contact = Interval(hi - 2.0 * r, hi) if side else Interval(lo, lo + 2.0 * r)
                k = self.moments(contact)
                if k.I0 == 0.0:
                    return Found(contact, moments=k)
                if (k.I0 < 0.0) == bool(side):
                    return Found(contact, (not side, bool(side)), k)
        contact, k = self._polish.centred(interval_about(0.5 * (low + high), r), low, high)
        return Found(contact, moments=k)


def _logarithmic_root(
    function: Callable[[float], tuple[float, float]],
    target: float,
    guess: float,
    limit: float,
    error: Callable[[float, float], ContactError],
    *,
    rough: float = ROUGH,
) -> float:
    """u in (0, limit) with function(u) = target, to `rough`, by Newton in ln u and ln f inside a bracket.

    `function` returns (f, u f'). It may fall again beyond a largest value, which a negative derivative shows; if the target exceeds that
    value, `error(u, f)` is raised with the best that was found.
    """
    low, high = 0.0, limit
    u, best, best_u = guess, 0.0, guess
    steps = [np.inf, np.inf]
    for _ in range(MAX_STEPS):
        f, slope = function(u)
        if f > best or f >= target:  # the last that is enough, or else the largest
            best, best_u = f, u
        rising = 0.0 < f < math.inf and slope > 0.0
        if rising and not 0.0 < target / f < math.inf:
            raise OverflowError("the ratio is no double")
        step = math.log(target / f) * f / slope if rising else np.inf
        if rising and abs(math.log(f / target)) <= rough:
            return min(u * math.exp(step), limit)
        if f < target and (rising or (f == 0.0 and slope >= 0.0)):  # zero: it underflows
            low = u
        else:
            high = u
        if u <= SMALLEST or (math.isfinite(high) and high - low <= 4.0 * EPS * high):
            break
        far = not OPEN * target < f < target / OPEN
        open_ended = low == 0.0 or not math.isfinite(high)
        new = u * math.exp(min(max(step, -MAX_LOG_STEP), MAX_LOG_STEP))
        if rising and far and open_ended:
            # steep where the contact is small, flat where it is large: without a bracket Newton creeps
            new = max(new, u * OPEN_STEP) if f < target else min(new, u / OPEN_STEP)
        if not low < new < high or (not open_ended and abs(math.log(new / u)) > 0.5 * steps[-2]):
            new = _between(low, high, u)  # Newton runs off, or to and fro across a kink
        steps.append(abs(math.log(new / u)))
        u = new
    if best >= target * (1.0 - rough):
        return best_u
    raise error(best_u, best)


def _pressing(k: Moments) -> float:
    """I1, the load over G r, if it is more than rounding."""
    return k.I1 if abs(k.I1) > ROUNDINGS * (k.size1 + k.size2) else 0.0


def _between(low: float, high: float, u: float) -> float:
    """A point inside the bracket: the geometric mean, or a large step where one end is still open."""
    if not math.isfinite(high):
        return u * LEAP
    return float(np.sqrt(low) * np.sqrt(high)) if low > 0.0 else high / 8.0
