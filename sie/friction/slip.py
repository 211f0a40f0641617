"""The contact to which a tangential load is applied, and what every state of slip answers."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from sie.traction.combination import ZERO

if TYPE_CHECKING:
    from sie.contact.known_contact import Edges
    from sie.numerics.interval import Interval
    from sie.problem.scene import Scene
    from sie.traction.base import Density

Array = NDArray[np.float64]


class Touching(Protocol):
    """A contact without shear, in one patch or in several."""

    @property
    def edges(self) -> Edges: ...
    @property
    def patches(self) -> tuple[tuple[float, float], ...]: ...
    @property
    def pressure(self) -> Any: ...
    def gap(self, x: Array) -> Array: ...


@dataclass(frozen=True)
class Step:
    """The loads Q and τ that are applied to a contact at constant P.

    full     the contact
    under    that of the same profile under a load and a tilt, whoever solves it
    """

    scene: Scene
    full: Touching
    Q: float
    tau: float
    economy: Collection[str]
    under: Callable[[float, float], Touching]

    @property
    def contact(self) -> Interval:
        return self.full.edges.contact

    @property
    def normal_load(self) -> float:
        return self.full.edges.normal_load


class Slip(ABC):
    """A state of stick and slip.

    kind         name of the state
    contact      the contact
    friction     f
    stick        stick zones (lo, hi)
    shear        shear traction q
    slip(x)      relative slip
    advancing    whether the slip zones grow along the whole step
    condition    relative error of the load on the stick zone over one of P or Q
    promised     error of q that is promised at best, over its peak
    """

    kind: str
    contact: Interval
    friction: float
    stick: tuple[tuple[float, float], ...]
    advancing: bool = True
    condition: float = 1.0
    promised: float = 0.0

    @property
    @abstractmethod
    def shear(self) -> Density: ...

    @property
    def parts(self) -> tuple[float, tuple[tuple[float, Density], ...]]:
        """q as a multiple of the pressure and the other densities, each times a factor."""
        return 0.0, ((1.0, self.shear),)

    @property
    def contacts(self) -> tuple[Any, ...]:
        """The contacts in several patches, beside that of the pressure, that make up the shear."""
        return ()

    @abstractmethod
    def slip(self, x: Array) -> Array:
        """Displacement of the indenter relative to the body at x (1-d).

        It is 0 in stick zones and outside the contact.
        """

    @property
    @abstractmethod
    def shift(self) -> float:
        """The shift of the indenter beyond that of a contact that does not slip.

        It is ∫ slip / (π sqrt((x - x1)(x2 - x))) dx.
        """

    @property
    def energy(self) -> float:
        """The dissipated energy ∫ f p |slip| dx at constant P."""
        return 0.0

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        """The zones that slipped since the last turning point as (lo, hi, sign of q).

        They are in the order of time; |q| = f p in those in contact.

        Where slip turned while P fell, the zones of the first direction lie beside the contact,
        which has left them.
        """
        return ()

    @property
    def untouched(self) -> tuple[float, float]:
        """The zone that never slipped."""
        return self.stick[0] if self.stick else (0.0, 0.0)

    @property
    def levels(self) -> tuple[float, ...]:
        """Further kinks of q: the ends of earlier stick zones."""
        return ()

    def slip_now(self, x: Array) -> Array:
        """The slip since the last turning point."""
        return self.slip(x)


@dataclass(frozen=True, eq=False)
class NoSlip(Slip):
    """Nothing slips and nothing is sheared."""

    contact: Interval
    friction: float
    patches: tuple[tuple[float, float], ...]
    kind = "stick"

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:  # type: ignore[override]
        return self.patches if self.friction else ()

    @property
    def shear(self) -> Density:
        return ZERO

    def slip(self, x: Array) -> Array:
        return np.zeros(x.shape)

    @property
    def shift(self) -> float:
        return 0.0
