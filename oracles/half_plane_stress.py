"""Stresses in 40 digits, by quadrature of the slope alone: the reference for the stress of the
solver.

From the potential F(z) = 1/π ∫p/(z - t) of `oracles.normal_contact` (smooth edges; e the piece
next to z, continued), differentiated under the integral:

    F  = G H_e - G/π R I0,      F' = G H_e' - G/π ( (z - m)/R I0 + R I1 ),
    I0 = ∫ q dφ,      I1 = ∫ (q - H_e'(z))/(t - z) dφ,      q = (H(t) - H_e(z))/(t - z)

and, written apart from the package under test (Muskhelishvili 1953, § 93), with f the friction of
full sliding and σ a bulk stress,

    σ_xx + σ_yy = 2 Im F - 2f Re F + σ,      σ_yy - σ_xx + 2i σ_xy = -2y (1 - if) F' + 2f F - σ
"""

from dataclasses import dataclass

from oracles.normal_contact import Contact, Number, mp


@dataclass(frozen=True)
class Stresses:
    xx: Number
    yy: Number
    xy: Number


def potentials(contact: Contact, z: Number) -> tuple[Number, Number]:
    """(F, F') at Im z > 0, both edges smooth."""
    c = contact
    nearest = min(max(mp.re(z), c.x1), c.x2)
    e = c.pieces.index(
        nearest - c.r * mp.mpf("1e-30") if nearest == c.x2 else nearest + c.r * mp.mpf("1e-30")
    )
    if abs(z - nearest) > c.r:
        H, dH, e = mp.zero, mp.zero, -1
    else:
        function = c.pieces.functions[e]
        h = mp.mpf(10) ** -12
        # central differences of an analytic function, four points: h^4 and rounding/h leave 28
        # digits
        H, dH = (
            function(z),
            (8 * (function(z + h) - function(z - h)) - (function(z + 2 * h) - function(z - 2 * h)))
            / (12 * h),
        )
    R = mp.sqrt(z - c.x1) * mp.sqrt(z - c.x2)
    I0 = I1 = mp.zero
    for t, _, Ht, weight in c.nodes(z, e):
        quotient = (Ht - H) / (t - z)
        I0 += weight * quotient
        I1 += weight * (quotient - dH) / (t - z)
    return c.G * H - c.G / mp.pi * R * I0, c.G * dH - c.G / mp.pi * ((z - c.m) / R * I0 + R * I1)


def stresses(
    contact: Contact, x: float, y: float, friction: float = 0.0, bulk: float = 0.0
) -> Stresses:
    """σ_xx, σ_yy, σ_xy at a depth y > 0 under the pressure and, in full sliding, the shear f p."""
    z, f = mp.mpc(x, y), mp.mpf(friction)
    F, dF = potentials(contact, z)
    total = 2 * mp.im(F) - 2 * f * mp.re(F) + bulk
    difference = -2 * mp.mpf(y) * mp.mpc(1, -f) * dF + 2 * f * F - bulk
    return Stresses(
        (total - mp.re(difference)) / 2, (total + mp.re(difference)) / 2, mp.im(difference) / 2
    )
