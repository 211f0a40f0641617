"""The state at the end of a step in which stick zones only shrink, from that at its start.

Where the surface stuck all along the change Δq of the shear has 1/π PV∫ Δq/(x - t) dt = Δτ,
whatever is locked in; beside it Δq = s f p₁ - q₀ is known, s the direction of slip. With stick
zones [a_k, b_k], k = 1...N, of centres μ_k, on the line or per period (d is the chord)

    T_k(z) = d(z, μ_k) Π_i [d(z, a_i) d(z, b_i)/d(z, μ_i)²]^(1/2)
    F(z)   = Δτ + T_k(z) 1/π ∫ dν_k(t)/d(z, t),      dν_k = Δq/T_k dt on slip; any k
    Σ cos(t - μ_k) dν_k = -π Δτ for each k,      Σ d(t, μ_k) dν_k = ΔQ
    Re ∫ T_k Ψ_k dz = 0 over each gap between neighbouring zones: one rigid shift of all

are 2N equations for 2N ends. On zone k Δq = -|T_k| Re Ψ_k. The integral over a gap goes over the
half-circle above it, where nothing is singular. Moving an end e adds a charge κ_e at e, from which
the derivatives follow (docs/derivations/marching.md).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.graded_panels import (
    OF_RULES,
    OF_SERIES,
    Pieces,
    Rule,
    breaks_for,
    gauss_shares,
    principal_value,
)

from .state import SAME, Contact, Ends, State, between, intervals, united

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

STEPS = 40  # of Newton's method
PINNED_STEPS = 8  # of it with one end on a mark
SLOW, FAR = 14, 1e-2  # after so many one that is so long, of the contact, finds nothing
SETTLED = 2e-14  # of the contact: a step so short is the last
GOOD = 1e-9  # and one so short is good enough if later ones do not shorten
INSIDE = 1e-9  # of what is between the bounds of an end: a guess is as far from them
CLOSEST = 0.9  # of the distance to its neighbour: an end moves so far at most in a step
NEAREST = 5  # places next to an end, from which what is there follows
FEW = 3  # nodes a panel of the places where |q| <= f p is tested on the way
EXCEEDED = 1e-8  # of the largest f p: by so much |q| may exceed f p
KNOWN = 1e-10  # of the contact: next to marks q is known from there on
OPPOSING = 1e-10  # of the largest slip: by so much it may oppose its direction
SHARES = (1.0, 0.5, 0.25, 0.1)  # of a step of Newton's method that are tried
JUST_INSIDE = 1e-3  # of a stick zone: so far inside a mark an end is tried
FLAT, FLAT_AMONG_ALL = (
    1e-4,
    1e-3,
)  # charge of an end, of what is released beside it: moving it changes nothing
NOTHING = 1e-8  # of the largest f p: nothing is released
CLOSE = 1e-7  # of the contact: so close to a mark an end may be on it
ON_MARK, ON_MARK_AT_LEAST = 1e-13, 3e-10  # of the loads: by so much equations may be missed there
IDLE = 1e-6  # of f p: q so close to it all over a stick zone has reached it
NARROWEST = 1e-12  # of the contact: a stick zone


@dataclass(frozen=True)
class Chord:
    """d(x, y) of a difference x - y shorter than a period."""

    period: float

    def __call__(self, step: Any) -> Any:
        if math.isinf(self.period):
            return step
        return np.sin(step * (np.pi / self.period)) * (self.period / np.pi)

    def cosine(self, step: Any) -> Any:
        """Its derivative."""
        return np.cos(step * (np.pi / self.period))

    def logarithm(self, step: Any) -> Any:
        """ln|d|."""
        return np.log(np.abs(self(step)))


@dataclass(frozen=True)
class Zones:
    """Stick zones, and the direction of slip on each part of the patches beside them."""

    stick: Ends
    signs: tuple[float, ...]


class Gap:
    """The half-circle above a gap between two stick zones."""

    def __init__(self, lo: float, hi: float, breaks: tuple[float, ...] = OF_RULES) -> None:
        shares = gauss_shares(breaks)
        half = 0.5 * np.pi * shares.lo  # half the angle from lo
        other = 0.5 * np.pi * shares.hi
        length = hi - lo
        turn = np.exp(-1j * half)
        self.lo, self.hi = lo, hi
        self.from_lo: Complex = length * np.sin(half) * 1j * turn
        self.from_hi: Complex = -length * np.sin(other) * turn
        self.near_lo = shares.lo < shares.hi
        self.weight: Complex = 0.5j * length * turn**2 * np.pi * shares.weight

    def apart(self, e: float) -> Complex:
        """z - e for an end e outside the gap, or one of its ends."""
        if e <= self.lo:
            return (self.lo - e) + self.from_lo
        return (self.hi - e) + self.from_hi

    def from_all(self, rule: Rule) -> Complex:
        """z - t as a matrix, t the places of a rule."""
        found = np.empty((len(self.weight), len(rule.lo)), dtype=complex)
        for rows, e, apart in (
            (self.near_lo, self.lo, self.from_lo),
            (~self.near_lo, self.hi, self.from_hi),
        ):
            found[rows] = apart[rows, None] - rule.apart_from(e)
        return found


def _at_end(near: Array, h: Array, side: float) -> float:
    """What h is at distance 0, by a polynomial through the nearest places; they are in order."""
    x, values = (part[:NEAREST] if side > 0.0 else part[::-1][:NEAREST] for part in (near, h))
    total = 0.0
    for k, value in enumerate(values):
        others = np.delete(x, k)
        total += value * float(np.prod(others / (others - x[k])))
    return total


@dataclass(frozen=True, eq=False)
class Equations:
    """The 2N equations for given zones, and the potential.

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
    def centres(self) -> Array:
        return self.stick.mean(axis=1)

    @cached_property
    def touched(self) -> Ends:
        """What is in contact at the start or at the end."""
        return united(self.before.contact.patches, self.after.patches)

    @cached_property
    def beside(self) -> Array:
        """The intervals between marks beside the stick zones, (n, 2)."""
        old, new = self.before.contact, self.after
        edges = np.array((*old.patches, *new.patches)).ravel()
        marks = np.unique(np.concatenate((self.before.marks, new.limit.marks, edges)))
        return intervals(between(self.touched, self.zones.stick), marks, SAME * new.width)

    @property
    def sources(self) -> Array:
        """The intervals where Δq, or on strips D, is given; those beside the stick zones first."""
        return self.beside

    @cached_property
    def rule(self) -> Rule:
        """Places on them."""
        rough = self.rough and len(self.stick) == 1  # the circle above a gap comes near its ends
        return Rule.graded(self.sources, self.breaks(self.sources) if rough else OF_RULES)

    def breaks(self, ends: Array) -> tuple[float, ...]:
        """Those of a rule on intervals: as fine as the nearest place beyond an end asks for."""
        points = np.unique(np.append(ends, self.stick))
        k = np.searchsorted(points, ends)
        steps = np.concatenate(([np.inf], np.diff(points), [np.inf]))
        beyond = np.stack((steps[k[:, 0]], steps[k[:, 1] + 1]), axis=1)
        nearest = float((beyond / np.diff(ends, axis=1)).min(initial=np.inf))
        return breaks_for(math.sqrt(nearest)) if 0.0 < nearest < np.inf else OF_RULES

    @cached_property
    def slip(self) -> tuple[tuple[float, float, float], ...]:
        beside = between(self.after.patches, self.zones.stick)
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

    def ratios(self, apart: Callable[[float], Array]) -> Array:
        """Π_i [d(z, a_i) d(z, b_i)/d(z, μ_i)²]^(1/2)."""
        d = self.chord
        out: Array = np.ones(())
        for (a, b), m in zip(self.stick, self.centres, strict=True):
            middle = d(apart(m))
            ratio = (d(apart(a)) / middle) * (d(apart(b)) / middle)
            out = out * np.sqrt(ratio if np.iscomplexobj(ratio) else np.abs(ratio))
        return out

    @cached_property
    def charges(self) -> Array:
        """ν_k, (N, places)."""
        ratios = self.ratios(self.rule.apart)
        scaled = self.rule.weight * self.change / ratios
        return np.array([scaled / self.chord(self.rule.apart(m)) for m in self.centres])

    @cached_property
    def gaps(self) -> list[Gap]:
        found = []
        for (_, b), (a, _) in zip(self.stick, self.stick[1:], strict=False):
            points = np.append(self.sources, self.stick)
            apart = np.abs(points - np.array([[b], [a]]))
            near = float(apart[apart > 0.0].min()) / (a - b)
            found.append(Gap(b, a, breaks_for(near) if self.rough else OF_RULES))
        return found

    def root(self, k: int, gap: Gap) -> Complex:
        """T_k on a half-circle."""
        middle: Complex = self.chord(gap.apart(self.centres[k]))
        return middle * self.ratios(gap.apart)

    @cached_property
    def residual(self) -> Array:
        """By how much the equations are missed, (2N)."""
        d, old, new = self.chord, self.before.contact, self.after
        out = []
        for m, nu in zip(self.centres, self.charges, strict=True):
            cos = d.cosine(self.rule.apart(m))
            out.append(float(nu @ cos) + math.pi * (new.tau - old.tau))
        out.append(float(self.charges[0] @ d(self.rule.apart(self.centres[0]))))
        out[-1] -= new.Q - old.Q
        out += [self.over(gap) for gap in self.gaps]
        return np.array(out)

    def over(self, gap: Gap) -> float:
        """Re ∫ (F - Δτ) dx over a gap, on the half-circle."""
        k = int(np.abs(self.stick - gap.lo).min(axis=1).argmin())
        psi = (1.0 / self.chord(gap.from_all(self.rule))) @ self.charges[k] / math.pi
        return float((gap.weight @ (self.root(k, gap) * psi)).real)

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
        """κ of each end: what moving it adds to F is κ T_k(z)/d(z, e).

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
        N, d = len(self.stick), self.chord
        out = np.zeros((2 * N, 2 * N))
        for j, (e, kappa) in enumerate(zip(self.stick.ravel(), self.charge_of_ends, strict=True)):
            own = float(d(e - self.centres[j // 2]))
            for k, m in enumerate(self.centres):
                out[k, j] = math.pi * kappa * own / d(e - m) * d.cosine(e - m)
            out[N, j] = math.pi * kappa * own
            for k, gap in enumerate(self.gaps):
                ratio = own / float(d(e - self.centres[k]))
                value = gap.weight @ (self.root(k, gap) / d(gap.apart(e)))
                out[N + 1 + k, j] = kappa * ratio * float(value.real)
        return out

    def in_stick(self, k: int, places: Rule) -> Array:
        """Δq at places in stick zone k."""
        found: Array = -self.size_of_root(k, places) * self.psi(k, places, np.zeros(0))
        return found

    def psi(self, k: int, places: Rule, density: Array) -> Array:
        """Ψ_k at places on the axis; `density` is ν_k' at those where data are given."""
        total, ends = np.zeros(len(places.lo)), self.stick.ravel()
        for n, (lo, hi) in enumerate(self.rule.ends):
            at, source = self.rule.part(n)
            own = (density.size > 0) & (places.lo >= lo) & (places.hi <= hi)
            if own.any():
                nu = self.charges[k][at] / source.weight, density[own]
                roots = bool((ends == lo).any()), bool((ends == hi).any())
                x = places.among(own)
                total[own] += principal_value(source, nu, x, roots, self.chord)
            if not own.all():
                x = places.among(~own)
                total[~own] += (1.0 / self.chord(x.from_all(source))) @ self.charges[k][at]
        return total / math.pi

    def size_of_root(self, k: int, places: Rule) -> Array:
        """|T_k| at places in stick zone k."""
        d = self.chord
        a, b = self.stick[k]
        out: Array = np.sqrt(np.abs(d(places.apart(a)) * d(places.apart(b))))
        for i, ((lo, hi), m) in enumerate(zip(self.stick, self.centres, strict=True)):
            if i != k:
                middle = d(places.apart(m))
                out *= np.sqrt((d(places.apart(lo)) / middle) * (d(places.apart(hi)) / middle))
        return out


