"""The derivative of the shear traction and of the zones of stick.

In sliding q = ± f p. In partial slip q = ± f (p - p̂), p̂ the pressure of the same profile under
P̂ = P - |Q|/f at the tilt of p less 2τ/(± f E*) (`friction.partial_slip`), so that

    δq = ± δf (p - p̂) ± f (δp - δp̂)

and the edges of the contact of p̂ are those of the stick zones.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

from sie.errors import ContactError
from sie.friction.partial_slip import OneSignedSlip
from sie.patches.friction import PatchSlip
from sie.traction.base import Density
from sie.traction.combination import superposed

from .contact_rate import ContactRate, Given, contact_rate
from .parameters import Parameter

Zones = tuple[tuple[float, float], ...]
Terms = tuple[tuple[float, Density], ...]


class ShearRate(NamedTuple):
    """The derivative of the shear q = Σ c p_i.

    stick    that of the stick zones
    terms    pairs (c, p_i)
    rates    pairs whose sum is the derivative
    """

    stick: Zones
    terms: Terms = ()
    rates: Terms = ()

    @property
    def shear(self) -> Density:
        """That of q."""
        return superposed(*self.rates)


def shear_rate(solution: Any, by: Parameter, contact: ContactRate) -> ShearRate:
    """The derivative of the shear of a solution. ContactError where it has none."""
    scene, f = solution.scene, solution.scene.friction
    if not f:
        return ShearRate(())
    if not solution.sheared:
        if by.tangential_load or by.tau:
            raise _begins("Q and the bulk stress are 0")
        return ShearRate(contact.patches)
    state: Any = solution.tangential
    found: Any
    density: Density
    if scene.sliding:
        return _sum((), scene.sliding, ((f, solution.pressure, contact.pressure),), by.friction)
    if scene.slides:
        raise _begins("|Q| = f P")
    if isinstance(state, OneSignedSlip):
        found, density = state.found, state.corrective
    elif isinstance(state, PatchSlip):
        found, density = state.corrective, state.corrective.pressure
    else:
        raise ContactError(
            "the bulk stress makes the two edges slip in opposite directions, where derivatives of "
            "the shear are not known: lower the bulk stress, or raise the tangential load"
        )
    sign, E, Q = state.sign, scene.Estar, solution.tangential_load
    g, strain = by.contact.modulus, -2.0 * scene.tau / (sign * f * E)
    change = replace(
        by.contact,
        load=contact.load - sign * (by.tangential_load - Q * by.friction / f) / f,
        tilt=contact.tilt - 2.0 * by.tau / (sign * f * E) - strain * (by.friction / f + g),
    )
    rate = contact_rate(found, density, scene.profile, change, Given(False, False))
    both = (f, solution.pressure, contact.pressure), (-f, density, rate.pressure)
    return _sum(rate.patches, sign, both, by.friction)


def _sum(
    stick: Zones, sign: float, parts: tuple[tuple[float, Density, Density], ...], friction: float
) -> ShearRate:
    """The shear of pressures times ± f, with their derivatives and that of f."""
    terms = tuple((sign * f, p) for f, p, _ in parts)
    rates = tuple((sign * f, rate) for f, _, rate in parts)
    by_friction = tuple((sign * math.copysign(1.0, f) * friction, p) for f, p, _ in parts)
    return ShearRate(stick, terms, rates + by_friction)


def _begins(where: str) -> ContactError:
    return ContactError(
        f"{where}, where slip begins or a stick zone vanishes, and derivatives are one-sided: give "
        "a tangential load between 0 and f P"
    )
