"""Stress intensity over a cycle of loading, and the depth at which a crack stops.

A crack grows while ΔK_I, the range over the cycle with closed faces at 0, exceeds the threshold,
which for short cracks falls with the depth (El Haddad, Smith & Topper 1979):

    ΔK(a) > ΔK0 sqrt(a/(a + a0)),      a0 = (ΔK0/Δσ0)²/π

ΔK0 is the threshold of long cracks, Δσ0 the fatigue limit of the smooth material, as ranges.

The equation of a crack has no length but its depth a. One solved system therefore gives, for all
depths, K = sqrt(π a) Σ_i W_i σ(a ξ_i). Cells of constant opening tell where all of a crack is open;
a crack that is not takes an equation of its own.

For cracks below a fretted contact: Nowell, Dini & Hills, Eng. Fract. Mech. 73 (2006) 207-222.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.cauchy.density import Part
from sie.cauchy.equation import CauchyEquation
from sie.cauchy.system import System
from sie.files import table_of_rows
from sie.numerics import jacobi
from sie.numerics.root_finding import false_positions

from .edge_crack import CrackCertificate, EdgeCrack, cells, opened, regular_kernel

Array = NDArray[np.float64]

MOST_DEPTHS = 10_000
LEAST = 64.0  # spacings of doubles at the place of a crack: the least depth
# W then has 9 digits for a stress that varies over a thousandth of the depth, next to the surface,
# and 13 where it varies over a tenth
NODES = 192
# Cells at the tip in which the sign of K tells more than that of the opening does
AT_TIP = 3


class StressIntensity:
    """K_I and K_II of cracks normal to the surface over a cycle; `Cycle.stress_intensity` makes it.

    Attributes
    ----------
    states : sequence of Solution
        The solutions at the turning points.
    at : float
        Position of the mouth of the crack on the surface, length.
    depth : ndarray of float
        Depths of the tip, lengths, ascending.
    mode_1, mode_2 : ndarray of float
        K_I, 0 where the tip is closed, and K_II, of shape (turning points, depths), stress times
        root of length.
    range, shear_range : ndarray of float
        ΔK_I and ΔK_II over the cycle at each depth.

    Notes
    -----
    Faces that touch are without friction, and the crack does not change the contact. A positive
    K_II is that of a positive σ_xy. K has nine digits or more where the stress varies over a
    thousandth of the depth or more slowly; `check` measures it.

    References
    ----------
    El Haddad, Smith & Topper, J. Eng. Mater. Technol. 101 (1979) 42-46; Nowell, Dini & Hills, Eng.
    Fract. Mech. 73 (2006) 207-222.
    """

    def __init__(self, states: Sequence[Any], at: float, depth: Array) -> None:
        self.states, self.at, self.depth = states, at, depth
        self.mode_1, self.mode_2 = self._modes(depth)
        self.range, self.shear_range = np.ptp(self.mode_1, axis=0), np.ptp(self.mode_2, axis=0)

    def _modes(self, depth: Array) -> Array:
        found = [modes(partial(self._stress, state), depth) for state in self.states]
        return np.stack(found, axis=1)

    def _stress(self, state: Any, y: Array) -> tuple[Array, Array]:
        stress = state.stress(self.at, y)
        return stress.xx, stress.xy

    def table(self) -> Any:
        """The extremes at each depth.

        Returns
        -------
        pandas.DataFrame or list of dict
            A row for each depth with the columns depth, K1_max, K1_min, K1_range, K2_max, K2_min,
            K2_range. A DataFrame where pandas is installed.
        """
        columns = {"depth": self.depth}
        for name, K in (("K1", self.mode_1), ("K2", self.mode_2)):
            columns[f"{name}_max"], columns[f"{name}_min"] = K.max(axis=0), K.min(axis=0)
            columns[f"{name}_range"] = np.ptp(K, axis=0)
        table = np.transpose([*columns.values()]).tolist()
        return table_of_rows([dict(zip(columns, row, strict=True)) for row in table])

    def threshold(
        self, threshold: float, fatigue_limit: float, depth: ArrayLike | None = None
    ) -> Array:
        """The range that a crack needs to grow, after El Haddad.

        Parameters
        ----------
        threshold : float
            ΔK0 of long cracks, stress times root of length.
        fatigue_limit : float
            Δσ0 of the smooth material, a range of stress.
        depth : array_like of float, optional
            Depths, those of the cracks if not given.

        Returns
        -------
        ndarray of float
            ΔK0 sqrt(a/(a + a0)), of the shape of the depths.
        """
        K0 = arguments.positive("threshold", threshold)
        a0 = (K0 / arguments.positive("fatigue_limit", fatigue_limit)) ** 2 / math.pi
        a = self.depth if depth is None else arguments.reals("depth", depth)
        out: Array = K0 * np.sqrt(a / (a + a0))
        return out

    def arrest(self, threshold: float, fatigue_limit: float) -> float:
        """The depth at which a crack that grows from the surface stops.

        Parameters
        ----------
        threshold, fatigue_limit : float
            ΔK0 and Δσ0, as of `threshold`.

        Returns
        -------
        float
            The depth at which ΔK_I falls to the threshold first; the first of the depths if it is
            below there already, and inf if it stays above down to the last one.
        """
        above = self.range > self.threshold(threshold, fatigue_limit)
        if above.all():
            return math.inf
        k = int(np.argmin(above))
        if k == 0:
            return float(self.depth[0])

        def excess(a: Array) -> Array:
            return np.ptp(self._modes(a)[0], axis=0) - self.threshold(threshold, fatigue_limit, a)

        return float(false_positions(excess, self.depth[k - 1 : k], self.depth[k : k + 1])[0])

    def crack(self, turning_point: int, depth: float) -> EdgeCrack:
        """One of the cracks by itself, with its opening, its closed zones and its certificate.

        Parameters
        ----------
        turning_point : int
            The index of the state.
        depth : float
            The depth of the tip, length.

        Returns
        -------
        EdgeCrack
            The crack in the stress of that state.
        """
        state = self.states[turning_point]
        return EdgeCrack(
            depth,
            lambda y: self._stress(state, y)[0],
            lambda y: self._stress(state, y)[1],
        )

    def check(self) -> CrackCertificate:
        """The certificate of the first, the middle and the last depth at each turning point.

        Returns
        -------
        CrackCertificate
            The worst of each measure; the residual includes the difference of both modes from the
            cracks solved one by one, over the largest K.
        """
        largest = max(np.abs(self.mode_1).max(), np.abs(self.mode_2).max(), 1e-300)
        found = []
        for k in range(len(self.states)):
            for i in {0, len(self.depth) // 2, len(self.depth) - 1}:
                crack = self.crack(k, float(self.depth[i]))
                off = np.abs([crack.mode_1 - self.mode_1[k, i], crack.mode_2 - self.mode_2[k, i]])
                residual, *lowest = crack.check()
                found.append((max(residual, off.max() / largest), *lowest))
        residuals, openings, pressures = zip(*found, strict=True)
        return CrackCertificate(float(max(residuals)), min(openings), min(pressures))

    def plot(
        self, ax: Any = None, threshold: float = 0.0, fatigue_limit: float = 0.0, units: Any = None
    ) -> Any:
        """ΔK_I and ΔK_II against depth, with the threshold where it is given.

        Parameters
        ----------
        ax, units
            As of `Solution.plot`.
        threshold, fatigue_limit : float, optional
            ΔK0 and Δσ0, as of `threshold`.

        Returns
        -------
        matplotlib.axes.Axes
            The axes that were drawn on.
        """
        from sie.plots.one_axes import of_cracks  # noqa: PLC0415 -- a higher layer

        lines = [(self.range, "-", "ΔK_I"), (self.shear_range, "--", "ΔK_II")]
        if threshold or fatigue_limit:
            limit = self.threshold(threshold, fatigue_limit)
            lines.append((limit, ":", "threshold of ΔK_I"))
        return of_cracks(self.depth, lines, ax, units)


def stress_intensity(
    states: Sequence[Any], at: float, depth: ArrayLike, face_friction: float = 0.0
) -> StressIntensity:
    """The cracks of a cycle. ValueError for cracks that are none, before anything is computed."""
    at = arguments.measure("at", at)
    if arguments.real("face_friction", face_friction) != 0.0:
        raise ValueError(
            f"face_friction = {face_friction:g}: closed faces slide without friction here, so that "
            "K_II is that of open ones; leave it out"
        )
    depths = np.atleast_1d(arguments.reals("depth", depth))
    if depths.ndim != 1 or not 0 < depths.size <= MOST_DEPTHS:
        raise ValueError(f"depth has the shape {depths.shape}: give 1 to {MOST_DEPTHS} depths")
    for value in depths.tolist():
        arguments.measure("depth", value)
        if value <= 0.0:
            raise ValueError(
                f"depth = {value:g} is not inside the body: give depths > 0 below the surface"
            )
    if not (np.diff(depths) > 0.0).all():
        raise ValueError("the depths do not ascend: give each once, the smallest first")
    ends = [x for state in states for x in state.tractions.pressure.interval]
    least = LEAST * float(np.spacing(max(abs(at), *(abs(x) for x in ends))))
    if depths[0] < least:
        raise ValueError(
            f"depth = {depths[0]:g} is below what doubles resolve at x = {at:g}: give depths from "
            f"{least:.2g}"
        )
    return StressIntensity(states, at, depths)


@lru_cache(maxsize=1)
def unit_weights() -> tuple[Array, Array]:
    """ξ and W."""
    equation = CauchyEquation((0.0, 1.0), g=0.0, k=regular_kernel, ends=("finite", "singular"))
    problem = equation.problem
    system = System(problem, (NODES,))
    x, response = system.of_values()
    (weight,), (interval,) = problem.weights, problem.maps
    at_tip = jacobi.polynomials(weight, NODES, np.ones(1))[:, 0]
    unit = Part(interval, weight, np.ones(1)).intensities[1] / at_tip[0]
    # B for g = 1 has K = -sqrt(2π) times its intensity, and g is -σ
    return x, math.sqrt(2.0) * unit * (at_tip @ response)


def modes(stress: Callable[[Array], tuple[Array, Array]], depth: Array) -> tuple[Array, Array]:
    """K_I >= 0 and K_II of cracks of these depths, whose faces may touch.

    `stress` gives σ_xx and σ_xy at an array of depths on their line.
    """
    x, W = unit_weights()
    _, middles, A = cells()
    normal, shear = stress(depth[:, None] * np.concatenate((x, middles)))
    scale, n = np.sqrt(np.pi * depth), len(x)
    K = scale * (normal[:, :n] @ W)
    sigma = normal[:, n:].T
    apart = np.linalg.solve(A, sigma)[:-AT_TIP] > 0.0
    for i in np.flatnonzero(~apart.all(axis=0)):
        open_at_tip = opened(A, sigma[:, i])[-1]
        K[i] = EdgeCrack(float(depth[i]), lambda y: stress(y)[0]).mode_1 if open_at_tip else 0.0
    return np.maximum(K, 0.0), scale * (shear[:, :n] @ W)
