"""The derivative of the shear traction and of the zones of stick.

In sliding q = ± f p. In partial slip q = ± f (p - p̂), p̂ the pressure of the same profile under
P̂ = P - |Q|/f at the tilt of p less 2τ/(± f E*) (`friction.partial_slip`), so that

    δq = ± δf (p - p̂) ± f (δp - δp̂)

and the edges of the contact of p̂ are those of the stick zones.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

from sie.contact.pressure import OnePatch
from sie.errors import ContactError
from sie.friction.partial_slip import OneSignedSlip
from sie.traction.base import Density
from sie.traction.combination import superposed

from .contact_rate import Change, ContactRate, contact_rate

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


def shear_rate(solution: Any, change: Change, contact: ContactRate) -> ShearRate:
    """The derivative of the shear of a solution. ContactError where it has none."""
    scene, f = solution.scene, solution.scene.friction
    if not f:
        return ShearRate(())
    if not solution.sheared:
        if change.tangential_load or change.tau:
            raise _begins("Q and the bulk stress are 0")
        return ShearRate(contact.patches)
    if scene.sliding:
        return _sum((), scene.sliding * f, ((1.0, solution.pressure, contact.pressure),), change, f)
    if scene.slides:
        raise _begins("|Q| = f P")
    state: Any = solution.tangential
    if not isinstance(state, OneSignedSlip):
        raise ContactError(
            "the bulk stress makes the two edges slip in opposite directions, where derivatives of "
            "the shear are not known: lower the bulk stress, or raise the tangential load"
        )
    reduced, density = state.reduced, state.corrective
    found = reduced.normal if isinstance(reduced, OnePatch) else reduced
    along, Q, gained = state.sign * f, solution.tangential_load, change.friction / f
    twice = 2.0 / (along * scene.Estar)
    under = replace(
        change,
        load=contact.load - (change.tangential_load - Q * gained) / along,
        tilt=contact.tilt - twice * (change.tau - scene.tau * (gained + change.modulus)),
    )
    rate = contact_rate(found, density, scene.profile, under)
    both = (1.0, solution.pressure, contact.pressure), (-1.0, density, rate.pressure)
    return _sum(rate.patches, along, both, change, f)


def _sum(
    stick: Zones,
    along: float,
    parts: tuple[tuple[float, Density, Density], ...],
    change: Change,
    f: float,
) -> ShearRate:
    """The shear ± f Σ ± p_i, with the derivatives of the p_i and that of f."""
    terms = tuple((along * c, p) for c, p, _ in parts)
    by_friction = tuple((c * change.friction / f, p) for c, p in terms)
    return ShearRate(stick, terms, tuple((along * c, rate) for c, _, rate in parts) + by_friction)


def _begins(where: str) -> ContactError:
    return ContactError(
        f"{where}, where slip begins or a stick zone vanishes, and derivatives are one-sided: give "
        "a tangential load between 0 and f P"
    )
