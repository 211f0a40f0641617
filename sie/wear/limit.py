"""The limit of fretting wear, without time and without a law of wear.

Zones that slip wear until they carry nothing; what sticks keeps its shape. In the limit the old
profile touches on the stick zone [c1, c2] alone, with sharp edges and under all of P: it is the
contact of an indenter that ends there. With p̂ the pressure that has smooth edges there (under P̂ and
at the tilt θ̂, the corrective pressure of partial slip), of centre m and half-width r,

    p = p̂ + [ΔP/π - E*/2 Δθ (x - m)]/sqrt(r² - (x - m)²),      ΔP = P - P̂,  Δθ = θ - θ̂

Beside the stick zone the gap of the old profile to the body is negative, and what overlaps is worn.
At the edges of the stick zone q/p = Q/ΔP = f: it neither grows nor shrinks. P may be held, or the
approach: then the load falls until the old profile has the gap at a distant place that it had
before.

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
from sie.contact.gap import gap
from sie.errors import ContactError
from sie.friction.partial_slip import OneSignedSlip
from sie.numerics.graded_rule import on_panels
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.sampled import Sampled
from sie.profiles.slope import Slope
from sie.solution import Solution, solve

Array = NDArray[np.float64]

HOLDS = ("load", "approach")
HALVINGS = 60  # of the interval that has the end of wear
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


@dataclass(frozen=True)
class Stuck(Profile):
    """The part of a profile on the stick zone."""

    whole: Profile
    zone: tuple[float, float]

    @cached_property
    def pieces(self) -> Slope:
        """Its slope, whose ends are corners."""
        return self.whole.pieces.within(*self.zone)


@dataclass(frozen=True, eq=False)
class WearLimit:
    """The final state of fretting wear; `wear_limit` makes it.

    Attributes
    ----------
    before : Solution
        The contact before wear.
    normal_load : float
        The load in the limit, force per length: P, or less where the approach is held.
    pressure : Density
        The pressure in the limit; infinite at the ends of the stick zone.
    """

    before: Solution
    normal_load: float

    @property
    def stick(self) -> tuple[float, float]:
        """The stick zone, which carries all of the load, lengths."""
        return self.before.stick[0]

    @cached_property
    def _limit(self) -> Solution:
        scene = self.before.scene
        stuck = Stuck(scene.profile, self.stick)
        P, tilt = self.normal_load, self.before.tilt
        scene = Scene(profile=stuck, modulus=scene.Estar, normal_load=P, tilt=tilt)
        return solve(scene, self.before.tol)

    @property
    def pressure(self) -> Any:
        """The pressure in the limit, a `Density`; infinite at the ends of the stick zone."""
        return self._limit.pressure

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
        r, total = 0.5 * (self.stick[1] - self.stick[0]), 0.0
        for side, edge, end in zip((-1.0, 1.0), self.stick, self.worn, strict=True):
            last = 2.0 * math.asinh(math.sqrt(0.5 * abs(end - edge) / r))
            t, weight = (of.ravel() for of in on_panels(np.linspace(0.0, last, PANELS + 1)))
            x = edge + side * 2.0 * r * np.sinh(0.5 * t) ** 2
            total += float(self.depth(x) @ (weight * r * np.sinh(t)))
        return total

    @cached_property
    def profile(self) -> Profile:
        """The worn profile, a trace that is dense next to the stick zone, where its slope jumps."""
        (c1, c2), (w1, w2) = self.stick, self.worn
        near = np.linspace(0.0, 1.0, POINTS) ** 2
        margin = BESIDE * (w2 - w1)
        lo, hi = self.before.scene.profile.domain
        ends = max(w1 - margin, lo), min(w2 + margin, hi)
        worn = c1 - (c1 - w1) * near, c2 + (w2 - c2) * near
        old = [np.linspace(*part, 2 * POINTS) for part in ((ends[0], w1), (c1, c2), (w2, ends[1]))]
        x = np.unique(np.concatenate((*worn, *old)))
        x = x[np.append(True, np.diff(x) > 1e-9 * (ends[1] - ends[0]))]
        return Sampled(x, self.before.scene.profile.height(x) + self.depth(x))

    def check(self) -> WearCertificate:
        """The certificate: that of the pressure, and that wear takes material away.

        Returns
        -------
        WearCertificate
            `.ok` sums it up.
        """
        measured = self._limit.check()
        zones = [np.linspace(*ends, CHECKED) for ends in zip(self.stick, self.worn, strict=True)]
        overlap = self._overlap(np.concatenate(zones))
        lowest = float(min(0.0, overlap.min())) / max(float(overlap.max()), 1e-300)
        force = abs(self.pressure.resultant / self.normal_load - 1.0)
        return WearCertificate(measured.error, force, min(0.0, measured.lowest_pressure), lowest)

    def _overlap(self, x: Array) -> Array:
        """How far the old profile would overlap the body at x; 0 in the stick zone."""
        slope = self.before.normal.slope(self.before.scene.profile)
        return -gap(x, self.pressure, slope)

    def _end(self, side: float) -> float:
        """The place beside the stick zone where wear ends."""
        edge = self.stick[side > 0.0]

        def worn(distance: float) -> bool:
            return bool(self._overlap(np.array([edge + side * distance]))[0] > 0.0)

        low, high = 0.0, 4.0 * float(np.spacing(max(map(abs, self.stick))))
        while worn(high):
            low, high = high, 2.0 * high
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
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
    P = before.normal_load
    if hold == "load":
        return WearLimit(before, P)
    x = np.array([arguments.measure("datum", datum)])
    gap_before = float(before.gap(x)[0])
    if not 0.0 < gap_before < math.inf:
        raise ValueError(
            f"datum = {x[0]:g} is in the contact {before.edges} or beyond the indenter: give a "
            "place beside the contact, under the indenter"
        )
    # The overlap is linear in the load, and has to be -gap_before
    once, twice = (float(WearLimit(before, k * P)._overlap(x)[0]) for k in (1.0, 2.0))
    return WearLimit(before, P * (1.0 - (once + gap_before) / (twice - once)))


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