def solved(before: State, after: Contact, guess: Zones) -> State:
    """The state at the end, whose zones Newton's method finds from a guess.

    Raises ContactError where it finds none, or one that is not admissible.
    """
    found = Equations(before, after, guess)
    if guess.signs and not balanced(found, ON_MARK_AT_LEAST):
        found = newton(before, after, guess)
    state = built(found)
    try:
        refuse_inadmissible(found, state)
    except ContactError:
        found = on_marks(found, ON_MARK_AT_LEAST)  # the history is known to so much
        state = built(found)
        refuse_inadmissible(found, state)
    return state


def newton(before: State, after: Contact, guess: Zones) -> Equations:
    """The equations with the zones that solve them."""
    if not guess.stick:
        raise ContactError("the bodies slide as a whole")
    shrinking, anywhere = (_bounds(before, after, guess, on) for on in (True, False))
    found = _within_bounds(before, after, guess, shrinking)
    if found is None and (anywhere != shrinking).any():
        found = _within_bounds(before, after, guess, anywhere)
    if found is None:
        raise ContactError("no stick zones inside the contact balance the loads")
    return found


def _within_bounds(before: State, after: Contact, guess: Zones, bounds: Array) -> Equations | None:
    """The equations with the zones that solve them, each end between two bounds."""
    ends = np.array(guess.stick).ravel()
    room = INSIDE * (bounds[:, 1] - bounds[:, 0])
    ends = np.clip(ends, bounds[:, 0] + room, bounds[:, 1] - room)
    if not (np.diff(ends) > 0.0).all():
        return None
    stick = tuple((float(a), float(b)) for a, b in ends.reshape(-1, 2))
    now = Equations(before, after, Zones(stick, guess.signs), rough=True)
    found, settled = _iterated(now, bounds)
    for outward in (False, True):
        if settled:
            break
        now = _beyond_flat(found, outward)
        if now is not found:
            found, settled = _iterated(now, bounds)
    return replace(on_marks(found, ON_MARK), rough=False) if settled else None


