"""A flat punch that sticks to the body all over: full stick, under P, Q and a moment or a tilt.

Neither body slips, so that both equations hold on the whole contact with g' = 0. In φ = p + i q
they are one,

    iβ φ(x) - 1/π PV∫ φ(t)/(t - x) dt = E*/2 tilt,        ∫φ dx = P + i Q,

whose exponents -1/2 ± iη, tanh πη = β, make the tractions oscillate next to the edges
(Muskhelishvili 1953, § 114; Johnson 1985, § 2.8(b)). There, within a distance of about e^(-π/2η) of
the width, p changes sign: bonded surfaces can pull.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.cauchy.density import JacobiDensity
from sie.cauchy.equation import CauchyEquation
from sie.contact.known_contact import Edges, refuse_out_of_scale
from sie.errors import ContactError
from sie.numerics.interval import Interval
from sie.problem.scene import Scene
from sie.traction.base import Density, on_surface

Array = NDArray[Any]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Component(Density):
    """The real or the imaginary part of φ = p + i q, as a traction."""

    whole: JacobiDensity
    imaginary: bool

    @property
    def contact(self) -> Interval:
        return Interval(*self.whole.interval)

    @property
    def interval(self) -> tuple[float, float]:
        return self.whole.interval

    @property
    def resultant(self) -> float:  # type: ignore[override]
        return float(self._part(np.asarray(self.whole.resultant)))

    @property
    def moment(self) -> float:  # type: ignore[override]
        return float(self._part(np.asarray(self.whole.moment)))

    def _part(self, values: NDArray[Any]) -> Array:
        part: Array = values.imag if self.imaginary else values.real
        return part

    def __call__(self, x: ArrayLike) -> Array:
        return self._part(self.whole(x))

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        def potential(flat: Complex) -> Complex:
            F, edge = self._of_component(self.whole.cauchy, flat, side)
            x = flat.real[edge]
            F[edge] = on_surface(self.hilbert(x), self(x), side)
            return F

        F: Complex = self._in_plane(potential, z, side)
        return F

    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        def derivative(flat: Complex) -> Complex:
            dF, edge = self._of_component(self.whole.cauchy_derivative, flat, side)
            x = flat.real[edge]
            dF[edge] = on_surface(
                np.zeros_like(x), np.where(x == self.interval[0], -1.0, 1.0) * self(x), side
            )
            return dF

        dF: Complex = self._in_plane(derivative, z, side, derivative=True)
        return dF

    def _of_component(
        self, potential: Callable[[ArrayLike, int], Array], z: Complex, side: int
    ) -> tuple[Complex, NDArray[np.bool_]]:
        """The potential at z (1-d) off the edges, and where these are."""
        edge = (z == self.interval[0]) | (z == self.interval[1])
        z = np.where(edge, self.contact.m, z)
        # F of the complex conjugate density is the conjugate of F at conj z
        F, mirrored = potential(z, side), potential(z.conj(), -side).conj()
        values = (
            np.multiply(-0.5j, F - mirrored) if self.imaginary else np.multiply(0.5, F + mirrored)
        )
        return values, edge

    def hilbert(self, x: ArrayLike) -> Array:
        """0 at the edges, as for other sharp ones: it oscillates there without limit."""
        x = arguments.reals("x", x)
        return np.where(
            (x == self.interval[0]) | (x == self.interval[1]),
            0.0,
            self._part(self.whole.hilbert(x)),
        )[()]


def full_stick_contact(scene: Scene, tol: float) -> tuple[Edges, JacobiDensity]:
    """The edges (those of the punch), load, moment and tilt, and φ = p + i q."""
    ends, P = _flat(scene)
    Q, G = scene.tangential_load, 0.5 * scene.Estar
    refuse_out_of_scale(0.5 * (ends[1] - ends[0]), P + abs(Q), scene.Estar)

    def answer(total: complex, tilt: float) -> JacobiDensity:
        return CauchyEquation(ends, G * tilt, a=1j * scene.beta, b=-1.0, total=total).solve(tol)

    tilt = scene.tilt
    if scene.moment is not None:
        # The moment is linear in the tilt, and falls with it
        upright, tilted = answer(complex(P, Q), 0.0), answer(0j, 1.0)
        tilt = (scene.moment - upright.moment.real) / tilted.moment.real
    found = answer(complex(P, Q), tilt)
    moment = found.moment.real if scene.moment is None else scene.moment
    return Edges(Interval(*ends), P, moment, tilt, (True, True), 0.0, 0.0, 0.0, 0), found


def _flat(scene: Scene) -> tuple[tuple[float, float], float]:
    """The ends of the punch, and its load."""
    pieces = scene.profile.pieces
    if not pieces.is_flat_punch:
        raise ContactError(
            f"friction = inf (full stick) is covered for a flat punch, not for {scene.profile!r}: "
            "contact that grows under load locks in strain; give a flat punch, or a finite friction"
        )
    if scene.normal_load is None:
        raise ContactError(
            "a bonded punch carries any load on its whole width: give normal_load instead of "
            "half_width"
        )
    return pieces.domain, scene.normal_load
