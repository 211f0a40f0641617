"""The state under a tangential load, whose zones may be found from those under other loads.

Other loads are followed in steps of ln tan φ, Q = f P sin²φ. Next to Q = 0 the edges leave those of
the normal load like powers of tan φ, and next to f P like powers of cot φ those of sliding, so that
the change of each is continued as a power. Where slip begins to oppose Q on the way down, no state
follows that depends on Q alone: the load is found, to be named.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from sie.contact.known_contact import Edges
from sie.contact.least_gaps import TOLERATED
from sie.numerics.root_finding import false_position
from sie.problem.coverage import refused_load, refused_slip
from sie.problem.scene import Scene
from sie.progress_bar import reported

from .iteration import SETTLED, next_to
from .sheared import ShearedContact
from .tangential import TangentialSearch, Trial

Array = NDArray[np.float64]

# Steps: the first one, the shortest and the longest one, and how much longer the next one is
STRIDE, SHORTEST, LONGEST, LONGER = 0.7, 1e-2, 2.0, 1.5
ROUGHLY = 1e-6  # of the conditions, on the way
NAMED = 3e-3  # of ln tan φ: the error of the least load that is named
AT_EDGE = 1e-4  # half-widths: nearer to the edge under P alone, e1 has ended there

# Of f P: where slip along Q in both zones begins above it, the zones depend on Q alone only above
# some larger load. On the grid of `oracles/sheared_grid.py` they do so from that load on in 16
# cases in which it is 0.02 to 0.49 f P, under parabolas, rounded flats and powers, and not up to
# 1.00 to 1.09 times that load in 10 of 11 in which it is 0.51 to 0.86 f P
LATE = 0.4


def sheared_contact(scene: Scene, search: TangentialSearch) -> tuple[Edges, ShearedContact]:
    """The edges and the state under the scene's Q.

    Raises ContactError where none is found, or slip since P would oppose Q.
    """
    sign = math.copysign(1.0, scene.beta)
    flip = math.copysign(1.0, sign * scene.tangential_load)
    state = replace(found_state(search, abs(scene.tangential_load)), sign=sign, flip=flip)
    P = search.normal.load
    moment = state.axis * P + flip * state.moment
    edges = Edges(state.contact, P, moment, 0.0, (False, False), 0.0, 0.0, 0.0, 0)
    return edges, state


def found_state(search: TangentialSearch, Q: float) -> ShearedContact:
    """The state under Q > 0 with β > 0.

    At a corner of the profile pressure is infinite, so that it sticks longer than what is beside
    it: while a slip zone is open between it and the rest of the stick zone, the four edges of
    `tangential` miss what slips.
    """
    state = ShearedContact(search, state_under(search, Q), Q, 1.0, 1.0)
    if search.corners and not keeps_friction_law(state):
        raise refused_slip(search.beta * search.friction, Q / search.limit)
    return state


def keeps_friction_law(state: ShearedContact) -> bool:
    """Whether slip since P goes along Q, and q is at most f p in the stick zone."""
    return state.least_slip >= -TOLERATED and state.least_deficit >= -TOLERATED


@reported("zones of stick and slip")
def state_under(search: TangentialSearch, Q: float) -> Trial:
    """The state under Q.

    Raises ContactError where none has these zones, or slip would oppose Q in them.
    """
    root = next_to(search, search.start(Q), Q)
    if root is not None and search.least_slip(root.trial) >= 0.0:
        return _unless_late(search, root.trial, Q)
    least, opposed = math.inf, search.spreads
    for load in () if opposed else search.first_loads:
        if Q < least <= load:  # from there one arrives where one has been
            continue
        first = next_to(search, search.start(load), load, settled=ROUGHLY)
        if first is not None and search.least_slip(first.trial) >= 0.0:
            now, end, opposed = LoadPath(search).followed(first.trial, load, Q)
            if end == Q:
                return _unless_late(search, now, Q)
            least = min(least, end)
            # Where e1 ends at the edge of the contact of P alone, what it reached sticks below
            opposed = opposed or now.zones.e1 + search.normal.b < AT_EDGE * search.normal.b
            if opposed:
                break
        elif first is not None:
            opposed = True
    if opposed:
        least = least if least <= LATE * search.limit else search.limit
    elif search.corners:
        raise refused_slip(search.beta * search.friction, Q / search.limit)
    raise refused_load(search.beta * search.friction, (Q, least, search.limit))


class LoadPath:
    """The states that a search finds one from the other."""

    def __init__(self, search: TangentialSearch) -> None:
        self.search = search

    def followed(self, now: Trial, load: float, Q: float) -> tuple[Trial, float, bool]:
        """The state under Q, in steps from that under another load.

        If a step finds none, it is the last one that was found, with the least load that has one,
        and whether slip would oppose Q below it.
        """
        place, end, before = self._place(load), self._place(Q), None
        way = math.copysign(1.0, end - place)
        stride = way * min(abs(end - place), STRIDE)
        while abs(stride) > SHORTEST:
            last = abs(end - place) <= abs(stride)
            to = end if last else place + stride
            aim = Q if last else self._load(to)
            guess = self._continued(before, (place, now), to)
            root = next_to(self.search, guess, aim, settled=SETTLED if last else ROUGHLY)
            if root is None:
                stride = 0.5 * (to - place)
                continue
            if self.search.least_slip(root.trial) < 0.0:
                return now, self._least_load((to, root.trial), (place, now)), True
            before, place, now, load = (place, now), to, root.trial, aim
            stride = way * min(abs(stride) * LONGER, LONGEST)
            if last:
                break
        return now, load, False

    def _place(self, Q: float) -> float:
        """ln tan φ."""
        return 0.5 * math.log(Q / (self.search.limit - Q))

    def _load(self, place: float) -> float:
        """Q there."""
        return self.search.limit / (1.0 + math.exp(-2.0 * place))

    def _continued(
        self, before: tuple[float, Trial] | None, now: tuple[float, Trial], place: float
    ) -> Array:
        """Edges at a place, whose changes since Q = 0 go on as powers, as between two states."""
        first = self.search.first_edges
        here = now[1].edges - first
        if before is None:
            one, other = (self.search.start(self._load(at)) - first for at in (now[0], place))
            growth, part = other / one, 1.0
        else:
            growth, part = here / (before[1].edges - first), (place - now[0]) / (now[0] - before[0])
        continued: Array = first + here * np.where(growth > 0.0, np.abs(growth), 1.0) ** part
        return continued

    def _least_load(self, opposing: tuple[float, Trial], along: tuple[float, Trial]) -> float:
        """The least load that was found whose slip is along Q, between those of two states."""
        (a, one), (b, other) = opposing, along
        ends = self.search.least_slip(one), self.search.least_slip(other)
        slopes: Array | None = None

        def least(place: float) -> float:
            nonlocal slopes, opposing, along
            guess = self._continued(opposing, along, place)
            root = next_to(self.search, guess, self._load(place), slopes, ROUGHLY)
            if root is None:
                return -1.0
            slip, slopes = self.search.least_slip(root.trial), root.slopes
            if slip < 0.0:
                opposing = place, root.trial
            else:
                along = place, root.trial
            return slip

        false_position(least, a, b, ends, lambda a, b, _: b - a < NAMED)
        return self._load(along[0])


def _unless_late(search: TangentialSearch, now: Trial, Q: float) -> Trial:
    """The state under Q; ContactError where slip would oppose Q under LATE f P.

    The same holds where the zones, followed down from Q, end above LATE f P. At corners of the
    profile they may end for another reason.
    """
    late = LATE * search.limit
    if late >= Q:
        return now
    root = next_to(search, search.start(late), late, settled=ROUGHLY)
    if root is not None:
        opposed = search.least_slip(root.trial) < 0.0
    else:
        _, end, opposed = LoadPath(search).followed(now, Q, late)
        opposed = opposed or (end > late and not search.corners)
    if opposed:
        raise refused_load(search.beta * search.friction, (Q, search.limit, search.limit))
    return now
