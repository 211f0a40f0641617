"""Partial slip: from a pressure and a load step to stick zones, slip zones and shear, at β = 0.

After the normal load P, at constant P, the tangential load Q and the bulk stress σ are applied
(τ = `Scene.tau`, σ/4 for similar bodies):

    |q| <= f p,      1/π PV∫q/(x - t) dt = τ and slip 0 in the stick zones,
    q = ± f p, in the direction of slip, in the slip zones

slip(x) is the tangential displacement of the indenter relative to the body, positive along +x.
Where it is positive so is q, which acts on the body. In slip of one direction on all patches

    q = ± f (p - p̂),      slip = ± f gap^

p̂, the corrective pressure, is that of the same profile, tilted by -2τ/(± f E*), under the reduced
load P - |Q|/f, and gap^ is the gap beside that contact. Its patches are the stick zones; a patch of
p without one slides all over. This is Cattaneo's and Mindlin's superposition for any profile
(Ciavarella 1998; Jäger 1998): subtracting the equations (1) and (12) leaves the normal problem for
p̂ and for the slip, and one rigid shift of all patches is for q what one approach is for p. It holds
where the patches of p̂ lie within those of p and p̂ <= 2p there, as they do on one patch with
π r |τ| <= |Q|, r its half-width, and without τ. In incipient sliding, |Q| = f P, p̂ = 0 and the gap
is that of the profile as it touches first. Where slip has two directions the state is one finite
step of the engine (`slip_of_state`).

Along the step dq is the pressure of a tilted flat punch on the stick zones. If that has the sign of
slip on the patches of p it does so on all that lie within (sweeping a positive charge inwards
leaves it positive), and the slip zones only grow. Where they would have to retreat on the way, the
state given is that of the friction law in total displacements, as in Nowell & Hills (1987), and
`advancing` is False.

The energy f² ∫ p gap^ dx and the shift ± f ∫ gap^ dμ, μ the pressure of a flat punch on all patches
under a unit load, are integrals of what is positive.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.contact.pressure import OnePatch
from sie.errors import ContactError
from sie.numerics.graded_panels import OF_RULES, OF_SERIES, Rule
from sie.numerics.interval import Interval, two_sum
from sie.numerics.zones import Zones, left_over, within
from sie.problem.coverage import refuse_sliding, remaining
from sie.traction.combination import ZERO, superposed

from .rates import Rate
from .slip import NoSlip, Slip, Step, Touching
from .slip_of_state import two_signed

if TYPE_CHECKING:
    from sie.problem.scene import Scene
    from sie.traction.base import Density

Array = NDArray[np.float64]

WITHIN = 1e-9  # of the peak, and of the width of all patches: by less p̂ may exceed 2p, or p
SCANNED = 40  # places on each stick zone where that is tested
# Where "sliding" is switched off in the economy, the corrective pressure carries this fraction of
# P: nothing, but it is solved for.
HARDLY = 1e-40
FEW = 32  # parts of the patches, whose rule is graded as closely as any
SHRUNK = 14  # times an interval about a minimum: to the root of rounding, which is enough
SAMPLES, LOWEST = 65, 8  # heights on a patch, and how many of their minima are refined


def slip(step: Step, one_sign: bool = False) -> Slip:
    """The state of a scene's contact after its Q and σ.

    With `one_sign`, slip is positive on one patch, whatever Q and σ, as in a layer of a memory.

    Raises ContactError where no zones of stick and slip answer.
    """
    P, f, Q, tau = step.normal_load, step.scene.friction, step.Q, step.tau
    if f == 0.0 or (Q == 0.0 == tau and "shear" in step.economy):
        return NoSlip(step.contact, f, step.full.patches)
    refuse_sliding(f, P, Q)
    along, one = math.copysign(1.0, Q), isinstance(step.full, OnePatch)
    if tau:
        refuse_stretch(step.scene.profile.period)
    if abs(Q) == f * P and "sliding" in step.economy:
        _, tilt = corrective_loads(step, along)
        return OneSignedSlip(step, along, Untouched(step.scene, tilt, step.full.patches))
    small = math.pi * step.contact.r * abs(tau) <= abs(Q)
    if one and (one_sign or small):
        found = _one_signed(step, 1.0 if one_sign else along)
        if not tau or isinstance(found.reduced, OnePatch) or found.fits:
            return found
    # Against Q only next to a sharp edge that holds, where the stick zone reaches it and all slip
    # is on the other side
    for sign in (along, -along) if one else (along,):
        tried = _fitting(step, sign)
        if tried is not None:
            return tried
    if one:
        return two_signed(step)
    raise _to_either_side(step)


def _one_signed(step: Step, sign: float) -> OneSignedSlip:
    return OneSignedSlip(step, sign, step.under(*corrective_loads(step, sign)))


def corrective_loads(step: Step, sign: float) -> tuple[float, float]:
    """The load and the tilt under which the stick zones of slip in the direction `sign` touch."""
    P, f, Q = step.normal_load, step.scene.friction, step.Q
    load = max(remaining(f, P, Q) if sign * Q >= 0.0 else P + abs(Q) / f, HARDLY * P)
    return load, step.full.edges.tilt - 2.0 * step.tau / (sign * f * step.scene.Estar)


def _fitting(step: Step, sign: float) -> OneSignedSlip | None:
    """Slip in one direction, if it fits."""
    if not step.tau:
        return _one_signed(step, sign)
    try:
        tried = _one_signed(step, sign)
        return tried if tried.fits else None
    except ContactError:
        return None


def refuse_stretch(period: float) -> None:
    """Refuse a bulk stress in a contact that repeats: the bodies fit in one period alone."""
    if math.isfinite(period):
        raise ContactError(
            f"a bulk stress stretches one of two bodies that meet every {period:.6g}, so that no "
            "periodic answer exists: leave it out, or add it to the stress afterwards if it "
            "strains both alike"
        )


def _to_either_side(step: Step) -> ContactError:
    unit = replace(step.scene, bulk_stress=1.0).tau
    return ContactError(
        f"bulk_stress = {step.tau / unit:.6g} makes patches slip to either side under "
        f"tangential_load = {step.Q:g}, which is solved on one patch only; lower the bulk stress "
        "or the change of tilt, or raise the tangential load"
    )


# -- the state -------------------------------------------------------------------------------------


class SlipZone(NamedTuple):
    """A rule on zones of slip of patches: p and |slip|/f there."""

    patches: Zones
    rule: Rule
    pressure: Array
    opening: Array


@dataclass(frozen=True, eq=False)
class OneSignedSlip(Slip):
    """Slip in the direction `sign` on all patches: q = sign f (p - p̂).

    reduced   the contact of p̂, of which only the edges are known from the start
    """

    step: Step
    sign: float
    reduced: Any

    @property
    def full(self) -> Touching:
        return self.step.full

    @property
    def kind(self) -> str:  # type: ignore[override]
        if isinstance(self.reduced, Untouched):
            return "sliding"
        return "one sign" if isinstance(self.full, OnePatch) else "one sign on all patches"

    @property
    def friction(self) -> float:  # type: ignore[override]
        return self.step.scene.friction

    @property
    def contact(self) -> Interval:  # type: ignore[override]
        return self.step.contact

    @property
    def period(self) -> float:
        return self.step.scene.profile.period

    @property
    def in_one_patch(self) -> bool:
        """Whether p and p̂ are in one patch each."""
        return isinstance(self.full, OnePatch) and isinstance(self.reduced, OnePatch)

    @cached_property
    def stick(self) -> tuple[tuple[float, float], ...]:  # type: ignore[override]
        """Per period those in the period of the patches."""
        zones, start = self.reduced.patches, self.full.patches[0][0]
        if self.in_one_patch:
            ((x1, x2),), ((c1, c2),) = self.full.patches, zones
            return ((max(c1, x1), min(c2, x2)),)
        if math.isinf(self.period):
            return zones
        turns = [math.floor((0.5 * (lo + hi) - start) / self.period) for lo, hi in zones]
        moved = ((k * self.period, zone) for k, zone in zip(turns, zones, strict=True))
        return tuple(sorted((lo - by, hi - by) for by, (lo, hi) in moved))

    @property
    def fits(self) -> bool:
        """Whether the stick zones lie within the patches, and |q| <= f p there."""
        room = WITHIN * 2.0 * self.contact.r
        wider = tuple((a - room, b + room) for a, b in self.full.patches)
        lo, hi = np.array(self.stick).T[..., None]
        share = np.sin(0.5 * np.pi * (np.arange(SCANNED) + 0.5) / SCANNED) ** 2
        x = (lo + (hi - lo) * share).ravel()
        p, corrective = self.full.pressure(x), self.corrective(x)
        most = 2.0 * p + WITHIN * p[np.isfinite(p)].max()
        return not left_over(self.reduced.patches, wider) and bool((corrective <= most).all())

    @property
    def corrective(self) -> Density:
        """p̂."""
        return self.reduced.pressure

    @property
    def parts(self) -> tuple[float, tuple[tuple[float, Density], ...]]:
        scale = self.sign * self.friction
        return scale, ((-scale, self.corrective),)

    @cached_property
    def shear(self) -> Density:
        scale, others = self.parts
        return superposed((scale, self.full.pressure), *others)

    @property
    def contacts(self) -> tuple[Any, ...]:
        return () if isinstance(self.reduced, OnePatch | Untouched) else (self.reduced,)

    @property
    def condition(self) -> float:  # type: ignore[override]
        if not self.in_one_patch:
            return 1.0
        return max(self.step.normal_load / self.reduced.edges.normal_load, 1.0)

    @cached_property
    def advancing(self) -> bool:  # type: ignore[override]
        """Whether the shear grows in the direction of slip beside all slip zones."""
        if self.step.tau == 0.0 or not self.stick:
            return True
        stuck = {e for zone in self.stick for e in zone}
        edges = {e for zone in self.full.patches for e in zone}
        for zones, still in ((self.full.patches, stuck), (self.stick, edges)):
            rate = Rate(zones, self.period, self.sign * self.step.Q, self.sign * self.step.tau)
            K, least = rate.K, -WITHIN * np.abs(rate.K).max()
            slips = [[e not in still for e in zone] for zone in zones]
            if (K[np.array(slips)] < least).any():
                return False
        return True

    def slip(self, x: Array) -> Array:
        out = np.where(np.isnan(x), np.nan, 0.0)
        inside = within(x, self.full.patches, self.period)
        if inside.any():
            out[inside] = self.sign * self.friction * self.reduced.gap(x[inside])
        return out

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        zones = left_over(self.full.patches, self.stick, self.period)
        return tuple((lo, hi, self.sign) for lo, hi in zones)

    @property
    def lengths(self) -> tuple[float, float]:
        """Those of the slip zones at the left edge and at the right one, of one patch.

        Halves of the contact where the bodies slide.
        """
        if isinstance(self.reduced, Untouched):
            return self.contact.r, self.contact.r
        outer, inner = self.contact, self.reduced.edges.contact
        left = (inner.x1 - outer.x1) + (inner.tail1 - outer.tail1)
        right = (outer.x2 - inner.x2) + (outer.tail2 - inner.tail2)
        return max(left, 0.0), max(right, 0.0)

    # -- integrals ---------------------------------------------------------------------------------

    @cached_property
    def energy(self) -> float:
        total = 0.0
        for _, rule, p, opening in self._zones():
            # rounding may put a node on a sharp edge or a corner
            total += float(rule.weight * np.where(np.isfinite(p), p, 0.0) @ opening)
        return self.friction**2 * total

    @cached_property
    def shift(self) -> float:
        total = 0.0
        for patches, rule, _, opening in self._zones():
            width = patches[-1][1] - patches[0][0]
            if width < self.period:
                flat = Rate(patches, self.period, 1.0, 0.0).density(rule)
            else:  # full contact
                flat = np.full(len(opening), 1.0 / width)
            total += float(rule.weight * flat @ opening)
        return self.sign * self.friction * total

    def _zones(self) -> Iterator[SlipZone]:
        if isinstance(self.full, OnePatch) and isinstance(self.reduced, OnePatch | Untouched):
            for right, length in enumerate(self.lengths):
                if length > 0.0:
                    yield self._beside(self.full, bool(right))
            return
        zones = left_over(self.full.patches, self.stick, self.period)
        rule = _rule(zones, np.array(self.full.pressure.breaks))
        p, opening = self.full.pressure(rule.x), self.reduced.gap(rule.x)
        yield SlipZone(self.full.patches, rule, p, opening)

    def _beside(self, full: OnePatch, right: bool) -> SlipZone:
        """The slip zone at an edge of one patch, which is the origin: it may be a few doubles."""
        c, near, reduced = self.contact, self.lengths[right], self.reduced
        stick = reduced.edges.contact.r if reduced.patches else 0.0
        # from the width of the stick zone, which the other length may not resolve
        far, rest = two_sum(near, 2.0 * stick)
        patch, inner = Interval(0.0, 2.0 * c.r), Interval(near, far, 0.0, rest)
        origin, zone = (c.x1, c.tail1), (0.0, near)
        if right:
            patch, inner = Interval(-patch.x2, 0.0), Interval(-far, -near, -rest, 0.0)
            origin, zone = (c.x2, c.tail2), (-near, 0.0)
        pressure, slope, _ = full.moved(patch, origin)
        *_, gap = reduced.moved(inner, origin)
        rule = _rule((zone,), slope.breaks)
        return SlipZone((patch[:2],), rule, pressure(rule.x), gap(rule.x))


def _rule(zones: Zones, breaks: Array) -> Rule:
    """A rule on zones, graded to their ends and to the breaks inside."""
    parts: list[tuple[float, float]] = []
    for lo, hi in zones:
        parts += pairwise([lo, *breaks[(breaks > lo) & (breaks < hi)].tolist(), hi])
    return Rule.graded(np.array(parts), OF_RULES if len(parts) <= FEW else OF_SERIES)


class Untouched:
    """The profile under no load: the gap is its height above its lowest point on some zones."""

    patches: tuple[tuple[float, float], ...] = ()
    pressure: Density = ZERO

    def __init__(self, scene: Scene, tilt: float, zones: Zones) -> None:
        self.profile, self.tilt = scene.profile, tilt
        self.lowest = min(self._lowest(lo, hi) for lo, hi in zones)

    def gap(self, x: Array) -> Array:
        return np.maximum(self._height(x) - self.lowest, 0.0)

    def moved(self, _: Interval, origin: tuple[float, float]) -> tuple[None, None, Any]:
        """The gap by distances from an origin."""
        return None, None, lambda distance: self.gap(origin[0] + distance)

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