def _iterated(now: Equations, bounds: Array) -> tuple[Equations, bool]:
    """The equations after Newton's method, and whether they are solved.

    It ends where an end moves nothing: a derivative there says nothing.
    """
    last, width = math.inf, now.after.width
    for number in range(STEPS):
        if _flat(now).any():
            return now, balanced(now, ON_MARK)
        with np.errstate(all="ignore"):
            scale = np.abs(now.derivatives).max(axis=1)
            matrix, right = now.derivatives / scale[:, None], -now.residual / scale
        if not (np.isfinite(matrix).all() and np.isfinite(right).all()):
            break
        step = np.linalg.lstsq(matrix, right, rcond=1e-14)[0]
        longest = float(np.abs(step).max())
        if longest <= SETTLED * width or (longest <= GOOD * width and longest >= last):
            return now, True
        if number >= SLOW and longest > FAR * width:
            break
        last = longest
        for share in SHARES:
            moved = _moved(now, share * step, bounds)
            if (np.diff(moved) < NARROWEST * width).any():
                return now, False
            trial = _with_ends(now, moved)
            left = np.linalg.lstsq(matrix, -trial.residual / scale, rcond=1e-14)[0]
            if _flat(trial).any() and not balanced(trial, ON_MARK):
                continue
            if np.abs(left).max() <= (1.0 - 0.25 * share) * longest:
                break
        now = trial
    return now, False


