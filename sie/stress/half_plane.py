"""Stress, strain and displacement gradients in the half-plane y >= 0 under tractions p and q.

With the potentials Fp(z) = 1/π ∫ p(t)/(z - t) dt and Fq likewise, z = x + iy, Φ = Fp - i Fq, and a
bulk stress σ along x,

    s = (σ_xx + σ_yy)/2             =  Im Φ + σ/2
    D = (σ_yy - σ_xx)/2 + i σ_xy    =  -y Φ'(z) + Fq(z) - σ/2
    σ_zz = 2ν s (plane strain) or 0 (plane stress);      ω = (u_y,x - u_x,y)/2 = -(κ + 1)/(4μ) Re Φ

(Muskhelishvili 1953, §§ 32, 93; Hills, Nowell & Sackfield 1993, ch. 3; the paper's (21)-(23) if its
Φ̄(z) is read as conj Φ(z̄)). On the surface Fp = hilbert_p - i p, so that σ_yy = -p, σ_xy = -q,
σ_xx = -p - 2 hilbert_q + σ: real arithmetic, no derivative, exact. Potentials are exact to the
surface and free of cancellation far away; so are the stresses. s and D are stored: no component
loses digits to another, and invariants follow without differences.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.problem.material import NO_POISSON, Elastic, Plane
from sie.progress_bar import counted
from sie.traction.base import Density, shallow

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# Points are taken in parts of this size: temporaries stay in the processor's cache, and few are
# ever as large as the whole.
PART = 4096


@dataclass(frozen=True, eq=False)
class Tractions:
    """The half-plane's loads, p and q on its surface and a tension σ along x, and its material.

    `poisson` and `body` may be None: quantities that depend on them then raise ValueError.
    """

    pressure: Density
    shear: Density
    bulk_stress: float = 0.0
    poisson: float | None = None
    plane: Plane = "strain"
    body: Elastic | None = None

    @cached_property
    def combined(self) -> tuple[tuple[Density, float, float], ...]:
        """(density, its share of p, its share of q), each density once."""
        shares: dict[int, list[Any]] = {}
        for place, traction in ((1, self.pressure), (2, self.shear)):
            for factor, density in traction.bases:
                shares.setdefault(id(density), [density, 0.0, 0.0])[place] += factor
        return tuple((density, p, q) for density, p, q in shares.values())

    @property
    def out_of_plane(self) -> float:
        """(s - σ_zz)/s: 1 - 2ν in plane strain, 1 in plane stress."""
        return 1.0 if self.plane == "stress" else 1.0 - 2.0 * self.known_poisson

    @property
    def known_poisson(self) -> float:
        """Poisson's ratio. ValueError if it was not given."""
        if self.poisson is None:
            raise ValueError(NO_POISSON)
        return self.poisson

    @property
    def known_body(self) -> Elastic:
        """The body with its elastic constants. ValueError if they were not given."""
        if self.body is None:
            raise ValueError(
                "strains need the elastic constants of the body: give the body by young and "
                "poisson in place of modulus"
            )
        return self.body

    @cached_property
    def marks(self) -> Array:
        """Edges and breaks of both tractions, ascending."""
        return np.unique(np.concatenate((self.pressure.breaks, self.shear.breaks)))

    @cached_property
    def singular(self) -> Array:
        """The marks at which the slope of a traction is infinite."""
        return np.unique(np.concatenate((self.pressure.singular, self.shear.singular)))

    @cached_property
    def hilbert_at_edges(self) -> tuple[tuple[float, float], ...]:
        """(edge, limit from inside of 1/π PV∫ q/(x - t) dt) where q spreads as far as p."""
        if self.shear.interval != self.pressure.interval:
            return ()
        return tuple(zip(self.shear.interval, self.shear.hilbert_at_edges, strict=True))

    @cached_property
    def depth_of_surface(self) -> float:
        """The depth above which a point is on the surface: 1/y would overflow."""
        x1, x2 = self.pressure.interval
        return shallow(0.5 * (x2 - x1))


class Tensor(NamedTuple):
    """The components of a symmetric tensor, arrays of one shape."""

    xx: Array
    yy: Array
    xy: Array
    zz: Array


class Gradients(NamedTuple):
    """Displacement gradients, arrays of one shape: xy is ∂u_x/∂y, yx is ∂u_y/∂x."""

    xx: Array
    xy: Array
    yx: Array
    yy: Array


