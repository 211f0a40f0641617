"""The derivative of a contact and its shear, for a change of profile, loads, friction and bodies.

With E* fixed, the pressure p = L[h'] on the contact is linear in h', and moving an edge adds a
square-root singularity there. So for any change of h', P and the tilt the derivative of p is the
inversion of δh' on the same contact, of any index,

    δp = L[δh'] + k1/2 sqrt((x2 - x)/(x - x1)) + k2/2 sqrt((x - x1)/(x2 - x)),

whose k1, k2 follow from ∫δh'/w dt and from δP as those of a punch with two corners. The edges move
as the singularities ask (`contact.edges`, with G = E*/2):

    δx2 = (δP/G - r K2[δh'])/(r JR),          δx1 = -(δP/G - r K1[δh'])/(r JL)

Where the half-width is given in place of the load, or the moment in place of the tilt, δP and the
change of the tilt follow from two linear equations. On several patches the charges at the edges
come from the linear equations of Newton's method (`patches.edge_charges`). A change of E* at a
given load is one of P by -P δE*/E*, of a pressure that is then scaled.

In sliding q = ± f p. In partial slip q = ± f (p - p̂), p̂ the pressure of the same profile under
P̂ = P - |Q|/f at the tilt of p less 2τ/(± f E*) (`friction.partial_slip`), so that

    δq = ± δf (p - p̂) ± f (δp - δp̂)

and the edges of the contact of p̂ are those of the stick zones.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.contact.edge_integrals import EdgeIntegrals, edge_integrals
from sie.contact.known_contact import Edges, Normal
from sie.contact.pressure import OnePatch, slope_series
from sie.errors import ContactError
from sie.friction.partial_slip import OneSignedSlip
from sie.patches.answer import SeveralPatches
from sie.patches.density import PatchPressure
from sie.patches.newton import response as response_of_patches
from sie.profiles.base import Profile
from sie.profiles.of_profile import of_profile
from sie.profiles.resolution import accuracy_for, refined
from sie.profiles.slope import polynomial_slope
from sie.traction.base import Density
from sie.traction.combination import superposed
from sie.traction.of_slope import SlopeDensity, TransformDensity
from sie.traction.on_panels import PanelDensity
from sie.traction.panels import Panels
from sie.traction.piece_quadrature import Geometry

from .parameters import Change

Array = NDArray[np.float64]
Zones = tuple[tuple[float, float], ...]
Terms = tuple[tuple[float, Density], ...]
TOLERANCE = 1e-13  # to which a direction is resolved on a contact
RESOLVED = 1e-15  # ... and on patches
NARROWEST = 1e-9  # of the contact: patches and gaps narrower than that are about to vanish
CORNER = 1e-9  # half-widths: an edge so near to a corner of the profile stands at it
FLAT = polynomial_slope((-math.inf, math.inf), (0.0,), ((0.0,),))


class ContactRate(NamedTuple):
    """The derivatives of the patches, the load, the moment about x = 0, the tilt, the pressure."""

    patches: tuple[tuple[float, float], ...]
    load: float
    moment: float
    tilt: float
    pressure: Density


def contact_rate(found: Any, density: Any, profile: Profile, change: Change) -> ContactRate:
    """The derivative of a contact with its pressure. ContactError where it has none."""
    g, P, M = change.modulus, density.resultant, density.moment
    # at fixed E*, for a pressure that is scaled afterwards
    load = None if change.load is None else change.load - g * P
    plain = replace(change, load=load, moment=change.moment - g * M)
    if isinstance(found, Normal):
        rate = _of_one_patch(found, density, profile, plain)
    elif isinstance(found, SeveralPatches):
        rate = _of_patches(found, plain)
    else:
        raise ContactError(
            "the whole period is in contact: derivatives are known where patches have edges; "
            "lower the load"
        )
    p = superposed((1.0, rate.pressure), (g, density))
    return rate._replace(load=rate.load + g * P, moment=rate.moment + g * M, pressure=p)


# -- one patch -------------------------------------------------------------------------------------


def _of_one_patch(
    found: Normal, density: SlopeDensity, profile: Profile, change: Change
) -> ContactRate:
    contact, G = found.edges.contact, density.half_modulus
    H = integrals_of(found, profile)
    _refuse_corners(found, profile)
    slope = FLAT if change.profile is None else change.profile.pieces
    slope = refined(slope, contact.x1, contact.x2, accuracy_for(TOLERANCE))
    h = edge_integrals(slope, contact, keep_zero=True)
    rate = response(found.edges, G, (H, h), change)
    turned, I0 = slope.tilted(rate.tilt), h.I0 + math.pi * rate.tilt
    common = contact, G, *rate.intensities, rate.load, rate.moment
    series = slope_series(turned, contact)
    p: Density
    if series is not None:
        p = TransformDensity(*common, series)
    else:
        p = PanelDensity(*common, Panels(Geometry(turned, contact, keep_zero=True), I0))
    return ContactRate((rate.edges,), rate.load, rate.moment, rate.tilt, p)


def integrals_of(found: Normal, profile: Profile) -> EdgeIntegrals:
    """Those of h' over the contact, by which its edges move."""
    contact = found.edges.contact
    slope = refined(found.slope(profile), contact.x1, contact.x2, accuracy_for(TOLERANCE))
    return edge_integrals(slope, contact, keep_zero=True)


