"""Elastic constants, and the two numbers of a pair of bodies that plane contact depends on.

    1/E* = (κ1 + 1)/(8 μ1) + (κ2 + 1)/(8 μ2)
    β    = [ (κ1 - 1)/μ1 - (κ2 - 1)/μ2 ] / [ (κ1 + 1)/μ1 + (κ2 + 1)/μ2 ]
 1 is the body, y > 0, and 2 the indenter. Kolosov's κ = 3 - 4ν in plane strain, where 1/E* is (1 -
ν1²)/E1 + (1 - ν2²)/E2, and (3 - ν)/(1 + ν) in plane stress (Dundurs 1969; Johnson 1985, § 5.4).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from sie import arguments

# Bodies whose |β| is below this differ by rounding of their constants.
SIMILAR = 1e-12

COUPLINGS = ("full", "goodman")  # how p and q of dissimilar bodies act on each other
NO_POISSON = (
    "σ_zz and what depends on it need Poisson's ratio: give poisson beside modulus, or the body by "
    "young and poisson"
)

Plane = Literal["strain", "stress"]


@dataclass(frozen=True)
class Elastic:
    """An isotropic elastic body.

    Parameters
    ----------
    young : float
        Young's modulus, stress.
    poisson : float
        Poisson's ratio, -1 < ν <= 0.5.
    plane : {"strain", "stress"}, optional
        Plane strain or plane stress.

    Raises
    ------
    ValueError
        For constants of no stable solid.

    Examples
    --------
    >>> Elastic(young=210e3, poisson=0.3).shear_modulus
    80769.23076923077
    """

    young: float
    poisson: float
    plane: Plane = "strain"

    def __post_init__(self) -> None:
        object.__setattr__(self, "young", arguments.positive("young", self.young))
        nu = arguments.finite("poisson", self.poisson)
        if not -1.0 < nu <= 0.5:
            raise ValueError(
                f"poisson = {nu:g} is outside (-1, 0.5]: no stable isotropic solid has it; metals "
                "are near 0.3"
            )
        object.__setattr__(self, "poisson", nu)
        if self.plane not in ("strain", "stress"):
            raise ValueError(f"plane = {self.plane!r} is neither 'strain' nor 'stress'")

    @property
    def shear_modulus(self) -> float:
        """Shear modulus μ = E/(2(1 + ν)), stress."""
        return self.young / (2.0 * (1.0 + self.poisson))

    @property
    def kolosov(self) -> float:
        """Kolosov's constant κ."""
        nu = self.poisson
        return 3.0 - 4.0 * nu if self.plane == "strain" else (3.0 - nu) / (1.0 + nu)


@dataclass(frozen=True)
class Rigid:
    """A body that does not deform."""

    def __repr__(self) -> str:
        return "RIGID"


RIGID = Rigid()
Body = Elastic | Rigid


def pair_modulus(body: Body, indenter: Body) -> float:
    """E* of the two bodies, in units of stress."""
    return 1.0 / (_compliance(body, +1.0) + _compliance(indenter, +1.0))


def dundurs(body: Body, indenter: Body) -> float:
    """Dundurs' second constant β; 0 for similar bodies."""
    difference = _compliance(body, -1.0) - _compliance(indenter, -1.0)
    return coupling(difference / (_compliance(body, 1.0) + _compliance(indenter, 1.0)))


def coupling(beta: float) -> float:
    """β, or 0 where it is below SIMILAR: such bodies are similar."""
    return beta if abs(beta) >= SIMILAR else 0.0


def share(body: Body, indenter: Body) -> float:
    """The body's part of the compliance 1/E*: 1/2 for similar bodies."""
    if body == indenter:
        return 0.5
    return _compliance(body, 1.0) / (_compliance(body, 1.0) + _compliance(indenter, 1.0))


def _compliance(body: Body, sign: float) -> float:
    """(κ ± 1) / (8 μ)."""
    return (body.kolosov + sign) / (8.0 * body.shear_modulus) if isinstance(body, Elastic) else 0.0
