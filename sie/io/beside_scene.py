"""What a scene file says beside the contact problem: units, fatigue and cracks."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Units:
    """Labels of consistent units, force = stress × length."""

    length: str = "mm"
    force: str = "N/mm"
    stress: str = "MPa"

    @property
    def moment(self) -> str:
        """The unit of ∫p x dx: N/mm times mm is N.

        >>> Units().moment, Units(force="kN").moment
        ('N', 'kN mm')
        """
        per_length = "/" + self.length
        return (
            self.force.removesuffix(per_length)
            if self.force.endswith(per_length)
            else f"{self.force} {self.length}"
        )


UNITS = Units()
PARTS, MOST_PARTS = 4, 100


@dataclass(frozen=True)
class Fatigue:
    """The content of [fatigue]; 0 stands for a constant that is not given.

    Parameters
    ----------
    findley_k : float
        Weight of the normal stress in Findley's parameter.
    shear_limit : float
        What Findley's parameter may reach, in units of stress.
    fatemi_socie_k : float
        Weight of the normal stress in the parameter of Fatemi and Socie.
    yield_stress : float
        σ_y in the parameter of Fatemi and Socie.
    depth : float or list of float
        Where parameters are given beside the surface; without it 1 % and 10 % of the largest
        half-width.
    parts : int
        At how many states each step of the cycle is examined, 4 if it is not given.
    """

    findley_k: float = 0.0
    shear_limit: float = 0.0
    fatemi_socie_k: float = 0.0
    yield_stress: float = 0.0
    depth: float | tuple[float, ...] = ()
    parts: int = PARTS

    def __post_init__(self) -> None:
        if not 1 <= self.parts <= MOST_PARTS:
            raise ValueError(
                f"[fatigue] parts = {self.parts} is not a number from 1 to {MOST_PARTS}"
            )


@dataclass(frozen=True)
class Crack:
    """The content of [crack].

    Parameters
    ----------
    at : str or float
        Where the cracks begin: "trailing edge" or "leading edge" of the contact under the largest
        tangential load, or x.
    depths : list of float
        Depths of their tips, ascending.
    threshold : float
        ΔK0 of long cracks, stress times root of length.
    fatigue_limit : float
        Δσ0 of the smooth material, a range of stress.
    friction : float
        Friction between the faces of a crack: only 0.
    """

    at: str | float
    depths: tuple[float, ...]
    threshold: float = 0.0
    fatigue_limit: float = 0.0
    friction: float = 0.0