def _beyond_flat(now: Equations, outward: bool) -> Equations:
    """The same with ends that move nothing put beyond the next mark of the shear.

    Between the marks all that slips has slipped before.
    """
    ends, marks = now.stick.ravel().copy(), now.before.marks
    for j in np.flatnonzero(_flat(now)):
        other = ends[j - 1] if j % 2 else ends[j + 1]
        upwards = (j % 2 == 1) == outward
        beyond = marks[marks > ends[j]] if upwards else marks[marks < ends[j]][::-1]
        if beyond.size and (beyond[0] - other) * (ends[j] - other) > 0.0:
            away = beyond[1] - beyond[0] if outward and beyond.size > 1 else other - beyond[0]
            ends[j] = beyond[0] + JUST_INSIDE * away
    return now if (ends == now.stick.ravel()).all() else _with_ends(now, ends)


def _flat(now: Equations) -> NDArray[np.bool_]:
    """Which ends can be moved without a change of anything.

    Their charge is compared with what is released beside them; with all that is, where nothing is.
    """
    rule, peak = now.rule, now.after.peak
    whole = float(np.abs(now.change).max(initial=0.0))
    found = np.zeros(now.stick.size, dtype=bool)
    for j, (e, kappa) in enumerate(zip(now.stick.ravel(), now.charge_of_ends, strict=True)):
        beside = (rule.hi == e) if j % 2 == 0 else (rule.lo == e)
        if beside.any():
            length = float((rule.hi - rule.lo)[beside][0])
            released = float(np.abs(now.change[beside]).max())
            if released > NOTHING * peak:
                found[j] = abs(kappa) * length**0.5 <= FLAT * released
            else:
                found[j] = abs(kappa) * now.after.width**0.5 <= FLAT_AMONG_ALL * whole
    return found


