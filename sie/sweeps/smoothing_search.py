"""The least smoothing of a rough trace that touches in one patch, found by trials."""

from __future__ import annotations

import math
from dataclasses import replace

from sie.errors import ContactError
from sie.problem.scene import Scene, refuse_no_scene
from sie.profiles.derived import with_part
from sie.profiles.placed_traces import traces_in
from sie.profiles.splines import longest_lambda
from sie.progress_bar import reported, step_done
from sie.solution import solve

COARSE = 10.0  # λ is multiplied by this until there is one patch ...
HALVINGS = 2  # ... and then that step is halved in the logarithm so often
DIGITS = 2


@reported("smoothing, trial")
def least_smoothing(scene: Scene, tol: float = 1e-13) -> float:
    """The least smoothing λ of a trace that makes its contact one patch.

    Parameters
    ----------
    scene : Scene
        A contact whose profile is a `Sampled` trace, or is made of one. `solve` may refuse it.
    tol : float
        As in `solve`.

    Returns
    -------
    float
        λ in length³, for `Sampled(..., smoothing=λ)`. The trace's own if the scene has an answer
        already, else at least that of cross validation; the least within a factor of about 2,
        rounded up to two digits. The contact is solved for each λ that is tried, about ten times.

    Raises
    ------
    ValueError
        The profile has no trace.
    ContactError
        No smoothing makes it one patch.

    Notes
    -----
    The smoothing removes a part of the surface, which is missing from the contact. `Sampled.misfit`
    gives the height of that part, `Solution.trace_reports` its effect on the pressure.

    Examples
    --------
    >>> import numpy as np
    >>> import sie
    >>> x = np.linspace(-2.0, 2.0, 201)
    >>> wavy = sie.Sampled(x, x**2 / 2.0 + 0.1 * np.cos(12.0 * x))
    >>> scene = sie.Scene(profile=wavy, modulus=1.0, normal_load=0.3)
    >>> smooth = wavy.smoothed(sie.least_smoothing(scene))
    >>> sie.solve(sie.Scene(profile=smooth, modulus=1.0, normal_load=0.3)).check().ok
    True
    """
    refuse_no_scene(scene)
    trace = next((placed.trace for placed in traces_in(scene.profile)), None)
    if trace is None:
        raise ValueError(f"{scene.profile!r} is no trace: only a sampled profile is smoothed")

    def one_patch(lam: float) -> bool:
        step_done()
        smooth = replace(scene, profile=with_part(scene.profile, trace, trace.smoothed(lam)))
        try:
            return len(solve(smooth, tol).patches) == 1
        except ContactError:
            return False

    if one_patch(trace.lam):
        return trace.lam
    start = _rounded_up(max(trace.smoothed("gcv").lam, COARSE * trace.lam))
    lam, longest = start, longest_lambda(trace.points)
    while lam < longest and not one_patch(lam):
        lam = _rounded_up(COARSE * lam)
    if lam >= longest:
        raise ContactError(
            f"no smoothing of the trace makes its contact one patch, up to {longest:.3g}, "
            "which leaves a straight line: raise the load or lower it"
        )
    step = COARSE
    for _ in range(HALVINGS if lam > start else 0):  # below the start the spline would follow noise
        step = math.sqrt(step)
        less = _rounded_up(lam / step)
        lam = less if one_patch(less) else lam
    return lam


def _rounded_up(lam: float) -> float:
    digit = 10.0 ** (math.floor(math.log10(lam)) + 1 - DIGITS)
    return float(f"{math.ceil(lam / digit) * digit:.{DIGITS - 1}e}")
