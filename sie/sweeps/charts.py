"""The charts of Ciavarella, Hills & Monno (1998) as numbers: Figs 4 to 8, of the rounded punch.

Lengths are in units of the half-width, b = 1. E* and R cancel, so a chart depends on a/b, f and ν
only. `python -m validation --only paper` draws the charts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.problem.scene import Scene
from sie.profiles.shapes import Parabola, RoundedFlat
from sie.progress_bar import counted
from sie.solution import Solution, solve
from sie.stress.half_plane import Stress
from sie.stress.yield_limit import YieldPoint

Array = NDArray[np.float64]

POISSON = 0.3
RATIOS = tuple(round(0.05 * k, 2) for k in range(19))  # a/b of Figs 5 to 7
# "each little cross corresponds to an increment of f = 0.0125" (Fig. 7).
FRICTIONS = tuple(0.0125 * k for k in range(41))


def punch(ratio: float, friction: float = 0.0, poisson: float = POISSON) -> Solution:
    """The punch of a/b = ratio in full sliding, b = E* = R = 1 (a parabola for ratio 0).

    ValueError unless 0 <= ratio < 1.
    """
    if not 0.0 <= arguments.finite("ratio", ratio) < 1.0:
        raise ValueError(
            f"ratio = {ratio:g} is not in [0, 1): a/b is 0 for a parabola and 1 for a sharp-edged "
            "flat"
        )
    profile = RoundedFlat(ratio, 1.0) if ratio else Parabola(1.0)
    return _sliding(
        solve(Scene(profile=profile, modulus=1.0, half_width=1.0, poisson=poisson)), friction
    )


def yield_parameter(
    ratio: float, friction: float, x: ArrayLike, y: ArrayLike, poisson: float = POISSON
) -> Array:
    """b √J2 / P at (x, y), in units of b, the contours of Fig. 4."""
    solution = punch(ratio, friction, poisson)
    stress: Stress = solution.stress(x, y)
    return np.sqrt(stress.j2) / solution.normal_load


@dataclass(frozen=True)
class ElasticLimits:
    """P/(bk) at first yield and where, (ratios, frictions): Figs 5 (f = 0), 6 and 7.

    Where two maxima are equal, x is that of the right one.
    """

    ratios: tuple[float, ...]
    frictions: tuple[float, ...]
    limit: Array
    x: Array
    y: Array


def elastic_limits(
    ratios: Sequence[float] = RATIOS,
    frictions: Sequence[float] = FRICTIONS,
    poisson: float = POISSON,
) -> ElasticLimits:
    """The chart of Fig. 6; one normal problem for each ratio."""
    found: list[list[YieldPoint]] = []
    for ratio in counted("a/b", ratios, len(ratios)):
        base = punch(ratio, 0.0, poisson)
        found.append([_sliding(base, f).elastic_limit() for f in frictions])
    limit = np.array([[point.ratio for point in row] for row in found])
    x, y = (np.array([[point.places[-1][k] for point in row] for row in found]) for k in (0, 1))
    return ElasticLimits(tuple(ratios), tuple(frictions), limit, x, y)


def surface_tension(ratio: float, stick: ArrayLike) -> Array:
    """Largest surface tension over f p0 in partial slip, p0 = P/(πb): Fig. 8.

    The stick zone has the half-width c = stick, in units of b.

    The shear is f (p_b - p_c), p_c the pressure of the same profile in a contact of half-width c
    (eq. (19)); where c <= a the punch slides. At the trailing edge that is 2f [E*(b - a)/(2R) -
    F_c(b)].
    """
    whole = punch(ratio)
    values = np.asarray(stick, dtype=float)
    if ((values < 0.0) | (values > 1.0)).any():
        raise ValueError(
            "stick holds values outside [0, 1]: give c/b, 0 in full sliding and 1 in full stick"
        )
    P = whole.normal_load

    def tension(c: float) -> float:
        Q = P if c <= ratio else P - whole.with_(half_width=c).normal_load
        return whole.with_(friction=1.0, tangential_load=Q).peak_tension().value

    out: Array = np.array([tension(c) for c in values.ravel().tolist()]) / (P / np.pi)
    return out.reshape(values.shape)


def _sliding(solution: Solution, friction: float) -> Solution:
    return solution.with_(friction=friction, tangential_load=friction * solution.normal_load)