def without_idle(found: Equations) -> Zones:
    """The zones without those in which q is f p all over, in the direction of slip beside them.

    There loads have come back to what they were, and what had slipped neither slips nor sticks.
    """
    stick, signs = list(found.zones.stick), list(found.zones.signs)
    for k in range(len(stick) - 1, -1, -1):
        lo, hi = stick[k]
        before = [j for j, (_, b, _) in enumerate(found.slip) if b == lo]
        after = [j for j, (a, _, _) in enumerate(found.slip) if a == hi]
        if len(stick) == 1 or not before or not after or signs[before[0]] != signs[after[0]]:
            continue
        marks = np.unique(np.concatenate((found.before.marks, found.after.limit.marks)))
        places = Pieces.places(intervals([(lo, hi)], marks, SAME * found.after.width))
        q = found.before.shear.on(places) + found.in_stick(k, places)
        if (signs[before[0]] * q >= found.after.limit.on(places) * (1.0 - IDLE)).all():
            del stick[k], signs[after[0]]
            found = Equations(found.before, found.after, Zones(tuple(stick), tuple(signs)))
    return found.zones


def on_marks(found: Equations, missed: float) -> Equations:
    """The same with ends on marks of the shear at the start, where that solves the equations too.

    Where loads come back to what they were, no end between two marks is better than another: what
    did not slip in the step is taken. `missed`: by how much equations may be missed, of the loads.
    """
    width, marks = found.after.width, found.before.marks
    flat = _flat(found)
    for j in range(len(flat)):
        e = float(found.stick.ravel()[j])
        room = CLOSE * width
        outward = marks[marks >= e - room] if j % 2 else marks[marks <= e + room][::-1]
        if not (flat[j] or (outward.size and abs(outward[0] - e) <= room)):
            continue
        for mark in outward:
            ends = found.stick.ravel().copy()
            ends[j] = mark
            moved = _with_ends(found, ends) if (np.diff(ends) > 0.0).all() else None
            if moved is None or not balanced(moved, missed):
                break
            found = moved
    return found


def on_earlier_zones(before: State, after: Contact, guess: Zones) -> Iterator[Equations]:
    """Equations that are solved with one end of the stick zone on a mark, inner marks first.

    Where loads come back to what they were, all that lies between two marks has come back too: any
    end between them solves the equations, and Newton's method finds none.
    """
    if len(guess.stick) != 1:
        return
    for j in (0, 1):
        other = 1 - j
        marks = before.marks if j else before.marks[::-1]
        for mark in marks:
            ends = np.array(guess.stick[0])
            ends[j] = mark
            now = Equations(before, after, guess, rough=True)
            for _ in range(PINNED_STEPS):
                if not after.patches[0][0] < ends[0] < ends[1] < after.patches[-1][1]:
                    break
                now = _with_ends(now, ends)
                if balanced(now, ON_MARK_AT_LEAST):
                    yield replace(now, rough=False)
                    break
                slope = now.derivatives[:, other]
                ends = ends.copy()
                ends[other] -= float(slope @ now.residual / (slope @ slope))


