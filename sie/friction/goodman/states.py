"""The state of a scene in Goodman's approximation, whichever way its stick zone moved."""

from __future__ import annotations

from sie.friction.slip_state import Step
from sie.problem.load_limit import refuse_corner, refuse_sliding

from .functions import goodman_flat
from .growth import Search
from .march import March
from .moving_slip import MovingSlip, NormalShear
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
    state = GoodmanSlip(step, flat, table)
    if any(side.recedes for side in state.sides):
        march = March(receding_flat(flat.beta / flat.friction), table)
        history = march.run()
        shear = NormalShear(step, history, table.middle, tuple(march.marks()))
        state = MovingSlip(step, flat, table, before=shear)
    return state.under_tangential_load() if step.Q else state
