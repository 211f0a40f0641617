"""Stick and slip on several patches at β = 0: Q and a bulk stress in proportion, after P.

    q = ± f (p - p*)

p* is the pressure of the same profile under P* = P - |Q|/f at the tilt of p. Its patches are the
stick zones; a patch of p without one in p* slides all over (Ciavarella 1998; Jäger 1998). One rigid
shift of all patches is for q what one approach is for p. At equal tilt p* <= p, and the patches of
p* lie in those of p, so that the slip

    g = ± f gap*                          gap* that of p*, on the patches of p

has one sign everywhere. A bulk stress tilts the profile of p* by ∓2τ/(f E*) over all patches. Along
the step -dp* is then the pressure of a tilted flat punch on the stick zones. If that presses
everywhere on the patches of p it does so on all that lie within (sweeping a positive charge inwards
leaves it positive), and the stick zones only shrink; otherwise the answer is verified.

The energy that slip dissipates at constant load is f² E, E = ∫ p_b gap_a dx for two loads a <= b,
p_b the pressure under b and gap_a under a: all that is integrated is positive.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.slip_state import Slip
from sie.numerics.graded_panels import OF_RULES, OF_SERIES, Rule
from sie.numerics.zones import Zones, left_over, within
from sie.problem.coverage import remaining
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.traction.base import Density
from sie.traction.combination import ZERO, superposed

from .answer import SeveralPatches
from .full import FullContact
from .measure import edge_ratio
from .newton import edge_charges, loaded

Array = NDArray[np.float64]

FEW = 32  # parts of the patches, whose rule is graded as closely as any
SHRUNK = 14  # times an interval about a minimum: to the root of rounding, which is enough
SAMPLES, LOWEST = 65, 8  # heights on a patch, and how many of their minima are refined
SCANNED = 40  # places on each stick zone
WITHIN = 1e-9  # of the width of all patches, and of the peak: by less p* may exceed 2p
Contact = SeveralPatches | FullContact
# The contact under a load and a tilt.
PatchesUnder = Callable[[float, float], Contact]
KIND = "one sign on all patches"


class PatchSlip(Slip):
    """Zones of stick and slip on all patches after the load Q and the strain τ.

    full     the contact
    under    the contact of the same profile under another load and tilt
    """

    kind = KIND

    def __init__(
        self,
        scene: Scene,
        full: Contact,
        loads: tuple[float, float],
        under: PatchesUnder,
    ) -> None:
        self.scene, self.full, self.under = scene, full, under
        self.friction, self.period = scene.friction, scene.profile.period
        self.Q, self.tau = loads
        self.sign = 1.0 if self.Q > 0.0 else -1.0
        self.contact = full.edges.contact

    @cached_property
    def corrective(self) -> Contact | Untouched:
        """p* and its gap; the untouched profile in full sliding."""
        edges, f = self.full.edges, self.friction
        tilt = edges.tilt - self.sign * self.tau / (f * 0.5 * self.scene.Estar)
        if self.tau != 0.0:
            refuse_stretch(self.period)
        if self.Q == 0.0 != self.tau:
            raise ContactError(
                f"{self._stretch} without tangential_load makes patches slip to either side, and "
                "zones of stick between slip in opposite directions are solved on one patch only; "
                "give a tangential load with the bulk stress"
            )
        if abs(self.Q) == f * edges.normal_load:
            return Untouched(self.scene.profile, tilt, self.full.patches)
        reduced = self.under(remaining(f, edges.normal_load, self.Q), tilt)
        if self.tau != 0.0:
            self._verify(reduced)
        return reduced

    @property
    def _stretch(self) -> str:
        unit = replace(self.scene, bulk_stress=1.0).tau
        return f"bulk_stress = {self.tau / unit:.6g}"

    def _verify(self, reduced: Contact) -> None:
        """Refuse stick zones beyond the patches, or |q| > f p there."""
        room = WITHIN * 2.0 * self.contact.r
        wider = tuple((a - room, b + room) for a, b in self.full.patches)
        x = _places(reduced.patches)
        p, p_star = self.full.pressure(x), reduced.pressure(x)
        if left_over(reduced.patches, wider) or (p_star > 2.0 * p + WITHIN * p.max()).any():
            raise ContactError(
                f"{self._stretch} makes patches slip to either side under tangential_load = "
                f"{self.Q:g}, which is solved on one patch only; lower the bulk stress or the "
                "change of tilt, or raise the tangential load"
            )

    @cached_property
    def advancing(self) -> bool:  # type: ignore[override]
        if self.tau == 0.0 or not isinstance(self.full, SeveralPatches):
            return True
        found = self.full.found
        changes = loaded(found.state, abs(self.Q))
        changes[-1] = self.sign * self.tau
        charges = edge_charges(found.operator, moment=False).of(changes)[:-1, 0]
        return bool((found.state.outward * charges >= -WITHIN * np.abs(charges).max()).all())

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:  # type: ignore[override]
        """Per period those in the period of the patches."""
        zones, start = self.corrective.patches, self.full.patches[0][0]
        if math.isinf(self.period):
            return zones
        turns = [math.floor((0.5 * (lo + hi) - start) / self.period) for lo, hi in zones]
        return tuple(
            sorted(
                (lo - turn * self.period, hi - turn * self.period)
                for (lo, hi), turn in zip(zones, turns, strict=True)
            )
        )

    @property
    def parts(self) -> tuple[float, tuple[tuple[float, Density], ...]]:
        f = self.sign * self.friction
        return f, ((-f, self.corrective.pressure),)

    @property
    def contacts(self) -> tuple[Contact, ...]:
        return () if isinstance(self.corrective, Untouched) else (self.corrective,)

    @cached_property
    def shear(self) -> Density:
        scale, others = self.parts
        return superposed((scale, self.full.pressure), *others)

    def slip(self, x: Array) -> Array:
        """g at x (1-d): 0 in stick and beside the patches."""
        out = np.where(np.isnan(x), np.nan, 0.0)
        inside = within(x, self.full.patches, self.period)
        if inside.any():
            out[inside] = self.sign * self.friction * self.corrective.gap(x[inside])
        return out

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        """The parts of the patches beside the stick zones, all slipping one way."""
        zones = left_over(self.full.patches, self.stick, self.period)
        return tuple((lo, hi, self.sign) for lo, hi in zones)

    @cached_property
    def energy(self) -> float:
        return self.friction**2 * work(self.corrective, self.full, self.period)

    @cached_property
    def shift(self) -> float:
        """∫ slip dμ, μ the pressure of a flat punch on all patches under a unit load."""
        rule = slip_rule(self.full, self.stick, self.period)
        points, weight, slip = rule.points, rule.weight, self.slip(rule.x)
        if isinstance(self.full, FullContact):
            return float(weight @ slip) / self.period
        o = self.full.found.operator
        P = o.patches
        _, k, _ = self.full.pressure.placed(points.x)
        T, _ = o.root(k, points)
        rho = edge_ratio(P, np.arange(P.number))[k]
        apart = P.chord.apart(points.anchor[:, None] - P.edges, points.offset[:, None])
        changes = loaded(self.full.found.state, 1.0)
        punch = edge_charges(o, moment=False).of(changes)[:-1, 0]
        D = -(punch * rho / apart).sum(axis=1)
        return float((weight * np.abs(T) * D / np.pi) @ slip)


def refuse_stretch(period: float) -> None:
    """Refuse a bulk stress in a contact that repeats: the bodies fit in one period alone."""
    if math.isfinite(period):
        raise ContactError(
            f"a bulk stress stretches one of two bodies that meet every {period:.6g}, so that no "
            "periodic answer exists: leave it out, or add it to the stress afterwards if it "
            "strains both alike"
        )


def _places(zones: Zones) -> Array:
    """Places on zones, close to their ends too."""
    lo, hi = np.array(zones).T[..., None]
    share = np.sin(0.5 * np.pi * (np.arange(SCANNED) + 0.5) / SCANNED) ** 2
    return np.asarray((lo + (hi - lo) * share).ravel())


# -- the energy that slip dissipates --------------------------------------------------------------


class Untouched:
    """The profile under no load: the gap is its height above its lowest point on some zones."""

    patches: tuple[tuple[float, float], ...] = ()
    pressure: Density = ZERO

    def __init__(self, profile: Profile, tilt: float, zones: Zones) -> None:
        self.profile, self.tilt = profile, tilt
        self.lowest = min(self._lowest(lo, hi) for lo, hi in zones)

    def gap(self, x: Array) -> Array:
        return np.maximum(self._height(x) - self.lowest, 0.0)

    def _height(self, x: Array) -> Array:
        return np.asarray(self.profile.height(x) + self.tilt * x)

    def _lowest(self, lo: float, hi: float) -> float:
        breaks = [b for b in self.profile.breaks if lo < b < hi]
        even = 0.5 * (lo + hi) - 0.5 * (hi - lo) * np.cos(np.linspace(0.0, np.pi, SAMPLES))
        x = np.unique(np.concatenate((even, breaks)))
        h = self._height(x)
        inner = np.flatnonzero((h[1:-1] <= h[:-2]) & (h[1:-1] <= h[2:])) + 1
        inner = inner[np.argsort(h[inner])][:LOWEST, None]
        lowest, first, last = float(h.min()), x[inner - 1], x[inner + 1]
        # between two places with one minimum: an interval of a quarter each time
        for _ in range(SHRUNK if inner.size else 0):
            x = first + (last - first) * np.linspace(0.0, 1.0, 9)
            h = self._height(x)
            lowest, k = min(lowest, float(h.min())), h.argmin(axis=1)[:, None]
            first = np.take_along_axis(x, np.maximum(k - 1, 0), 1)
            last = np.take_along_axis(x, np.minimum(k + 1, 8), 1)
        return lowest


def work(lower: Contact | Untouched, upper: Contact, period: float) -> float:
    """E: the pressure of the upper level times the gap of the lower one."""
    rule = slip_rule(upper, lower.patches, period)
    p = upper.pressure(rule.x)
    # a node that rounding puts on a sharp edge
    return float(np.where(np.isfinite(p), rule.weight * p, 0.0) @ lower.gap(rule.x))


def slip_rule(upper: Contact, stick: Zones, period: float) -> Rule:
    """A rule on the patches beside the stick zones, graded to neighbouring ends and breaks."""
    breaks = np.array(upper.pressure.breaks)
    parts: list[tuple[float, float]] = []
    for lo, hi in left_over(upper.patches, stick, period):
        parts += pairwise([lo, *breaks[(breaks > lo) & (breaks < hi)].tolist(), hi])
    return Rule.graded(np.array(parts), OF_RULES if len(parts) <= FEW else OF_SERIES)
