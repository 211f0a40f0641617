"""Slip over a load path: a lazy sequence of solutions, one for each turning point.

On the way to the first point P and the tilt change alone, then Q and σ in proportion. From each
point to the next all loads change in proportion to time. What is exact, and covered:

    constant P and tilt, Q and σ in    layers: every unloading, reloading and nested loop (Mindlin &
    one proportion                     Deresiewicz 1953; Jäger 1998)
    P, Q, σ, tilt or moment in any     part by part, by the shear at the start of each
    way, also from P = 0
    dissimilar bodies                  P that grows alone, then Q and σ at constant P

`path_contacts` has the contacts under the loads of the path, `friction.memory` the layers,
`friction.course` the parts of a step, and `friction.path_slip` the state at one point.

Everything else raises ContactError, which names the step and the reason. `History.plan` says which
steps are followed part by part, and why. A path may begin unloaded, at (0, 0, 0).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from sie.answers.sheared import Sheared
from sie.certificate.shear_check import certificate_of_parts
from sie.errors import ContactError
from sie.friction.load_steps import (
    Followable,
    TurningPoint,
    named,
    points_of_loads,
    sheared_all_over,
    turning_points,
)
from sie.friction.loading import Loads
from sie.friction.path_slip import (
    CourseSlip,
    PathSlip,
    state_of,
    step_energy,
    step_shift,
)
from sie.inheritance import override
from sie.patches.full import FullContact
from sie.planning import Plan, Step
from sie.problem.load_path import Path, pressed_first, unsheared
from sie.problem.request import ECONOMY
from sie.progress_bar import counted
from sie.solution import Solution, solve

from .path_contacts import PathContacts

if TYPE_CHECKING:
    from sie.certificate.result import ShearCertificate
    from sie.contact.known_contact import Normal
    from sie.friction.slip import Slip
    from sie.patches.answer import SeveralPatches
    from sie.patches.result import PatchCertificate
    from sie.problem.scene import Scene
    from sie.traction.of_slope import SlopeDensity


def follow(
    scene: Scene, path: Path, tol: float = 1e-13, economy: Collection[str] = ECONOMY
) -> History:
    """The solutions at the turning points of a load path, as a lazy sequence.

    Parameters
    ----------
    scene : Scene
        Profile, bodies, friction and tilt; its loads are replaced by those of the path.
    path : Path
        Turning points of the loads.
    tol : float, optional
        As in `solve`.
    economy : collection of str, optional
        As in `solve`.

    Returns
    -------
    History
        One solution for each turning point. Nothing is solved yet.

    Raises
    ------
    ValueError
        If `path` is no path, or the scene is one of full stick.
    ContactError
        Where a step is not covered, as soon as that shows: in the loads, or once the contact is
        known.

    References
    ----------
    Mindlin & Deresiewicz, J. Appl. Mech. 20 (1953) 327-344; Jäger, Arch. Appl. Mech. 68 (1998)
    57-60.

    Examples
    --------
    >>> import sie
    >>> scene = sie.Scene(profile=sie.Parabola(100.0), modulus=80e3, normal_load=50.0, friction=0.5)
    >>> loading, unloading = sie.follow(scene, sie.Path([(50.0, 20.0), (50.0, 0.0)]))
    >>> round(loading.stick[0][1], 6), round(unloading.stick[0][1], 6)
    (0.126157, 0.21851)
    """
    return History(scene, path, tol, economy)


# -- the sequence ----------------------------------------------------------------------------------


class History(PathContacts, Sequence[Solution]):
    """The solutions at the turning points of a load path; `follow` makes it.

    Parameters
    ----------
    scene : Scene
        Profile, bodies, friction and tilt.
    path : Path
        Turning points of the loads.
    tol : float
        As in `solve`.
    economy : collection of str
        As in `solve`.
    steps : callable, optional
        The function that finds the layers at each turning point.

    Notes
    -----
    A history is a sequence: `history[k]` is the `Solution` at turning point k, made when it is
    asked for. `history.path` is the path. The contacts that the points share are solved once
    (`path_contacts`).
    """

    def __init__(
        self,
        scene: Scene,
        path: Path,
        tol: float,
        economy: Collection[str],
        steps: Callable[[Scene, Path, Followable], tuple[TurningPoint, ...]] = turning_points,
    ) -> None:
        solve(unsheared(scene, path), tol, economy)  # refuses what is not covered
        super().__init__(scene, path, tol, economy)
        self._points: dict[int, PathSolution] = {}
        self._energies: list[float] = []
        self._shifts: dict[int, float] = {}
        self._kind = PathSolution
        if steps is turning_points and pressed_first(scene, path):
            self._kind, self.turning_points = SceneSolution, points_of_loads(path)
            _ = self.scene_states  # refuses what is not covered
        else:
            self.turning_points = steps(scene, path, self)

    def __getstate__(self) -> dict[str, Any]:
        """What points share; these, and states that hold functions, are found anew."""
        return {k: v for k, v in vars(self).items() if k != "scene_states"} | {"_points": {}}

    def __len__(self) -> int:
        return len(self.turning_points)

    @overload
    def __getitem__(self, index: int) -> Solution: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Solution]: ...
    def __getitem__(self, index: int | slice) -> Solution | Sequence[Solution]:
        if isinstance(index, slice):
            return [self[k] for k in range(*index.indices(len(self)))]
        k = range(len(self))[index]
        if k not in self._points:
            touching = self.path.points[k][0] > 0.0
            self._points[k] = (self._kind if touching else PathSolution)(self, k)
        return self._points[k]

    @override
    def solution(self, scene: Scene) -> Solution:
        return Solution(scene, self.tol, self.economy)

    def subdivided(self, parts: int) -> History:
        """The history of the same path with each step divided into so many parts."""
        return follow(self.scene, self.path.subdivided(parts), self.tol, self.economy)

    @property
    def plan(self) -> Plan:
        """For each step whether layers answer it or it is followed part by part, and why.

        Returns
        -------
        Plan
            A step of the plan for each step of the path, printed as a table.
        """
        route, points = self._kind.route, self.turning_points
        how = (f"part by part: {point.why}" if point.parts else route for point in points)
        return Plan(tuple(Step(f"step {k}", True, reason) for k, reason in enumerate(how)))

    def plot(self, ax: Any = None, units: Any = None) -> Any:
        """The loop of Q over the shift that slip allows, on axes of Matplotlib.

        Parameters
        ----------
        ax, units
            As of `Solution.plot`.

        Returns
        -------
        matplotlib.axes.Axes
            The axes that were drawn on.

        Raises
        ------
        ValueError
            If the path has no loop, or for other axes or units.
        ImportError
            If Matplotlib is not installed.
        """
        from sie.plots.one_axes import of_history  # noqa: PLC0415 -- a higher layer

        return of_history(self, ax, units)

    def rows(self) -> list[dict[str, Any]]:
        """The points of the path for files.

        Returns
        -------
        list of dict
            The loads of each point, its stick zones, and the energy dissipated up to it if that is
            known.
        """
        return [self._row(k) for k in counted("turning points", range(len(self)), len(self))]

    def _row(self, index: int) -> dict[str, Any]:
        point, (P, Q, sigma, turn) = self[index], self.turning_points[index].loads
        row: dict[str, Any] = {"normal_load": P, "tangential_load": Q, "bulk_stress": sigma}
        if self.path.tilt or self.path.moment:
            row["tilt" if self.path.tilt else "moment"] = turn
        row["stick"] = [list(zone) for zone in point.stick] if P else []
        with suppress(ContactError):
            row["energy_lost"] = point.energy_lost if P else 0.0
        return row

    # -- for steps and states ----------------------------------------------------------------------

    def in_parts(self, before: TurningPoint, loads: Loads) -> TurningPoint:
        """The turning point after a step, followed part by part."""
        first = before.loads.touching(loads)
        self._refuse_unseen(first, loads)
        if first is before.loads:
            start = state_of(self, before)
        else:  # the bodies have just come into contact
            start = sheared_all_over(self, first, first.Q)
        return self.followed(start, first, loads)

    def energy(self, index: int) -> float:
        """The energy lost from the beginning of the path to a turning point."""
        known = self._energies
        for k in counted("dissipated energy, step", range(len(known), index + 1), index + 1):
            loads = self.turning_points[k].loads
            place = "step {} of the path, to"
            lost = named(k, loads, partial(step_energy, self, k), place)
            if not np.isfinite(lost):
                raise ContactError("the energy lost is no double in these units: take larger ones")
            known.append(lost + (known[-1] if known else 0.0))
        return known[index]

    @cached_property
    def scene_states(self) -> list[Solution]:
        """The points as scenes, which share the contact under P; refused if they are not covered.

        Dissimilar bodies go from the state of one point to that of the next.
        """
        found, scenes, P_before = self.solution(self.scene), list[Solution](), 0.0
        for P, Q, sigma in counted("points", self.path.points, len(self.path.points)):
            if P:
                state = found.coupled[1] if P_before == P and scenes else None
                found = found.with_(normal_load=P, tangential_load=Q, bulk_stress=sigma)
                solve(found.scene, self.tol)
                found.go_on_from(state)
            scenes.append(found)
            P_before = P
        return scenes

    def shift_of_step(self, index: int) -> float:
        """The shift of the indenter that slip adds in one step."""
        if index not in self._shifts:
            self._shifts[index] = step_shift(self, index)
        return self._shifts[index]


class PathSolution(Solution):
    """The solution at one point of a path."""

    route = "layers: contacts superposed"

    history: History

    def __init__(self, history: History, index: int) -> None:
        self.history, self.index = history, index
        self.tol, self.economy = history.tol, history.economy

    @cached_property
    def scene(self) -> Scene:  # type: ignore[override]
        """The scene of the path with the loads of this point."""
        loads = self.history.turning_points[self.index].loads
        if loads.P == 0.0:
            return self.history.scene
        plain = self._plain.scene
        return replace(plain, tangential_load=loads.Q, bulk_stress=loads.sigma)

    @property
    def _plain(self) -> Sheared:
        return self.history.plain(*self.history.turning_points[self.index].loads.normal)

    @cached_property
    def normal(self) -> Normal | SeveralPatches | FullContact:
        """The contact without shear, as of `Solution`."""
        return self._plain.normal

    @cached_property
    def in_patches(self) -> SeveralPatches | FullContact:
        """The contact in several patches, as of `Solution`."""
        return self._plain.in_patches

    @cached_property
    def pressure(self) -> SlopeDensity:
        """The pressure p(x), a stress, as of `Solution`."""
        return self._plain.slope_density

    @property
    def sheared(self) -> bool:
        """Whether there is friction, and a load that shears."""
        return self.history.scene.friction != 0.0

    @cached_property
    def tangential(self) -> Slip:
        """The state of slip at this point of the path."""
        parts = self.history.turning_points[self.index].parts
        return (CourseSlip if parts else PathSlip)(self.history, self.index)

    def _shear_certificate(
        self, of_pressures: Sequence[PatchCertificate] = ()
    ) -> ShearCertificate | None:
        if isinstance(self.tangential, CourseSlip):
            point = self.history.turning_points[self.index]
            return certificate_of_parts(self.tangential, point.parts, self.tol)
        return super()._shear_certificate(of_pressures)

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        """The stick zones at this point.

        The scene is not built for them: in a cycle of many steps that would take most of the time.
        """
        return self.tangential.stick if self.sheared else ()

    @property
    def energy_lost(self) -> float:
        """Energy that friction dissipated since the beginning of the path."""
        return self.history.energy(self.index) if self.sheared else 0.0

    def with_(self, **changes: Any) -> Solution:
        """Raises ValueError: a changed scene or path has to be followed again."""
        raise ValueError(
            "this solution is a point of a path: change the scene or the path, and follow it again"
        )

    def __repr__(self) -> str:
        return f"sie.follow({self.history.scene!r}, {self.history.path!r})[{self.index}]"


class SceneSolution(PathSolution):
    """The solution of dissimilar bodies at a point of a path."""

    route = "the state of a scene, that of its loads"

    normal, pressure = Solution.normal, Solution.pressure  # type: ignore[assignment]
    sheared, tangential = Solution.sheared, Solution.tangential
    stick, energy_lost = Solution.stick, Solution.energy_lost

    def __init__(self, history: History, index: int) -> None:
        super().__init__(history, index)
        self.__dict__.update(history.scene_states[index].__dict__)

    def __reduce__(self) -> tuple[Any, ...]:
        # The state depends on those before it, and holds functions, which no pickle takes
        return SceneSolution, (self.history, self.index)