class Response(NamedTuple):
    """What follows from the integrals of δh': of one patch, all but the pressure inside."""

    edges: tuple[float, float]
    load: float
    moment: float
    tilt: float
    intensities: tuple[float, float]


def response(
    edges: Edges, G: float, integrals: tuple[EdgeIntegrals, EdgeIntegrals], change: Change
) -> Response:
    """The moves of the edges, the loads and the singular ends, by the integrals of h' and δh'."""
    (r, m), (H, h) = (edges.contact.r, edges.contact.m), integrals
    moves = np.zeros((2, 3))  # of both edges by δP, by the change of the tilt, and by δh' alone
    if not edges.sharp[0]:
        moves[0] = -1.0 / (G * r * H.JL), -math.pi / H.JL, (h.I1 - h.I0) / H.JL
    if not edges.sharp[1]:
        moves[1] = 1.0 / (G * r * H.JR), -math.pi / H.JR, -(h.I1 + h.I0) / H.JR
    system, right = np.eye(2), np.array([change.load or 0.0, change.tilt or 0.0])
    if change.load is None:
        if any(edges.sharp):
            raise ContactError(
                "the half-width is bounded by a corner of the indenter, whatever the load: give "
                "normal_load for a derivative"
            )
        row = 0.5 * (moves[1] - moves[0])
        system[0], right[0] = row[:2], change.half_width - row[2]
    if change.tilt is None:
        system[1], right[1] = (m, -0.5 * math.pi * G * r * r), change.moment + G * r * r * h.C2
    load, tilt = np.linalg.solve(system, right).tolist()
    moment = m * load - G * r * r * (h.C2 + 0.5 * math.pi * tilt)
    apart = 2.0 * G * (h.I0 + math.pi * tilt) / math.pi
    both = 2.0 * (load / r - G * h.I1) / math.pi
    x1, x2 = (moves @ (load, tilt, 1.0)).tolist()
    return Response((x1, x2), load, moment, tilt, (0.5 * (both + apart), 0.5 * (both - apart)))


def _refuse_corners(found: Normal, profile: Profile) -> None:
    """ContactError where an edge stands at a corner of the profile: it moves to one side only."""
    contact, slope = found.edges.contact, found.slope(profile)
    for x, held in zip((contact.x1, contact.x2), found.edges.sharp, strict=True):
        for e, _ in () if held or slope.functions else slope.jumps:
            if abs(x - e) <= CORNER * contact.r:
                raise ContactError(
                    f"the edge at x = {x:.6g} stands at a corner of the profile, where "
                    "derivatives are one-sided: change the load a little"
                )


# -- several patches -------------------------------------------------------------------------------


def _of_patches(found: SeveralPatches, change: Change) -> ContactRate:
    """On several patches, at fixed E*."""
    o, G = found.found.operator, found.pressure.half_modulus
    P, N, held = o.patches, o.patches.number, change.tilt is None
    _refuse_events(P.r, P.gaps[: N - 1 + P.closing], 0.5 * (P.b[-1] - P.a[0]))
    load, last = change.load or 0.0, change.tilt or 0.0
    changes = np.zeros(2 * N + 1)
    changes[-2:] = load / G, change.moment / G if held else last
    flat = np.zeros((len(o.pieces.origins), 1))
    pieces = replace(o.pieces, coefficients=flat, series=flat[:, :0])
    if change.profile is not None:
        pieces = of_profile(change.profile, o.pieces.domain, RESOLVED)
    changed, tilt, moves = response_of_patches(found.found, pieces, changes)
    p = PatchPressure(changed, G, tilt, load)
    patches = tuple((a, b) for a, b in moves.reshape(N, 2).tolist())
    return ContactRate(patches, load, change.moment if held else p.moment, tilt, p)


def _refuse_events(r: Array, gaps: Array, half: float) -> None:
    """ContactError where a patch is born or two merge: derivatives are one-sided there."""
    if r.min() < NARROWEST * half:
        what, remedy = "a patch of contact has no width", "it is just born"
    elif gaps.min(initial=math.inf) < NARROWEST * half:
        what, remedy = "a gap between patches has no width", "they just merge"
    else:
        return
    raise ContactError(
        f"{what} to rounding ({remedy}), where derivatives are one-sided: change the load a little"
    )


# -- the shear -------------------------------------------------------------------------------------


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
