"""Stick and slip on several patches at β = 0: Q and a bulk stress in proportion, after P.

    q = ± f (p - p*)

p* is the pressure of the same profile under P* = P - |Q|/f at the tilt of p. Its patches are the
stick zones; a patch of p without one in p* slides all over (Ciavarella 1998; Jäger 1998). One rigid
shift of all patches is for q what one approach is for p. At equal tilt p* <= p, and the patches of
p* lie in those of p, so that the slip

    g = ± f gap*                          gap* that of p*, on the patches of p

has one sign everywhere. A bulk stress tilts the profile of p* by ∓2τ/(f E*) over all patches: then
both are verified.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.states import Slip
from sie.numerics import chebyshev
from sie.numerics.interval import Interval
from sie.problem.scene import Scene
from sie.traction.base import ZERO, Density
from sie.traction.combination import superposed

from .answer import SeveralPatches, answered, whole
from .full import FullContact
from .measure import edge_ratio
from .newton import punch
from .of_scene import changed, problem_of
from .solver import contact

Array = NDArray[np.float64]

NODES = 40  # between two edges of patches and stick zones
WITHIN = 1e-9  # of the width of all patches, and of the peak: by less p* may exceed p
KIND = "one sign on all patches"


class PatchSlip(Slip):
    """Zones of stick and slip on all patches."""

    kind = KIND

    def __init__(
        self, scene: Scene, full: SeveralPatches | FullContact, tangential_load: float, tau: float
    ) -> None:
        self.scene, self.full = scene, full
        self.friction = scene.friction
        self.sign = 1.0 if tangential_load > 0.0 else -1.0
        self.tangential_load, self.tau = tangential_load, tau
        self.contact = Interval(*full.pressure.interval)

    @cached_property
    def corrective(self) -> SeveralPatches | FullContact | None:
        """p*; None in full sliding."""
        scene, Q, f = self.scene, self.tangential_load, self.scene.friction
        assert scene.normal_load is not None
        if scene.slides:
            return None
        if self.tau != 0.0 and scene.profile.period < np.inf:
            raise ContactError(
                f"bulk_stress = {scene.bulk_stress:g} in one of two bodies that meet "
                "periodically has no periodic "
                "answer: leave it out, or give it to both bodies as a stress afterwards"
            )
        if Q == 0.0:
            raise ContactError(
                f"bulk_stress = {scene.bulk_stress:g} without tangential_load makes the patches "
                "slip both ways: "
                "that is not covered on several patches; give tangential_load"
            )
        G = 0.5 * scene.Estar
        left = scene.normal_load - abs(Q) / f
        tilt = self.full.edges.tilt - self.sign * self.tau / (f * G)
        problem = problem_of(replace(scene, moment=None, tilt=0.0))
        problem = changed(problem, load=left / G, tilt=tilt, moment=None)
        lighter = replace(scene, normal_load=left, moment=None, tangential_load=0.0)
        full = whole(problem, lighter)
        if full is not None:
            return full
        reduced = answered(problem, contact(problem), lighter)
        if self.tau != 0.0:
            self._verify(reduced)
        return reduced

    def _verify(self, reduced: SeveralPatches) -> None:
        inner, outer = reduced.pressure, self.full.pressure
        room = WITHIN * (self.contact.x2 - self.contact.x1)
        inside = all(
            any(a - room <= lo and hi <= b + room for a, b in outer.patches)
            for lo, hi in inner.patches
        )
        k = inner.operator.panels
        x = k.points.x.ravel()
        p, p_star = outer(x), inner(x)
        with np.errstate(invalid="ignore"):
            excess = np.max(
                np.where(np.isfinite(p), p_star - p, 0.0), initial=0.0
            ) > WITHIN * np.max(p[np.isfinite(p)])
        if not inside or excess:
            raise ContactError(
                f"bulk_stress = {self.scene.bulk_stress:g} makes the patches slip both ways under "
                f"tangential_load = {self.tangential_load:g}: that is not covered on several "
                "patches; "
                "lower the bulk stress or raise the tangential load"
            )

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:  # type: ignore[override]
        return () if self.corrective is None else self.corrective.patches

    @cached_property
    def shear(self) -> Density:
        f = self.sign * self.friction
        inner = ZERO if self.corrective is None else self.corrective.pressure
        return superposed((f, self.full.pressure), (-f, inner))

    def slip(self, x: Array) -> Array:
        """g at x (1-d): 0 in stick and beside the patches."""
        a, b = np.array(self.full.patches).T
        period = self.scene.profile.period
        at = x - period * np.floor((x - a[0]) / period) if period < np.inf else x
        k = np.clip(np.searchsorted(a, at, side="right") - 1, 0, len(a) - 1)
        inside = (at >= a[k]) & (at <= b[k])
        out = np.where(np.isnan(x), np.nan, 0.0)
        if self.corrective is None:
            raise ContactError(
                "all patches slide: how far is not determined; lower tangential_load below f P"
            )
        if inside.any():
            out[inside] = self.sign * self.friction * self.corrective.gap(x[inside])
        return out

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        """The parts of the patches beside the stick zones, all slipping one way."""
        zones = []
        for a, b in self.full.patches:
            inner = [zone for zone in self.stick if a <= zone[0] and zone[1] <= b]
            ends = [a, *(end for zone in inner for end in zone), b]
            zones += [
                (lo, hi, self.sign) for lo, hi in zip(ends[::2], ends[1::2], strict=True) if lo < hi
            ]
        return tuple(zones)

    @cached_property
    def energy(self) -> float:
        x, weight = self._rule()
        return float(self.friction * (weight * self.full.pressure(x)) @ np.abs(self.slip(x)))

    @cached_property
    def shift(self) -> float:
        """∫ slip dμ, μ the pressure of a flat punch on all patches under a unit load."""
        if isinstance(self.full, FullContact):
            x, weight = self._rule()
            return float(weight @ self.slip(x)) / self.scene.profile.period
        o = self.full.found.operator
        P = o.patches
        unit = punch(o)
        x, weight = self._rule()
        points, k, _ = self.full.pressure.placed(x)
        T, _ = o.root(k, points)
        rho = edge_ratio(P, np.arange(P.number))[k]
        D = -(
            unit * rho / P.chord.apart(points.anchor[:, None] - P.edges, points.offset[:, None])
        ).sum(axis=1)
        return float((weight * np.abs(T) * D / np.pi) @ self.slip(x))

    def _rule(self) -> tuple[Array, Array]:
        """Places and weights on the slip zones, in the angle between neighbouring edges."""
        g, w = chebyshev.gauss_legendre(NODES)
        xs, weights = [], []
        for a, b in self.full.patches:
            cuts = {a, b} | {e for zone in self.stick for e in zone if a < e < b}
            ends = np.array(sorted(cuts))
            angle = np.pi * g
            half = 0.5 * np.diff(ends)[:, None]
            xs.append((ends[:-1, None] + 2.0 * half * np.sin(0.5 * angle) ** 2).ravel())
            weights.append((half * np.sin(angle) * np.pi * w).ravel())
        return np.concatenate(xs), np.concatenate(weights)
