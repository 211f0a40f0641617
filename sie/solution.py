"""The solution of a scene: a lazy view over the stages of the work.

Each result is computed when it is read first, and `vars(solution)` shows the computed ones. The
stages are in `frictionless` and `sheared`, the stress in the body in `stress_answers`.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import arguments
from .derivative_answers import DerivativeAnswers
from .errors import ContactError
from .problem.coverage import refuse_uncovered
from .problem.request import ECONOMY
from .profiles.placed_traces import traces_in
from .sheared import changed_scene, kept_stages
from .stress_answers import StressAnswers
from .traction.base import on_line

if TYPE_CHECKING:  # what a stage needs is imported when it is computed
    from .certificate.result import Certificate
    from .certificate.trace_noise import TraceReport
    from .patches.result import PatchCertificate
    from .paths.history import History
    from .problem.scene import Scene

Array = NDArray[np.float64]

NEARLY = 0.999  # of f P: a load in partial slip next to sliding


class Solution(StressAnswers, DerivativeAnswers):
    """The solution of a contact problem; `solve` makes it.

    Parameters
    ----------
    scene : Scene
        The question.
    tol : float, optional
        Relative accuracy, as in `solve`.
    economy : collection of str, optional
        The savings that are allowed, as in `solve`.

    Raises
    ------
    ContactError
        By any attribute, where the scene has no answer that the package covers.

    Notes
    -----
    Lengths, stresses and loads are in the units of the scene, loads per unit length of the line of
    contact. An attribute computes what it needs when it is read, and keeps it.
    """

    history: History | None = None  # the path that this is a point of

    def __getstate__(self) -> dict[str, Any]:
        """The stages; the question alone where they hold functions, which no pickle takes."""
        scene, state = self.scene, vars(self)
        computed_again = scene.coupled or math.isfinite(scene.profile.period)
        if type(self) is not Solution or not computed_again:
            return state
        return {name: state[name] for name in ("scene", "tol", "economy")}

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
        if self.scene.coupled and not (self.scene.tangential_load or self.scene.tau):
            width = self.pressed[1].slip_width
            return width, width
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
        from .contact.gap import gap

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
        from .certificate.result import RETREAT

        return (f"note: slip is found in total displacements: {RETREAT}",)

    @cached_property
    def coupling_notes(self) -> tuple[str, ...]:
        """A sentence on what is neglected where β, or β q, is left out, or ()."""
        if self.scene.neglects_beta:
            from .friction.coupled.normal import departure

            return (departure(self.scene, self.tol),)
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
        from .certificate.pressure_check import certificate

        return certificate(self.slope_density, self._slope, self.tol).notes

    def check(self) -> Certificate | PatchCertificate:
        """The certificate: how well this answer satisfies the equations.

        Returns
        -------
        Certificate or PatchCertificate
            Measured at points that were not used to find the answer; `.ok` sums it up. Its notes
            say what the equations neglect.

        Examples
        --------
        >>> import sie
        >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0)
        >>> sie.solve(scene).check().ok
        True
        """
        found, neglected = self.certificate, self.coupling_notes
        return replace(found, notes=(*found.notes, *neglected)) if neglected else found

    def trace_reports(self) -> tuple[TraceReport, ...]:
        """The measured traces in the profile, with their treatment and what their noise implies.

        The error of the pressure is estimated from the misfit of the spline, which the certificate
        takes as it is. The cost is a cross validation and a dozen systems for the edges.

        Returns
        -------
        tuple of TraceReport
            One for each trace, () if the profile has none.
        """
        from .certificate.trace_noise import trace_reports

        scene = self.scene
        if scene.bonded or scene.coupled or next(traces_in(scene.profile), None) is None:
            return ()
        several = self.in_patches
        return trace_reports(scene, several) if several.found else ()

    def plot(self, ax: Any = None, what: str = "pressure", units: Any = None) -> Any:
        """One panel of the picture of the contact, on axes of Matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; axes of their own, which a notebook shows, if not given.
        what : {"pressure", "gap", "shear", "slip", "stress"}, optional
            The quantity; "stress" draws contours of √J2 in the body.
        units : mapping of str to str, optional
            Labels of "length", "force" and "stress"; mm, N/mm and MPa if not given.

        Returns
        -------
        matplotlib.axes.Axes
            The axes that were drawn on.

        Raises
        ------
        ValueError
            For another name, axes or units, and for the shear of a contact without one.
        ImportError
            If Matplotlib is not installed.
        """
        from sie.plots.one_axes import of_solution

        return of_solution(self, ax, what, units)

    def _repr_png_(self) -> bytes | None:
        """The picture that a notebook shows; None without Matplotlib."""
        try:
            from sie.plots.contact_plot import picture
        except ImportError:
            return None
        return picture(self)._repr_png_()

    def with_(self, **changes: Any) -> Solution:
        """The solution of a changed scene, which keeps the stages that cannot have changed.

        Parameters
        ----------
        **changes
            Fields of `Scene` and their new values. `normal_load` and `half_width` replace each
            other, and so do `tilt` and `moment`.

        Returns
        -------
        Solution
            A new solution; this one stays as it is.

        Raises
        ------
        ValueError
            For a name that is no field of a scene, or a scene that is no contact problem.

        Examples
        --------
        >>> import sie
        >>> light = sie.solve(sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0))
        >>> round(light.with_(normal_load=4.0).half_width / light.half_width, 12)
        2.0
        """
        scene = changed_scene(self.scene, changes)
        refuse_uncovered(scene)
        new, kept = Solution(scene, self.tol, self.economy), kept_stages(self.scene, scene)
        new.__dict__.update({name: self.__dict__[name] for name in kept & self.__dict__.keys()})
        return new

    def __repr__(self) -> str:
        return f"Solution({self.scene!r}, tol={self.tol!r})"


def solve(scene: Scene, tol: float = 1e-13, economy: Collection[str] = ECONOMY) -> Solution:
    """The solution of a scene, as a lazy view: nothing is computed yet.

    Parameters
    ----------
    scene : Scene
        The question.
    tol : float, optional
        Relative accuracy that is asked of the resolution of functions and of the certificate.
    economy : collection of str, optional
        What may be skipped; () computes everything, with the same answer.

    Returns
    -------
    Solution
        Its attributes compute what they need when they are read.

    Raises
    ------
    ValueError
        For a scene, tolerance or economy that is none.
    ContactError
        For loads that are not covered, as far as that shows without a solution.

    Examples
    --------
    >>> import sie
    >>> scene = sie.Scene(profile=sie.Parabola(radius=100.0), modulus=80e3, normal_load=50.0)
    >>> round(sie.solve(scene).half_width, 6)
    0.282095
    """
    refuse_uncovered(scene)
    tol = arguments.tolerance(tol)
    names = () if economy is ECONOMY else arguments.listed("economy", economy, "a set of names")
    for name in names:
        if not arguments.among(name, ECONOMY):
            raise ValueError(f"economy {name!r} is not known: choose among {sorted(ECONOMY)}")
    return Solution(scene, tol, economy)
