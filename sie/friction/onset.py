"""How the zones of a state go on when the loads begin to change, by the rates alone.

The rates do not depend on the history, so that the zones and their directions of slip decide it:
an end at which the shear beside it grows beyond f p recedes; where it falls instead, slip stops at
once up to the place where K = 0, or everywhere. A stuck edge goes on to stick while the contact
grows there and |K| <= f K_p; else slip begins at it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.graded_panels import Rule
from sie.numerics.root_finding import false_position

from .rates import TESTED, LoadRates, Rates
from .state import TURNS, State, Zones

Array = NDArray[np.float64]

ROUNDS = 12
SCANNED = np.append(  # shares of a slip zone
    np.sin(0.5 * np.pi * np.arange(1, 26) / 26.0) ** 2, 1.0 - 10.0 ** -np.arange(3.0, 9.0)
)
SETTLED = 1e-14  # of a slip zone, and of f p
ROUNDED = 1e-13  # of f K_p: |dQ| = f dP sticks
NEAR = 1e-7  # of the contact: so near to an end f p - q goes like the root of the distance
NARROW = 1e-3  # of a zone of slip: so much of it sticks at least, where the rest slips on
STILL = 1e-9  # of the largest K: less is zero


class Motion(Enum):
    """What an end of a stick zone does."""

    RECEDES = "recedes"
    ADVANCES = "advances"
    GROWS = "grows"  # it is an edge of a contact that grows, and sticks


@dataclass(frozen=True)
class End:
    """An end of a stick zone: its place, the direction of slip beside it, and its motion.

    `sense` is 0 at an edge of the contact where nothing slips.
    """

    place: float
    sense: float
    motion: Motion = Motion.RECEDES


@dataclass(frozen=True)
class Onset:
    """Stick zones (left end, right end), and the patches that slide as a whole (lo, hi, s)."""

    zones: tuple[tuple[End, End], ...]
    patches: tuple[tuple[float, float], ...]
    sliding: tuple[tuple[float, float, float], ...]

    @property
    def ends(self) -> tuple[End, ...]:
        return tuple(end for zone in self.zones for end in zone)

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        return tuple((a.place, b.place) for a, b in self.zones)

    @property
    def sticks_anew(self) -> bool:
        """Whether something comes to stick as time goes on."""
        return any(end.motion is not Motion.RECEDES for end in self.ends)

    @property
    def slip(self) -> tuple[tuple[float, float, float], ...]:
        """The slip zones, ascending; those of zero length too, but not those at stuck edges."""
        found = list(self.sliding)
        for lo, hi in self.patches:
            inside = [zone for zone in self.zones if lo <= zone[0].place and zone[1].place <= hi]
            if inside:
                found.append((lo, inside[0][0].place, inside[0][0].sense))
                found += [
                    (left[1].place, right[0].place, left[1].sense)
                    for left, right in pairwise(inside)
                ]
                found.append((inside[-1][1].place, hi, inside[-1][1].sense))
        return tuple(sorted(zone for zone in found if zone[2]))

    @property
    def signs(self) -> Zones:
        return Zones(self.stick, tuple(s for *_, s in self.slip))

    def rates(self, loads: LoadRates, friction: float, period: float) -> Rates:
        slip = tuple(zone for zone in self.slip if zone[1] > zone[0])
        return Rates.solved(self.patches, self.stick, slip, loads, friction=friction, period=period)

    def of_ends(self, ends: list[End]) -> Onset:
        """The same with other ends."""
        return replace(self, zones=tuple(zip(ends[::2], ends[1::2], strict=True)))

    def placed(self, places: Array) -> Onset:
        """The same with its ends at other places."""
        pairs = zip(self.ends, places, strict=True)
        return self.of_ends([replace(end, place=float(x)) for end, x in pairs])

    def on(self, patches: tuple[tuple[float, float], ...]) -> Onset:
        """The same on other patches."""
        return replace(self, patches=patches)

    def split(self, place: float, sense: float) -> Onset:
        """The same with slip that begins inside a stick zone."""
        k = sum(e.place < place for e in self.ends)
        opened = [End(place, sense), End(place, sense)]
        return self.of_ends([*self.ends[:k], *opened, *self.ends[k:]])

    @property
    def opened(self) -> int | None:
        """The first of two ends between which slip begins; None if it does not."""
        places = [end.place for end in self.ends]
        return next((k for k in range(1, len(places) - 2, 2) if places[k] == places[k + 1]), None)

    def without(self, k: int) -> Onset:
        """The same without ends k and k + 1."""
        return self.of_ends([*self.ends[:k], *self.ends[k + 2 :]])

    def moved(self, j: int, end: End) -> Onset:
        """The same with another end j."""
        return self.of_ends([*self.ends[:j], end, *self.ends[j + 1 :]])

    def outer(self, j: int) -> float:
        """Where the slip zone beside end j ends: at an edge, or at another stick zone."""
        x, step = self.ends[j].place, 1 if j % 2 else -1
        lo, hi = next(((lo, hi) for lo, hi in self.patches if lo <= x <= hi), (np.nan, np.nan))
        if np.isnan(lo):
            raise ContactError("an end of a stick zone is outside the contact")
        edge = hi if step > 0 else lo
        if 0 <= j + step < len(self.ends):
            other = self.ends[j + step].place
            return other if lo <= other <= hi else edge
        return edge

    def joined(self, j: int) -> Onset:
        """The slip zone beside end j stuck: two zones become one, or an edge sticks."""
        outer, step = self.outer(j), 1 if j % 2 else -1
        if any(outer in patch for patch in self.patches):
            return self.moved(j, End(outer, 0.0))
        return self.without(min(j, j + step))


def onset(
    state: State, loads: LoadRates, friction: float, known: Mapping[float, End] | None = None
) -> Onset:
    """The zones and the motions of their ends as loads begin to change at these rates.

    known: what the ends at some places do, where an event just decided it
    """
    known = known or {}

    def rates(zones: Onset) -> Rates:
        return zones.rates(loads, friction, state.contact.period)

    now = _as_it_is(state, known)
    for _ in range(ROUNDS * len(now.ends)):
        changed = (
            _changed(state, now, rates, known)
            or _slips_on(state, now, rates)
            or _stops_inside(now, rates(now))
        )
        if changed is None:
            return now
        now = changed
    raise ContactError("which parts of the contact stick next is not decided by the rates")


def set_out(state: State, now: Onset, loads: LoadRates, friction: float) -> Array:
    """The speeds of ends that recede, as a step begins.

    Where f p - s q is C √t at a distance t inside an end, the end recedes by t = 2 K/C, K/√t the
    rate at which s q - f p grows there.
    """
    rates, near = now.rates(loads, friction, state.contact.period), NEAR * state.contact.width
    edges = dict(zip(np.ravel(now.patches).tolist(), rates.Kp.ravel().tolist(), strict=True))
    speeds = np.zeros(len(now.ends))
    for j, (end, K) in enumerate(zip(now.ends, rates.K.ravel(), strict=True)):
        if end.motion is Motion.RECEDES:
            inward = -1.0 if j % 2 else 1.0
            x = np.array([end.place + inward * near])
            limit = float(state.contact.limit(x)[0])
            C = max(limit - end.sense * float(state.shear(x)[0]), SETTLED * limit) / np.sqrt(near)
            grows = end.sense * float(K) - friction * edges.get(end.place, 0.0)
            speeds[j] = inward * 2.0 * max(grows, 0.0) / C
    return speeds


def _changed(
    state: State, now: Onset, rates: Callable[[Onset], Rates], known: Mapping[float, End]
) -> Onset | None:
    """The zones with the first end that does something else mended; None if there is none."""
    here = rates(now)
    for j, end in enumerate(now.ends):
        if end.place in known:
            continue
        at_edge = any(end.place in patch for patch in now.patches)
        found = _edge(state, now, here, j) if at_edge else _inner(state, now, rates, j)
        if found is None:
            return now.joined(j)
        if found != end:
            return now.moved(j, found)
    return None


def _as_it_is(state: State, known: Mapping[float, End]) -> Onset:
    """The zones of a state, with its directions of slip; the whole contact where nothing sticks."""
    right = {lo: s for lo, _, s in state.slip}
    left = {hi: s for _, hi, s in state.slip}
    zones = tuple(
        (
            known.get(a, End(a, left.get(a, 0.0))),
            known.get(b, End(b, right.get(b, 0.0))),
        )
        for a, b in state.stick or state.contact.patches
    )
    sliding = tuple(zone for zone in state.slip if zone[:2] in state.contact.patches)
    return Onset(zones, state.contact.patches, sliding if state.stick else ())


def _edge(state: State, now: Onset, rates: Rates, j: int) -> End:
    """What a stuck edge does."""
    end, K = now.ends[j], float(rates.K.ravel()[j])
    edges = np.array(now.patches).ravel()
    Kp = rates.friction * float(rates.Kp.ravel()[np.abs(edges - end.place).argmin()])
    if Kp > 0.0 and abs(K) <= (1.0 + ROUNDED) * Kp:
        return End(end.place, 0.0, Motion.GROWS)
    if Kp <= 0.0:
        K -= _share_of_limit(state, end.place) * Kp
    sense = float(np.sign(K)) or 1.0
    beside = [(*zone, s) for *zone, s in state.slip if end.place in zone and s == sense]
    for lo, hi, s in beside:  # what slipped there did not stop all over
        return End(lo if end.place == hi else hi, s)
    return End(end.place, sense)


def _slips_on(state: State, now: Onset, rates: Callable[[Onset], Rates]) -> Onset | None:
    """The same with slip that goes on next to an end, of a zone that would stick all over.

    There |q| = f p all over the zone, and |q| would grow faster than f p next to the end.
    """
    stick = {e for zone in state.stick for e in zone}
    for lo, hi, s in state.slip:
        for e, far in ((lo, hi), (hi, lo)):
            k = sum(end.place < e for end in now.ends)
            if e not in stick or k % 2 == 0 or now.ends[k].place < max(e, far):
                continue
            here, at = rates(now), Rule.graded(np.array([[e, e]]))
            margin = here.friction * here.pressure.density(at) - s * here.shear.density(at)
            if float(margin[0]) >= 0.0:
                continue
            opened = sorted((e, far + NARROW * (e - far)))
            ends = [*now.ends[:k], *(End(x, s) for x in opened), *now.ends[k:]]
            j = k + (e == lo)
            place = resting_place(now.of_ends(ends), rates, j)
            if place is not None:
                ends[j] = End(place, s, Motion.ADVANCES)
                return now.of_ends(ends)
    return None


def _stops_inside(now: Onset, rates: Rates) -> Onset | None:
    """The same with stick where slip would oppose its direction most; None where it does not."""
    if rates.turning >= TURNS:
        return None
    slips = rates.slips
    m, i = np.unravel_index(slips.argmin(), slips.shape)
    lo, hi, sense = rates.shear.slip[m]
    x = float(lo + (hi - lo) * TESTED[i])
    opened = [End(x + side * NARROW * min(x - lo, hi - x), sense) for side in (-1.0, 1.0)]
    for j, (e, last) in enumerate(((lo, slips[m, 0]), (hi, slips[m, -1]))):
        if last < 0.0 and any(e in patch for patch in now.patches):
            opened[j] = End(e, 0.0)
    k = sum(end.place < x for end in now.ends)
    sliding = tuple(zone for zone in now.sliding if zone[0] != lo)
    return replace(now.of_ends([*now.ends[:k], *opened, *now.ends[k:]]), sliding=sliding)


def _share_of_limit(state: State, edge: float) -> float:
    """q/(f p) next to an edge."""
    lo, hi = next(patch for patch in state.contact.patches if edge in patch)
    x = edge + (1e-9 if edge == lo else -1e-9) * (hi - lo)
    at = np.array([x])
    return float(np.clip(state.shear(at) / state.contact.limit(at), -1.0, 1.0)[0])


def _inner(state: State, now: Onset, rates: Callable[[Onset], Rates], j: int) -> End | None:
    """What an end beside slip does; None: the slip zone beside it sticks."""
    end = now.ends[j]
    here = _margin(now, rates, j)
    if here >= -STILL if end.motion is Motion.RECEDES else abs(here) <= STILL:
        return end
    old = np.array(state.stick).ravel()  # from where it is in the state
    inside = old[old <= end.place] if j % 2 else old[old >= end.place]
    start = (inside.max() if j % 2 else inside.min()) if inside.size else end.place
    place = resting_place(now.moved(j, replace(end, place=float(start))), rates, j)
    return None if place is None else End(place, end.sense, Motion.ADVANCES)


def _margin(now: Onset, rates: Callable[[Onset], Rates], j: int) -> float:
    """S K of an end over the largest K."""
    found = rates(now).K.ravel()
    return now.ends[j].sense * float(found[j]) / float(np.abs(found).max())


def resting_place(now: Onset, rates: Callable[[Onset], Rates], j: int) -> float | None:
    """Where outside of its place, and inside the slip zone beside it, an end has K = 0."""
    end, outer = now.ends[j], now.outer(j)

    def margin(place: float) -> float:
        return _margin(now.moved(j, replace(end, place=place)), rates, j)

    places = end.place + (outer - end.place) * np.append(0.0, SCANNED)
    last, small = margin(places[0]), SETTLED * abs(outer - end.place)
    for a, b in pairwise(places):
        value = margin(b)
        if last < 0.0 <= value:
            ends = (last, value) if a < b else (value, last)
            return false_position(
                margin, min(a, b), max(a, b), ends, lambda lo, hi, _: hi - lo < small
            )
        last = value
    return None