def _with_ends(found: Equations, ends: Array) -> Equations:
    stick = tuple((float(a), float(b)) for a, b in ends.reshape(-1, 2))
    return replace(found, zones=Zones(stick, found.zones.signs))


def balanced(found: Equations, missed: float) -> bool:
    """Whether zones solve the equations."""
    try:
        size = np.abs(found.charges).sum(axis=1).max() + abs(found.after.Q) + found.after.peak
        return bool(np.abs(found.residual).max() <= missed * size)
    except ContactError:  # a zone of slip that has vanished
        return False


def _moved(now: Equations, step: Array, bounds: Array) -> Array:
    """The ends after a step of Newton's method, which keeps zones apart and inside their bounds."""
    ends = now.stick.ravel()
    out = ends.copy()
    for j, (e, move) in enumerate(zip(ends, step, strict=True)):
        lo, hi = bounds[j]
        if j:
            lo = max(lo, 0.5 * (ends[j - 1] + e))
        if j + 1 < len(ends):
            hi = min(hi, 0.5 * (ends[j + 1] + e))
        room = CLOSEST * ((hi - e) if move > 0.0 else (e - lo))
        out[j] = e + math.copysign(min(abs(move), max(room, 0.0)), move)
    return out


def _bounds(before: State, after: Contact, zones: Zones, goes_on: bool) -> Array:
    """The places between which each end lies.

    They lie in the patches at the start and at the end. Where slip goes on beside an earlier stick
    zone, in the direction that it had there, that zone only shrinks; it may also have stopped at
    once, and begun again at a retreating edge.
    """
    ends = np.array(zones.stick).ravel()
    out = np.empty((len(ends), 2))
    beside, old = between(after.patches, zones.stick), {e for zone in before.stick for e in zone}
    for j, e in enumerate(ends):
        inside = []
        for patches in (before.contact.patches, after.patches):
            inside.append(next((p for p in patches if p[0] <= e <= p[1]), (e, e)))
        lo, hi = max(a for a, _ in inside), min(b for _, b in inside)
        sign = {zone[j % 2 == 0]: s for zone, s in zip(beside, zones.signs, strict=False)}.get(e)
        for a, b, s in before.slip if goes_on else ():
            if (b if j % 2 == 0 else a) not in old:
                continue
            if s == sign and a - after.width * SAME <= e <= b + after.width * SAME:
                lo, hi = (max(lo, b), hi) if j % 2 == 0 else (lo, min(hi, a))
        out[j] = lo, hi
    return out


def built(found: Equations) -> State:
    """The state of solved equations."""
    before, after = found.before, found.after
    same = SAME * after.width
    slip = intervals([zone[:2] for zone in found.slip], after.limit.marks, same)
    marks = np.unique(np.concatenate((before.marks, after.limit.marks, found.begins)))
    stuck = [intervals([zone], marks, same) for zone in found.zones.stick]
    ends = np.concatenate((slip, *stuck))
    values = Pieces.places(ends)
    q = np.zeros(len(values.lo))
    each = len(values.lo) // len(ends)
    first = len(slip) * each
    for lo, hi, s in found.slip:
        part = Pieces.places(intervals([(lo, hi)], after.limit.marks, same))
        at = (values.lo >= lo) & (values.hi <= hi)
        q[at] = s * after.limit.on(part)
    for k, zone in enumerate(stuck):
        part = Pieces.places(zone)
        n = len(part.lo)
        q[first : first + n] = before.shear.on(part) + found.in_stick(k, part)
        first += n
    order = np.argsort(ends[:, 0])
    series = Pieces.of_values(ends, q)
    return State(after, found.zones.stick, found.slip, Pieces(ends[order], series[order]))


# -- whether it is the answer ----------------------------------------------------------------------


def refuse_inadmissible(found: Equations, state: State) -> None:
    """Raise ContactError where |q| > f p in stick, or slip opposes its direction."""
    excess = excess_in_stick(state)
    if excess > EXCEEDED:
        raise ContactError(f"|q| exceeds f p in stick by {excess:.1e} of its peak")
    opposing = opposing_slip(found.before, state, state.stick)
    if opposing > OPPOSING:
        raise ContactError(f"slip opposes its direction by {opposing:.1e} of the largest")


