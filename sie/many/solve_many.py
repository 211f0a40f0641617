"""Many contacts at once: numbers as arrays, answers as arrays.

Scenes go through the families of their profile (`families`) in chunks that stay in the processor's
cache. What no family answers (several patches, traces, an edge that reaches an end, slip to either
side) is solved one by one, and what that refuses keeps its reason.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import fields
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.answers.body import BodyAnswers
from sie.answers.sheared import Sheared
from sie.errors import ContactError
from sie.problem.coverage import refuse_uncovered
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.from_function import FromFunction

from .families import SHAPES, families
from .smooth import Array, Contact

CHUNK = 4096  # scenes, whose arrays stay in the cache
VALUES = 1 << 14  # of a pressure that are evaluated together
ALONE = -1  # the family of what is solved one by one
ZOOMS, PLACES = 12, 9  # of the search for a peak, after a first look at FIRST places
FIRST = 65
LEFT_OPEN = "not solved as an array"
ACTING = "tilt", "friction", "tangential_load", "bulk_stress"
Numbers = dict[str, Array]  # each (n,), by its name


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
    if (normal_load is None) == (half_width is None):
        raise ValueError("give exactly one of normal_load and half_width")
    acting = dict(zip(ACTING, (tilt, friction, tangential_load, bulk_stress), strict=True))
    given = {"modulus": modulus, "normal_load": normal_load, "half_width": half_width, **acting}
    loads = {name: value for name, value in given.items() if value is not None}
    return many(profile, loads, parameters or {})


def many(
    profile: Any, loads: Mapping[str, Any], parameters: Mapping[str, Any], alone: bool = True
) -> Many:
    """Numbers by name as `Many`; `alone` as there. ValueError for what have no common shape."""
    if not isinstance(profile, Profile) and not callable(profile):
        raise ValueError(f"profile = {profile!r} is neither a profile nor a slope as a function")
    if type(profile) in SHAPES:
        parameters = {f.name: getattr(profile, f.name) for f in fields(profile)}
    numbers, own = ({k: arguments.reals(k, v) for k, v in d.items()} for d in (loads, parameters))
    try:
        shape = np.broadcast_shapes(*(v.shape for v in (*numbers.values(), *own.values())))
    except ValueError:
        raise ValueError(
            "the numbers have no common shape: give arrays that NumPy broadcasts, such as "
            "a[:, None] and b[None, :]"
        ) from None
    own, numbers = (
        {k: np.broadcast_to(v, shape).ravel() for k, v in d.items()} for d in (own, numbers)
    )
    return Many(profile, own, numbers, shape, alone)


class Alone(BodyAnswers, Sheared):
    """What is asked of a scene that no family answers."""


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

    def __init__(
        self, profile: Any, own: Numbers, loads: Numbers, shape: tuple[int, ...], alone: bool
    ) -> None:
        """Arrays (n,) by name; `alone`: whether what no family answers is solved one by one."""
        self.shape, self._profile, self._own, self._loads = shape, profile, own, loads
        n, self._families = math.prod(shape), families(profile, tuple(own))
        self._family = np.full(n, ALONE, dtype=np.int8)
        self._found = Contact(*(np.full(n, np.nan) for _ in range(4)))
        self._alone: dict[int, Alone] = {}
        with np.errstate(all="ignore"):
            for some in _chunks(n, CHUNK):
                for number in range(len(self._families)):
                    self._solve(number, some)
        reasons = np.full(n, "", dtype=object)
        for k in np.flatnonzero(np.isnan(self._found.r)).tolist():
            reasons[k] = self._answer(k) if alone else LEFT_OPEN
        self.refused = reasons.reshape(shape)
        G, (m, r, T, about) = 0.5 * loads["modulus"], self._found
        self.half_width, self.centre = self._shaped(r), self._shaped(m)
        self.normal_load, self.moment = self._shaped(G * T), self._shaped(G * (m * T + about))
        self.tilt = self._shaped(np.where(np.isnan(r), np.nan, loads["tilt"]))

    def __repr__(self) -> str:
        refused = int((self.refused != "").sum())
        return f"Many(scenes of shape {self.shape}{f', {refused} refused' if refused else ''})"

    def _shaped(self, values: Array) -> Array:
        return values.reshape(self.shape + values.shape[1:])

    def _solve(self, number: int, some: slice) -> None:
        """Let a family answer those of some scenes that are open."""
        family, tilt = self._families[number], self._loads["tilt"][some]
        open_ = np.isnan(self._found.r[some]) & (family.tilts | (tilt == 0.0))
        at = np.flatnonzero(open_) + some.start
        if not at.size:
            return
        loads = {name: v[at] for name, v in self._loads.items()}
        width, own = loads.get("half_width"), (v[at] for v in self._own.values())
        size = 2.0 * loads["normal_load"] / loads["modulus"] if width is None else width
        found = family.contact(size, loads["tilt"], width is not None, *own)
        good = _answered(loads, found)
        for mine, new in zip(self._found, found, strict=True):
            mine[at[good]] = new[good]
        self._family[at[good]] = number

    def _answer(self, k: int) -> str:
        """Solve one scene by itself; why it has no answer, or ""."""
        try:
            solution = self._solution(k)
            m, P, M = solution.centre, solution.normal_load, solution.moment
            _ = solution.stick
        except (ContactError, ValueError) as problem:
            return str(problem)
        G, r = 0.5 * solution.scene.Estar, solution.half_width
        for mine, new in zip(self._found, (m, r, P / G, (M - m * P) / G), strict=True):
            mine[k] = new
        self._alone[k] = solution
        return ""

    def _solution(self, k: int, **more: Any) -> Alone:
        """The solution of one scene, with more of its numbers."""
        profile, own = self._profile, {name: float(v[k]) for name, v in self._own.items()}
        loads: dict[str, Any] = {name: float(v[k]) for name, v in self._loads.items()}
        if not isinstance(profile, Profile):
            profile = FromFunction(partial(profile, **own))
        elif own:
            profile = type(profile)(*own.values())
        scene = Scene(profile=profile, **loads, **more)
        refuse_uncovered(scene)
        return Alone(scene)

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
        out = np.empty((len(self._family), places.size))
        for some in _chunks(len(out), max(VALUES // max(places.size, 1), 1)):
            out[some] = self._pressure(some, np.broadcast_to(places.ravel(), out[some].shape))
        return out.reshape(self.shape + places.shape)

    def _pressure(self, some: slice, x: Array) -> Array:
        """p of some scenes at x (n, k)."""
        out = np.full(x.shape, np.nan)
        for number in np.unique(self._family[some]).tolist():
            here = np.flatnonzero(self._family[some] == number)
            at = here + some.start
            if number == ALONE:
                for row, k in zip(here.tolist(), at.tolist(), strict=True):
                    if k in self._alone:
                        out[row] = self._alone[k].pressure(x[row])
                continue
            found = Contact(*(v[at, None] for v in self._found))
            own = (v[at, None] for v in (self._loads["tilt"], *self._own.values()))
            u = x[here] - found.m
            inside = np.abs(u) <= found.r
            with np.errstate(all="ignore"):
                clipped = np.where(inside, u, 0.5 * found.r)
                p = self._families[number].pressure(clipped, found, *own)
                p *= 0.5 * self._loads["modulus"][at, None]
                out[here] = np.where(inside, p, np.where(np.isnan(u), np.nan, 0.0))
        return out

    @cached_property
    def peak_pressure(self) -> Array:
        """The largest pressure, ndarray of float; inf under a corner."""
        best, first = np.zeros(len(self._family)), np.linspace(-0.5, 0.5, FIRST)
        for some in _chunks(len(best), VALUES // FIRST):
            m, r = (v[some, None] for v in self._found[:2])
            every = np.arange(len(m))
            places = np.broadcast_to(np.sin(math.pi * first), (len(m), FIRST))
            for _ in range(ZOOMS):
                p = self._pressure(some, m + r * places)
                k = np.argmax(p, axis=1)
                best[some] = np.maximum(best[some], p[every, k])
                lo, hi = places[every, np.clip((k - 1, k + 1), 0, p.shape[1] - 1)]
                places = np.linspace(lo, hi, PLACES, axis=1)
        return self._shaped(best)

    def elastic_limit(self, poisson: float) -> Array:
        """The load P/k at first yield by von Mises' criterion, found scene by scene in some ms.

        Parameters
        ----------
        poisson : float
            ν of the bodies, above -1 and at most 0.5.

        Returns
        -------
        ndarray of float
            `YieldPoint.load`, a length, of shape `shape`; nan where a scene, or its limit, is
            refused.
        """
        out = np.full(len(self._family), np.nan)
        for k in np.flatnonzero(self.refused.ravel() == "").tolist():
            with suppress(ContactError):
                out[k] = self._solution(k, poisson=poisson).elastic_limit().load
        return self._shaped(out)

    @cached_property
    def stick(self) -> Array:
        """The stick zone, ndarray of float of shape (..., 2).

        nan in full sliding and without friction, and where there are several stick zones.
        """
        out, slips = self.edges.reshape(-1, 2).copy(), _slips(self._loads)
        if slips.any():
            out[slips] = self._corrective(slips & (self._family != ALONE))[slips]
        out[self._loads["friction"] == 0.0] = np.nan
        for k, solution in self._alone.items():
            zones = solution.stick
            out[k] = zones[0] if len(zones) == 1 else np.nan
        return self._shaped(out)

    def _corrective(self, some: NDArray[np.bool_]) -> Array:
        """The edges of p̂ of some scenes: under P - |Q|/f, at a tilt that the bulk stress adds."""
        E, tilt, f, Q, sigma = (self._loads[name] for name in ("modulus", *ACTING))
        f = np.where(some, f, 1.0)
        load = np.where(some, 0.5 * E * self._found.T - np.abs(Q) / f, np.nan)
        tilt = tilt - 0.5 * sigma / (np.where(Q < 0.0, -f, f) * E)
        loads = dict.fromkeys(ACTING, 0.0 * E) | {"modulus": E, "normal_load": load, "tilt": tilt}
        alike = Many(self._profile, self._own, loads, self.shape, alone=True)
        return alike.edges.reshape(-1, 2)


def _slips(loads: Numbers) -> NDArray[np.bool_]:
    """Whether something slips."""
    _, f, Q, sigma = (loads[name] for name in ACTING)
    return np.asarray((f > 0.0) & ((Q != 0.0) | (sigma != 0.0)))


def _answered(loads: Numbers, found: Contact) -> NDArray[np.bool_]:
    """Whether numbers are those of a scene, and nothing slips, or all of one sign and some sticks.

    Others are solved, or refused, one by one.
    """
    E, (tilt, f, Q, sigma) = loads["modulus"], (loads[name] for name in ACTING)
    good = np.isfinite(found.m + tilt + Q + sigma) & (f >= 0.0) & (f < math.inf)
    for v in (E, found.r, E * found.T):
        good &= (v > 1.0 / arguments.LARGEST) & (v < arguments.LARGEST)
    none = ~_slips(loads) & ((f > 0.0) | (Q == 0.0))
    fits = (0.5 * f * E * found.T > np.abs(Q)) & (
        0.25 * math.pi * found.r * np.abs(sigma) <= np.abs(Q)
    )
    return np.asarray(good & (none | fits))


def _chunks(n: int, size: int) -> Iterator[slice]:
    return (slice(k, min(k + size, n)) for k in range(0, n, size))
