"""Refusals of loads with friction that no contact carries, or that are not covered."""

from __future__ import annotations

from sie.problem.scene import Scene

from .coupled_refusals import refuse_unsolved
from .load_limit import refuse_sliding

# The nearest contact of dissimilar bodies that is covered: E*, the bodies' shares of it and their
# constants stay.
NEGLECTED = (
    "give dundurs = 0 (in a scene file, under [pair]) to neglect β alone, which changes tractions "
    "by a part of about β"
)


def refuse_uncovered(scene: Scene) -> None:
    """Raises ContactError for loads that no contact carries, or that are not covered."""
    if scene.bonded and scene.bulk_stress == 0.0:
        return
    if scene.normal_load is not None and not scene.slides:
        refuse_sliding(scene.friction, scene.normal_load, scene.tangential_load)
    if scene.beta != 0.0 and scene.friction != 0.0 and (scene.coupled or scene.bulk_stress):
        refuse_unsolved(scene, NEGLECTED)
