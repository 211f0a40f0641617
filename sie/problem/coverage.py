"""Refusals of loads with friction that no contact carries, or that are not covered.

Of dissimilar bodies, a normal load that grows, and a tangential load that grows after it, leave
states that depend on the loads alone, as zones of stick and slip move in one direction. Other loads
do not: what sticks again keeps a slip gradient that depends on every state before.
"""

from __future__ import annotations

import math
from typing import NoReturn

from sie.errors import ContactError
from sie.numerics.interval import EPS

from .load_limit import refuse_sliding
from .scene import Scene, refuse_no_scene

# The nearest contact of dissimilar bodies that is covered: E*, the bodies' shares of it and their
# constants stay.
NEGLECTED = "give dundurs = 0 to neglect β"


class LargerLoad(ContactError):
    """The load is larger than those under which all that the contact gains sticks."""


def refuse_uncovered(scene: Scene) -> None:
    """Raises ValueError unless it is a scene, ContactError for loads that are not covered."""
    refuse_no_scene(scene)
    if scene.bonded and scene.bulk_stress == 0.0:
        return
    if scene.normal_load is not None and not scene.slides:
        refuse_sliding(scene.friction, scene.normal_load, scene.tangential_load)
    if scene.beta != 0.0 and scene.friction != 0.0 and (scene.coupled or scene.bulk_stress):
        _refuse_dissimilar(scene)


def _refuse_dissimilar(scene: Scene) -> None:
    """Raises ContactError for what is asked beyond P at a tilt, or P, then Q."""
    pair = f"dissimilar bodies (β = {scene.beta:.4g}) with friction = {scene.friction:g}"
    if scene.bulk_stress:
        raise ContactError(
            f"{pair}: bulk_stress = {scene.bulk_stress:g} is not solved for them; "
            f"set bulk_stress = 0, set friction = 0, or {NEGLECTED}"
        )
    if scene.moment:
        raise held_moment(scene)
    if scene.tangential_load and scene.half_width is not None:
        raise ContactError(
            f"{pair}: the load of half_width = {scene.half_width:g} under tangential_load = "
            f"{scene.tangential_load:g} is not solved; give normal_load"
        )
    if scene.tangential_load and scene.profile.pieces.is_flat_punch:
        refuse_corners(scene)


def held_moment(scene: Scene) -> ContactError:
    """The ContactError: a moment that turns the indenter while P grows."""
    return ContactError(
        f"dissimilar bodies (β = {scene.beta:.4g}) with friction = {scene.friction:g}: a moment "
        f"that is held, here {scene.moment:g}, is not solved; give a tilt in its place, set "
        f"friction = 0, or {NEGLECTED}"
    )


def uneven_under_shear(scene: Scene) -> ContactError:
    """The ContactError: Q after P under a profile that is not symmetric."""
    return ContactError(
        f"dissimilar bodies (β = {scene.beta:.4g}) with friction = {scene.friction:g}: "
        f"tangential_load = {scene.tangential_load:g} is solved under symmetric profiles alone; "
        f"set tangential_load = 0, set friction = 0, or {NEGLECTED}"
    )


def refused_load(kappa: float, loads: tuple[float, float, float], spreads: bool) -> ContactError:
    """The ContactError: under Q there are no zones that depend on Q alone, or none were found.

    `loads` are |Q|, the least one that such zones were followed to, and f P; `spreads` tells that
    below it slip would oppose Q.
    """
    Q, least, limit = loads
    if spreads:
        why = (
            "the contact spreads so fast that surfaces stick or slip back which came into contact "
            f"under Q, as far as |Q| = {least:.6g} = {_part(least / limit)} f P. The slip gradient "
            "that they keep from when they were touched depends on every state before and is not "
            "solved; "
        ) + ("give a larger |Q| up to f P" if least < limit else "let the bodies slide")
    elif Q < least < math.inf:
        why = (
            "the zones of stick and slip that larger loads leave were followed down to |Q| = "
            f"{least:.6g} = {_part(least / limit)} f P, where they end; what is below it is not "
            "solved; give a larger |Q| up to f P"
        )
    else:
        why = "no zones of stick and slip were found; change Q"
    return ContactError(
        f"dissimilar bodies with β f = {kappa:.3g} under |Q| = {Q:.6g} = {Q / limit:.3g} f P: "
        f"{why}, lower the friction, or give dundurs = 0 to neglect β"
    )


def refused_spread(kappa: float, loads: tuple[float, float], why: str) -> ContactError:
    """The ContactError: under |Q|, of f P, all that is gained sticks, and this is not solved."""
    Q, limit = loads
    return ContactError(
        f"dissimilar bodies with β f = {kappa:.3g} under |Q| = {Q:.6g} = {Q / limit:.3g} f P: "
        f"what the contact gains under so small a load sticks as it is touched, and {why}; give a "
        "larger |Q| up to f P or tangential_load = 0, lower the friction, or give dundurs = 0 to "
        "neglect β"
    )


def refused_opened(kappa: float, loads: tuple[float, float], why: str) -> ContactError:
    """The ContactError: under |Q|, of f P, a slip zone is open, or was, and this is not solved."""
    Q, limit = loads
    return ContactError(
        f"dissimilar bodies with β f = {kappa:.3g} under |Q| = {Q:.6g} = {Q / limit:.3g} f P: "
        "the contact spreads so fast that surfaces stick which came into contact under Q, until a "
        f"slip zone opens at the old edge, and {why}; give a |Q| nearer to f P, or a small one, "
        "lower the friction, or give dundurs = 0 to neglect β"
    )


def refused_energy(Q: float) -> ContactError:
    """The ContactError: the energy under a load whose states depend on those before."""
    return ContactError(
        f"the energy that dissimilar bodies dissipate under |Q| = {Q:.6g}, where a slip zone is "
        "open inside the stick zone, is a sum over all smaller loads that is not taken; set "
        "tangential_load = 0 for the energy under the normal load"
    )


def refused_slip(kappa: float, part: float) -> ContactError:
    """The ContactError: under Q, a part of f P, an end of the stick zone passes a corner."""
    return ContactError(
        f"dissimilar bodies with β f = {kappa:.3g} under |Q| = {part:.3g} f P: an edge of contact "
        "or stick passes a corner of the profile, which is not solved; give another |Q|, or "
        "dundurs = 0 to neglect β"
    )


def _part(part: float) -> str:
    """A part of f P in words that tell it from 1."""
    return f"{part:.4g}" if part < 0.99 or part == 1.0 else f"(1 - {1.0 - part:.3g})"


def old_slip_width(beta: float, friction: float) -> float:
    """About the widest zone, in half-widths, that keeps the slip of the normal load under Q.

    It lies at the edge behind. A bonded edge oscillates with the exponent η, over distances up to a
    few half-widths; the sense of slip turns where its phase has passed that of f and a right angle.
    """
    eta = math.atanh(abs(beta)) / math.pi
    return 8.0 * math.exp(-(0.5 * math.pi + math.atan(friction)) / eta)


def refuse_corners(scene: Scene) -> NoReturn:
    """Raises ContactError: under Q the contact would end at a corner of the indenter."""
    width = old_slip_width(scene.beta, scene.friction)
    size = f" in about {width:.1g} half-widths" if width > EPS else ""
    raise ContactError(
        f"dissimilar bodies (β = {scene.beta:.4g}) with friction = {scene.friction:g}: under "
        f"tangential_load = {scene.tangential_load:g} a corner of the indenter keeps old slip"
        f"{size}, which is not solved; round it, set sliding = ±1, or give dundurs = 0"
    )