class Stress:
    """The stress at points of the body; every value is computed when it is read.

    Parameters
    ----------
    tractions : Tractions
        The tractions and the bulk stress.
    x, y : array_like of float
        Positions and depths, y >= 0, length. They are broadcast against each other, and every value
        has the broadcast shape.

    Raises
    ------
    ValueError
        For points above the surface, and where Poisson's ratio or the body is needed but not given.

    Notes
    -----
    Tension is positive. `xx, yy, xy, zz = stress` unpacks the components. Where p is infinite (a
    sharp edge, a jump of h') so are the stresses; σ1 and σ3 are then both given as -inf.

    Examples
    --------
    >>> import sie
    >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0)
    >>> solution = sie.solve(scene)
    >>> bool(solution.stress(0.0, 0.0).yy == -solution.pressure(0.0))
    True
    """

    def __init__(self, tractions: Tractions, x: ArrayLike, y: ArrayLike) -> None:
        self.tractions = tractions
        self.x, self.y = arguments.of_one_shape(_real("x", x), _real("y", y))
        above = self.y < 0.0
        if above.any():
            raise ValueError(
                f"y = {self.y[above].flat[0]:g} is above the surface: give depths y >= 0"
            )

    def __repr__(self) -> str:
        return f"Stress(at points of shape {self.x.shape})"

    def __iter__(self) -> Iterator[Array]:
        return iter((self.xx, self.yy, self.xy, self.zz))

    # -- components --------------------------------------------------------------------------------

    @property
    def xx(self) -> Array:
        """σ_xx, ndarray of float, stress."""
        s, D = self._both
        return s - D.real

    @property
    def yy(self) -> Array:
        """σ_yy, ndarray of float, stress."""
        s, D = self._both
        return s + D.real

    @property
    def xy(self) -> Array:
        """σ_xy, ndarray of float, stress."""
        return self._both[1].imag.copy()

    @property
    def zz(self) -> Array:
        """σ_zz, ndarray of float, stress: ν (σ_xx + σ_yy) in plane strain, 0 in plane stress."""
        t = self.tractions
        return _times(0.0 if t.plane == "stress" else 2.0 * t.known_poisson, self._s)

    @property
    def knows_zz(self) -> bool:
        """Whether σ_zz is determined: in plane stress, or with Poisson's ratio."""
        return self.tractions.plane == "stress" or self.tractions.poisson is not None

    @property
    def in_plane_sum(self) -> Array:
        """σ_xx + σ_yy, for which no derivative of a potential is needed."""
        return 2.0 * self._s

    # -- invariants --------------------------------------------------------------------------------

    @property
    def in_plane_shear(self) -> Array:
        """The largest shear stress in the plane."""
        return np.abs(self._both[1])

    @property
    def j2(self) -> Array:
        """Second invariant of the deviator, ½ s:s = |D|² + (s - σ_zz)²/3, stress²."""
        s, D = self._both
        return D.real**2 + D.imag**2 + _times(self.tractions.out_of_plane, s) ** 2 / 3.0

    @property
    def mises(self) -> Array:
        """Von Mises stress √(3 J2)."""
        return np.sqrt(3.0 * self.j2)

    @property
    def max_shear(self) -> Array:
        """Half the largest difference of principal stresses (Tresca)."""
        shear = self.in_plane_shear
        return np.maximum(
            shear, 0.5 * (shear + np.abs(_times(self.tractions.out_of_plane, self._s)))
        )

    @property
    def principal(self) -> tuple[Array, Array, Array]:
        """Principal stresses (σ1, σ2, σ3), σ1 >= σ2 >= σ3, with σ_zz among them."""
        s, shear, zz = self._s, self.in_plane_shear, self.zz
        finite = np.isfinite(shear)
        high = np.where(finite, s + np.where(finite, shear, 0.0), s)
        low = s - shear
        return np.maximum(high, zz), np.maximum(np.minimum(high, zz), low), np.minimum(low, zz)

    # -- deformation -------------------------------------------------------------------------------

    @property
    def strain(self) -> Tensor:
        """Strains, a `Tensor` of arrays.

        Notes
        -----
        Hooke's law, 2μ ε = σ - (3 - κ)/4 (σ_xx + σ_yy) 1 in the plane.
        """
        body = self.tractions.known_body
        two_mu = 2.0 * body.shear_modulus
        s, D = self._both
        volume = _times(0.5 * (body.kolosov - 1.0), s)  # s - (3 - κ)/4 2s
        zz = np.zeros_like(s) if body.plane == "strain" else -2.0 * body.poisson / body.young * s
        return Tensor((volume - D.real) / two_mu, (volume + D.real) / two_mu, D.imag / two_mu, zz)

    @property
    def gradients(self) -> Gradients:
        """Displacement gradients, a `Gradients` of arrays; the rotation at infinity is 0."""
        e, body = self.strain, self.tractions.known_body
        rotation = -(body.kolosov + 1.0) / (4.0 * body.shear_modulus) * self._real_potential
        infinite = np.isinf(rotation) & (e.xy == -rotation)
        if not infinite.any():
            return Gradients(e.xx, e.xy - rotation, e.xy + rotation, e.yy)
        # q outweighs the rest of Re Φ = hilbert_p - q there: 4μ u_x,y ~ -(κ + 3) q, 4μ u_y,x ~ (κ -
        # 1) q
        finite = np.where(infinite, 0.0, rotation)
        xy, yx = e.xy - finite, np.where(infinite, _times(1.0 - body.kolosov, e.xy), e.xy + finite)
        return Gradients(e.xx, xy, yx[()], e.yy)

    # -- the potentials, by parts ------------------------------------------------------------------

    @property
    def _s(self) -> Array:
        return self._both[0] if "_both" in self.__dict__ else self._only_s

    @cached_property
    def _only_s(self) -> Array:
        return self._filled(self._s_of, float)

    @cached_property
    def _real_potential(self) -> Array:
        return self._filled(self._real_of, float)

    @cached_property
    def _both(self) -> tuple[Array, Complex]:
        D = np.empty(self.x.shape, dtype=complex)
        s = self._filled(self._s_and_D_of, float, D)
        return s, D

    def _filled(self, function: Any, kind: type, second: Any = None) -> Any:
        """function(x, y, surface?) over all points, in parts on the surface and parts below."""
        first: Any = np.empty(self.x.shape, dtype=kind)
        outs = [out.reshape(-1) for out in (first, second) if out is not None]
        x, y = (v.reshape(-1) if v.flags.c_contiguous else v.flat for v in (self.x, self.y))
        parts = range(0, first.size, PART)
        for i in counted("stress, part", parts, len(parts)):
            x_part, y_part = x[i : i + PART], y[i : i + PART]
            surface = y_part <= self.tractions.depth_of_surface
            for at, is_surface in ((surface, True), (~surface, False)):
                if at.any():
                    where = slice(None) if at.all() else at
                    values = function(x_part[where], y_part[where], is_surface)
                    for out, value in zip(outs, values, strict=True):
                        out[i : i + PART][where] = value
        return first

    def _s_of(self, x: Array, y: Array, surface: bool) -> tuple[Array]:
        t = self.tractions
        if not surface:
            return (self._Phi(x + 1j * y).imag + 0.5 * t.bulk_stress,)
        p = t.pressure(x)
        return (-p - hilbert_of_shear(t, x, p) + 0.5 * t.bulk_stress,)

    def _real_of(self, x: Array, y: Array, surface: bool) -> tuple[Array]:
        t = self.tractions
        return (t.pressure.hilbert(x) - t.shear(x) if surface else self._Phi(x + 1j * y).real,)

    def _s_and_D_of(self, x: Array, y: Array, surface: bool) -> tuple[Array, Complex]:
        t = self.tractions
        if surface:
            p = t.pressure(x)
            hilbert = hilbert_of_shear(t, x, p)
            D = np.empty(x.shape, dtype=complex)
            D.real = hilbert - 0.5 * t.bulk_stress
            D.imag = 0.0 - t.shear(x)  # no -0 where there is no shear
            return -p - hilbert + 0.5 * t.bulk_stress, D
        Phi, dPhi, Fq = potentials(t, x + 1j * y)
        return Phi.imag + 0.5 * t.bulk_stress, Fq - y * dPhi - 0.5 * t.bulk_stress

    def _Phi(self, z: Complex) -> Complex:
        total = np.zeros_like(z)
        for density, p, q in self.tractions.combined:
            total += _complex(p, q) * density.cauchy(z)
        return total


