"""The derivative of a profile by each of its parameters, which is a profile itself.

A slope h' is linear in most parameters, and every answer to first order in a change of h': a
direction is the profile dh/d(parameter), such as -x²/(2 R²) of a parabola of radius R. It presses
on nothing by itself; the answers use its slope and its height alone.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial, singledispatch
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.errors import ContactError
from sie.inheritance import override
from sie.numerics.zones import united
from sie.profiles.base import Composite, Placed, Profile
from sie.profiles.from_function import FromFunction
from sie.profiles.indenter import of_any_x
from sie.profiles.polynomials import Piecewise, Polynomial
from sie.profiles.row import Periodic, Row
from sie.profiles.sampled import Sampled
from sie.profiles.shapes import Flat, Parabola, Power, RoundedFlat, Wedge
from sie.profiles.slope import Slope

Array = NDArray[np.float64]
Directions = dict[str, Callable[[], Profile]]
INF = float("inf")


def _monomial(k: int) -> Profile:
    """x^k, of which a straight line is no polynomial that touches anything."""
    if k > 1:
        return Polynomial((0.0,) * k + (1.0,))
    return Piecewise((-INF, INF), [(float(k),)]).raised(1.0 - k)


LIFT: Callable[[], Profile] = partial(_monomial, 0)


@singledispatch
def directions(profile: Profile) -> Directions:
    """The parameters of a profile by name, each with what makes its direction."""
    return {}


@directions.register
def _(profile: Parabola) -> Directions:
    return {"radius": lambda: Polynomial((0.0, 0.0, -0.5 / profile.radius**2))}


@directions.register
def _(profile: RoundedFlat) -> Directions:
    a, R = profile.half_flat, profile.radius
    arcs = [(-a / R**2, -1.0 / R**2), (0.0,), (a / R**2, -1.0 / R**2)]
    return {
        "half_flat": lambda: Piecewise((-a, a), [(1.0 / R,), (0.0,), (-1.0 / R,)]),
        "radius": lambda: Piecewise((-a, a), arcs),
    }


@directions.register
def _(profile: Flat) -> Directions:
    def refused() -> Profile:
        raise ContactError(
            "the pressure at a corner is infinite, and moving the corner has no derivative there: "
            "scale the lengths, all answers follow from half_width = 1"
        )

    return {"half_width": refused}


@directions.register
def _(profile: Wedge) -> Directions:
    return {"slope": lambda: Piecewise((0.0,), [(-1.0,), (1.0,)])}


@directions.register
def _(profile: Power) -> Directions:
    m, A = profile.exponent, profile.coefficient

    def by_exponent(x: Array) -> Array:
        y = np.where(x == 0.0, 1.0, np.abs(x))
        rise = A * y ** (m - 1.0) * (1.0 + m * np.log(y))
        return np.where(x == 0.0, 0.0, np.sign(x) * rise)

    return {
        "coefficient": lambda: Power(m, 1.0),
        "exponent": lambda: FromFunction(by_exponent, breaks=(0.0,)),
    }


@directions.register
def _(profile: Polynomial) -> Directions:
    count = len(profile.coefficients)
    return {f"coefficients[{k}]": partial(_monomial, k) for k in range(count)}


@directions.register
def _(profile: Piecewise) -> Directions:
    def one(k: int, j: int) -> Profile:
        pieces: list[tuple[float, ...]] = [(0.0,)] * len(profile.coefficients)
        pieces[k] = (0.0,) * j + (1.0,)
        return Piecewise(profile.ends, pieces)

    rows = enumerate(profile.coefficients)
    return {f"pieces[{k}][{j}]": partial(one, k, j) for k, row in rows for j in range(len(row))}


@directions.register
def _(profile: Sampled) -> Directions:
    def one(k: int) -> Profile:
        return Sampled(profile.points, np.eye(1, len(profile.points), k)[0], profile.lam)

    return {f"heights[{k}]": partial(one, k) for k in range(len(profile.points))}


@directions.register
def _(profile: Composite) -> Directions:
    alone, found = len(profile.parts) == 1, {}
    for k, part in enumerate(profile.parts):
        own = {
            name: partial(_placed, part, make) for name, make in directions(part.profile).items()
        }
        for name, make in (own | {"rise": LIFT}).items():
            found[name if alone else f"parts[{k}].{name}"] = make
    return found


def _placed(part: Placed, make: Callable[[], Profile]) -> Profile:
    """The direction of a part where it stands."""
    return (make() if part.sign > 0.0 else make().mirrored()).shifted(part.shift)


@directions.register
def _(profile: Row) -> Directions:
    return {
        f"profiles[{k}].{name}": lambda k=k, make=make: OfOne(profile, k, make())  # type: ignore[misc]
        for k, one in enumerate(profile.profiles)
        for name, make in ({"rise": LIFT} | directions(one)).items()
    }


@directions.register
def _(profile: Periodic) -> Directions:
    def repeated(make: Callable[[], Profile]) -> Profile:
        if profile.repeated is not profile.profile:
            raise ContactError(
                "the ends of a period are joined by other profiles than the given one, whose "
                "derivative is not known: give the profile on one period, equally high at its ends"
            )
        return Periodic(make() + Piecewise(profile.pieces.domain, [(0.0,)]), profile.repeats)

    return {name: partial(repeated, make) for name, make in directions(profile.profile).items()}


@dataclass(frozen=True)
class OfOne(Profile):
    """The direction of one indenter of a row: 0 where it is not the lowest."""

    row: Row
    number: int
    direction: Profile

    @cached_property
    def pieces(self) -> Slope:
        """H of the direction where that indenter is the lowest."""
        ends = [run[0] for run in self.row.lowest] + [self.row.lowest[-1][1]]
        masks = [(1.0 if k == self.number else 0.0,) for _, _, k in self.row.lowest]
        slope = self.direction.pieces
        if slope.functions:
            raise ContactError(
                "the derivative by a parameter of a function in a row is not known: give that "
                "indenter as a polynomial, a piecewise profile or a trace"
            )
        both = slope + Piecewise(ends, [(0.0,)] * len(masks)).pieces
        middle = both.breaks[:-1] + 0.5 * np.diff(np.clip(both.breaks, -1e300, 1e300))
        run = np.clip(np.searchsorted(ends, middle) - 1, 0, len(masks) - 1)
        kept = np.array(masks)[run]
        return Slope(both.breaks, both.origins, both.coefficients * kept)

    @of_any_x
    @override
    def height(self, x: ArrayLike) -> Array:
        x = np.asarray(x, dtype=float)
        starts = np.array([lo for lo, _, _ in self.row.lowest[1:]])
        which = np.array([k for _, _, k in self.row.lowest])[np.searchsorted(starts, x, "right")]
        return np.where(which == self.number, self.direction.height(x), 0.0)

    @property
    def walls(self) -> tuple[tuple[float, float], ...]:
        """Those of the row, and the places where it jumps from another indenter to this one."""
        runs = pairwise(self.row.lowest)
        jumps = [
            (x, x) for (_, x, k), (_, _, j) in runs if self.number in (k, j) and min(k, j) >= 0
        ]
        return united((*self.row.walls, *jumps))
