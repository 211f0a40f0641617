"""The contact of dissimilar bodies under P, then Q: which zones that are found are those sought.

The zones found from incipient sliding downwards are those, unless an end of the stick zone passes a
corner of the profile. Pressure is infinite there, so that the corner sticks longer than what is
beside it: a slip zone opens between it and the rest of the stick zone, while the four edges of
`tangential` go back and forth over one range of loads. In that range they miss what slips; above it
they are found from incipient sliding, and below it from a small Q upwards.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from sie.contact.inequalities import TOLERATED
from sie.contact.known_contact import Edges
from sie.errors import ContactError
from sie.problem.coverage import LargerLoad, refused_slip
from sie.problem.scene import Scene

from .load_path import LoadPath
from .sheared import ShearedContact
from .tangential import TangentialSearch

Below = Callable[[TangentialSearch, float], ShearedContact]

SMALL = (1e-2, 1e-4, 1e-6)  # parts of f P from which the load is followed upwards


def either(first: Below, second: Below) -> Below:
    """The state of the first one, and that of the second one under larger loads."""

    def below(search: TangentialSearch, Q: float) -> ShearedContact:
        try:
            return first(search, Q)
        except LargerLoad:
            return second(search, Q)

    return below


def refused(search: TangentialSearch, Q: float) -> ShearedContact:
    """No state below the zones of `tangential`."""
    raise LargerLoad("such loads are not asked for")


def sheared_contact(
    scene: Scene, search: TangentialSearch, spreading: Below
) -> tuple[Edges, ShearedContact]:
    """The edges and the state under the scene's Q.

    Raises ContactError where none is found, or slip since P would oppose Q.
    """
    sign = math.copysign(1.0, scene.beta)
    flip = math.copysign(1.0, sign * scene.tangential_load)
    state = replace(
        found_state(search, abs(scene.tangential_load), spreading), sign=sign, flip=flip
    )
    P = search.normal.load
    moment = state.axis * P + flip * state.moment
    edges = Edges(state.contact, P, moment, 0.0, (False, False), 0.0, 0.0, 0.0, 0)
    return edges, state


def found_state(search: TangentialSearch, Q: float, spreading: Below = refused) -> ShearedContact:
    """The state under Q > 0 with β > 0; `spreading` gives those below the zones of `tangential`.

    Its refusals are the user's where the load lies there.
    """
    try:
        state = ShearedContact(search, search.found(Q), Q, 1.0, 1.0)
        if not search.corners or keeps_friction_law(state):
            return state
        refusal = refused_slip(search.beta * search.friction, Q / search.limit)
    except ContactError as error:
        if not search.corners:
            try:
                return spreading(search, Q)
            except LargerLoad:
                raise error from None
        refusal = error
    for load in (part * search.limit for part in SMALL if part * search.limit < Q):
        root = search.next_to(search.start(load), load)
        if root is None or search.least_slip(root.trial) < 0.0:
            continue
        trial, end, _ = LoadPath(search).followed(root.trial, load, Q)
        state = ShearedContact(search, trial, end, 1.0, 1.0)
        if end == Q and keeps_friction_law(state):
            return state
        break
    raise refusal


def keeps_friction_law(state: ShearedContact) -> bool:
    """Whether slip since P goes along Q, and q is at most f p in the stick zone."""
    return state.least_slip >= -TOLERATED and state.least_deficit >= -TOLERATED
