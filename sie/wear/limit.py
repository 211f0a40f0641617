"""The limit of fretting wear, without time and without a law of wear.

Zones that slip wear until they carry nothing; what sticks keeps its shape. In the limit the old
profile touches on the stick zone [c1, c2] alone, m ± r, with sharp edges and under all of P: with p̂
the pressure that has smooth edges there (under P̂ and at the tilt θ̂, the corrective pressure of
partial slip),

    p = p̂ + [ΔP/π - E*/2 Δθ (x - m)]/sqrt(r² - (x - m)²),      ΔP = P - P̂,  Δθ = θ - θ̂

Beside the stick zone the old profile would then overlap the body by

    depth = 2 ΔP/(π E*) arcosh(X/r) ∓ Δθ sqrt(X² - r²) - gap^,      X = |x - m|,

gap^ the gap beside p̂, and what overlaps is worn. At the edges of the stick zone q/p = Q/ΔP = f: it
neither grows nor shrinks. P may be held, or the approach: then the load falls until the old profile
has the gap at a distant place that it had before.

In three dimensions: Dmitriev, Voll, Psakhie & Popov, Sci. Rep. 6 (2016) 23231. In plane strain:
Hills, Sackfield & Paynter, Eur. J. Mech. A 28 (2009) 1002-1013, find the same by stepping.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.cauchy.density import JacobiDensity
from sie.cauchy.equation import CauchyEquation
from sie.certificate.pressure_check import certificate
from sie.contact.gap import gap
from sie.errors import ContactError
from sie.friction.partial_slip import OneSignedSlip
from sie.numerics.graded_rule import on_panels
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.sampled import Sampled
from sie.solution import Solution, solve
from sie.traction.base import Density
from sie.traction.combination import superposed
from sie.traction.of_slope import SlopeDensity

Array = NDArray[np.float64]

HOLDS = ("load", "approach")
# The first distance from the stick zone that is looked at, of its half-width, and how often it is
# doubled, and halved, until wear ends
NEXT, DOUBLINGS, HALVINGS = 1e-15, 1100, 200
PANELS = 8  # of the rule for the volume, in arcosh
CHECKED, TOLERATED = 101, 1e-9
# Points of the worn profile on each worn zone and, coarser, on what is left, and how far it reaches
POINTS, BESIDE = 160, 1.0


class WearCertificate(NamedTuple):
    """How well a wear limit meets its conditions.

    Parameters
    ----------
    residual : float
        Error of the pressure in the stick zone, measured on both of its parts.
    force : float
        Relative error of the load.
    lowest_pressure, lowest_depth : float
        0 where p >= 0 in the stick zone and wear takes material away, otherwise negative.
    """

    residual: float
    force: float
    lowest_pressure: float
    lowest_depth: float

    @property
    def ok(self) -> bool:
        """Whether all are zero to 1e-9."""
        return max(self[:2]) <= TOLERATED and min(self[2:]) >= -TOLERATED


@dataclass(frozen=True, eq=False)
class WearLimit:
    """The final state of fretting wear; `wear_limit` makes it.

    Parameters
    ----------
    before : Solution
        The contact before wear.
    normal_load : float
        The load in the limit, force per length: P, or less where the approach is held.
    """

    before: Solution
    normal_load: float

    @property
    def stick(self) -> tuple[float, float]:
        """The stick zone, which carries all of the load, lengths."""
        zone = self._hat.contact
        return zone.x1, zone.x2

    @cached_property
    def pressure(self) -> Density:
        """The pressure in the limit, a `Density`; infinite at the ends of the stick zone."""
        return superposed((1.0, self._hat), (1.0, self._flat))

    @cached_property
    def _flat(self) -> JacobiDensity:
        """The pressure with sharp edges that is added to p̂."""
        slope = 0.5 * self.before.scene.Estar * self._turned
        return CauchyEquation(self.stick, g=slope, b=-1.0, total=self._gained).solve()

    def depth(self, x: ArrayLike) -> Array:
        """How much of the indenter, or of both bodies together, is worn away.

        Parameters
        ----------
        x : array_like of float
            Places on the surface, length.

        Returns
        -------
        ndarray of float
            Depths, length, of the shape of x; 0 in the stick zone and where nothing wears.
        """
        x = arguments.reals("x", x)
        depth: Array = np.maximum(self._overlap(x.ravel()), 0.0).reshape(x.shape)
        return depth

    @cached_property
    def worn(self) -> tuple[float, float]:
        """The ends of the worn zones on the left and on the right, lengths."""
        return self._end(-1.0), self._end(1.0)

    @cached_property
    def volume(self) -> float:
        """∫ of the depth, an area: volume per length of the line of contact."""
        zone, total = self._hat.contact, 0.0
        for side, end in zip((-1.0, 1.0), self.worn, strict=True):
            last = float(_arcosh_excess(_beyond(zone, end, side) / zone.r))
            t, weight = (of.ravel() for of in on_panels(np.linspace(0.0, last, PANELS + 1)))
            distance = zone.r * 2.0 * np.sinh(0.5 * t) ** 2
            x = zone.x2 + distance if side > 0.0 else zone.x1 - distance
            total += float(self.depth(x) @ (weight * zone.r * np.sinh(t)))
        return total

    @cached_property
    def profile(self) -> Profile:
        """The worn profile, a trace that is dense next to the stick zone, where its slope jumps."""
        (c1, c2), (w1, w2) = self.stick, self.worn
        near = np.linspace(0.0, 1.0, POINTS) ** 2
        margin = BESIDE * (w2 - w1)
        lo, hi = self.before.scene.profile.domain
        ends = max(w1 - margin, lo), min(w2 + margin, hi)
        parts = [
            c1 - (c1 - w1) * near, c2 + (w2 - c2) * near, np.linspace(c1, c2, 2 * POINTS),
            np.linspace(ends[0], w1, POINTS), np.linspace(w2, ends[1], POINTS),
        ]  # fmt: skip
        x = np.unique(np.concatenate(parts))
        least = 1e-9 * (ends[1] - ends[0])
        x = x[np.concatenate(([True], np.diff(x) > least))]
        return Sampled(x, self.before.scene.profile.height(x) + self.depth(x))

    def check(self) -> WearCertificate:
        """The certificate: the equation at other points, the load, and both inequalities.

        Returns
        -------
        WearCertificate
            `.ok` sums it up.
        """
        zone, state, p = self._hat.contact, self._state, self.pressure
        slope = state.found.slope(self.before.scene.profile)
        of_hat = certificate(state.corrective, slope, self.before.tol)
        values = p(zone.m + zone.r * np.cos(np.pi * (np.arange(CHECKED) + 0.5) / CHECKED))
        worn = np.concatenate(
            [np.linspace(c, w, CHECKED) for c, w in zip(self.stick, self.worn, strict=True)]
        )
        deepest = float(self.depth(worn).max())
        return WearCertificate(
            max(of_hat.error, self._flat.error),
            abs(p.resultant / self.normal_load - 1.0),
            min(0.0, float(values.min() / values.max())),
            min(0.0, float(self._overlap(worn).min() / deepest)) if deepest else 0.0,
        )

    # -- p̂, and what is added to it ----------------------------------------------------------------

    @property
    def _state(self) -> OneSignedSlip:
        state = self.before.tangential
        assert isinstance(state, OneSignedSlip)
        return state

    @property
    def _hat(self) -> SlopeDensity:
        return self._state.corrective

    @property
    def _gained(self) -> float:
        return self.normal_load - self._hat.resultant

    @property
    def _turned(self) -> float:
        return self.before.tilt - self._state.found.edges.tilt

    def _gap_hat(self, x: Array) -> Array:
        state = self._state
        return gap(x, state.corrective, state.found.slope(self.before.scene.profile))

    def _overlap(self, x: Array) -> Array:
        """How far the old profile would overlap the body at x; 0 in the stick zone."""
        zone, out = self._hat.contact, np.zeros(x.shape)
        rise = 2.0 * self._gained / (math.pi * self.before.scene.Estar)
        for side in (-1.0, 1.0):
            beyond = _beyond(zone, x, side)
            at = beyond > 0.0
            u = beyond[at] / zone.r
            turn = side * self._turned * zone.r * np.sqrt(u * (2.0 + u))
            out[at] = rise * _arcosh_excess(u) - turn - self._gap_hat(x[at])
        return out

    def _end(self, side: float) -> float:
        """The place beside the stick zone where wear ends."""
        zone = self._hat.contact
        edge = zone.x2 if side > 0.0 else zone.x1

        def worn(distance: float) -> bool:
            return bool(self._overlap(np.array([edge + side * distance]))[0] > 0.0)

        low, high = 0.0, NEXT * zone.r
        for _ in range(DOUBLINGS):
            if not worn(high):
                break
            low, high = high, 2.0 * high
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            if not low < middle < high or edge + side * middle in (
                edge + side * low,
                edge + side * high,
            ):
                break
            low, high = (middle, high) if worn(middle) else (low, middle)
        return edge + side * low


def wear_limit(scene: Scene, hold: str = "load", datum: float | None = None) -> WearLimit:
    """The shape, pressure, depth and volume in which fretting wear ends.

    Parameters
    ----------
    scene : Scene
        The contact before wear in partial slip, similar bodies, any profile; Q is the amplitude of
        the tangential load.
    hold : {"load", "approach"}, optional
        What is held while the profile wears: P, or the approach of the bodies.
    datum : float, optional
        For the approach: a place on the surface beyond the worn zone, under the indenter, whose gap
        stays. In plane elasticity an approach is one relative to some place.

    Returns
    -------
    WearLimit
        `.profile`, `.pressure`, `.depth(x)`, `.volume`, `.worn`, `.normal_load`, `.check()`.

    Raises
    ------
    ValueError
        For a scene without tangential load, for another `hold`, and for a datum that is none.
    ContactError
        For what has no such limit: full sliding, several patches, slip in two directions,
        dissimilar bodies.

    Notes
    -----
    Tilt is held. No law of wear is needed as long as what slips wears and what does not slip does
    not. The stick zone is that before wear, as it carries q = f p at its ends in the limit too.

    References
    ----------
    Dmitriev, Voll, Psakhie & Popov, Sci. Rep. 6 (2016) 23231.

    Examples
    --------
    >>> import sie
    >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, half_width=1.0, friction=0.5)
    >>> load = sie.solve(scene).normal_load
    >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=load, friction=0.5,
    ...                   tangential_load=0.3 * load)
    >>> worn = sie.wear_limit(scene)
    >>> round(worn.worn[1], 8), round(float(worn.depth([0.8366600265]).max()), 8)
    (1.22143452, 0.16257102)
    """
    _refuse(scene, hold, datum)
    before = solve(scene)
    several = before._several
    if several is not None or not isinstance(before.tangential, OneSignedSlip):
        what = (
            f"contact in {len(before.patches)} patches"
            if several is not None
            else (f"a bulk stress of {scene.bulk_stress:g}, which makes the edges slip two ways,")
        )
        raise ContactError(
            f"{what} has no wear limit here: it is found for one stick zone and slip in one "
            "direction; give one patch, or more tangential_load"
        )
    if not any(before.slip_widths):
        raise ContactError(
            f"nothing slips: both edges are sharp and stick under Q = {scene.tangential_load:g}, "
            "and nothing wears; round the edges of the profile"
        )
    limit = WearLimit(before, before.normal_load)
    if hold == "load":
        return limit
    x = np.array([arguments.measure("datum", datum)])
    gap_before = float(before.gap(x)[0])
    beyond = max(_beyond(limit._hat.contact, float(x[0]), side) for side in (-1.0, 1.0))
    if not 0.0 < gap_before < math.inf:
        raise ValueError(
            f"datum = {x[0]:g} is in the contact {before.edges} or beyond the indenter: give a "
            "place beside the contact, under the indenter"
        )
    # The overlap is linear in the load, and has to be -gap_before
    u = beyond / limit._hat.contact.r
    share = 2.0 * _arcosh_excess(np.array(u)) / (math.pi * scene.Estar)
    missing = float((limit._overlap(x)[0] + gap_before) / share)
    return WearLimit(before, before.normal_load - missing)


def _refuse(scene: Scene, hold: str, datum: float | None) -> None:
    """ValueError or ContactError for what needs no solution to be refused."""
    if not isinstance(scene, Scene):
        raise ValueError(f"{scene!r} is not a scene: build one with sie.Scene(profile=..., ...)")
    if hold not in HOLDS:
        raise ValueError(f"hold = {hold!r} is not known: give {arguments.choices(HOLDS)}")
    if (datum is not None) != (hold == "approach"):
        raise ValueError(
            "hold = 'approach' and datum = x go together: the approach is held relative to a place "
            "x on the surface; give both, or none for a constant load"
        )
    if not scene.tangential_load and not scene.slides:
        raise ValueError(
            "tangential_load = 0: nothing slips back and forth, and nothing wears; give the "
            "amplitude of the tangential load"
        )
    if scene.beta:
        raise ContactError(
            f"dissimilar bodies (β = {scene.beta:.4g}) have no such limit, as pressure and shear "
            "are one problem: give dundurs = 0 to neglect β"
        )
    if scene.slides:
        raise ContactError(
            "the bodies slide: no zone sticks, and wear does not end but for an even pressure, "
            "see sie.wear_modes; give tangential_load below f P"
        )
    if scene.bonded:
        raise ContactError("infinite friction: nothing slips, and nothing wears; give a finite one")


def _beyond(zone: Any, x: Any, side: float) -> Any:
    """The distance of x outwards from an end of the zone; negative on its inner side."""
    return -zone.from_right(x) if side > 0.0 else -zone.from_left(x)


def _arcosh_excess(u: Any) -> Any:
    """arcosh(1 + u)."""
    return 2.0 * np.arcsinh(np.sqrt(0.5 * np.asarray(u)))
