"""The solution of a scene: a lazy view over the stages of the work.

Each result is computed when it is read first, and `vars(solution)` shows the computed ones. The
stages, and what is answered from them, are in `answers`.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from . import arguments
from .answers.body import BodyAnswers
from .answers.derivatives import DerivativeAnswers
from .answers.sheared import Sheared, changed_scene, kept_stages
from .answers.surface import SurfaceAnswers
from .problem.coverage import refuse_uncovered
from .problem.request import ECONOMY
from .profiles.placed_traces import traces_in

if TYPE_CHECKING:  # what a stage needs is imported when it is computed
    from .certificate.result import Certificate
    from .certificate.trace_noise import TraceReport
    from .patches.result import PatchCertificate
    from .problem.scene import Scene


class Solution(SurfaceAnswers, BodyAnswers, DerivativeAnswers, Sheared):
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

    def __getstate__(self) -> dict[str, Any]:
        """The stages; the question alone where they hold functions, which no pickle takes."""
        scene, state = self.scene, vars(self)
        computed_again = scene.coupled or math.isfinite(scene.profile.period)
        if type(self) is not Solution or not computed_again:
            return state
        return {name: state[name] for name in ("scene", "tol", "economy")}

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
