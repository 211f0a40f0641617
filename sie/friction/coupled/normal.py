"""The search for the contact of dissimilar bodies pressed with friction.

The half-width is that at which ∫P' ds = P (`growth`, `march`). It is not larger than without
friction, as friction stiffens the contact: the frictionless contact bounds the search, and refuses
what no contact can carry.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from sie.contact.known_contact import Normal
from sie.errors import ContactError
from sie.numerics.interval import EPS, Interval
from sie.numerics.root_finding import false_position
from sie.problem.scene import Scene
from sie.profiles.slope import Slope
from sie.progress_bar import reported

from .flat import FlatPunch, flat_punch, goodman_flat
from .frozen import Frozen
from .growth import Panel
from .march import NEGLECT, March, Touch, first_touch, refuse_turning
from .pressed import Grown, Pressed
from .state import HalfSlope

WIDER = 1.0 + 64.0 * EPS  # than the frictionless contact: as far as P' is sought at first
MORE = 1.1  # where a load asks for more
NEARLY = 1e-14  # of the load
MOST_KINKS = 8  # of the profile within the contact: each cuts a state at up to five places
NARROWEST_STICK = 1e-9  # of the contact
RESOLVED = 3e-12  # of P: what a state may miss
STEEPEST = 1.5  # β f: exponents at the ends of slip zones are then 0.19 and 0.81


@reported("contact of dissimilar bodies")
def coupled_contact(scene: Scene, frictionless: Callable[[Scene], Normal]) -> Pressed:
    """How the contact grew; ContactError where none answers.

    `frictionless` solves the normal problem of a scene; its contact bounds the search.
    """
    punch = goodman_flat if scene.neglects_beta else flat_punch
    flat = punch(abs(scene.beta), scene.friction)
    _refuse_friction(flat, scene)
    P, b, G = scene.normal_load, scene.half_width, 0.5 * scene.Estar
    plain = Scene(profile=scene.profile, modulus=scene.Estar, normal_load=P, half_width=b)
    bound = frictionless(plain)
    contact, slope = bound.edges.contact, bound.slope(scene.profile)
    touch = first_touch(slope, contact.r)
    if touch.lo <= contact.x1 and contact.x2 <= touch.hi:
        assert P is not None
        return Pressed(flat, P, scene.friction, contact.r, contact.m)
    _refuse_many_kinks(slope, contact, touch)
    law = scene.profile.power_law
    march = March(flat, slope, G, touch, law.exponent if law is not None else 0.0)
    # without β q the contact is that without friction
    s, load = _marched(march, None if flat.approximate else P, contact.r)
    frozen, events = Frozen(flat, tuple(march.panels)), (march.base, *march.kinks)
    origin, load = march.panels[0].middle, load if P is None else P
    H1 = HalfSlope(slope.shifted(-origin) if origin else slope, G, frozen.window(s))
    grown = Grown(flat, load, scene.friction, s, origin, frozen, events, H1)
    _refuse_unresolved(grown)
    return grown


def _refuse_friction(flat: FlatPunch, scene: Scene) -> None:
    """Raises ContactError where β f or the stick zone of the flat punch is out of reach."""
    steep = flat.beta * scene.friction
    if steep > STEEPEST and not (flat.bonded or flat.approximate):
        raise ContactError(
            f"dissimilar bodies with β f = {steep:.3g}, more than {STEEPEST:g}, are not solved: "
            f"give friction = {STEEPEST / flat.beta:.3g} or less"
        )
    if flat.c < NARROWEST_STICK:
        raise ContactError(
            f"dissimilar bodies (β = {scene.beta:.3g}) with friction = {scene.friction:g} stick "
            f"on a part {flat.c:.1g} of the contact, less than is solved: raise friction, or "
            f"{NEGLECT}"
        )


def _refuse_unresolved(state: Grown) -> None:
    """Raises ContactError where the conditions at the ends of zones are not met well enough."""
    # but for Q, which (1) tells with the digits that 1/β leaves
    missed = float(np.abs(state.loaded.state.missed[:-1]).max())
    if not missed <= RESOLVED:
        raise ContactError(
            f"the contact of dissimilar bodies under P = {state.load:.6g} is known to {missed:.1g} "
            "of P alone, as where it hardly spreads beyond a flat base: raise the load, or "
            f"{NEGLECT}"
        )


def _refuse_many_kinks(slope: Slope, contact: Interval, touch: Touch) -> None:
    """Raises ContactError where more places are not smooth than a state is cut at."""
    breaks = slope.breaks
    inside = (breaks > contact.x1) & (breaks < contact.x2)
    kinks = int(np.count_nonzero(inside & ((breaks < touch.lo) | (breaks > touch.hi))))
    if kinks > MOST_KINKS:
        raise ContactError(
            f"dissimilar bodies touch over {kinks} places where the slope of the profile is not "
            f"smooth, as at the points of a trace; {MOST_KINKS} are solved: fit a sie.Polynomial "
            f"to it, or {NEGLECT}"
        )


def _marched(march: March, P: float | None, goal: float) -> tuple[float, float]:
    """The half-width under the load, or the goal without one, and the load."""
    farthest = goal * WIDER
    while True:
        before = march.load
        panel = march.advance(farthest)
        end = panel.length
        if P is None and panel.hi >= goal:
            end = goal - panel.lo
        if P is not None and march.load >= P:
            end = _at_load(panel, P - before)
        refuse_turning(panel, end, before, march.flat)
        if panel.hi >= goal if P is None else march.load >= P:
            return panel.lo + end, before + panel.load(end) if P is None else P
        if march.stopped is not None:
            raise ContactError(_at_corner(march))
        if panel.hi >= farthest:
            farthest *= MORE


def _at_load(panel: Panel, missing: float) -> float:
    """How far along the panel it carries that load."""
    return false_position(
        lambda d: panel.load(d) - missing,
        0.0,
        panel.length,
        (-missing, panel.load(panel.length) - missing),
        lambda _lo, _hi, missed: abs(missed) <= NEARLY * missing,
    )


def _at_corner(march: March) -> str:
    """Why there is no answer beyond a corner that an edge has reached."""
    edge = march.stopped
    assert edge is not None
    return (
        f"under P = {march.load:.6g} the contact reaches a corner of the indenter at x = "
        f"{edge.place:.6g}: there one of its edges stays while the other one moves, and how the "
        "stick zone between dissimilar bodies moves then is not solved; lower the load, round the "
        f"corner, {NEGLECT}"
    )
