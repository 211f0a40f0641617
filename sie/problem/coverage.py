"""Refusals of loads with friction that no contact carries, or that are not covered.

Of dissimilar bodies, a normal load that grows, and a tangential load that grows after it, leave
states that depend on the loads alone, as long as zones of stick and slip move in one direction.
Other loads do not: what sticks again keeps a slip gradient that depends on every state before.
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


def refused_load(kappa: float, loads: tuple[float, float, float]) -> ContactError:
    """The ContactError: under Q there are no zones that depend on Q alone, or none were found.

    `loads` are |Q|, the least one under which there are (f P for none, inf if unknown), and f P.
    """
    Q, least, limit = loads
    asked = f"dissimilar bodies (β f = {kappa:.3g}) under |Q| = {Q:.6g} ({Q / limit:.3g} f P)"
    why = "what the contact gains sticks, with slip that depends on the path"
    digit = 10.0 ** (math.floor(math.log10(limit)) - 7)
    if Q < least < limit - digit:
        least = math.ceil(least / digit) * digit
        return ContactError(f"{asked}: {why}; give |Q| from {least:.8g} up to f P, or dundurs = 0")
    if limit - digit <= least < math.inf:
        why += "; let them slide (sliding = 1 or -1)"
    else:
        why = "no zones of stick and slip were found; change |Q|"
    return ContactError(f"{asked}: {why}, lower friction, or give dundurs = 0")


def refused_slip(kappa: float, part: float) -> ContactError:
    """The ContactError: under Q, a part of f P, an end of the stick zone passes a corner."""
    return ContactError(
        f"dissimilar bodies (β f = {kappa:.3g}) under |Q| = {part:.3g} f P: a corner of the "
        "profile sticks while what is beside it slips; give a |Q| nearer to f P, round the corner, "
        "or give dundurs = 0"
    )


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
