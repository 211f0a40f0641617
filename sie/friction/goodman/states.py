"""The state of a scene in Goodman's approximation, whichever way its stick zone moved."""

from __future__ import annotations

import math

from sie.errors import ContactError
from sie.friction.slip_state import Step
from sie.problem.load_limit import refuse_corner, refuse_sliding

from .functions import goodman_flat
from .growth import Search
from .march import march
from .marched_shear import MarchedShear
from .moving_slip import MovingShear, MovingSlip
from .proportion import Proportion, in_proportion, on_straight_pieces
from .receding_flat import receding_flat
from .slip import GoodmanSlip, contact_table
from .zone_table import zone_table

NARROWEST = 1e-6  # of the half-width: a march has too few digits in narrower zones


def goodman_slip(step: Step, search: Search) -> GoodmanSlip:
    """The state of a scene's contact after P and Q; ContactError where it is not solved.

    `search` finds contacts of the same slope up to this one.
    """
    scene = step.scene
    if step.Q:
        refuse_sliding(scene.friction, step.normal_load, step.Q)
        refuse_corner(step.normal.edges.sharp, step.Q)
    flat = goodman_flat(abs(scene.beta), scene.friction)
    table = contact_table(step, search, flat)
    state: GoodmanSlip = GoodmanSlip(step, flat, table)
    growth = on_straight_pieces(table, step.slope, step.normal.edges.sharp)
    if growth and abs(growth[0]) <= flat.k:
        growth = None
    half_width = 0.0 if growth else max(side.recedes for side in state.sides)
    if half_width:
        growth = in_proportion(table)
    if growth:
        turn, power = growth
        rates = Proportion(receding_flat(flat.beta / flat.friction), abs(turn), power)
        shear = MovingShear(step, rates, table.first_centre, math.copysign(1.0, turn))
        state = MovingSlip(step, flat, table, before=shear)
    elif half_width:
        if min(flat.k, flat.modulus.rest) < NARROWEST:
            raise _too_narrow(flat.k, half_width)
        spells = march(table, zone_table(flat.beta / flat.friction))
        state = MovingSlip(step, flat, table, before=MarchedShear(step, spells, table.first_centre))
    return state.under_tangential_load() if step.Q else state


def _too_narrow(k: float, half_width: float) -> ContactError:
    return ContactError(
        f"the contact moves aside faster than it grows: its stick zone, {k:.4g} of the width, "
        f"would recede at one end at a half-width of {half_width:.6g}, and Goodman's approximation "
        f"is solved there for stick and slip zones of more than {NARROWEST:g} of the half-width, "
        "or for growth in proportion as under a wedge; raise or reduce the friction, reduce the "
        "tilt, or give dundurs = 0 to neglect β"
    )
