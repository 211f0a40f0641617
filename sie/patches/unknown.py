"""Refusals of contacts that what is known of the indenter does not decide.

Beyond the end of a trace nothing is known. And doubles of h tell no difference of two depths below
their rounding: where a load is so light that such a difference decides which valleys touch, or how
they share it, there is no answer. Nor is there one where two patches are about to merge, and the
search for them does not come to rest.
"""

from __future__ import annotations

import numpy as np

from sie.errors import LoadError

from .newton import conditions_of
from .of_scene import Problem
from .operator import Found
from .state import State

UNKNOWN = 0.01  # part by which the rounding of h may change the load of a patch


def refuse_unknown_ends(state: State, problem: Problem) -> None:
    """Raises LoadError where contact reaches an end beyond which the indenter is not known."""
    edges = zip(
        state.patches.edges[[0, -1]].tolist(),
        problem.domain,
        problem.profile.ends_are_corners,
        strict=True,
    )
    for edge, end, corner in edges:
        if edge != end or problem.chord.periodic:
            continue
        if not np.isfinite(float(problem.slope(np.array([end]))[0])):
            raise LoadError(
                f"the slope is infinite at the end x = {end:.6g} of its domain, which the "
                "contact comes near: "
                "narrow the domain"
            )
        if not corner:
            raise LoadError(
                f"the contact reaches the end of the trace at x = {end:.6g}, and what the indenter "
                "is like beyond is not known: lower the load or the tilt, repeat the trace by "
                "sie.Periodic(trace, period), or measure further out",
                end=end,
            )


def refuse_unknown_depths(found: Found, problem: Problem) -> None:
    """Raises LoadError where the rounding of h decides which valleys touch, or how they share."""
    P, seen, load = found.state.patches, found.findings, found.given.load

    def refuse(k: int, place: float, known: float, least: float) -> None:
        away = abs(place - P.c[k])
        decides = load / np.pi * (np.log(max(2.0 * away / P.r[k], 1.0)) + 0.5)
        if known > least * decides:
            raise _unknown_depth(problem.load, (float(P.c[k]), place), known, decides)

    if seen.doubt:
        refuse(int(np.argmin(np.abs(P.c - seen.place))), seen.place, seen.doubt, UNKNOWN)
    if P.number == 1:
        return
    linear = conditions_of(found)
    moved = linear.rounded_moves(found.state)  # by the rounding from patch to patch
    if 2.0 * float(np.abs(moved / np.repeat(P.r, 2)).max()) > UNKNOWN:
        k = int(np.argmax(linear.rounding))
        refuse(k, float(P.c[k + 1]), linear.rounding[k], 0.0)


def _unknown_depth(
    load: float, places: tuple[float, float], known: float, decides: float
) -> LoadError:
    x1, x2 = sorted(places)
    return LoadError(
        f"how the valleys at x = {x1:.6g} and {x2:.6g} share normal_load = {load:.6g} "
        f"is decided by a difference of depths of {decides:.2g}, and doubles of h tell "
        f"{known:.2g}: raise the load, or make one valley deeper",
        valleys=(x1, x2),
    )


def unsettled(problem: Problem, patches: int) -> LoadError:
    """The refusal of a load under which the search does not come to rest."""
    other = problem.given.moment is not None
    return LoadError(
        f"the patches of contact do not settle at normal_load = {problem.load:.6g}: two "
        "of them are about to merge, or one to appear; change the load"
        f"{' or the moment' * other} a little",
        patches=patches,
    )
