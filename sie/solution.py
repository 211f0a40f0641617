"""The solution of a scene: a lazy view over the stages of the work.

Each result is computed when it is read first, and `vars(solution)` shows the computed ones. The
contact without shear is in `frictionless`, the stress in the body in `stress_answers`. Of the lines
here more than 300 are the docstrings of what users read in one place.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import arguments
from .contact.known_contact import Edges, Normal
from .contact.normal import contact_under
from .contact.pressure import pressure
from .derivative_answers import DerivativeAnswers
from .errors import ContactError, InequalityError
from .frictionless import Frictionless
from .numerics.interval import Interval
from .problem.coverage import held_moment, refuse_uncovered
from .problem.request import ECONOMY, sheared
from .problem.scene import Scene
from .profiles.placed_traces import traces_in
from .stages import changed_scene, kept_stages
from .stages import stage as cached_property  # its first reading is logged
from .stress_answers import StressAnswers
from .traction.base import ZERO, Density, on_line
from .traction.combination import scaled
from .traction.of_slope import SlopeDensity

if TYPE_CHECKING:  # what a stage needs is imported when it is computed
    from .cauchy.density import JacobiDensity
    from .certificate.result import Certificate, ShearCertificate
    from .certificate.trace_noise import TraceReport
    from .cracks.edge_intensity import EdgeIntensity
    from .friction.coupled.answer import LoadedContact
    from .friction.coupled.pressed import Pressed
    from .friction.coupled.traction import OnHalves
    from .friction.full_stick import Component
    from .friction.slip_state import Slip, Step
    from .patches.answer import SeveralPatches
    from .patches.friction import PatchesUnder
    from .patches.full import FullContact
    from .patches.result import PatchCertificate
    from .paths.history import History

Array = NDArray[np.float64]

NEARLY = 0.999  # of f P: a load in partial slip next to sliding
BALANCED = 1e-9  # of P times the half-width: a moment that needs no tilt


class Solution(Frictionless, StressAnswers, DerivativeAnswers):
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

    # -- stages ------------------------------------------------------------------------------------

    def _contact(self) -> Normal | SeveralPatches | FullContact:
        if self.scene.bonded:
            return Normal(self.bonded[0], False)
        if self.scene.coupled:
            return Normal(self.coupled[0], not (self.scene.tangential_load or self.scene.tau))
        return super()._contact()

    @property
    def _not_convex(self) -> Normal | SeveralPatches | FullContact:
        """The same; of dissimilar bodies that slide one patch, whose inequalities are verified."""
        if not self.scene.epsilon:
            return super()._not_convex
        from .certificate.pressure_check import certificate
        from .contact.least_gaps import TOLERATED, shown

        found = self.unverified
        density = pressure(found, self.scene, self.tol, self.economy)
        measured = certificate(density, found.slope(self.scene.profile), self.tol)
        if min(measured.lowest_pressure, measured.lowest_gap) < -TOLERATED:
            where = shown(measured.tension or measured.overlap)
            raise InequalityError(
                f"one patch of contact {density.interval} would need tension, or overlap, at "
                f"{where}, and dissimilar bodies that slide are solved in one patch only; smooth "
                "the profile, or give dundurs = 0 to neglect β",
                edges=density.interval,
                tension=measured.tension,
                overlap=measured.overlap,
            )
        return found

    @cached_property
    def bonded(self) -> tuple[Edges, JacobiDensity]:
        """The edges of a flat punch in full stick, and p + i q."""
        from .friction.full_stick import full_stick_contact

        return full_stick_contact(self.scene, self.tol)

    @cached_property
    def coupled(self) -> tuple[Edges, Pressed | LoadedContact]:
        """The edges and the state of dissimilar bodies in partial slip."""
        scene = self.scene
        if not (scene.tangential_load or scene.tau):
            return self.pressed
        state = self.locked_in.under(scene.tangential_load, scene.tau)
        return replace(state.edges, tilt=scene.tilt), state

    def go_on_from(self, before: Pressed | LoadedContact | None) -> None:
        """Goes on from another state under the same P, and not from that under P alone."""
        if before is not None and hasattr(before, "under"):
            state = before.under(self.scene.tangential_load, self.scene.tau)
            self.__dict__["coupled"] = replace(state.edges, tilt=self.scene.tilt), state

    @cached_property
    def pressed(self) -> tuple[Edges, Pressed]:
        """The same under the normal load alone."""
        from .friction.coupled.normal import coupled_contact

        scene = self._upright
        if not scene.profile.convex:
            P, b = scene.normal_load, scene.half_width
            plain = Scene(profile=scene.profile, modulus=scene.Estar, normal_load=P, half_width=b)
            _ = Frictionless(plain, self.tol).grown_as_one_patch
        edges, state = coupled_contact(scene, self._frictionless)
        lever = edges.normal_load * edges.contact.r
        if scene.moment is not None and abs(edges.moment - scene.moment) > BALANCED * lever:
            raise held_moment(self.scene)
        return replace(edges, tilt=self.scene.tilt), state

    @property
    def _upright(self) -> Scene:
        """The scene with its tilt in the profile."""
        scene = self.scene
        return replace(scene, profile=scene.profile.tilted(scene.tilt), tilt=0.0)

    @cached_property
    def locked_in(self) -> LoadedContact:
        """The same with what it locks in, from which Q and bulk stress lead to other states."""
        from .friction.coupled.answer import pressed_contact

        return pressed_contact(self.pressed[1])

    def _frictionless(self, scene: Scene) -> Normal:
        return Frictionless(scene, self.tol).unverified

    @property
    def normal_and_shear(self) -> JacobiDensity:
        """The traction p + i q in full stick."""
        _ = self.normal
        return self.bonded[1]

    @cached_property
    def pressure(self) -> SlopeDensity | Component | OnHalves:
        """The contact pressure p, a `Density` in units of stress.

        Returns
        -------
        Density
            `pressure(x)` gives its values, `.resultant` and `.moment` its load, `.cauchy(z)` its
            Cauchy potential ∫p(t)/(t - z) dt up to a factor, and `.hilbert(x)` the principal value.

        Raises
        ------
        ContactError
            If the profile carries no such load.
        """
        if self.scene.bonded:
            from .friction.full_stick import Component

            return Component(self.normal_and_shear, imaginary=False)
        _ = self.normal
        if self.scene.coupled:
            return self.coupled[1].tractions[0]
        several = self._several
        return self.density if several is None else cast(SlopeDensity, several.pressure)

    @property
    def _loads(self) -> tuple[float, float]:
        return self.tangential_load, self.scene.tau if self.scene.friction else 0.0

    @property
    def sheared(self) -> bool:
        """Whether the shear is found after the pressure: partial slip, or similar bodies."""
        scene = self.scene
        elsewhere = scene.epsilon or scene.bonded or scene.coupled
        return sheared(scene, self.economy) and not elsewhere

    @property
    def carries_shear(self) -> bool:
        """Whether there is a shear traction, of partial slip, sliding or full stick."""
        scene = self.scene
        return self.sheared or bool(scene.epsilon) or scene.bonded or scene.coupled

    @cached_property
    def tangential(self) -> Slip:
        """Zones of stick and slip, and the shear."""
        return self.first_loading(self._loads, self.patches_under)

    def first_loading(
        self,
        loads: tuple[float, float],
        under: PatchesUnder,
        near: Interval | None = None,
        *,
        one_sign: bool = False,
    ) -> Slip:
        """The state after Q and τ on this contact without shear.

        Parameters
        ----------
        loads : tuple of float
            Q, a force per unit length, and τ, a stress.
        under : callable
            The contact in several patches as a function of load and tilt.
        near : Interval, optional
            As in `load_step`.
        one_sign : bool, optional
            Whether slip is positive at both edges, whatever Q and τ.

        Returns
        -------
        Slip
            The zones of stick and slip, and the shear.

        Raises
        ------
        ContactError
            If Q exceeds f P, or no zones of stick and slip meet all conditions.
        """
        if self._several is None:
            from .friction.partial_slip import slip

            step = self.load_step(*loads, near)
            if self.convex or self._sticks_in_one_patch(step):
                return slip(step, one_sign)
        from .patches.friction import PatchSlip

        state = PatchSlip(self.scene, self.in_patches, loads, under)
        _ = state.corrective
        return state

    def _sticks_in_one_patch(self, step: Step) -> bool:
        """Whether the stick zone of slip in one direction is one patch; there may be none."""
        from .friction.partial_slip import corrective_loads

        f, Q = self.scene.friction, step.Q
        slides = not 0.0 < abs(Q) < f * step.normal_load
        if slides or math.pi * step.pressure.contact.r * abs(step.tau) > abs(Q):
            return True
        loads = corrective_loads(step, math.copysign(1.0, Q))
        return isinstance(self._contact_under(*loads).normal, Normal)

    def _contact_under(self, load: float, tilt: float) -> Frictionless:
        """The contact of the profile under another load and tilt, kept."""
        if (load, tilt) not in self._others:
            plain = self._without_shear(load, tilt)
            self._others[load, tilt] = Frictionless(plain, self.tol, self.economy)
        return self._others[load, tilt]

    @cached_property
    def _others(self) -> dict[tuple[float, float], Frictionless]:
        return {}

    def load_step(self, Q: float, tau: float, near: Interval | None = None) -> Step:
        """The load Q and the strain τ on this contact of one patch.

        Parameters
        ----------
        Q : float
            The tangential load, a force per unit length.
        tau : float
            τ, a stress.
        near : Interval, optional
            A stick zone that may be close to the one sought. It saves work, and does not change
            the answer.

        Returns
        -------
        Step
            What the states of slip are found from.
        """
        from .friction.slip_state import Step

        scene, tol, economy, normal = self.scene, self.tol, self.economy, self.as_one_patch
        under: Callable[[float, float], Normal] = partial(
            contact_under, scene=scene, tol=tol, economy=economy, near=near, seen=normal.seen
        )
        if not self.convex:
            under = lambda load, tilt: self._contact_under(load, tilt).as_one_patch  # noqa: E731
        on = partial(pressure, scene=scene, tol=tol, economy=economy)
        return Step(scene, normal, self.slope_density, Q, tau, tol, economy, under, on)

    @cached_property
    def dissipated(self) -> float:
        """The energy dissipated by slip."""
        if self.scene.coupled:
            return self.coupled[1].energy
        return self.tangential.energy

    @cached_property
    def certificate(self) -> Certificate | PatchCertificate:
        """The certificate that `check` returns, measured once."""
        if self.scene.bonded:
            from .certificate.coupled_check import full_stick_certificate

            return full_stick_certificate(
                self.normal.edges, self.normal_and_shear, self.scene, self.tol
            )
        if self.scene.coupled:
            from .certificate.coupled_check import coupled_certificate

            return coupled_certificate(self.coupled[1], self._upright, self.tol)
        others = self.tangential.contacts if self.sheared else ()
        if others or self._several is not None:
            from .patches.result import worst_of

            each = [c.certificate(self.tol) for c in (self.in_patches, *others)]
            return replace(worst_of(each), shear=self._shear_certificate(each))
        from .certificate.pressure_check import certificate

        found = certificate(self.slope_density, self._slope, self.tol)
        return replace(found, shear=self._shear_certificate())

    def _shear_certificate(
        self, of_pressures: Sequence[PatchCertificate] = ()
    ) -> ShearCertificate | None:
        """The certificate of the shear, on several patches with those of its pressures."""
        if not self.sheared:
            return None
        from .certificate.shear_check import shear_certificate

        p: Density = self.pressure
        tol = min((c.tol for c in of_pressures), default=self.tol)
        state, slope = self.tangential, self._slope
        return shear_certificate(state, p, self._loads, slope, tol=tol, of_pressures=of_pressures)

    @property
    def slope_density(self) -> SlopeDensity:
        """The pressure, where it is not that of full stick."""
        return cast(SlopeDensity, self.pressure)

    # -- answers -----------------------------------------------------------------------------------

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        """The stick zones, ((lo, hi), ...) in lengths.

        Returns
        -------
        tuple of tuple of float
            The whole contact where no tangential load was applied; () in full sliding and without
            friction.
        """
        if self.scene.epsilon:
            return ()
        if self.sheared:
            return self.tangential.stick
        if self.scene.coupled:
            return self.coupled[1].stick
        return self.patches if self.scene.friction else ()

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

    @property
    def shear(self) -> Density:
        """The shear traction q, which acts on the body along +x, a `Density` in units of stress.

        Returns
        -------
        Density
            As for `pressure`; zero everywhere without friction.
        """
        if self.scene.bonded:
            from .friction.full_stick import Component

            return Component(self.normal_and_shear, imaginary=True)
        if self.scene.epsilon:
            return scaled(self.scene.slides * self.scene.friction, self.pressure)
        if self.scene.coupled:
            _ = self.normal
            return self.coupled[1].tractions[1]
        return self.tangential.shear if self.sheared else ZERO

    @property
    def tangential_load(self) -> float:
        """Tangential load Q, force per length; ±f P in full sliding."""
        slides = self.scene.slides
        return (
            slides * self.scene.friction * self.normal_load
            if slides
            else self.scene.tangential_load
        )

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
        Where dissimilar bodies are pressed together it is counted from when a point came into
        contact: what slipped first sticks later, and keeps its slip. Where their contact spreads
        under a tangential load, or leaves a place for a while, all that the surfaces move against
        each other from when that load began is counted.

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
        The shift without slip is Q times a constant that depends on the place of observation,
        because plane elasticity leaves it undetermined. For dissimilar bodies it is that of a
        contact bonded between the edges that the normal load made.

        References
        ----------
        Johnson, Contact Mechanics (1985), § 2.2.
        """
        self._refuse_unknown_slip()
        if self.scene.coupled:
            return self.coupled[1].shift
        return self.tangential.shift if self.sheared else 0.0

    def edge_intensity(self, side: str) -> EdgeIntensity:
        """What the stress next to an edge depends on: its intensities, and how far they hold.

        Parameters
        ----------
        side : {"left", "right"}
            The edge.

        Returns
        -------
        EdgeIntensity
            `.normal` K_N, `.tangential` K_T in full stick, `.slip_length` and `.reach`.

        Raises
        ------
        ValueError
            For another side.
        ContactError
            For a contact in several patches, and for dissimilar bodies with friction, whose edges
            have other powers.

        Examples
        --------
        >>> import math, sie
        >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=math.pi / 4)
        >>> round(sie.solve(scene).edge_intensity("left").normal, 12)  # p0 sqrt(2/b) = sqrt(2)/2
        0.707106781187
        """
        if side not in ("left", "right"):
            raise ValueError(f'side = {side!r} is no edge: give "left" or "right"')
        if self.scene.beta and self.scene.friction:
            raise ContactError(
                f"dissimilar bodies (β = {self.scene.beta:.4g}) with friction have other powers at "
                "their edges than a root: give dundurs = 0 to neglect β"
            )
        if self._several is not None:
            raise ContactError(
                f"contact in {len(self.patches)} patches: what sticks at one edge depends on all; "
                "give the profile of one patch and its load"
            )
        from .cracks.edge_intensity import edge_intensity

        left = side == "left"
        loads = self.tangential_load, self.scene.tau
        return edge_intensity(
            self.pressure, self.sharp[0 if left else 1], left, loads, self.scene.friction
        )

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
        """Sentences on effects that the equations neglect for this scene.

        Returns
        -------
        tuple of str
            `strain_notes`, `coupling_notes` and `slip_notes`; () where small strains, a full
            coupling and growing slip zones are given.
        """
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
            from .friction.coupled.departure import departure
            from .friction.coupled.normal import coupled_contact

            return (departure(self.scene, self.tol, coupled_contact),)
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

        The error of the pressure that a report states is estimated from the misfit of the spline.
        The certificate measures something else: how well the equations are solved for this spline.
        The cost is a smoothing by cross validation and a dozen systems for the edges.

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

        Examples
        --------
        >>> import sie
        >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0)
        >>> axes = sie.solve(scene).plot(what="gap")    # doctest: +SKIP
        """
        from sie.plots.one_axes import of_solution

        return of_solution(self, ax, what, units)

    def _repr_html_(self) -> str:
        from sie.io.html_report import html

        return html(self)

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
