"""An indenter given by its slope: a Python function, or a formula as text."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie import arguments
from sie.inheritance import override

from .base import Profile, function_slope
from .expression import Expression
from .functions import Vectorised
from .indenter import Parity
from .slope import Slope

Array = NDArray[np.float64]
INF = float("inf")
# Points where the function is tried, as fractions of a part of the domain; no round numbers.
TRIALS = np.array([0.13, 0.29, 0.5, 0.61, 0.83])
EVEN = 1e-12  # |h'(x) + h'(-x)| of a symmetric profile, relative


@dataclass(frozen=True, init=False, repr=False)
class FromFunction(Profile):
    """A profile by its slope h'(x), as a Python function or as a formula.

    Parameters
    ----------
    slope : callable or str
        h' at an array of x, same shape as x; or a formula in x with NumPy's names, like
        "0.1*sinh(x/2)".
    breaks : sequence of float, default ()
        Lengths where h' or a derivative of it jumps or is not smooth. Breaks that are not declared
        are located by bisection, which takes longer.
    domain : (float, float), default (-inf, inf)
        Ends of the indenter, lengths. A contact that reaches an end is sharp there.
    parity : {"none", "even"}, default "none"
        "even" if h(-x) = h(x), which halves the work.

    Raises
    ------
    ValueError
        If the function does not return finite real numbers of its argument's shape, or the
        breaks, the domain or the parity do not fit it.

    Notes
    -----
    h is 0 at x = 0, or at the end of the domain that is nearest to it. The solver uses the
    function's values at some points. The polynomials that resolve it are compared with it at 2584
    points of the contact, which depend on the edges; a jump, a kink, a cusp or a narrow feature
    that the comparison shows is resolved like a declared one. Sampling cannot detect a feature
    narrower than 5e-4 of the contact (a bump, a dent, two jumps, nan), except for one kink or jump
    beside an edge, down to 1e-12 of the contact from it. Nor can it detect one below 32 ulp of the
    largest slope or 8 times the roughness of the function's own rounding. The place of a jump is
    known to one ulp of x. Declare breaks around such places.

    Beside the contact a second valley of h is found if it is wider, at half of its depth, than 1 %
    of its distance from the middle of the contact; the certificate looks eight times as closely. A
    break in a narrower valley shows it.

    Examples
    --------
    >>> FromFunction("0.5*sinh(x)", parity="even").axis
    0.0
    >>> FromFunction(np.sinh, domain=(-3.0, 3.0)).domain
    (-3.0, 3.0)
    """

    function: Vectorised
    declared: tuple[float, ...]
    ends: tuple[float, float]
    symmetric: bool

    def __init__(
        self,
        slope: Vectorised | str,
        breaks: Sequence[float] = (),
        domain: tuple[float, float] = (-INF, INF),
        parity: Parity = "none",
    ) -> None:
        function = Expression(slope) if isinstance(slope, str) else slope
        if not callable(function):
            raise ValueError(
                f"slope = {slope!r} is not a function: "
                "give a function of an array, or an expression in x as text"
            )
        ends = _ends(domain)
        if not arguments.among(parity, ("even", "none")):
            raise ValueError(f"parity = {parity!r} is neither 'even' nor 'none'")
        object.__setattr__(self, "function", function)
        object.__setattr__(self, "declared", _inner(breaks, ends))
        object.__setattr__(self, "ends", ends)
        object.__setattr__(self, "symmetric", parity == "even")
        self._try_out()

    def _try_out(self) -> None:
        """Refuse a function whose values at a few points show that it cannot be a slope."""
        lo, hi = self.ends
        if math.isfinite(lo) != math.isfinite(hi):  # one unit of length next to the end
            lo, hi = (lo, lo + 1.0) if math.isfinite(lo) else (hi - 1.0, hi)
        elif not math.isfinite(hi - lo):
            lo, hi = -1.0, 1.0
        x = lo + (hi - lo) * TRIALS
        with np.errstate(all="ignore"):
            values = arguments.real_values("slope", self.function, x)
            arguments.real_values("slope", self.function, x[:, None])
        if not np.isfinite(values).all():
            bad = int(np.argmin(np.isfinite(values)))
            raise ValueError(
                f"slope is {values[bad]} at x = {x[bad]:.6g}: it must be finite, narrow the domain"
            )
        if self.symmetric:
            self._refuse_asymmetry(x, values)

    def _refuse_asymmetry(self, x: Array, values: Array) -> None:
        if self.ends[0] != -self.ends[1] or set(self.declared) != {-b for b in self.declared}:
            raise ValueError(
                f"parity 'even' with domain {self.ends} and breaks {self.declared}: "
                "make them symmetric about 0 or drop the parity"
            )
        largest = float(np.abs(values).max())
        mirrored = np.asarray(self.function(-x))
        if not np.allclose(mirrored, -values, rtol=EVEN, atol=EVEN * largest):
            raise ValueError("parity 'even' but slope(-x) is not -slope(x): drop the parity")

    def __repr__(self) -> str:
        f = self.function
        name = repr(f.text) if isinstance(f, Expression) else getattr(f, "__qualname__", repr(f))
        parity = ", parity='even'" if self.symmetric else ""
        return f"FromFunction(slope={name}, breaks={self.declared!r}, domain={self.ends!r}{parity})"

    @cached_property
    def pieces(self) -> Slope:
        """H = slope(x) on its declared breaks, resolved when a contact is known."""
        return function_slope((self.ends[0], *self.declared, self.ends[1]), self.function)

    @property
    @override
    def axis(self) -> float | None:
        return 0.0 if self.symmetric else None


def _ends(domain: tuple[float, float]) -> tuple[float, float]:
    pair = arguments.listed("domain", domain, "(lo, hi)")
    if len(pair) != 2:
        raise ValueError(f"domain = {domain!r} is not a pair: give (lo, hi)")
    lo, hi = (arguments.real("domain", end) for end in pair)
    if not lo < hi:
        raise ValueError(f"domain = ({lo:g}, {hi:g}) is empty: give lo < hi")
    for end in (lo, hi):
        if math.isfinite(end):
            arguments.measure("domain", end)
    if math.isfinite(hi - lo):
        arguments.positive("the length of the domain", hi - lo)
    return lo, hi


def _inner(breaks: Sequence[float], ends: tuple[float, float]) -> tuple[float, ...]:
    """The declared breaks between the ends, ascending."""
    lo, hi = ends
    given = arguments.listed("breaks", breaks, "the places where h' is not smooth")
    inner = sorted({arguments.measure("breaks", b) for b in given})
    for b in inner:
        if not lo <= b <= hi:
            raise ValueError(
                f"break {b:g} is outside the domain ({lo:g}, {hi:g}): "
                "leave it out or widen the domain"
            )
    return tuple(b for b in inner if lo < b < hi)