def hilbert_of_shear(tractions: Tractions, x: Array, p: Array) -> Array:
    """1/π PV∫ q/(x - t) dt on the surface.

    It is set to 0 at a sharp edge of dissimilar bodies, where p is infinite and much larger.
    """
    values = tractions.shear.hilbert(x)
    return np.where(np.isinf(p) & np.isinf(values), 0.0, values)


def potentials(tractions: Tractions, z: Complex) -> tuple[Complex, Complex, Complex]:
    """(Φ, Φ', Fq) at z, Im z > 0: each density in p and q is evaluated once."""
    Phi, dPhi, Fq = np.zeros_like(z), np.zeros_like(z), np.zeros_like(z)
    for density, p, q in tractions.combined:
        F, dF = density.potentials(z)
        weight = _complex(p, q)
        Phi += weight * F
        dPhi += weight * dF
        if q:
            Fq += q * F
    return Phi, dPhi, Fq


def _complex(p: float, q: float) -> complex | float:
    """p - iq, real where it can be."""
    return p - 1j * q if q else p


def _times(factor: float, values: Array) -> Array:
    """factor × values, 0 for a factor 0 even where a value is infinite."""
    return factor * values if factor else np.zeros_like(values)


def _real(name: str, values: ArrayLike) -> Array:
    array = arguments.reals(name, values)
    bad = ~np.isfinite(array)
    if bad.any():
        raise ValueError(f"{name} = {array[bad].flat[0]} is not finite: give finite positions")
    return array
