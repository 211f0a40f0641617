"""Partial slip: from a pressure and a load step to stick zones, slip zones and shear, at β = 0.

After the normal load P, at constant P, the tangential load Q and the bulk stress σ are applied
(τ = `Scene.tau`, σ/4 for similar bodies):

    |q| <= f p,      1/π PV∫q/(x - t) dt = τ and slip 0 in the stick zone,
    q = ± f p, in the direction of slip, in the slip zones

slip(x) is the tangential displacement of the indenter relative to the body, positive along +x.
Where it is positive so is q, which acts on the body. Loads and inequalities distinguish four
states:

    stick               Q = 0 = σ                       no shear
    incipient sliding   |Q| = f P                       q = ± f p, no second solve
    one-signed slip     π r |τ| <= |Q|, or if it fits   q = ± f (p - p̂), slip = ± f gap^
    two-signed slip     otherwise                       opposite slip beside the two edges

In one-signed slip p̂, the corrective pressure, is that of the same profile, tilted by -2τ/(± f E*),
under the reduced load P - |Q|/f, and gap^ is the gap beside that contact. This is Cattaneo's and
Mindlin's superposition for any profile (Ciavarella 1998; Jäger 1998): subtracting the equations (1)
and (12) leaves the normal problem for p̂ and for the slip. It holds where the contact of p̂ lies
within that of p and p̂ <= 2p there. Two-signed slip is one finite step of the engine (`state_slip`).

Along the step dq = [dQ/π - dτ (x - c)]/sqrt(ρ² - (x - c)²) in the stick zone of half-width ρ. With
π r |τ| <= |Q|, r the half-width of the contact, slip is one-signed and the slip zones only grow.
Where they would have to retreat on the way (r replaced by ρ, the wrong sign), the state given is
that of the friction law in total displacements, as in Nowell & Hills (1987), and `advancing` is
False.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.contact.gap import gap
from sie.errors import ContactError
from sie.numerics.graded_rule import graded, on_panels
from sie.numerics.interval import EPS, Interval, two_sum
from sie.problem.coverage import refuse_sliding, remaining
from sie.profiles.lowest_points import lowest_points, raised
from sie.profiles.resolution import refined
from sie.traction.combination import superposed

from .slip_state import NoSlip, Slip, Step
from .state_slip import two_signed

if TYPE_CHECKING:
    from sie.contact.known_contact import Normal
    from sie.profiles.slope import Slope
    from sie.traction.base import Density
    from sie.traction.of_slope import SlopeDensity

Array = NDArray[np.float64]

# Violations of |q| <= f p below this fraction of f p are rounding.
TOLERATED = 1e-10
SCANNED = 400
# Where "sliding" is switched off in the economy, the corrective pressure carries this fraction of
# P: nothing, but it is solved for.
HARDLY = 1e-40
LEVELS = 26  # of a rule towards a break, and towards the end of a zone: its last panel is rounding


def slip(step: Step, one_sign: bool = False) -> Slip:
    """The state of a scene's contact after its Q and σ.

    With `one_sign`, slip is positive at both edges, whatever Q and σ, as in a layer of a memory.

    Raises ContactError where no single stick zone answers.
    """
    P, f, Q, tau = step.normal_load, step.scene.friction, step.Q, step.tau
    if f == 0.0 or (Q == 0.0 == tau and "shear" in step.economy):
        return NoSlip(step.pressure.contact, f)
    refuse_sliding(f, P, Q)
    if abs(Q) == f * P and "sliding" in step.economy:
        sign = math.copysign(1.0, Q)
        return Sliding(step, sign, step.slope.tilted(_tilt_of_strain(step, sign)))
    if one_sign:
        return _one_signed(step, 1.0)
    if math.pi * step.pressure.contact.r * abs(tau) <= abs(Q):
        return _one_signed(step, math.copysign(1.0, Q))
    # Against Q only next to a sharp edge that holds, where the stick zone reaches it and all slip
    # is on the other side
    for sign in (math.copysign(1.0, Q), -math.copysign(1.0, Q)):
        tried = _fitting(step, sign)
        if tried is not None:
            return tried
    return two_signed(step)


def _tilt_of_strain(step: Step, sign: float) -> float:
    """The tilt -2τ/(± f E*) that stands for a strain in the corrective problem."""
    return -2.0 * step.tau / (sign * step.scene.friction * step.scene.Estar)


def _one_signed(step: Step, sign: float) -> OneSignedSlip:
    """Slip in the direction `sign`.

    It follows from the normal problem of the tilted profile under the reduced load.
    """
    found = step.contact_under(*corrective_loads(step, sign))
    return OneSignedSlip(step, sign, found)


def corrective_loads(step: Step, sign: float) -> tuple[float, float]:
    """The load and the tilt under which the stick zone of slip in the direction `sign` touches."""
    P, f, Q = step.normal_load, step.scene.friction, step.Q
    load = max(remaining(f, P, Q) if sign * Q >= 0.0 else P + abs(Q) / f, HARDLY * P)
    return load, step.normal.edges.tilt + _tilt_of_strain(step, sign)


def _fitting(step: Step, sign: float) -> OneSignedSlip | None:
    """Slip in one direction although the strain is large, if it fits.

    It fits if the stick zone is within the contact and |q| <= f p there.
    """
    try:
        tried = _one_signed(step, sign)
        _ = tried.corrective
    except ContactError:
        return None
    outer, inner = tried.contact, tried.corrective.contact
    slack = 4.0 * EPS * (outer.r + abs(outer.m))
    if inner.x1 < outer.x1 - slack or inner.x2 > outer.x2 + slack:
        return None
    x = inner.m + inner.r * np.cos(np.pi * (np.arange(SCANNED) + 0.5) / SCANNED)
    p = step.pressure(x)
    return (
        tried
        if (
            tried.corrective(x) <= (2.0 + TOLERATED) * p + TOLERATED * p[np.isfinite(p)].max()
        ).all()
        else None
    )


# -- the states ------------------------------------------------------------------------------------


class Edge(NamedTuple):
    """An edge of the contact as the origin of distances, which keep their digits next to it."""

    side: float  # -1 at the left edge, 1 at the right one
    at: float
    tail: float

    def moved(self, slope: Slope) -> Slope:
        """A slope with the edge as its origin."""
        return slope.shifted(-self.at).shifted(-self.tail)


class SlipZone(NamedTuple):
    """A rule on a slip zone: distances from both edges of the contact, dx, p dx and |slip|/f."""

    from_edge: Array
    from_other_edge: Array
    weight: Array
    force: Array
    opening: Array


@dataclass(frozen=True, eq=False)
class Slipping(Slip):
    """Slip in one direction: sign f opening(x), integrated by distances from the edges."""

    step: Step
    sign: float

    @property
    @abstractmethod
    def lengths(self) -> tuple[float, float]:
        """Those of the slip zones at the left edge and at the right one."""

    @abstractmethod
    def _opening(self, distance: Array, edge: Edge) -> Array:
        """|slip|/f at these distances from an edge."""

    @property
    def pressure(self) -> SlopeDensity:
        return self.step.pressure

    @property
    def friction(self) -> float:  # type: ignore[override]
        return self.step.scene.friction

    @property
    def contact(self) -> Interval:  # type: ignore[override]
        return self.pressure.contact

    @property
    def edges(self) -> tuple[Edge, Edge]:
        c = self.contact
        return Edge(-1.0, c.x1, c.tail1), Edge(1.0, c.x2, c.tail2)

    def slip(self, x: Array) -> Array:
        out = np.zeros(x.shape)
        if not x.size:
            return out
        from_edge = self.contact.from_left(x), self.contact.from_right(x)
        nearer_left = from_edge[0] - self.lengths[0] < from_edge[1] - self.lengths[1]
        for edge, distance, side in zip(
            self.edges, from_edge, (nearer_left, ~nearer_left), strict=True
        ):
            at = side & (distance >= 0.0)
            if at.any():
                out[at] = self.sign * self.friction * self._opening(distance[at], edge)
        return out

    @cached_property
    def zones(self) -> list[SlipZone]:
        return list(self._zones())

    def _zones(self) -> Iterator[SlipZone]:
        width = 2.0 * self.contact.r
        for edge, length in zip(self.edges, self.lengths, strict=True):
            if length <= 0.0:
                continue
            seen = Interval(-width, 0.0) if edge.side > 0.0 else Interval(0.0, width)
            pressure = self.pressure.moved(seen, -edge.at, -edge.tail)
            breaks = -edge.side * edge.moved(self.step.slope).breaks
            from_stick, from_edge, weight = _rule(length, breaks)
            p = pressure(-edge.side * from_edge)
            p[~np.isfinite(p)] = 0.0  # on a break
            opening = self._opening(from_edge, edge)
            yield SlipZone(from_edge, width - length + from_stick, weight, weight * p, opening)

    @property
    def energy(self) -> float:
        return self.friction**2 * float(sum(zone.force @ zone.opening for zone in self.zones))

    @property
    def shift(self) -> float:
        total = 0.0
        for z in self.zones:
            total += float((z.weight / np.sqrt(z.from_edge * z.from_other_edge)) @ z.opening)
        return self.sign * self.friction * total / math.pi

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        x1, x2 = self.pressure.interval
        if not self.stick:
            return ((x1, x2, self.sign),)
        (c1, c2), lengths = self.stick[0], self.lengths
        both = ((x1, c1, self.sign), (c2, x2, self.sign))
        return tuple(z for z, length in zip(both, lengths, strict=True) if length > 0.0)


def _rule(length: float, breaks: Array) -> tuple[Array, Array, Array]:
    """Distances from the stick zone and from the edge, and weights, over a slip zone.

    They are edge - length cos²(ψ/2), in which a smooth edge and a sharp one are harmless, graded
    towards the stick zone and towards breaks, whose distances from the edge are given.
    """
    inner = np.sort(breaks[(breaks > 0.0) & (breaks < length)])
    at_breaks = 2.0 * np.arctan2(np.sqrt(length - inner), np.sqrt(inner))[::-1]
    marks, ratios = np.concatenate(([0.0], at_breaks, [np.pi])), graded(LEVELS)
    cuts = [marks]
    for k, (lo, hi) in enumerate(pairwise(marks)):
        cuts += [lo + (hi - lo) * ratios, lo + (hi - lo) * np.array([0.5, 0.75])]
        if k < len(marks) - 2:
            cuts.append(hi - (hi - lo) * ratios[:-1])
    angle, step = on_panels(np.unique(np.concatenate(cuts)))
    half = 0.5 * angle.ravel()
    weight = step.ravel() * length * np.sin(half) * np.cos(half)
    return length * np.sin(half) ** 2, length * np.cos(half) ** 2, weight


@dataclass(frozen=True, eq=False)
class Sliding(Slipping):
    """Incipient sliding, |Q| = f P: the slip is that at which the stick zone vanishes.

    `unloaded` is the slope of that limit.
    """

    unloaded: Slope
    kind = "sliding"
    stick = ()

    @cached_property
    def shear(self) -> Density:
        return superposed((self.sign * self.friction, self.pressure))

    @cached_property
    def _touch(self) -> tuple[float, float]:
        return lowest_points(self._resolved)

    @cached_property
    def _resolved(self) -> Slope:
        """The slope, resolved on the contact alone.

        A strain may move the lowest point of the whole profile out of the contact; then an edge
        slips last.
        """
        x1, x2 = self.pressure.interval
        return refined(self.unloaded.within(x1, x2), x1, x2, EPS)

    @property
    def lengths(self) -> tuple[float, float]:
        (z1, z2), width = self._touch, 2.0 * self.contact.r
        left, right = self.contact.from_left(z1), self.contact.from_right(z2)
        return min(max(left, 0.0), width), min(max(right, 0.0), width)

    def _opening(self, distance: Array, edge: Edge) -> Array:
        z1, z2 = ((z - edge.at) - edge.tail for z in self._touch)
        return raised(edge.moved(self._resolved), (z1, z2), -edge.side * distance)


@dataclass(frozen=True, eq=False)
class OneSignedSlip(Slipping):
    """Slip in one direction at both edges: q = sign f (p - p̂).

    Only the edges of the reduced contact are known from the start.
    """

    found: Normal
    kind = "one sign"

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:  # type: ignore[override]
        inner, outer = self.found.edges.contact, self.contact
        return ((max(inner.x1, outer.x1), min(inner.x2, outer.x2)),)

    @cached_property
    def corrective(self) -> SlopeDensity:
        """p̂."""
        return self.step.pressure_on(self.found)

    @property
    def parts(self) -> tuple[float, tuple[tuple[float, Density], ...]]:
        scale = self.sign * self.friction
        return scale, ((-scale, self.corrective),)

    @cached_property
    def shear(self) -> Density:
        scale, others = self.parts
        return superposed((scale, self.pressure), *others)

    @property
    def condition(self) -> float:  # type: ignore[override]
        P, left = self.step.normal_load, self.found.edges.normal_load
        return max(P / left, 1.0)

    @property
    def advancing(self) -> bool:  # type: ignore[override]
        """Whether s (Q ∓ π ρ τ) >= 0 beside both ends, from the first stick zone to the last."""
        Q, strain = self.step.Q, math.pi * self.step.tau
        return all(
            length == 0.0 or self.sign * (Q - outward * strain * rho) >= 0.0
            for length, outward in zip(self.lengths, (-1.0, 1.0), strict=True)
            for rho in (self.contact.r, self.found.edges.contact.r)
        )

    @property
    def lengths(self) -> tuple[float, float]:
        outer, inner = self.contact, self.found.edges.contact
        left = (inner.x1 - outer.x1) + (inner.tail1 - outer.tail1)
        right = (outer.x2 - inner.x2) + (outer.tail2 - inner.tail2)
        return max(left, 0.0), max(right, 0.0)

    def _opening(self, distance: Array, edge: Edge) -> Array:
        """The gap beside the contact of p̂, in the frame of an edge."""
        near = self.lengths[edge.side > 0.0]
        # from the width of the stick zone, which the other length may not resolve
        far, rest = two_sum(-near, -2.0 * self.corrective.contact.r)
        ends = Interval(far, -near, rest, 0.0)
        if edge.side < 0.0:
            ends = Interval(near, -far, 0.0, -rest)
        density = self.corrective.moved(ends, -edge.at, -edge.tail)
        slope = edge.moved(self.found.slope(self.step.scene.profile))
        return gap(-edge.side * distance, density, slope)
