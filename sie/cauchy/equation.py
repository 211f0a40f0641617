"""Cauchy singular integral equations as values, refused unless they are well posed.

`solver` solves them. Reference: Muskhelishvili, Singular Integral Equations (1953), §§ 107-115, for
the exponents and the index.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie import arguments
from sie.numerics.interval import EPS
from sie.numerics.jacobi_weight import Weight, weight_of

from .density import JacobiDensity
from .formulation import Condition, Function, Problem
from .interval_map import maps
from .solver import attempt, consistent, solve
from .system import System

Array = NDArray[Any]
Interval = tuple[float, float]

LARGEST_RATIO = 100.0  # of a to b: beyond, exponents next to 0 and ±1 have lost their digits
MOUTH = 1e-14  # of the length: what is left out next to a finite end, where φ varies with ln x


@dataclass(frozen=True)
class CauchyEquation:
    """A Cauchy singular integral equation on one interval or several.

    Parameters
    ----------
    interval : (float, float) or sequence of these
        The two ends, or those of several intervals, ascending and apart.
    g : callable or complex
        The right-hand side: a function of an array x, or a number; real or complex.
    a, b : complex
        Constants, b ≠ 0, |a| at most 100 |b| and a² + b² ≠ 0.
    k : callable, optional
        Regular kernel k(x, t), called with arrays of one shape.
    ends : {"singular", "bounded", "finite"}, pair of these, or a pair for each interval
        Whether φ is infinite or zero at the left and at the right end; "finite" at the end x = 0
        where k is singular, as at the mouth of a crack.
    total : complex or sequence, optional
        Given ∫φ dx: of all intervals together, or one for each interval (None where not given).
    moment : complex or sequence, optional
        Given ∫φ x dx about x = 0, in the same way.
    free : sequence of callable or complex
        Functions u_j whose multiples d_j are unknown too.

    Raises
    ------
    ValueError
        If the equation is not well posed; the message gives the side conditions that the index
        needs.

    Notes
    -----
    The equation is

        a φ(x) + b/π PV∫ φ(t)/(t - x) dt + ∫ k(x, t) φ(t) dt = g(x) + Σ d_j u_j(x)

    The half-plane's conventions, with 1/(x - t) in place of 1/(t - x), are b = -1. The number of
    side conditions must be the index (the sum over the intervals of +1, 0, -1 for two, one, no
    singular ends), plus one for each free function. Without free functions and with the index -1
    the right-hand side must be consistent, which is checked.

    A generalised kernel is singular where x and t both reach an end, like 1/(x + t) at the mouth of
    a crack. Such an end is x = 0 and "finite" (for the index it counts as bounded); the unknown is
    a function of ln x there, and k is called with x and t down to 1e-14 of the length, where the
    interval ends.

    References
    ----------
    Muskhelishvili, Singular Integral Equations (1953), §§ 107-115; Erdogan, Gupta & Cook (1973), on
    generalised kernels § 7.5.

    Examples
    --------
    A slit |x| < 1 under unit pressure, by its dislocation density: φ = x / sqrt(1 - x²), the stress
    intensity is 1/sqrt(2) at each end.

    >>> import sie
    >>> crack = sie.CauchyEquation((-1.0, 1.0), g=1.0, total=0.0)
    >>> solution = crack.solve()
    >>> round(float(solution(0.6)), 12), solution.n
    (0.75, (4,))
    """

    interval: Any
    g: Function
    _: KW_ONLY
    a: complex = 0.0
    b: complex = 1.0
    k: Callable[[Array, Array], Any] | None = None
    ends: Any = "singular"
    total: Any = None
    moment: Any = None
    free: Sequence[Function] = ()

    def __post_init__(self) -> None:
        for name, value in (
            ("interval", self._intervals()),
            ("a", _constant("a", self.a)),
            ("b", _constant("b", self.b)),
        ):
            object.__setattr__(self, name, value)
        if not isinstance(self.free, (Sequence, np.ndarray)) or isinstance(self.free, str):
            raise ValueError(
                f"free = {self.free!r}: give a sequence of functions or numbers, such as (1.0,)"
            )
        object.__setattr__(self, "free", tuple(self.free))
        for function, name in ((self.g, "g"), *((f, "free") for f in self.free)):
            if not callable(function):
                if np.ndim(function):
                    raise ValueError(
                        f"{name} = {function!r} is an array: give a function of an array x, or a "
                        "number"
                    )
                _constant(name, function)
        if self.k is not None and not callable(self.k):
            raise ValueError(
                f"k = {self.k!r} is not a function: give k(x, t), or None for no kernel"
            )
        self._refuse_degenerate()
        object.__setattr__(self, "ends", self._ends())
        self._refuse_finite_ends()
        for name in ("total", "moment"):
            object.__setattr__(self, name, self._given(name))
        self._refuse_miscounted()

    # -- the arguments -----------------------------------------------------------------------------

    def _intervals(self) -> tuple[Interval, ...]:
        arguments.refuse_masked("interval", self.interval)
        try:
            ends = np.array(self.interval, dtype=float)
            ends = (
                ends.reshape(-1, 2)
                if ends.ndim in (1, 2) and ends.shape[-1] == 2
                else np.zeros((0, 2))
            )
        except OverflowError:
            raise ValueError(
                f"interval holds a whole number beyond the range of doubles: {arguments.REMEDY}"
            ) from None
        except (TypeError, ValueError):
            ends = np.zeros((0, 2))
        if not len(ends):
            raise ValueError(
                f"interval = {self.interval!r}: give a pair (x1, x2), or several such pairs"
            )
        out = tuple((float(x1), float(x2)) for x1, x2 in ends)
        for x1, x2 in out:
            if not (np.isfinite(x1) and np.isfinite(x2) and x1 < x2):
                raise ValueError(f"interval ({x1:g}, {x2:g}): give finite ends with x1 < x2")
            if not np.isfinite(x2 - x1):
                raise ValueError(
                    f"interval ({x1:g}, {x2:g}): its length is more than the largest double; "
                    "measure x in larger units"
                )
        for before, after in pairwise(out):
            if before[1] == after[0]:
                raise ValueError(
                    f"the intervals {before} and {after} touch: give them as one, "
                    f"({before[0]:g}, {after[1]:g}), on which φ is one function, or leave a gap"
                )
            if not before[1] < after[0]:
                raise ValueError(
                    f"the intervals {before} and {after} overlap or descend: give them "
                    "apart, from left to right"
                )
        return out

    def _refuse_degenerate(self) -> None:
        if self.b == 0.0:
            raise ValueError(
                "b = 0: without a Cauchy kernel this is a Fredholm equation, for which any "
                "quadrature will do"
            )
        ratio = self.a / self.b  # a² or b² may be more, or less, than the largest double
        if not abs(ratio) <= LARGEST_RATIO:
            raise ValueError(
                f"a = {self.a}, b = {self.b}: next to such an a the Cauchy kernel is but a "
                f"perturbation of a Fredholm equation; give b of at least a/{LARGEST_RATIO:g}"
            )
        if abs(self.b) < np.finfo(float).tiny:
            raise ValueError(
                f"b = {self.b:g} is below the least normal double: "
                "multiply the equation by a large number"
            )
        if abs(ratio * ratio + 1.0) <= 4.0 * EPS:
            raise ValueError(
                f"a = {self.a}, b = {self.b}: a² + b² = 0, no exponents exist; the equation is "
                "not of normal type"
            )

    def _ends(self) -> tuple[tuple[str, str], ...]:
        ends = self.ends.tolist() if isinstance(self.ends, np.ndarray) else self.ends
        n = len(self.interval)
        if isinstance(ends, str) or (
            isinstance(ends, Sequence) and len(ends) == 2 and all(isinstance(e, str) for e in ends)
        ):
            ends = (ends,) * n
        if not isinstance(ends, Sequence) or len(ends) != n:
            given = (
                f"given for {len(ends)} intervals, but there are {n}"
                if isinstance(ends, Sequence)
                else f"{ends!r}"
            )
            raise ValueError(
                f"ends are {given}: give 'singular', 'bounded' or 'finite', or a pair of them, or "
                "such a pair for each interval"
            )
        pairs = tuple((pair, pair) if isinstance(pair, str) else pair for pair in ends)
        for pair in pairs:
            if (
                not isinstance(pair, Sequence)
                or len(pair) != 2
                or any(end not in ("singular", "bounded", "finite") for end in pair)
            ):
                raise ValueError(f"ends = {pair!r}: each end is 'singular', 'bounded' or 'finite'")
        return tuple((left, right) for left, right in pairs)

    def _refuse_finite_ends(self) -> None:
        places = [
            x
            for interval, pair in zip(self.interval, self.ends, strict=True)
            for x, end in zip(interval, pair, strict=True)
            if end == "finite"
        ]
        if places not in ([], [0.0]):
            raise ValueError(
                f"a finite end at x = {places[-1]:g}: there is one at most, and it is x = 0, so "
                "that k has all digits next to it; measure x from there"
            )
        if places and self.k is None:
            raise ValueError(
                "a finite end without k: φ is finite at an end only where k is singular; give k, "
                "or make the end singular or bounded"
            )

    @property
    def _mouths(self) -> tuple[float, float]:
        """What is left out at a finite first and last end; infinite at the others."""
        first, last = self.ends[0][0] == "finite", self.ends[-1][1] == "finite"
        (x1, x2), (x3, x4) = self.interval[0], self.interval[-1]
        return (MOUTH * (x2 - x1) if first else np.inf, MOUTH * (x4 - x3) if last else np.inf)

    def _given(self, name: str) -> tuple[Any, ...] | complex | None:
        value = getattr(self, name)
        if value is None or np.ndim(value) == 0:
            return None if value is None else _constant(name, value)
        values = tuple(None if v is None else _constant(name, v) for v in value)
        if len(values) != len(self.interval):
            raise ValueError(
                f"{name} is given for {len(values)} intervals, but there are "
                f"{len(self.interval)}: None where it is not given"
            )
        return values

    def _refuse_miscounted(self) -> None:
        needed, given = self.index + len(self.free), len(self._conditions)
        if given == needed or (needed < 0 and given == 0):
            return
        free = f" and {len(self.free)} free function(s)" if self.free else ""
        raise ValueError(
            f"index {self.index}{free} needs {max(needed, 0)} side condition(s), but {given} "
            "given: give as many of total and moment, or make other ends bounded or singular, or "
            "free a constant of g"
        )

    @cached_property
    def weights(self) -> tuple[Weight, ...]:
        """The weight (1-s)^alpha (1+s)^beta of each interval, with its index."""
        found = [
            weight_of(complex(self.a), complex(self.b), (e[0] != "singular", e[1] != "singular"))
            for e in self.ends
        ]
        for weight, pair in zip(found, self.ends, strict=True):
            if weight is None:
                raise ValueError(
                    f"ends = {pair!r}: with a = {self.a}, b = {self.b} the exponents are "
                    "imaginary: make both ends bounded"
                )
        return tuple(w for w in found if w is not None)

    @property
    def index(self) -> int:
        """The index: the number of side conditions without free functions."""
        return sum(weight.kappa for weight in self.weights)

    @property
    def exponents(self) -> tuple[tuple[Any, Any], ...]:
        """The exponents of the distance from the left and the right end of each interval."""
        return tuple((weight.beta, weight.alpha) for weight in self.weights)

    @cached_property
    def _conditions(self) -> tuple[Condition, ...]:
        found = []
        for power, name in enumerate(("total", "moment")):
            value = getattr(self, name)
            if isinstance(value, tuple):
                found += [Condition(power, (i,), v) for i, v in enumerate(value) if v is not None]
            elif value is not None:
                found.append(Condition(power, tuple(range(len(self.interval))), value))
        return tuple(found)

    # -- the solution ------------------------------------------------------------------------------

    @cached_property
    def problem(self) -> Problem:
        """The equation on its maps, with weights and conditions, as the solver takes it."""
        return Problem(
            maps(self.interval, self.weights, self._mouths),
            self.weights,
            self.a,
            self.b,
            self.g,
            self.k,
            self._conditions,
            tuple(self.free),
            any("finite" in pair for pair in self.ends),
        )

    def solve(self, tol: float = 1e-13, n: int | None = None) -> JacobiDensity:
        """The density that solves the equation.

        Parameters
        ----------
        tol : float
            Relative tolerance: there are as many nodes as the coefficients need for it.
        n : int, optional
            Nodes on each interval, whatever the tolerance.

        Returns
        -------
        JacobiDensity
            The solution φ.

        Raises
        ------
        ValueError
            If `tol` or `n` is out of range, or a function returns what is no number.
        ContactError
            If `tol` is not met, g is not consistent with the ends, or the homogeneous equation has
            solutions of its own; `reached["density"]` is the best density.

        Notes
        -----
        k is called once for each number of nodes, which grows by half until the density is
        resolved: all calls together ask for about twice the values of the last one. No x is a t.
        """
        tol = arguments.tolerance(tol)
        if n is not None:
            return consistent(attempt(self.problem, (_size(n),) * len(self.interval)))
        return solve(self.problem, tol)

    def system(self, n: int) -> tuple[Array, Array]:
        """The square system that is solved.

        Parameters
        ----------
        n : int
            Nodes on each interval.

        Returns
        -------
        matrix : ndarray, shape (N, N)
        rhs : ndarray, shape (N,)
        """
        system = System(self.problem, (_size(n),) * len(self.interval))
        return system.matrix, system.rhs


def _constant(name: str, value: Any) -> complex:
    """A finite number: a float where it is real."""
    if isinstance(value, (complex, np.complexfloating)):
        arguments.finite(f"{name}.real", value.real)
        arguments.finite(f"{name}.imag", value.imag)
        return complex(value) if value.imag else float(value.real)
    return arguments.finite(name, value)


def _size(n: Any) -> int:
    if isinstance(n, bool) or not isinstance(n, (int, np.integer)) or n < 2:
        raise ValueError(f"n = {n!r} is not a number of nodes: give an integer >= 2")
    return int(n)
