"""What would make a rough trace touch in one patch: the least smoothing that does, found by trying."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from .errors import ContactError, InequalityError, LoadError
from .normal import Normal
from .profile import Derived, Profile
from .sampled import Sampled
from .scene import Scene
from .smoothing import longest_lambda

COARSE = 10.0  # λ is multiplied by this until there is one patch ...
HALVINGS = 2  # ... and then that step is halved in the logarithm so often
DIGITS = 2


def with_smoothing(
    error: ContactError, scene: Scene, attempt: Callable[[Scene], Normal], verify: Callable[[Scene, Normal], object]
) -> ContactError:
    """The error with the smoothing that makes it one patch in its message and in `reached["smoothing"]`; itself, if there is none.

    `attempt` finds the contact of a scene or raises ContactError; `verify` raises InequalityError, with the intervals of tension and
    overlap, if a scene cannot touch there. So a load that found no contact at all is told where the smoothed trace's would lift off.
    """
    trace = _trace(scene.profile)
    if trace is None or "end" in error.reached:
        return error
    least = trace.smoothed("gcv").lam
    lam = _least(max(least, COARSE * trace.lam), trace, scene, attempt)
    if lam is None:
        advice = "no smoothing makes it one patch under this load"
    else:
        if isinstance(error, LoadError):
            try:
                verify(scene, attempt(replace(scene, profile=_replaced(scene.profile, trace, trace.smoothed(lam)))))
            except InequalityError as found:
                error = found
        advice = (
            f"smoothing = {lam:g} makes it one patch (and leaves {trace.smoothed(lam).misfit:.3g} rms of the heights, "
            f"where cross validation, with {least:.2g}, leaves {trace.smoothed(least).misfit:.3g})"
        )
    reached = error.reached if lam is None else error.reached | {"smoothing": lam}
    return type(error)(f"{error.args[0]}; {advice}", **reached)


def _least(start: float, trace: Sampled, scene: Scene, attempt: Callable[[Scene], object]) -> float | None:
    def one_patch(lam: float) -> bool:
        try:
            attempt(replace(scene, profile=_replaced(scene.profile, trace, trace.smoothed(lam))))
        except ContactError:
            return False
        return True

    lam, longest = _rounded_up(start), longest_lambda(trace.points)
    while lam < longest and not one_patch(lam):
        lam = _rounded_up(COARSE * lam)
    if lam >= longest:
        return None
    if lam == _rounded_up(start):
        return lam
    step = COARSE
    for _ in range(HALVINGS):
        step = math.sqrt(step)
        less = _rounded_up(lam / step)
        lam = less if one_patch(less) else lam
    return lam


def _rounded_up(lam: float) -> float:
    digit = 10.0 ** (math.floor(math.log10(lam)) + 1 - DIGITS)
    return float(f"{math.ceil(lam / digit) * digit:.{DIGITS - 1}e}")


def _trace(profile: Profile) -> Sampled | None:
    """The trace in a profile that is made of others."""
    parts = profile.steps if isinstance(profile, Derived) else (profile,)
    return next((part for part in parts if isinstance(part, Sampled)), None)


def _replaced(profile: Profile, old: Sampled, new: Sampled) -> Profile:
    return profile.with_part(old, new) if isinstance(profile, Derived) else new
