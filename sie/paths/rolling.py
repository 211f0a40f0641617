"""Steady tractive rolling of similar bodies in one patch, after Carter, for any profile.

What enters at the leading edge sticks at once, and slips further back. Where it sticks the strains
of both surfaces differ by the creep ξ, a constant: q = ± f (p - p*), p* the pressure of the same
profile under P - |Q|/f at a tilt θ* at which its contact has the same leading edge. With the
integrals I0 and I1 of h' over a zone of half-width r at that edge

    P - |Q|/f = E*/2 r I1,      θ* = θ - I0/π,      |ξ| = f |θ* - θ|

The first gives r; for a cylinder c = b sqrt(1 - |Q|/(f P)) and |ξ| = f (b - c)/R.

F. W. Carter, Proc. R. Soc. A 112 (1926) 151-157; Johnson (1985), § 8.3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sie import arguments
from sie.contact.edge_integrals import EdgeIntegrals, edge_integrals
from sie.errors import ContactError
from sie.numerics.interval import EPS, Interval
from sie.numerics.root_finding import false_position
from sie.problem.scene import Scene
from sie.profiles.resolution import refined
from sie.solution import Solution, solve
from sie.traction.base import Density
from sie.traction.combination import superposed

PLACES, WITHIN = 101, 1e-9  # at which |q| <= f p is looked at, and of the peak pressure


@dataclass(frozen=True, eq=False)
class Rolling:
    """A contact that rolls and transmits a tangential load; `rolling` makes it.

    Parameters
    ----------
    solution : Solution
        The contact; rolling does not change the pressure of similar bodies.
    stick : (float, float)
        The stick zone, which begins at the leading edge, lengths.
    creep : float
        ξ, the sliding speed over the rolling speed, with the sign of Q; Q ξ is lost per length.
    shear : Density
        The shear q.
    """

    solution: Solution
    stick: tuple[float, float]
    creep: float
    shear: Density


def rolling(scene: Scene, leading: str = "right") -> Rolling:
    """Steady rolling under a tangential load, after Carter.

    Parameters
    ----------
    scene : Scene
        Similar bodies with friction, 0 < |Q| < f P, without bulk stress.
    leading : {"right", "left"}, optional
        The edge at which material enters the contact.

    Returns
    -------
    Rolling
        `.stick`, `.creep`, `.shear`.

    Raises
    ------
    ValueError
        For another edge, and without tangential load.
    ContactError
        For dissimilar bodies, bulk stress, sliding, several patches, a sharp leading edge.

    Examples
    --------
    >>> import sie
    >>> wheel = sie.Scene(profile=sie.Parabola(2.0), modulus=1.0, normal_load=1.0, friction=0.3,
    ...                   tangential_load=0.225)
    >>> round(sie.rolling(wheel).creep, 12)  # f (b - c)/R, c = b/2
    0.11968268412
    """
    if not arguments.among(leading, ("right", "left")) or not scene.tangential_load:
        raise ValueError(
            f"leading = {leading!r}, tangential_load = {scene.tangential_load!r}: give 'right' or "
            "'left', and the load that is transmitted"
        )
    if scene.beta or scene.bulk_stress or scene.slides or scene.bonded:
        raise ContactError(
            "rolling is found for similar bodies in partial slip without bulk stress: give "
            "dundurs = 0 to neglect β, bulk_stress = 0 and |tangential_load| below f P"
        )
    solution, f, Q = solve(scene), scene.friction, scene.tangential_load
    normal, load = solution.as_one_patch, solution.normal_load - abs(Q) / f
    contact, right = normal.edges.contact, leading == "right"
    if normal.edges.sharp[right]:
        raise ContactError("the leading edge is a corner of the indenter: round it")
    slope = refined(normal.slope(scene.profile), contact.x1, contact.x2, EPS)

    def integrals(r: float) -> EdgeIntegrals:
        lo, hi = (contact.x2 - 2.0 * r, contact.x2) if right else (contact.x1, contact.x1 + 2.0 * r)
        return edge_integrals(slope, Interval(lo, hi), keep_zero=True)

    def lacking(r: float) -> float:
        return 0.5 * scene.Estar * r * integrals(r).I1 - load

    ends = -load, lacking(contact.r)
    r = false_position(lacking, 0.0, contact.r, ends, lambda lo, hi, _: hi - lo <= 4.0 * EPS * hi)
    turned = -integrals(r).I0 / math.pi
    E, tilt = scene.Estar, solution.tilt + turned
    under = solve(Scene(profile=scene.profile, modulus=E, normal_load=load, tilt=tilt))
    sign = math.copysign(1.0, Q)
    x = under.centre + under.half_width * np.linspace(-1.0, 1.0, PLACES)[1:-1]
    p = solution.pressure(x)
    if (under.pressure(x) > 2.0 * p + WITHIN * p.max()).any():
        raise ContactError(f"in {under.edges} sticking needs more than f p: lower tangential_load")
    shear = superposed((sign * f, solution.pressure), (-sign * f, under.pressure))
    return Rolling(solution, under.edges, sign * f * abs(turned), shear)
