"""Stress histories of a cycle of loading, slip on the surface, and parameters of fretting damage.

A cycle is a sequence of states, one Solution after each step of the load.

    slip amplitude     δ(x) = (max s - min s)/2 over the cycle
    Ruiz (1984)        κ1 = max|q| δ, friction work, for wear
                       κ2 = max σ_xx max|q| δ, for the start of cracks
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.arguments import abridged
from sie.errors import ContactError
from sie.files import table_of_rows

from . import fatigue
from .fatigue import CriticalPlane

if TYPE_CHECKING:
    from sie.cracks.stress_intensity import StressIntensity

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Range:
    """The extremes of a quantity over a cycle, at points.

    lowest     the smallest value, of the shape of the points
    highest    the largest value

    Where both are infinite, at a sharp edge, the range is infinite too.
    """

    lowest: Array
    highest: Array

    @property
    def range(self) -> Array:
        """highest - lowest."""
        infinite = np.isinf(self.lowest)
        return np.where(infinite, np.inf, self.highest - np.where(infinite, 0.0, self.lowest))

    @property
    def amplitude(self) -> Array:
        """Half of the range."""
        return 0.5 * self.range


@dataclass(frozen=True, eq=False, repr=False)
class Cycle:
    """A cycle of loading: the solutions after each of its steps, the last of which closes it.

    Parameters
    ----------
    states : sequence of Solution
        At least two; `Cycle(follow(scene, path))`, or a part of that.

    Raises
    ------
    ValueError
        For fewer than two states.

    Notes
    -----
    Loads between two states are not examined. Inside the body and in slip zones a stress may be
    largest there: follow `path.subdivided(8)`.

    References
    ----------
    Ruiz, Boddington & Chen, Exp. Mech. 24 (1984) 208-217; Hills & Nowell, Mechanics of Fretting
    Fatigue (1994), ch. 7.

    Examples
    --------
    >>> import sie
    >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0, friction=0.5)
    >>> cycle = sie.Cycle(sie.follow(scene, sie.Path([(1.0, 0.3), (1.0, -0.3), (1.0, 0.3)])))
    >>> bool(cycle.friction_work(1.1) > cycle.friction_work(0.0) == 0.0)
    True
    """

    states: Sequence[Any]

    def __post_init__(self) -> None:
        remedy = "the solutions at two or more steps of the load"
        states = arguments.listed("states", self.states, remedy)
        if len(states) < 2:
            raise ValueError(f"{len(states)} states make no cycle: give {remedy}")
        for state in states:
            if not callable(getattr(state, "stress", None)):
                raise ValueError(f"{state!r} is not a solution: give {remedy}")
        object.__setattr__(self, "states", states)  # a generator gives them once only

    def __repr__(self) -> str:
        return f"Cycle([{abridged(self.states)}])"

    @cached_property
    def size(self) -> int:
        """The number of states."""
        return len(self.states)

    def history(self, x: ArrayLike, y: ArrayLike) -> Array:
        """The stress tensors at points after every step, as codes for critical planes take them.

        Parameters
        ----------
        x, y : array_like of float
            Positions and depths, length, broadcast against each other.

        Returns
        -------
        ndarray of float
            Stresses of shape (steps, ..., 3, 3), with the axes x, y (depth) and z out of the
            plane.

        Raises
        ------
        ValueError
            If Poisson's ratio, which σ_zz needs, is not given.
        """
        stresses = [state.stress(x, y) for state in self.states]
        out = np.zeros((self.size, *stresses[0].xx.shape, 3, 3))
        for tensor, s in zip(out, stresses, strict=True):
            tensor[..., 0, 0], tensor[..., 1, 1], tensor[..., 2, 2] = s.xx, s.yy, s.zz
            tensor[..., 0, 1] = tensor[..., 1, 0] = s.xy
        return out

    def table(self) -> Any:
        """The loads, the contact and the stick zone at each turning point, as a table.

        Returns
        -------
        pandas.DataFrame or list of dict
            A row for each state with the columns P, Q, sigma, x1, x2, stick_from, stick_to and,
            where it is known, energy_lost. A DataFrame where pandas is installed. Of several stick
            zones the outermost ends are given; in full sliding there are none.
        """
        return table_of_rows([_row(state) for state in self.states])

    def range(self, x: ArrayLike, y: ArrayLike) -> dict[str, Range]:
        """Lowest and highest stress components at points over the cycle.

        Parameters
        ----------
        x, y : array_like of float
            As of `history`.

        Returns
        -------
        dict of str to Range
            For "xx", "yy", "xy", and "zz" where Poisson's ratio is known.
        """
        stresses = [state.stress(x, y) for state in self.states]
        names = ("xx", "yy", "xy", *["zz"] * all(s.knows_zz for s in stresses))
        values = ((name, np.stack([getattr(s, name) for s in stresses])) for name in names)
        return {name: Range(v.min(axis=0), v.max(axis=0)) for name, v in values}

    def stress_intensity(
        self, at: float, depth: ArrayLike, face_friction: float = 0.0
    ) -> StressIntensity:
        """K_I and K_II of cracks normal to the surface, at each turning point and depth.

        Parameters
        ----------
        at : float
            Position of the mouth of the crack on the surface, length.
        depth : array_like of float
            Depths of the tip, ascending, length.
        face_friction : float, optional
            Only 0: the faces of a closed crack slide freely.

        Returns
        -------
        StressIntensity
            `.mode_1` and `.mode_2`, arrays of shape (turning points, depths), `.range`, `.table()`,
            `.plot()`, `.arrest(threshold, fatigue_limit)` and `.check()`.

        Raises
        ------
        ValueError
            For depths that do not ascend, are not below the surface or too small for doubles, and
            for friction on the faces.

        Examples
        --------
        >>> import sie
        >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0, friction=0.3)
        >>> cycle = sie.steady_cycle(scene, (1.0, 0.15), (1.0, -0.15)).cycle
        >>> K = cycle.stress_intensity(at=-cycle.states[0].pressure.interval[1], depth=[0.01, 0.1])
        >>> K.mode_1.shape, K.range.shape
        ((2, 2), (2,))
        """
        from sie.cracks.stress_intensity import stress_intensity  # noqa: PLC0415 -- SciPy's parts

        return stress_intensity(self.states, at, depth, face_friction)

    def slip_range(self, x: ArrayLike) -> Range:
        """Lowest and highest slip on the surface over the cycle.

        Parameters
        ----------
        x : array_like of float
            Positions on the surface where the slip of all states is known, length.

        Returns
        -------
        Range
            Its `amplitude` is δ(x), length.
        """
        slip = np.stack([np.asarray(state.slip(x)) for state in self.states])
        return Range(slip.min(axis=0), slip.max(axis=0))

    def friction_work(self, x: ArrayLike) -> Array:
        """Ruiz' first parameter κ1 = max|q| δ: where the surface wears.

        Parameters
        ----------
        x : array_like of float
            Positions as of `slip_range`.

        Returns
        -------
        ndarray of float
            Work per area, same shape as x; 0 where nothing slips, at a sharp edge too.
        """
        q = np.stack([np.abs(state.shear(x)) for state in self.states]).max(axis=0)
        return _product(q, self.slip_range(x).amplitude)

    def ruiz(self, x: ArrayLike) -> Array:
        """Ruiz' second parameter κ2 = max(σ_xx) max|q| δ: where cracks begin.

        Parameters
        ----------
        x : array_like of float
            Positions on the surface where the slip and the tension of all states are known.

        Returns
        -------
        ndarray of float
            Stress times work per area, same shape as x; 0 where the surface is never in tension.
        """
        tension = np.stack([state.stress(x, 0.0).xx for state in self.states]).max(axis=0)
        return _product(np.maximum(tension, 0.0), self.friction_work(x))

    def swt(self, x: ArrayLike | None = None, y: ArrayLike = 0.0) -> CriticalPlane:
        """The parameter of Smith, Watson and Topper: max over planes of σ_n,max Δε_n/2.

        Parameters
        ----------
        x, y : array_like of float, optional
            Positions and depths, length. Without x, the worst place at each depth.

        Returns
        -------
        CriticalPlane
            The value, stress, and the plane; 0 where no plane is ever in tension.

        Raises
        ------
        ValueError
            If the body is not given by young and poisson.
        ContactError
            At a sharp edge on the surface, where the stress is infinite: ask at a depth.

        Notes
        -----
        All planes are compared, on a grid of 3 by 6 degrees that is refined around its highest
        values: to rounding nearly always, and in one of 5000 random histories too small by 1e-4 to
        1e-3. In plane strain a fully reversed σ_xx = ±S gives
        S² (1 - ν²)/E.

        References
        ----------
        Smith, Watson & Topper, J. Materials 5 (1970) 767-778.

        Examples
        --------
        >>> import sie
        >>> ti = sie.Elastic(115e3, 0.32)
        >>> scene = sie.Scene(profile=sie.Parabola(100.0), body=ti, normal_load=50, friction=0.5)
        >>> worst = sie.steady_cycle(scene, (50.0, 15.0, 30.0), (50.0, -15.0, -30.0)).cycle.swt()
        >>> round(float(worst.value), 3), round(float(worst.x), 4), float(worst.y)
        (0.098, -0.3152, 0.0)
        """
        return fatigue.at_points(self.states, fatigue.smith_watson_topper(self.states), x, y)

    def findley(self, x: ArrayLike | None = None, y: ArrayLike = 0.0, *, k: float) -> CriticalPlane:
        """Findley's parameter: max over planes of τ_a + k σ_n,max.

        Parameters
        ----------
        x, y : array_like of float, optional
            As of `swt`.
        k : float
            Weight of the normal stress, about 0.2 to 0.3 for ductile metals.

        Returns
        -------
        CriticalPlane
            The value, stress, and the plane.

        Raises
        ------
        ValueError
            If Poisson's ratio is not given, or k is negative.
        ContactError
            As of `swt`.

        Notes
        -----
        τ_a is half the longest chord of the path of the shear on a plane: half its range where the
        normal lies in the x-y plane. The accuracy is that of `swt`. A fully reversed σ_xx = ±S
        gives S [k + √(1 + k²)]/2.

        References
        ----------
        Findley, J. Eng. Ind. 81 (1959) 301-306.
        """
        return fatigue.at_points(self.states, fatigue.findley(k), x, y)

    def fatemi_socie(
        self, x: ArrayLike | None = None, y: ArrayLike = 0.0, *, k: float, yield_stress: float
    ) -> CriticalPlane:
        """The parameter of Fatemi and Socie: max over planes of γ_a (1 + k σ_n,max/σ_y).

        Parameters
        ----------
        x, y : array_like of float, optional
            As of `swt`.
        k : float
            Weight of the normal stress, about 0.3 to 1.
        yield_stress : float
            σ_y, stress.

        Returns
        -------
        CriticalPlane
            The value, a strain, and the plane.

        Raises
        ------
        ValueError
            If the body is not given by young and poisson, k is negative, or σ_y not positive.
        ContactError
            As of `swt`.

        Notes
        -----
        γ_a = τ_a/μ is the amplitude of the engineering shear strain, τ_a and the accuracy as of
        `findley`.

        References
        ----------
        Fatemi & Socie, Fatigue Fract. Eng. Mater. Struct. 11 (1988) 149-165.
        """
        criterion = fatigue.fatemi_socie(self.states, k, yield_stress)
        return fatigue.at_points(self.states, criterion, x, y)


def _product(a: Array, b: Array) -> Array:
    """a × b, 0 where b is 0 even if a is infinite."""
    return np.asarray(np.where(b == 0.0, 0.0, a) * b)


def _row(state: Any) -> dict[str, float]:
    """The loads, the contact and the stick zone of a state."""
    row = {"P": state.normal_load, "Q": state.tangential_load, "sigma": state.tractions.bulk_stress}
    row |= dict(zip(("x1", "x2"), state.pressure.interval, strict=True))
    if state.stick:
        row |= {"stick_from": state.stick[0][0], "stick_to": state.stick[-1][1]}
    with suppress(ContactError, AttributeError):  # of a steady state only the cycle's is known
        row["energy_lost"] = state.energy_lost
    return row
