"""The answers on the surface: relative slip and its energy, the gap, what the equations neglect."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.errors import ContactError
from sie.traction.base import on_line

if TYPE_CHECKING:  # a part of a solution, which has the stages
    from .body import BodyAnswers as Stages
else:
    Stages = object

Array = NDArray[np.float64]

NEARLY = 0.999  # of f P: a load in partial slip next to sliding


class SurfaceAnswers(Stages):
    """What a solution answers about slip, gap and what is neglected."""

    history: Any = None  # of `follow`, where this is a point of a path

    @property
    def slip_widths(self) -> tuple[float, float]:
        """The widths of the zones of slip at the left edge and at the right one, in lengths.

        Returns
        -------
        tuple of float
            From each edge to the stick zone next to it; the width of the contact, twice, in full
            sliding. Between dissimilar bodies under a normal load alone they keep their digits
            when they are smaller than the rounding of the edges; 0 below 1e-15 of the half-width,
            where that is full stick.
        """
        if self.scene.coupled:
            return self.coupled[1].slip_widths
        x1, x2 = self.edges
        stick = self.stick or ((x2, x1),)
        return stick[0][0] - x1, x2 - stick[-1][1]

    def slip(self, x: ArrayLike) -> Array:
        """Relative slip: the tangential displacement of the indenter relative to the body.

        Parameters
        ----------
        x : array_like of float
            Positions on the surface, length.

        Returns
        -------
        ndarray of float
            Slip in units of length, same shape as x: 0 in stick zones and outside the contact, with
            the sign of q elsewhere.

        Raises
        ------
        ContactError
            For dissimilar bodies that slide: their slip depends on the partial slip before.

        Notes
        -----
        In full sliding it is the slip at incipient sliding, when the last stick zone vanishes.
        Between dissimilar bodies it is counted from when a point came into contact, or from when
        the tangential load began where the contact spreads under it.

        Examples
        --------
        >>> import sie
        >>> scene = sie.Scene(profile=sie.Parabola(100.0), modulus=80e3, normal_load=50.0,
        ...                   friction=0.5, tangential_load=20.0)
        >>> sie.solve(scene).slip([0.0, 1.0]).tolist()
        [0.0, 0.0]
        """
        self._refuse_unknown_slip()
        if self.scene.coupled:
            return self.coupled[1].relative_slip(x)
        slipped: Array = on_line(self.tangential.slip if self.sheared else np.zeros_like, x)
        return slipped

    @property
    def energy_lost(self) -> float:
        """Energy that friction dissipated since the normal load was applied.

        Returns
        -------
        float
            ∫∫|q| |dslip| dx, force per length of the line times length.

        Raises
        ------
        ContactError
            As for `slip`, and for dissimilar bodies under a tangential load if the states on the
            way to it are not found.
        """
        self._refuse_unknown_slip()
        return self.dissipated if self.sheared or self.scene.coupled else 0.0

    @property
    def shift(self) -> float:
        """Rigid-body shift of the indenter along x that slip adds, length.

        Returns
        -------
        float
            The shift beyond that of the same loads without slip.

        Raises
        ------
        ContactError
            As for `energy_lost`.

        Notes
        -----
        The shift without slip is Q times a constant that plane elasticity leaves undetermined
        (Johnson, Contact Mechanics, 1985, § 2.2). For dissimilar bodies it is that of a contact
        bonded between the edges that the normal load made.
        """
        self._refuse_unknown_slip()
        if self.scene.coupled:
            return self.coupled[1].shift
        return self.tangential.shift if self.sheared else 0.0

    def _refuse_unknown_slip(self) -> None:
        if self.scene.slides and self.scene.beta:
            limit = self.scene.slides * self.scene.friction * self.normal_load
            raise ContactError(
                f"how far dissimilar bodies (β = {self.scene.beta:.4g}) slip before they slide "
                "depends on the states before: drop sliding and give tangential_load = "
                f"{NEARLY * limit:.6g}, {NEARLY:g} of f P, for the slip next to it"
            )

    def gap(self, x: ArrayLike) -> Array:
        """The gap between the deformed bodies.

        Parameters
        ----------
        x : array_like of float
            Positions on the surface, in the contact or beside it, length.

        Returns
        -------
        ndarray of float
            Gap in units of length, same shape as x: 0 in the contact, inf beyond the ends of the
            indenter.
        """
        x = arguments.reals("x", x)
        if self.scene.bonded:
            return np.where(
                (x < self.edges[0]) | (x > self.edges[1]), np.inf, np.where(np.isnan(x), x, 0.0)
            )
        if self.scene.coupled:
            return self.coupled[1].gap(x, self._upright.profile)
        if self._several is not None:
            return self._several.gap(x.ravel()).reshape(x.shape)
        from sie.contact.gap import gap

        return gap(x.ravel(), self.slope_density, self._slope).reshape(x.shape)

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on effects that the equations neglect for this scene, () for none."""
        return *self.strain_notes, *self.coupling_notes, *self.slip_notes

    @property
    def slip_notes(self) -> tuple[str, ...]:
        """A sentence on what is approximated in the slip, or ()."""
        if self.scene.neglects_beta or not self.sheared or self.tangential.advancing:
            return ()
        from sie.certificate.result import RETREAT

        return (f"note: slip is found in total displacements: {RETREAT}",)

    @cached_property
    def coupling_notes(self) -> tuple[str, ...]:
        """A sentence on what is neglected where β, or β q, is left out, or ()."""
        if self.scene.neglects_beta:
            return (
                "note: β q is left out of the normal equation (Goodman's approximation); give "
                'coupling="full" to compare',
            )
        beta = self.scene.neglected_beta
        if not beta:
            return ()
        return (
            f"note: β = {beta:.4g} is neglected (dundurs = 0): p and q are those of similar bodies",
        )

    @property
    def strain_notes(self) -> tuple[str, ...]:
        """Sentences on strains that are not small: a slope above 0.2, p above E*/4."""
        measured = self.scene.bonded or self.scene.coupled or self._several is not None
        if measured or "certificate" in self.__dict__:
            return self.certificate.notes
        from sie.certificate.pressure_check import certificate

        return certificate(self.slope_density, self._slope, self.tol).notes
