"""The stress in the body under the tractions of a solution, as its attributes and methods."""

from __future__ import annotations

from numpy.typing import ArrayLike

from .errors import ContactError
from .problem.material import Elastic
from .problem.request import refuse_unknown_poisson
from .problem.scene import Scene
from .stages import stage as cached_property  # its first reading is logged
from .stress.half_plane import Stress, Tractions
from .stress.yield_limit import (
    Criterion,
    Peak,
    YieldPoint,
    elastic_limit,
    peak_tension,
    refuse_unknown_criterion,
)
from .traction.base import Density


class StressAnswers:
    """What a solution answers about the body below the surface; it gives the tractions."""

    scene: Scene

    @property
    def pressure(self) -> Density:
        """The contact pressure, a stress."""
        raise NotImplementedError

    @property
    def shear(self) -> Density:
        """The shear traction, a stress."""
        raise NotImplementedError

    @property
    def normal_load(self) -> float:
        """Normal load, force per length."""
        raise NotImplementedError

    @cached_property
    def tractions(self) -> Tractions:
        """The tractions and the constants that the stress in the body depends on."""
        scene, body = self.scene, self.scene.body
        if body is None:
            return Tractions(self.pressure, self.shear, scene.bulk_stress, scene.poisson)
        if isinstance(body, Elastic):
            constants = body.poisson, body.plane, body
            return Tractions(self.pressure, self.shear, scene.bulk_stress, *constants)
        raise ContactError(
            "the body is rigid: its stress is not determined; give the elastic one as body and "
            "the rigid as indenter"
        )

    def stress(self, x: ArrayLike, y: ArrayLike) -> Stress:
        """The stress at points of the body.

        Parameters
        ----------
        x, y : array_like of float
            Positions and depths, y >= 0, length. They are broadcast against each other.

        Returns
        -------
        Stress
            Components, invariants and strains, arrays of the broadcast shape, computed as they are
            read.

        Raises
        ------
        ValueError
            For points above the surface or not finite.
        ContactError
            If the body is rigid.
        """
        return Stress(self.tractions, x, y)

    def surface_stress(self, x: ArrayLike) -> Stress:
        """The stress on the surface, in the contact and beside it.

        Parameters
        ----------
        x : array_like of float
            Positions at y = 0, length.

        Returns
        -------
        Stress
            As `stress(x, 0.0)`.
        """
        return self.stress(x, 0.0)

    def elastic_limit(self, criterion: Criterion = "mises") -> YieldPoint:
        """The place where the body yields first, and the load.

        Parameters
        ----------
        criterion : {"mises", "tresca"}, optional
            Yield criterion.

        Returns
        -------
        YieldPoint
            First-yield load, place and stress.

        Raises
        ------
        ValueError
            For an unknown criterion, or if Poisson's ratio is needed and not given.

        Examples
        --------
        >>> import sie
        >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, poisson=0.3, normal_load=1.0)
        >>> found = sie.solve(scene).elastic_limit()
        >>> round(found.y / found.half_width, 2)
        0.7
        """
        refuse_unknown_criterion(criterion)
        refuse_unknown_poisson(self.scene)
        return elastic_limit(self.tractions, self.normal_load, criterion)

    def peak_tension(self) -> Peak:
        """The largest tension σ_xx on the surface.

        Returns
        -------
        Peak
            (value, x): stress, and the position where it is reached, in the contact or beside it.
        """
        return peak_tension(self.tractions)
