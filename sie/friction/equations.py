"""The state at the end of a step in which stick zones only shrink, from that at its start.

Where the surface stuck all along the change Δq of the shear has 1/π PV∫ Δq/(x - t) dt = Δτ,
whatever is locked in; beside it Δq = s f p₁ - q₀ is known, s the direction of slip. Of its
potential (`potentials`) with A = ΔQ, B = Δτ nothing is unknown, and the 2N equations give the 2N
ends. Moving an end e adds a pole κ_e there, from which the derivatives follow
(docs/derivations/marching.md).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.chord import Chord
from sie.numerics.graded_panels import OF_SERIES, Pieces, Rule, gauss_shares
from sie.numerics.zones import left_over, united

from .potentials import Potential, RelativeSlip
from .state import KNOWN, SAME, Contact, Ends, State, Zones, intervals

Array = NDArray[np.float64]
NEAREST = 5  # places next to an end, from which what is there follows
FEW = 3  # nodes a panel of the places where |q| <= f p is tested on the way


def _at_end(near: Array, h: Array, side: float) -> float:
    """What h is at distance 0, by a polynomial through the nearest places; they are in order."""
    x, values = (part[:NEAREST] if side > 0.0 else part[::-1][:NEAREST] for part in (near, h))
    total = 0.0
    for k, value in enumerate(values):
        others = np.delete(x, k)
        total += value * float(np.prod(others / (others - x[k])))
    return total


@dataclass(frozen=True, eq=False)
class Equations(Potential):
    """The 2N equations for given zones, and the potential of Δq.

    before   the state at the start
    after    the contact at the end
    zones    stick zones and directions of slip
    rough    whether rules do for the residual alone, and not for q next to an end
    """

    before: State
    after: Contact
    zones: Zones
    rough: bool = field(default=False, kw_only=True)

    @property
    def chord(self) -> Chord:
        return Chord(self.after.period)

    @cached_property
    def stick(self) -> Array:
        return np.array(self.zones.stick, dtype=float).reshape(-1, 2)

    @cached_property
    def touched(self) -> Ends:
        """What is in contact at the start or at the end."""
        return united((*self.before.contact.patches, *self.after.patches))

    @cached_property
    def beside(self) -> Array:
        """The intervals between marks beside the stick zones, (n, 2)."""
        old, new = self.before.contact, self.after
        edges = np.array((*old.patches, *new.patches)).ravel()
        marks = np.unique(np.concatenate((self.before.marks, new.limit.marks, edges)))
        return intervals(left_over(self.touched, self.zones.stick), marks, SAME * new.width)

    @property
    def sources(self) -> Array:
        """The intervals where Δq, or on strips D, is given; those beside the stick zones first."""
        return self.beside

    @cached_property
    def slip(self) -> tuple[tuple[float, float, float], ...]:
        beside = left_over(self.after.patches, self.zones.stick)
        if len(beside) != len(self.zones.signs):
            raise ContactError("a stick zone reaches an edge of the contact")
        return tuple((*zone, s) for zone, s in zip(beside, self.zones.signs, strict=True))

    @property
    def begins(self) -> Array:
        """Where strips begin."""
        return np.zeros(0)

    @cached_property
    def change(self) -> Array:
        """Δq at the places."""
        return self.slipped

    @cached_property
    def slipped(self) -> Array:
        """Δq beside the stick zones."""
        count = len(self.rule.lo) // max(len(self.sources), 1) * len(self.beside)
        rule = self.rule.among(slice(0, count), self.beside)
        middle, signs = 0.5 * (rule.lo + rule.hi), np.zeros(len(rule.lo))
        for lo, hi, s in self.slip:
            signs[(middle > lo) & (middle < hi)] = s
        return signs * self.after.limit.on(rule) - self.before.shear.on(rule)

    def known(self, places: Rule, sense: float) -> Array:
        """Δq at places in a slip zone."""
        found: Array = sense * self.after.limit.on(places) - self.before.shear.on(places)
        return found

    @cached_property
    def residual(self) -> Array:
        """By how much the equations are missed, (2N)."""
        old, new = self.before.contact, self.after
        return self.missed(new.Q - old.Q, new.tau - old.tau)

    @cached_property
    def stuck_shear(self) -> tuple[Array, Array, Array]:
        """A few places in the stick zones, q and f p there."""
        marks = np.unique(np.concatenate((self.before.marks, self.after.limit.marks, self.begins)))
        found = []
        for k, zone in enumerate(self.zones.stick):
            ends = intervals([zone], marks, SAME * self.after.width)
            rule = Rule.of(ends, gauss_shares(OF_SERIES, FEW))
            q = self.before.shear.on(rule) + self.in_stick(k, rule)
            found.append((rule.x, q, self.after.limit.on(rule)))
        x, q, limit = (np.concatenate(part) for part in zip(*found, strict=True))
        return x, q, limit

    @property
    def excess(self) -> float:
        """The largest |q| - f p at those places over the peak of f p."""
        _, q, limit = self.stuck_shear
        return float((np.abs(q) - limit).max()) / self.after.peak

    @cached_property
    def charge_of_ends(self) -> Array:
        """κ of each end: the pole that moving it adds.

        2π κ is the finite part of ∫ dν_k/d(t, e).
        """
        out, r = [], self.rule
        for k, zone in enumerate(self.stick):
            nu = self.charges[k]
            for e in zone:
                apart = r.apart(e)
                near, terms = np.abs(apart), 0.0
                with np.errstate(all="ignore"):
                    total = nu / self.chord(apart)
                for side, anchors, other in ((1.0, r.lo, r.hi), (-1.0, r.hi, r.lo)):
                    at = anchors == e
                    if at.any():
                        h = nu[at] * np.sqrt(near[at]) / r.weight[at]
                        h0 = _at_end(near[at], h, side)
                        pole = h0 * r.weight[at] / near[at] ** 1.5
                        total[at] = total[at] - side * pole
                        terms -= side * h0 * 2.0 / math.sqrt(abs(other[at][0] - e))
                out.append((float(total.sum()) + terms) / (2.0 * math.pi))
        return np.array(out)

    @cached_property
    def derivatives(self) -> Array:
        """Those of the residual by the ends, (2N, 2N)."""
        return self.by_poles * self.charge_of_ends

    @cached_property
    def state(self) -> State:
        """The state that solved equations leave."""
        before, after = self.before, self.after
        same = SAME * after.width
        marks = np.unique(np.concatenate((before.marks, after.limit.marks, self.begins)))
        parts, values = [], []
        for lo, hi, s in self.slip:
            parts.append(Pieces.places(intervals([(lo, hi)], after.limit.marks, same)))
            values.append(s * after.limit.on(parts[-1]))
        for k, zone in enumerate(self.zones.stick):
            part = Pieces.places(intervals([zone], marks, same))
            near = np.minimum(part.from_lo, part.from_hi) <= KNOWN * after.width
            limit = np.where(near, after.limit.on(part), np.inf)
            q = before.shear.on(part) + self.in_stick(k, part)
            parts.append(part)
            values.append(np.minimum(np.maximum(q, -limit), limit))
        ends = np.concatenate([part.ends for part in parts])
        order, series = np.argsort(ends[:, 0]), Pieces.of_values(ends, np.concatenate(values))
        return State(after, self.zones.stick, self.slip, Pieces(ends[order], series[order]))


# -- what slip costs and shifts --------------------------------------------------------------------


def slip_work(slip: RelativeSlip, density: Callable[[Rule], Array], contact: Contact) -> float:
    """∫ d s Δg dx of a density d on a contact, s the direction of slip."""
    total = 0.0
    for lo, hi, sense, pieces in slip.slipped:
        marks = np.unique(np.concatenate((pieces.marks, contact.limit.marks)))
        rule = Rule.graded(intervals([(lo, hi)], marks, SAME * contact.width), OF_SERIES)
        total += sense * float(rule.weight @ (density(rule) * pieces.on(rule)))
    return total


def scaled_shift(before: State, after: State, stuck: Ends) -> float:
    """π E*/2 times the shift of the indenter, but for a multiple of ΔQ that is always the same.

    It is -∫Δq ln|x_s - t| dt + π Δτ x_s, x_s in the longest of the zones that stuck all along.
    """
    old, new = before.contact, after.contact
    if not stuck:
        raise ContactError("no point stuck all along: how far slip shifts is not covered")
    lo, hi = max(stuck, key=lambda zone: zone[1] - zone[0])
    x_s = 0.5 * (lo + hi)
    marks = np.unique(np.concatenate((before.marks, after.marks, [x_s])))
    rule = Rule.graded(intervals(united((*old.patches, *new.patches)), marks, SAME * new.width))
    change = rule.weight * (after.shear.on(rule) - before.shear.on(rule))
    log = np.log(np.abs(rule.apart_from(x_s)))
    return float(-(change @ log) + math.pi * (new.tau - old.tau) * x_s)