def excess_in_stick(state: State) -> float:
    """The largest |q| - f p in the stick zones over the peak of f p.

    Next to a mark |q| falls from f p like a root of the distance, and marks are rounded.
    """
    contact = state.contact
    ends = intervals(state.stick, state.marks, SAME * contact.width)
    places = Pieces.places(ends)
    known = np.minimum(places.from_lo, places.from_hi) > KNOWN * contact.width
    beyond = np.abs(state.shear.on(places)) - contact.limit.on(places)
    return float(beyond[known].max(initial=-1.0)) / contact.peak


PLACES = (1e-3, 0.1, 0.5, 0.9)  # shares of a part of a slip zone where slip is tested


def opposing_slip(before: State, state: State, stuck: Ends) -> float:
    """The largest slip against its direction over the largest slip.

    `stuck` are zones that stuck from one state to the other.
    """
    old, new = before.contact, state.contact
    same = SAME * new.width
    chord = Chord(new.period)
    marks = np.unique(np.concatenate((before.marks, state.marks)))
    tested, signs, nearest = [], [], []
    stick = np.array(stuck).ravel()
    for lo, hi, s in state.slip:
        cuts = np.append(intervals([(lo, hi)], marks, same), [])
        for a, b in cuts.reshape(-1, 2):
            x = [a + share * (b - a) for share in PLACES] + [a, b]
            tested += x
            signs += [s] * len(x)
            nearest += [stick[np.abs(stick - y).argmin()] for y in x]
    x, c, s = np.array(tested), np.array(nearest), np.array(signs)
    inner = x[~np.isin(x, stick)]
    cuts = np.unique(np.concatenate((marks, inner)))
    touched = united(old.patches, new.patches)
    rule = Rule.graded(intervals(touched, cuts, same), OF_SERIES)
    change = rule.weight * (state.shear.on(rule) - before.shear.on(rule))
    slip = np.zeros(len(x))
    for j, (y, e) in enumerate(zip(x, c, strict=True)):
        if y != e:
            to_y, to_e = rule.apart_from(y), rule.apart_from(e)
            with np.errstate(divide="ignore"):
                log = chord.logarithm(to_y) - chord.logarithm(to_e)
            slip[j] = change @ np.where(np.isfinite(log), log, 0.0) / np.pi
            slip[j] -= (new.tau - old.tau) * (y - e)
    largest = float(np.abs(slip).max(initial=0.0))
    return float((-s * slip).max(initial=0.0)) / largest if largest else 0.0


# -- how well states satisfy the equation ----------------------------------------------------------

MEASURED = np.sin(0.5 * np.pi * (np.arange(8) + 0.5) / 8) ** 2  # shares of a stick zone


def change_of_shear(before: State, state: State, stuck: Ends) -> float:
    """The largest |1/π PV∫ Δq/(x - t) dt - Δτ| at places that stuck from one state to another."""
    old, new = before.contact, state.contact
    chord, same = Chord(new.period), SAME * new.width
    x = np.array([lo + (hi - lo) * share for lo, hi in stuck for share in MEASURED])
    cuts = np.unique(np.concatenate((before.marks, state.marks, x)))
    zones = united(old.patches, new.patches)
    rule = Rule.graded(intervals(zones, cuts, same), OF_SERIES)
    change = state.shear.on(rule) - before.shear.on(rule)
    missed = 0.0
    for y in x[np.isin(x, rule.ends)]:
        here = float(state.shear(np.array([y]))[0] - before.shear(np.array([y]))[0])
        lo, hi = next(zone for zone in zones if zone[0] < y < zone[1])
        own = (rule.lo >= lo) & (rule.hi <= hi)
        apart = -rule.apart_from(y)
        kernel = chord.cosine(apart) / chord(apart)
        total = rule.weight @ ((change - np.where(own, here, 0.0)) * kernel)
        total += here * float(chord.logarithm(y - lo) - chord.logarithm(hi - y))
        missed = max(missed, abs(float(total) / np.pi - (new.tau - old.tau)))
    return missed
