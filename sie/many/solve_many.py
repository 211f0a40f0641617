"""Many contacts at once: numbers as arrays, answers as arrays.

Scenes go through the families of their profile (`choice`) in chunks that stay in the processor's
cache. What no family answers (several patches, traces, an edge that reaches an end, slip to either
side) is solved one by one, and what that refuses keeps its reason.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.errors import ContactError
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.from_function import FromFunction
from sie.solution import Solution, solve

from .choice import families
from .families import Contact, Family
from .loads import Loads, one_signed, regular, sign, slips
from .smooth import Smooth

Array = NDArray[np.float64]

CHUNK = 4096  # scenes, whose arrays stay in the cache
VALUES = 1 << 14  # of a pressure that are evaluated together
ALONE = -1  # the family of what is solved one by one
ZOOMS, PLACES = 12, 9  # of the search for a peak, after a first look at FIRST places
FIRST = 65
LEFT_OPEN = "not solved as an array"


def solve_many(
    profile: Profile | Callable[..., Any],
    *,
    modulus: ArrayLike,
    normal_load: ArrayLike | None = None,
    half_width: ArrayLike | None = None,
    tilt: ArrayLike = 0.0,
    friction: ArrayLike = 0.0,
    tangential_load: ArrayLike = 0.0,
    bulk_stress: ArrayLike = 0.0,
    parameters: Mapping[str, ArrayLike] | None = None,
) -> Many:
    """Many scenes of similar bodies, solved as arrays; all numbers are broadcast.

    Parameters
    ----------
    profile : Profile or callable
        A profile, whose parameters may be arrays: Parabola, RoundedFlat, Flat, Wedge, and the
        coefficient of Power. Or a slope h'(x, ...), a function of arrays and named parameters.
    modulus : array_like of float
        E*, stress.
    normal_load, half_width : array_like of float
        P, force per length, or the half-width of the contact, length: exactly one of them.
    tilt, friction, tangential_load, bulk_stress : array_like of float, optional
        As of `Scene`.
    parameters : mapping of str to array_like, optional
        Those of a function, by name; it gets them in a shape that is broadcast against x.

    Returns
    -------
    Many
        Arrays of the broadcast shape; a scene without an answer is nan there, and its reason in
        `refused`.

    Raises
    ------
    ValueError
        If the numbers have no common shape, or both or neither of P and half-width are given. A
        number that makes no scene is refused in its own place, and not raised.

    Notes
    -----
    Symmetric profiles with a formula take some tenths of a microsecond each, a rounded flat under a
    tilt a few, a smooth slope some tens; others take what `solve` takes. The slope is resolved by
    its values at 24 to 192 places, and compared with its series at others, and has to rise as far
    as is looked: features between those places are not looked for, as `solve` does.

    Examples
    --------
    >>> import numpy as np
    >>> import sie
    >>> punches = sie.RoundedFlat(half_flat=np.array([0.5, 1.0]), radius=1.0)
    >>> many = sie.solve_many(punches, modulus=1.0, normal_load=1.0)
    >>> many.half_width.round(6)
    array([1.482937, 1.8859  ])
    """
    given = {
        "modulus": modulus,
        "normal_load": normal_load,
        "half_width": half_width,
        "tilt": tilt,
        "friction": friction,
        "tangential_load": tangential_load,
        "bulk_stress": bulk_stress,
    }
    if (normal_load is None) == (half_width is None):
        raise ValueError("give exactly one of normal_load and half_width")
    numbers = {k: arguments.reals(k, v) for k, v in given.items() if v is not None}
    values = {k: arguments.reals(k, v) for k, v in (parameters or {}).items()}
    if not isinstance(profile, Profile) and not callable(profile):
        raise ValueError(f"profile = {profile!r} is neither a profile nor a slope as a function")
    own = profile.arrays if isinstance(profile, Profile) else ()
    every = (*numbers.values(), *values.values(), *own)
    try:
        shape = np.broadcast_shapes(*map(np.shape, every))
    except ValueError:
        raise ValueError(
            "the numbers have no common shape: give arrays that NumPy broadcasts, such as "
            "a[:, None] and b[None, :]"
        ) from None
    flat = {k: np.broadcast_to(v, shape).ravel() for k, v in numbers.items()}
    loads = Loads(*(flat.get(name) for name in Loads._fields))  # type: ignore[arg-type]
    columns = {k: np.broadcast_to(v, shape).ravel() for k, v in values.items()}
    return Many(Question(profile, columns, shape, loads))


@dataclass(frozen=True, eq=False)
class Question:
    """A profile or a slope, its parameters, the shape of the answers, and the loads.

    `alone`: whether what no family answers is solved one by one, or left open.
    """

    profile: Any
    parameters: dict[str, Array]
    shape: tuple[int, ...]
    loads: Loads
    alone: bool = True

    @property
    def size(self) -> int:
        """The number of scenes."""
        return math.prod(self.shape)

    @cached_property
    def families(self) -> tuple[Family, ...]:
        """The families of the profile, in the order in which they are asked."""
        if isinstance(self.profile, Profile):
            return families(self.profile, self.shape)
        return (Smooth(self.profile, self.parameters),)

    def scene(self, k: int) -> Scene:
        """One of the scenes."""
        given = self.loads._asdict().items()
        loads: dict[str, Any] = {name: float(v[k]) for name, v in given if v is not None}
        return Scene(profile=self.one_profile(k), **loads)

    def one_profile(self, k: int) -> Profile:
        """The profile of one scene."""
        if not isinstance(self.profile, Profile):
            return FromFunction(
                partial(self.profile, **{n: v[k] for n, v in self.parameters.items()})
            )
        if not self.profile.arrays:
            return self.profile
        values = {
            f.name: float(np.broadcast_to(getattr(self.profile, f.name), self.shape).ravel()[k])
            for f in fields(self.profile)  # type: ignore[arg-type]
        }
        return type(self.profile)(*values.values())


class Many:
    """The contacts of many scenes; `solve_many` makes it.

    Attributes
    ----------
    shape : tuple of int
        That of the answers.
    refused : ndarray of str
        Why a scene has no answer, "" where it has one; its numbers are nan.
    half_width, centre, normal_load, moment, tilt : ndarray of float
        As of `Solution`.
    """

    def __init__(self, question: Question) -> None:
        self._question = question
        self.shape = question.shape
        n = question.size
        self._family = np.full(n, ALONE, dtype=np.int8)
        self._found = Contact(*(np.full(n, np.nan) for _ in range(4)))
        self._alone: dict[int, Solution] = {}
        reasons = np.full(n, "", dtype=object)
        for some in _chunks(np.arange(n), CHUNK):
            self._solve(some)
            left = some[np.isnan(self._found.r[some])]
            if not question.alone:
                reasons[left] = LEFT_OPEN
                continue
            for k in left.tolist():
                try:
                    self._answer(k)
                except (ContactError, ValueError) as problem:
                    reasons[k] = str(problem)
        self.refused = reasons.reshape(self.shape)
        G = 0.5 * question.loads.modulus
        self.half_width, self.centre = self._shaped(self._found.r), self._shaped(self._found.m)
        self.normal_load = self._shaped(G * self._found.T)
        self.moment = self._shaped(G * (self._found.m * self._found.T + self._found.about))
        self.tilt = self._shaped(np.where(np.isnan(self._found.r), np.nan, question.loads.tilt))

    def __repr__(self) -> str:
        refused = int((self.refused != "").sum())
        return f"Many(scenes of shape {self.shape}{f', {refused} refused' if refused else ''})"

    def _shaped(self, values: Array) -> Array:
        return values.reshape(self.shape + values.shape[1:])

    def _solve(self, some: NDArray[np.int64]) -> None:
        """Let the families answer scenes, one after the other."""
        q = self._question
        loads = q.loads.of(some)
        with np.errstate(all="ignore"):
            good_numbers = regular(loads)
            for number, family in enumerate(q.families):
                open_ = good_numbers & np.isnan(self._found.r[some])
                open_ &= family.takes(loads.tilt, loads.half_width is not None)
                if not open_.any():
                    continue
                at, of = some[open_], loads.of(open_)
                G, width = 0.5 * of.modulus, of.half_width is not None
                size = of.size / (1.0 if width else G)
                found = family.part(at).contact(size, of.tilt, width)
                good = np.isfinite(found.r) & (found.r > 0.0) & np.isfinite(found.T)
                good &= one_signed(of, found)
                for mine, new in zip(self._found, found, strict=True):
                    mine[at[good]] = new[good]
                self._family[at[good]] = number

    def _answer(self, k: int) -> None:
        """One scene by `solve`."""
        solution = solve(self._question.scene(k))
        r, G = solution.half_width, 0.5 * solution.scene.Estar
        _ = solution.stick
        values = solution.centre, r, solution.normal_load / G
        about = (solution.moment - solution.centre * solution.normal_load) / G
        for mine, new in zip(self._found, (*values, about), strict=True):
            mine[k] = new
        self._alone[k] = solution

    # -- answers -----------------------------------------------------------------------------------

    @cached_property
    def edges(self) -> Array:
        """The outermost edges, ndarray of float of shape (..., 2)."""
        m, r = self._found[:2]
        return self._shaped(np.stack((m - r, m + r), axis=-1))

    def pressure(self, x: ArrayLike) -> Array:
        """The pressure of every scene at x.

        Parameters
        ----------
        x : array_like of float
            Places, a length of any shape S, the same for all scenes.

        Returns
        -------
        ndarray of float
            Stresses of shape `shape` + S: 0 outside the contact, nan where a scene is refused.
        """
        places = arguments.reals("x", x)
        n, count = self._question.size, max(places.size, 1)
        out = np.empty((n, places.size))
        for some in _chunks(np.arange(n), max(VALUES // count, 1)):
            out[some] = self._pressure(some, np.broadcast_to(places.ravel(), (len(some), count)))
        return out.reshape(self.shape + places.shape)

    def _pressure(self, some: NDArray[np.int64], x: Array) -> Array:
        """p of some scenes at x (n, k)."""
        out = np.full(x.shape, np.nan)
        for number in np.unique(self._family[some]).tolist():
            here = np.flatnonzero(self._family[some] == number)
            at = some[here]
            if number == ALONE:
                for row, k in zip(here.tolist(), at.tolist(), strict=True):
                    if k in self._alone:
                        out[row] = self._alone[k].pressure(x[row])
                continue
            found = Contact(*(v[at] for v in self._found))
            u = x[here] - found.m[:, None]
            tilt, G = self._question.loads.tilt[at], 0.5 * self._question.loads.modulus[at]
            inside = np.abs(u) <= found.r[:, None]
            with np.errstate(all="ignore"):
                clipped = np.where(inside, u, 0.5 * found.r[:, None])
                p = self._question.families[number].part(at).pressure(found, tilt, clipped)
                out[here] = np.where(inside, G[:, None] * p, np.where(np.isnan(u), np.nan, 0.0))
        return out

    @cached_property
    def peak_pressure(self) -> Array:
        """The largest pressure, ndarray of float; inf under a corner."""
        n = self._question.size
        out = np.empty(n)
        for some in _chunks(np.arange(n), VALUES // FIRST):
            out[some] = self._peak(some)
        return self._shaped(out)

    def _peak(self, some: NDArray[np.int64]) -> Array:
        m, r = (v[some, None] for v in self._found[:2])
        every, s = np.arange(len(some)), np.sin(math.pi * (np.arange(FIRST) / (FIRST - 1) - 0.5))
        places = np.broadcast_to(s, (len(some), FIRST))
        best = np.zeros(len(some))
        for _ in range(ZOOMS):
            p = self._pressure(some, m + r * places)
            k = np.argmax(p, axis=1)
            best = np.maximum(best, p[every, k])
            lo, hi = (
                places[every, np.maximum(k - 1, 0)],
                places[every, np.minimum(k + 1, p.shape[1] - 1)],
            )
            places = np.linspace(lo, hi, PLACES, axis=1)
        return best

    @cached_property
    def _corrective(self) -> Many:
        """The contacts of p̂: under P - |Q|/f, at the tilt that the bulk stress asks for."""
        q, P = self._question, 0.5 * self._question.loads.modulus * self._found.T
        a = q.loads
        direction, f = sign(a), np.where(a.friction > 0.0, a.friction, np.nan)
        with np.errstate(invalid="ignore"):
            load = np.where(
                slips(a) & (self._family != ALONE), P - np.abs(a.tangential_load) / f, np.nan
            )
            tilt = a.tilt - 0.5 * a.bulk_stress / (direction * f * a.modulus)
        none = np.zeros(len(P))
        loads = Loads(a.modulus, load, None, np.where(np.isnan(tilt), 0.0, tilt), none, none, none)
        return Many(replace(q, loads=loads, alone=True))

    @cached_property
    def stick(self) -> Array:
        """The stick zone, ndarray of float of shape (..., 2).

        nan in full sliding and without friction, and where there are several stick zones.
        """
        a, out = self._question.loads, self.edges.reshape(-1, 2).copy()
        some = slips(a)
        if some.any():
            out[some] = self._corrective.edges.reshape(-1, 2)[some]
        out[a.friction == 0.0] = np.nan
        for k, solution in self._alone.items():
            zones = solution.stick
            out[k] = zones[0] if len(zones) == 1 else np.nan
        return self._shaped(out)


def _chunks(which: NDArray[np.int64], size: int) -> Iterator[NDArray[np.int64]]:
    return (which[k : k + size] for k in range(0, len(which), size))
