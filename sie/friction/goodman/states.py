"""The state of a scene in Goodman's approximation, whichever way its stick zone moved."""

from __future__ import annotations

import math

from sie.errors import ContactError
from sie.friction.slip_state import Step
from sie.problem.load_limit import refuse_corner, refuse_sliding

from .functions import goodman_flat
from .growth import Search
from .moving_slip import MovingShear, MovingSlip
from .proportion import Proportion, in_proportion, on_straight_pieces
from .receding_flat import receding_flat
from .slip import GoodmanSlip, contact_table


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
        if growth is None:
            raise ContactError(
                f"the contact moves aside faster than it grows: its stick zone, {flat.k:.4g} of "
                f"the width, would recede at one end at a half-width of {half_width:.6g}, and "
                "Goodman's approximation is solved for stick zones that only grow, or recede in "
                "proportion to the contact as under a wedge; raise the friction, reduce the tilt, "
                "or give dundurs = 0 to neglect β"
            )
    if growth:
        turn, power = growth
        rates = Proportion(receding_flat(flat.beta / flat.friction), abs(turn), power)
        shear = MovingShear(step, rates, table.first_centre, math.copysign(1.0, turn))
        state = MovingSlip(step, flat, table, before=shear)
    return state.under_tangential_load() if step.Q else state
