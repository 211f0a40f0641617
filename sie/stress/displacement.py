"""The displacement in a half-plane y >= 0 under tractions p and q: exact up to the surface.

With F the potential of a density, Φ = Fp - i Fq as in `half_plane`, and the primitives G' = Φ and
Gq' = Fq, the displacement gradients there are those of

    2μ u_x =  (κ - 1)/2 Im G + y Re Φ - Re Gq + (κ + 1)/4 σ x
    2μ u_y = -(κ + 1)/2 Re G - y Im Φ + Im Gq + (κ - 3)/4 σ y

without rotation at infinity (Muskhelishvili 1953, § 93). The primitive of one density is its
Laurent series away from the contact,

    G = P/π ln ζ - Σ_k c_k / (k ζ^k),       c_k = 1/2π ∫ F(ζ) ζ^(k+1) dθ  on a circle,  ζ = z - m

and nearer G(z) = G(z + iS) - i ∫_0^S F(z + is) ds, with z + iS away from it. F is analytic on
either side of that line as far as the surface. With s = S t/(1 + t), t = exp(u + exp(u)), the
trapezoidal rule of step H in u therefore errs by exp(-π²/H), whatever singularities the surface
has. Per period F tends to the constant -iP/period instead, exponentially.

Of two bodies in contact the one is y > 0, and the other, mirrored, bears p and -q. A half-plane
has no displacement at infinity to start from: that of the body is 0 at a given point, and the
indenter's rigid motion follows from the contact.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.errors import ContactError
from sie.progress_bar import counted
from sie.traction.base import Density

from .half_plane import Tractions

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Primitive = Callable[[Complex], Complex]

STEP = 0.1875  # H, a sum of few powers of 2: the nodes u are exact; exp(-π²/H) = 1e-23
# The first u, ln s/S: F is bounded, or infinite at an edge like a root or a power
BOUNDED, INFINITE, LAST = -40.0, -80.0, 4.2
# In half-widths: the circle of the c_k, and where the series serves, with TERMS of them
CIRCLE, AWAY, TERMS = 2.0, 6.0, 24
PERIODS = 6.0  # above the surface, where F is constant to rounding
PART = 256  # points at a time

BODIES = ("body", "indenter")
ZERO_AT = "the point (x, y) of the body that keeps its place"


@dataclass(frozen=True, eq=False)
class Displacement:
    """The displacement at points of one body, along x and along the depth y.

    Parameters
    ----------
    x, y : ndarray of float
        Its components, length, of the shape of the points.
    zero : tuple of float
        The point (x, y) of the body at which both components are 0.
    rotation : float
        The rotation at infinity, radians, from x towards y.
    approach : float
        How far the indenter's point opposite to `zero`, at the same distance from the surface,
        has moved along y, length.
    """

    x: Array
    y: Array
    zero: tuple[float, float]
    rotation: float
    approach: float


def displacement_of(
    solution: Any,
    x: ArrayLike,
    y: ArrayLike,
    body: str,
    *,
    zero: Sequence[float] | None,
    rotation: float,
) -> Displacement:
    """The displacement in a body of a solution, as `Solution.displacement` describes it."""
    x, y = arguments.of_one_shape(arguments.reals("x", x), arguments.reals("y", y))
    _refuse_outside(x, y, body)
    rotation = arguments.finite("rotation", rotation)
    period = solution.scene.profile.period
    deep = 10.0 * solution.half_width if math.isinf(period) else period
    place = (solution.centre, deep) if zero is None else arguments.listed("zero", zero, ZERO_AT)
    if len(place) != 2:
        raise ValueError(f"zero = {place!r} has {len(place)} numbers: give {ZERO_AT}")
    x0, y0 = place
    x0, y0 = arguments.finite("zero", x0), arguments.not_negative("zero", y0)
    at = _middle(solution)
    tilt = solution.tilt

    def of_body(x: Array, y: Array) -> Array:
        return _elastic(solution.tractions_of("body"), x, y, period)

    def of_indenter(x: Array, y: Array) -> Array:
        u_x, u_y = _elastic(solution.tractions_of("indenter"), x, -y, period)
        return np.stack((u_x + tilt * y, -u_y - tilt * x))

    def turned(x: Array, y: Array) -> Array:
        return rotation * np.stack((y0 - y, x - x0))

    surface = np.array([at]), np.zeros(1)
    origin = of_body(np.array([x0]), np.array([y0]))
    apart = np.array([-_slip(solution, at), -solution.scene.profile.height(at)])[:, None]
    push = of_body(*surface) - origin - of_indenter(*surface) - apart
    opposite = np.array([x0]), np.array([-y0])
    approach = float((of_indenter(*opposite) + push + turned(*opposite))[1, 0])
    field, shift = (of_body, -origin) if body == "body" else (of_indenter, push)
    flat = x.ravel(), y.ravel()
    u_x, u_y = (u.reshape(x.shape)[()] for u in field(*flat) + shift + turned(*flat))
    return Displacement(u_x, u_y, (x0, y0), rotation, approach)


def _refuse_outside(x: Array, y: Array, body: str) -> None:
    """ValueError for points that are not in the body, or for another name."""
    if not arguments.among(body, BODIES):
        raise ValueError(f"body = {body!r} is not known: give 'body' or 'indenter'")
    sign, side = (1.0, "depths y >= 0") if body == "body" else (-1.0, "heights y <= 0")
    outside = ~(np.isfinite(x) & np.isfinite(y) & (sign * y >= 0.0))
    if outside.any():
        place = f"({x[outside].flat[0]:g}, {y[outside].flat[0]:g})"
        raise ValueError(f"{place} is not in the {body}: give finite x and {side}")


def _middle(solution: Any) -> float:
    """The middle of the widest stick zone, or of the widest patch."""
    zones = solution.stick or solution.patches
    if not zones:  # full contact of a periodic profile
        return 0.0
    lo, hi = max(zones, key=lambda zone: zone[1] - zone[0])
    return float(0.5 * (lo + hi))


def _slip(solution: Any, at: float) -> float:
    """The slip at a point, 0 where it is not known."""
    try:
        return float(solution.slip(at))
    except ContactError:
        return 0.0


def _elastic(tractions: Tractions | None, x: Array, y: Array, period: float) -> Array:
    """The displacement (2, points) of a half-plane, 0 of a rigid one."""
    if tractions is None:
        return np.zeros((2, *x.shape))
    return displacement(tractions, x, y, period)


def displacement(tractions: Tractions, x: Array, y: Array, period: float = math.inf) -> Array:
    """The displacement (2, points) of a half-plane, up to a rigid motion of the whole."""
    z = x + 1j * y
    Phi, G, Gq = (np.zeros_like(z) for _ in range(3))
    below = y > 0.0  # on the surface Φ may be infinite, and y Φ is 0
    for density, p, q in tractions.combined:
        of_density = primitive(density, z, period)
        G += (p - 1j * q) * of_density
        Gq += q * of_density
        Phi[below] += (p - 1j * q) * density.cauchy(z[below])
    body, sigma = tractions.known_body, 0.25 * tractions.bulk_stress
    kappa, two_mu = body.kolosov, 2.0 * body.shear_modulus
    u_x = 0.5 * (kappa - 1.0) * G.imag + y * Phi.real - Gq.real + (kappa + 1.0) * sigma * x
    u_y = Gq.imag - 0.5 * (kappa + 1.0) * G.real - y * Phi.imag + (kappa - 3.0) * sigma * y
    return np.stack((u_x, u_y)) / two_mu


def primitive(density: Density, z: Complex, period: float = math.inf) -> Complex:
    """∫F dz of a density at z (1-d), Im z >= 0, up to a constant."""
    lo, hi = density.interval
    if math.isinf(period):
        end = _laurent(density)
        height = math.sqrt(2.0) * AWAY * 0.5 * (hi - lo)
        near = np.abs(z - 0.5 * (lo + hi)) < height
    else:
        end = _at_depth(density, period)
        height, near = PERIODS * period, z.imag < PERIODS * period
    out = end(np.where(near, z + 1j * height, z))
    infinite = not np.isfinite(density(np.array(density.breaks))).all()
    s, weight = _rule(height, INFINITE if infinite else BOUNDED)
    places = np.flatnonzero(near)
    parts = range(0, len(places), PART)
    for i in counted("displacement, part", parts, len(parts)):
        part = places[i : i + PART]
        out[part] -= 1j * (density.cauchy(z[part, None] + 1j * s) @ weight)
    return out


def _laurent(density: Density) -> Primitive:
    """G away from the contact."""
    lo, hi = density.interval
    m, radius = 0.5 * (lo + hi), 0.5 * CIRCLE * (hi - lo)
    turn = np.exp(1j * np.pi * (np.arange(2.0 * TERMS) + 0.5) / (2.0 * TERMS))
    F = density.cauchy(m + radius * turn)  # conjugate on the other half of the circle
    k = np.arange(1.0, TERMS + 1.0)
    c = (F * turn ** (k[:, None] + 1.0)).real.mean(axis=1) / k  # over radius^(k+1)

    def series(z: Complex) -> Complex:
        zeta = (z - m) / radius
        terms = np.polynomial.polynomial.polyval(1.0 / zeta, np.concatenate(([0.0], c)))
        return density.resultant / math.pi * np.log(zeta) - radius * terms

    return series


def _at_depth(density: Density, period: float) -> Primitive:
    """G of a periodic density far below the surface."""
    return lambda z: -1j * (density.resultant / period) * z


def _rule(height: float, lowest: float) -> tuple[Array, Array]:
    """Nodes s and weights of ∫_0^S f(s) ds."""
    u = np.arange(lowest, LAST, STEP)
    t = np.exp(u + np.exp(u))
    s = height * t / (1.0 + t)
    return s, STEP * s * (1.0 + np.exp(u)) / (1.0 + t)
