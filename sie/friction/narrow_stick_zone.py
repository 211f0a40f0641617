"""A narrow stick zone between slip zones of opposite directions, as a large bulk stress leaves it.

The two conditions of `slip_zones` in the combinations that stay apart when the stick zone
[c - ρ, c + ρ] shrinks; s = ±1 is the sign of τ, t the distance from c, and |R| = sqrt(t² - ρ²):

    ∫_left p/|R| ds + ∫_right p/|R| ds     = π |τ|/f
    ∫_left p t/|R| ds - ∫_right p t/|R| ds = s Q/f

The first gives its width, ρ ~ exp(-π |τ|/(2 f p(c))), the second its place: for ρ -> 0 slip in the
two directions balances Q. They are solved by Newton's method in ln ρ and ln(distance of c from the
nearer edge), from the limit ρ -> 0. A zone narrower than `PINCHED` is a point in doubles: it is
solved for with that width, and the strain that it does not hold is slip from c on
(`SlipZones.unheld`).
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from sie.numerics.interval import EPS, Interval, interval_about, two_sum
from sie.numerics.root_finding import false_position, increasing_root

from .slip_zones import Drive, EdgeFrame, SlipZone, SlipZones, slip_zone

# of the distance of c from the nearer edge: beyond, the lengths of the slip zones are the better
# unknowns
NARROW = 0.5
PINCHED = 8.0 * EPS  # of the distance of c from the nearer edge, which says where c is
STEP = 1e-7  # of finite differences
MAX_STEPS = 30
ROUGHLY = 1e-3  # of ln ρ, and of the excess along it: from there Newton's method converges
SETTLED = 1e-10  # relative steps below it that no longer shrink are rounding


def narrow_stick_zone(
    frames: tuple[EdgeFrame, EdgeFrame], contact: Interval, drive: Drive
) -> SlipZones | None:
    """The slip zones beside a narrow stick zone; None if the stick zone is not narrow."""
    strain, width = abs(drive.strain), 2.0 * contact.r
    near, depth = _balanced(frames, contact, drive)
    # The load of the far side less that of the near one
    load = (drive.left, drive.right)[1 - near] * drive.load

    def cut(rho: float, depth: float) -> tuple[SlipZone, SlipZone]:
        return slip_zone(frames[near], depth - rho), slip_zone(
            frames[1 - near], width - depth - rho
        )

    def excess(rho: float, depth: float) -> tuple[float, float]:
        (pull, turn), (far_pull, far_turn) = (_pull_and_turn(z, rho) for z in cut(rho, depth))
        return pull + far_pull - strain, far_turn - turn - load

    if depth == 0.0 or excess(NARROW * depth, depth)[0] >= 0.0:
        return None
    least = PINCHED * depth
    short = -excess(least, depth)[0]
    if short > 0.0:
        rho = least
    else:
        rho = _narrowed(lambda rho: excess(rho, depth)[0], least, NARROW * depth)
        rho, depth = _settled(excess, rho, depth)
        if not rho < min(depth, width - depth):
            # Newton's method left the contact, or did not settle: the stick zone is not narrow
            return None
    zones = cut(rho, depth)
    left, right = zones[near], zones[1 - near]
    return SlipZones(_about(contact, rho, depth, near), left, right, drive, max(short, 0.0))


def _balanced(
    frames: tuple[EdgeFrame, EdgeFrame], contact: Interval, drive: Drive
) -> tuple[int, float]:
    """The point where slip to and fro balance Q.

    It is given by the edge that it is nearer to (0 left, 1 right), and its distance from it.
    """
    near, depth = 0, 0.0
    for near, sign in ((0, drive.left), (1, drive.right)):
        force = 0.5 * (frames[near].density.resultant + sign * drive.load)
        depth = _depth(frames[near], force) if force > 0.0 else 0.0
        if depth <= contact.r:
            break
    return near, depth


def _depth(frame: EdgeFrame, force: float) -> float:
    """The distance from an edge over which the pressure has this resultant."""
    return increasing_root(
        lambda d: float(slip_zone(frame, d).force.sum()) - force, 0.5 * frame.width, frame.width
    )


def _pull_and_turn(z: SlipZone, rho: float) -> tuple[float, float]:
    """∫p/|R| ds and ∫p t/|R| ds over a zone."""
    weight = z.force / np.sqrt(z.from_stick * (z.from_stick + 2.0 * rho))
    return float(weight.sum()), float(weight @ (z.from_stick + rho))


def _about(contact: Interval, rho: float, depth: float, near: int) -> Interval:
    edge, tail = (
        (contact.x2, contact.tail2 - depth) if near else (contact.x1, contact.tail1 + depth)
    )
    c, rest = two_sum(edge, tail)
    return interval_about(c, rho).moved(rest, rest)


def _narrowed(excess: Callable[[float], float], low: float, high: float) -> float:
    """ρ to a few digits, where a function that falls like -ln ρ vanishes."""
    a, b, ends = math.log(low), math.log(high), (excess(low), excess(high))
    steep = abs(ends[0] - ends[1]) / (b - a)

    def settled(a: float, b: float, value: float) -> bool:
        return b - a < ROUGHLY or abs(value) <= ROUGHLY * steep

    return math.exp(false_position(lambda u: excess(math.exp(u)), a, b, ends, settled))


def _settled(
    excess: Callable[[float, float], tuple[float, float]], rho: float, depth: float
) -> tuple[float, float]:
    """Newton's method for both at once, until its steps are rounding."""
    previous = math.inf
    for _ in range(MAX_STEPS):
        pull, turn = excess(rho, depth)
        wider, deeper = excess(rho * (1.0 + STEP), depth), excess(rho, depth * (1.0 + STEP))
        J = (
            np.array([[wider[0] - pull, deeper[0] - pull], [wider[1] - turn, deeper[1] - turn]])
            / STEP
        )
        determinant = J[0, 0] * J[1, 1] - J[0, 1] * J[1, 0]
        if determinant == 0.0:
            break
        step = (
            np.array([J[0, 1] * turn - J[1, 1] * pull, J[1, 0] * pull - J[0, 0] * turn])
            / determinant
        )
        size = float(np.abs(step).max())
        if size >= previous and size < SETTLED:
            break
        rho, depth, previous = rho * math.exp(step[0]), depth * math.exp(step[1]), size
        if size <= 4.0 * EPS:
            break
    else:
        return math.inf, depth  # to and fro across a corner of the pressure
    return rho, depth
