"""The certificate of a shear on several patches, measured at places that no solver used.

q is a sum of pressures, each with multiples, on patches of their own. Each of them is integrated by
the rule of the certificate of its pressure; per period the kernel is (π/λ) cot(π(x - t)/λ).

residual      max |1/π PV∫q(t)/(x - t) dt - τ| / max|q|     where the patches never slipped
equilibrium   |∫q dx - Q| / ∫|q| dx
excess        largest |q| - f p, and of ||q| - f p| in slip zones, over the peak of f p
opposing      smallest slip in the direction of q over the largest
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.friction.slip_state import Slip
from sie.numerics.interval import EPS
from sie.numerics.zones import Zones, within
from sie.patches.certificate import measured_on, principal_value
from sie.patches.chord import Chord
from sie.patches.density import PatchPressure
from sie.patches.full import FullPressure
from sie.patches.result import PatchCertificate
from sie.profiles.slope import Slope
from sie.traction.base import Density
from sie.traction.of_slope import SlopeDensity

from .quadrature import composite_rule
from .result import ShearCertificate
from .shear_check import excess, finite, opposing, places_between

Array = NDArray[np.float64]

PLACES = 24  # at which the equation is measured in one patch or in full contact
BESIDE = 0.05  # of the distance of two nodes: a place closer to one divides rounding by that
SLIPS = 400  # places at which the direction of slip is measured
EXPLAINED = 16.0  # times rounding, that a certificate of a pressure allows for


class Part(NamedTuple):
    """A multiple of a pressure: places, weights and pressures of a rule."""

    factor: float
    density: Density
    x: Array
    weight: Array
    p: Array

    def principal_value(self, x: Array, chord: Chord) -> Array:
        """PV∫p(t)/(x - t) dt/π at x, which are on the patches of it."""
        if isinstance(self.density, PatchPressure):
            points, patch, _ = self.density.placed(x)
            rule = measured_on(self.density)[0]
            return principal_value(self.density, (rule, self.p), (points, patch, self.density(x)))
        kernel = chord.kernel(chord.difference(x[:, None] - self.x))
        value, whole, (x1, x2) = self.density(x), np.zeros(len(x)), self.density.interval
        if not chord.periodic:
            whole = value * np.log((x - x1) / (x2 - x))
        return np.asarray((((self.p - value[:, None]) * kernel) @ self.weight + whole) / np.pi)


def shear_certificate(
    state: Slip,
    pressure: Density,
    loads: tuple[float, float],
    slope: Slope,
    of_pressures: Sequence[PatchCertificate],
) -> ShearCertificate:
    """Measure a state; `loads` are Q and τ, and `of_pressures` certify the pressures in q."""
    f, chord = state.friction, Chord(_period(pressure))
    parts = [_part(factor, d, slope) for factor, d in state.shear.bases]
    own = next((t for t in parts if t.density is pressure), _part(f, pressure, slope))
    p, q = f * own.p, finite(np.asarray(sum(_values(t, own) for t in parts)) + np.zeros(own.x.size))
    # q may be made of another pressure, whose edges and places are rounded apart from those of p
    rounding = p * np.minimum(np.spacing(np.abs(own.x)) / _from_edges(own.x, pressure, chord), 1.0)
    q_near_p = np.sign(q) * np.clip(p, np.abs(q) - rounding, np.abs(q) + rounding)
    # without shear what is missed is compared with f p
    scale = np.abs(q) if q.any() else p
    size, peak = float(own.weight @ scale), float(scale.max())
    at = _places(parts, chord)
    missed = np.full(len(at), -loads[1])
    for part in parts:
        missed += part.factor * part.principal_value(at, chord)
    force = sum(part.factor * float(part.weight @ part.p) for part in parts)
    # what the pressures that q is the difference of are rounded by
    digits = max([EPS, *(c.measured_to / EXPLAINED for c in of_pressures)])
    of_force = sum(abs(part.factor) * float(part.weight @ part.p) for part in parts)
    highest = sum(abs(part.factor) * float(part.p.max()) for part in parts)
    some = slice(None, None, max(own.x.size // SLIPS, 1))
    return ShearCertificate(
        residual=float(np.abs(missed).max(initial=0.0)) / peak,
        equilibrium=abs(force - loads[0]) / size,
        excess=excess(state, state.contact, own.x, p, q_near_p) / float(p.max()),
        opposing=opposing(state, state.slip_now(own.x[some]), own.x[some]),
        abscissae=digits * max(of_force / size, highest / peak),
        condition=state.condition,
        advancing=state.advancing,
        kind=state.kind,
        tol=min(c.tol for c in of_pressures),
    )


def _from_edges(x: Array, pressure: Density, chord: Chord) -> Array:
    """The distances from the nearest edges of patches, of an ulp at least."""
    ends = np.array(_zones(pressure)).ravel()
    apart = np.abs(chord.difference(x[:, None] - ends)).min(axis=1, initial=np.inf)
    return np.asarray(np.maximum(apart, np.spacing(np.abs(x))))


def _period(pressure: Density) -> float:
    return pressure.period if isinstance(pressure, (PatchPressure, FullPressure)) else np.inf


def _part(factor: float, density: Density, slope: Slope) -> Part:
    if isinstance(density, PatchPressure):
        rule = measured_on(density)[0]
        p = finite(density.at_points(rule.points, rule.patch, rule.piece))
        return Part(factor, density, rule.points.x, rule.weight, p)
    if isinstance(density, SlopeDensity):
        x, _, weight, *_ = composite_rule(density.contact, slope)
    else:
        assert isinstance(density, FullPressure)
        x, weight = density.rule
    return Part(factor, density, x, weight, finite(density(x)))


def _values(part: Part, own: Part) -> Array:
    """What a part of the shear is at the places of another."""
    return part.factor * (own.p if part.density is own.density else finite(part.density(own.x)))


def _places(parts: Sequence[Part], chord: Chord) -> Array:
    """Places that never slipped, on the patches of all parts and beside the nodes of all."""
    zones = [_zones(part.density) for part in parts]
    if not parts or not all(zones):
        return np.zeros(0)
    lightest = min(parts, key=lambda part: part.density.resultant)
    x = _between_nodes(lightest)
    kept = np.logical_and.reduce([within(x, zone, chord.period) for zone in zones])
    for part in parts:
        nodes = part.x
        if chord.periodic:
            nodes = x[0] + chord.difference(nodes - x[0])
            nodes = np.concatenate([nodes - chord.period, nodes, nodes + chord.period])
        nodes = np.unique(nodes)
        k = np.clip(np.searchsorted(nodes, x), 1, len(nodes) - 1)
        apart = np.minimum(np.abs(x - nodes[k - 1]), np.abs(nodes[k] - x))
        kept &= apart > BESIDE * (nodes[k] - nodes[k - 1])
    return np.asarray(x[kept])


def _between_nodes(part: Part) -> Array:
    """Places on the patches of a part, as its certificate has them."""
    if isinstance(part.density, PatchPressure):
        return np.asarray(measured_on(part.density)[1].points.x)
    return places_between(part.density.interval, np.unique(part.x), 1, PLACES)


def _zones(density: Density) -> Zones:
    if isinstance(density, (PatchPressure, FullPressure)):
        return density.patches
    return () if not density.resultant else (density.interval,)
