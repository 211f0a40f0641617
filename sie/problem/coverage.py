"""Which loads with friction are refused at sight, and what a scene needs.

Of dissimilar bodies, a normal load that grows is covered, and then a tangential load and a bulk
stress at constant P. Where P falls, or changes while a tangential load acts, what comes to stick
keeps a slip gradient that depends on every state before: that is refused.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import NoReturn

from sie.errors import ContactError, LoadError
from sie.numerics.interval import EPS, two_product

from .material import NO_POISSON
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
    loads = {"tangential_load": scene.tangential_load, "bulk_stress": scene.bulk_stress}
    given = [f"{name} = {value:g}" for name, value in loads.items() if value]
    if scene.moment:
        raise held_moment(scene)
    if given and scene.half_width is not None:
        raise ContactError(
            f"{pair}: the load of half_width = {scene.half_width:g} under {given[0]} is not "
            "solved; give normal_load"
        )
    if given and scene.profile.pieces.is_flat_punch:
        refuse_corners(scene)


def held_moment(scene: Scene) -> ContactError:
    """The ContactError: a moment that turns the indenter while P grows."""
    return ContactError(
        f"dissimilar bodies (β = {scene.beta:.4g}) with friction = {scene.friction:g}: a moment "
        f"that is held, here {scene.moment:g}, is not solved; give a tilt in its place, set "
        f"friction = 0, or {NEGLECTED}"
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
        f"Q = {scene.tangential_load:g} a corner of the indenter keeps old slip"
        f"{size}, which is not solved; round it, set sliding = ±1, or give dundurs = 0"
    )


def refuse_sliding(friction: float, normal_load: float, Q: float) -> None:
    """Raises LoadError if friction cannot carry Q."""
    limit = friction * normal_load
    if abs(Q) > limit:
        enough = math.nextafter(abs(Q) / friction, math.inf)
        raise LoadError(
            f"|Q| = {abs(Q)!r} exceeds f P = {limit!r}: the bodies slide; lower tangential_load to "
            f"at most that, or raise normal_load to {enough!r} or friction",
            limit=limit,
        )


def remaining(friction: float, normal_load: float, Q: float) -> float:
    """P - |Q|/f, from (f P - |Q|)/f without cancellation."""
    product, rest = two_product(friction, normal_load)
    return ((product - abs(Q)) + rest) / friction


# -- what a scene needs ---------------------------------------------------------------------------


def refuse_unknown_poisson(scene: Scene) -> None:
    """Raises ValueError where what needs Poisson's ratio is asked for without one."""
    if scene.body is None and scene.poisson is None:
        raise ValueError(NO_POISSON)


def energy_costs(scene: Scene) -> bool:
    """Whether the dissipated energy is a sum over states, and so only answered if asked for."""
    return scene.coupled and (scene.tangential_load != 0.0 or scene.tau != 0.0)


def sheared(scene: Scene, economy: Collection[str]) -> bool:
    """Whether the shear of a scene has to be computed.

    It is not computed without friction, nor, of similar bodies (unless economy is switched off),
    without Q and σ.
    """
    return scene.friction != 0.0 and (
        scene.tangential_load != 0.0
        or scene.sliding != 0
        or scene.tau != 0.0
        or "shear" not in economy
    )
