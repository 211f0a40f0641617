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

import numpy as np

from sie.errors import ContactError, LoadError
from sie.numerics.interval import EPS
from sie.problem.load_limit import refuse_sliding, remaining

from .slip_state import NoSlip, Slip, Step
from .state_slip import two_signed
from .states import OneSignedSlip, Sliding

# Violations of |q| <= f p below this fraction of f p are rounding.
TOLERATED = 1e-10
SCANNED = 400
# Forces over a zone are its length to the power of 3/2 and more: below this fraction of f P they
# would underflow.
SMALLEST = 1e-60
# Where "sliding" is switched off in the economy, the corrective pressure carries this fraction of
# P: nothing, but it is solved for.
HARDLY = 1e-40


def slip(step: Step, one_sign: bool = False) -> Slip:
    """The state of a scene's contact after its Q and σ.

    With `one_sign`, slip is positive at both edges, whatever Q and σ, as in a layer of a memory.

    Raises ContactError where no single stick zone answers.
    """
    P, f, Q, tau = step.normal_load, step.scene.friction, step.Q, step.tau
    if f == 0.0 or (Q == 0.0 == tau and "shear" in step.economy):
        return NoSlip(step.pressure.contact, f)
    refuse_sliding(f, P, Q)
    if (
        max(abs(Q), math.pi * step.pressure.contact.r * abs(tau)) < SMALLEST * f * P
        and "shear" in step.economy
    ):
        raise LoadError(
            f"Q = {Q:.6g} and the bulk stress are below {SMALLEST:g} of f P = {f * P:.6g}: "
            "zones of slip so short have no length in doubles; give 0 instead"
        )
    if abs(Q) == f * P and "sliding" in step.economy:
        return sliding(step)
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


def sliding(step: Step) -> Sliding:
    f, sign = step.scene.friction, math.copysign(1.0, step.Q)
    return Sliding(
        step.pressure, step.slope, f, step, sign, step.slope.tilted(_tilt_of_strain(step, sign))
    )


def _tilt_of_strain(step: Step, sign: float) -> float:
    """The tilt -2τ/(± f E*) that stands for a strain in the corrective problem."""
    return -2.0 * step.tau / (sign * step.scene.friction * step.scene.Estar)


def _one_signed(step: Step, sign: float) -> OneSignedSlip:
    """Slip in the direction `sign`.

    It follows from the normal problem of the tilted profile under the reduced load.
    """
    found = step.contact_under(*corrective_loads(step, sign))
    return OneSignedSlip(step.pressure, step.slope, step.scene.friction, step, sign, found)


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
