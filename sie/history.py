"""Slip over a load path: a lazy sequence of solutions, one for each turning point.

The first point is answered like a scene: P and the tilt alone, then Q and σ in proportion. From
each point to the next all loads change in proportion to time. What is exact, and covered:

    constant P and tilt, Q alone       every unloading, reloading and nested loop
    P and Q at will, σ constant        Mindlin & Deresiewicz (1953) and Jäger (1998): P grows with
                                       |dQ/dP| on either side of f, or falls
    P, Q, σ and tilt together          the same superposition of tilted profiles, where both ends of
                                       the stick zone recede along the step and pass earlier ones
                                       together (`friction.load_step`)
    slip of opposite signs             at constant P with σ in proportion to Q; a first loading with
                                       P changing

`friction.memory` computes the layers that a step changes, `friction.partial_slip` the slip of a
single step, and `friction.moving_work` the energy where the pressure changes meanwhile.

Everything else raises ContactError, which names the step and the reason. A path may begin unloaded,
at (0, 0, 0).
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import accumulate, pairwise
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from .contact.inequalities import slope_rises
from .contact.pressure import Normal
from .errors import ContactError, LoadError
from .friction.dissipation import Dissipation, dissipated
from .friction.load_step import Contacts
from .friction.load_steps import turning_points
from .friction.memory import SlippedLayer
from .friction.moving_work import work
from .friction.states import NoSlip, OneSignedSlip, Slip
from .friction.turning_point import Loads, TurningPoint
from .numerics.interval import EPS, Interval
from .numerics.zones import left_over, within
from .patches.answer import SeveralPatches
from .patches.dissipation import PatchDissipation, Untouched
from .patches.friction import PatchSlip
from .patches.full import FullContact
from .problem.load_path import Path
from .problem.request import ECONOMY
from .problem.scene import Scene, refuse_no_scene
from .solution import Solution, solve
from .traction.base import ZERO, Density
from .traction.combination import superposed
from .traction.of_slope import SlopeDensity

Array = NDArray[np.float64]
# P, and what is added to the scene's tilt or moment.
Under = tuple[float, float]


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
    if not isinstance(path, Path):
        refuse_no_scene(scene)
        raise ValueError(f"{path!r} is not a path: give sie.Path([(P, Q, σ), ...])")
    refuse_uncovered(scene)
    return History(scene, path, tol, economy)


def refuse_uncovered(scene: Scene) -> None:
    """Raises ValueError or ContactError for a scene without load paths."""
    refuse_no_scene(scene)
    if scene.bonded:
        raise ValueError(
            "a bonded contact never slips, so its path does not matter: give a finite friction, "
            "or solve the last point as a scene"
        )
    if scene.beta and scene.friction and not scene.sliding:
        raise ContactError(
            f"a path of dissimilar bodies (β = {scene.beta:.4g}) with friction is not solved: what "
            "sticks again after unloading of P or a reversal of Q keeps a slip gradient that "
            "depends on every state before; solve P, then a Q that grows, as scenes, or give "
            "dundurs = 0 to neglect β"
        )


# -- the sequence ----------------------------------------------------------------------------------


class History(Sequence[Solution]):
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
    asked for. Stages that the points share are solved once. `history.path` is the path.
    """

    def __init__(
        self,
        scene: Scene,
        path: Path,
        tol: float,
        economy: Collection[str],
        steps: Callable[[Scene, Path, Contacts], tuple[TurningPoint, ...]] = turning_points,
    ) -> None:
        for turned, held, name in (
            (path.tilt, scene.moment is not None, "moment"),
            (path.moment, scene.tilt != 0.0, "tilt"),
        ):
            if turned and held:
                raise ValueError(
                    f"the scene has a {name}, which what the path turns by would change: give both "
                    "as tilt or both as moment"
                )
        first, turn = next(
            (P, turn) for (P, _, _), turn in zip(path.points, path.turns, strict=True) if P > 0.0
        )
        self.scene = replace(
            scene,
            normal_load=first,
            half_width=None,
            tangential_load=0.0,
            sliding=0,
            bulk_stress=0.0,
        )
        solve(self.scene, tol, economy)  # refuses what is not covered
        self.path, self.tol, self.economy = path, tol, frozenset(economy)
        self._first = first, turn
        self._plain: dict[Under, Solution] = {}
        self._first_loadings: dict[tuple[Under, complex], Slip] = {}
        self.largest = max(P for P, _, _ in path.points)
        self._in_patches: dict[tuple[float, float], SeveralPatches | FullContact] = {}
        self._points: dict[int, PathSolution] = {}
        self._energy: list[float] = []
        self._tau = replace(self.scene, bulk_stress=1.0).tau  # of a unit of bulk stress
        self._known: dict[Under, KnownZones] = {}
        self._dissipation: dict[float, Dissipation] = {}
        self._work_in_patches: dict[float, PatchDissipation] = {}
        self.turning_points = steps(scene, path, self)

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
            self._points[k] = PathSolution(self, k)
        return self._points[k]

    def __iter__(self) -> Iterator[Solution]:
        return (self[k] for k in range(len(self)))

    # -- the contacts of the path ------------------------------------------------------------------

    @cached_property
    def arm(self) -> float:
        """The length by which bulk stress and tilt are made forces: about π times the half-width of
        the first contact, and a power of 2, which does not round.
        """
        return 2.0 ** round(math.log2(math.pi * self.plain(*self._first).half_width))

    def level(self, loads: Loads) -> complex:
        """f P, with the tilt beyond that of the first contact as imaginary part."""
        f, turn = self.scene.friction, loads.turn - self._first[1]
        if self.curved:
            normals = self._first, loads.normal
            first, now = (self.plain(*at).tilt if at[0] else 0.0 for at in normals)
            turn = now - first if loads.P else 0.0
        level = f * loads.P
        return complex(level, f * 0.5 * self.scene.Estar * turn * self.arm) if turn else level

    @cached_property
    def curved(self) -> bool:
        """Whether the tilt follows from a moment that is carried at changing places."""
        path, scene = self.path, self.scene
        if not path.moment and (scene.moment is None or scene.moment == 0.0 == scene.profile.axis):
            return False
        normal = {(P, turn) for (P, _, _), turn in zip(path.points, path.turns, strict=True)}
        return len(normal) > 1

    def shear(self, loads: Loads) -> complex:
        """Q, with the strain of the bulk stress as imaginary part."""
        return complex(loads.Q, loads.sigma * self._tau * self.arm) if loads.sigma else loads.Q

    def contact(self, loads: Loads) -> Interval:
        return self.plain(*loads.normal).as_one_patch.edges.contact

    def half_width(self, loads: Loads) -> float:
        return self.plain(*loads.normal).half_width

    def plain(self, P: float, turn: float = 0.0) -> Solution:
        """The contact under P and what is added to the scene's tilt or moment, without shear."""
        if (P, turn) not in self._plain:
            self._plain[P, turn] = self._frictionless(P, turn)
        return self._plain[P, turn]

    def _frictionless(self, P: float, turn: float) -> Solution:
        if P == 0.0:
            raise LoadError("the path is at P = 0 here: nothing touches; ask for a later point")
        scene = replace(self.scene, normal_load=P)
        if self.path.moment:
            scene = replace(scene, moment=(scene.moment or 0.0) + turn)
        elif turn:
            scene = replace(scene, tilt=scene.tilt + turn)
        return Solution(scene, self.tol, self.economy)

    def first_loading(self, normal: Under, depth: complex, turned: bool) -> Slip:
        """The state of a contact that was never sheared after S has risen to a depth.

        `turned`: slip may have opposite directions at the two edges.
        """
        key = (normal, depth)
        if key not in self._first_loadings:
            near = self._known.setdefault(normal, KnownZones())
            guess = None if depth.imag else near.guess(depth.real)
            found = self._loaded(self.plain(*normal), depth, turned, guess)
            if isinstance(found, OneSignedSlip) and not depth.imag:
                near.add(depth.real, found.found.edges.contact)
            self._first_loadings[key] = found
        return self._first_loadings[key]

    def _loaded(
        self, plain: Solution, depth: complex, turned: bool, near: Interval | None = None
    ) -> Slip:
        f, P, Q = self.scene.friction, plain.normal_load, depth.real
        if abs(Q) >= f * P * (1.0 - 4.0 * EPS):
            Q = math.copysign(f * P, Q)
        tau = depth.imag / self.arm if depth.imag else 0.0
        return plain.first_loading((Q, tau), self.under, near, one_sign=not turned)

    def under(self, load: float, tilt: float) -> SeveralPatches | FullContact:
        """The contact in several patches under a load at a tilt."""
        if (load, tilt) not in self._in_patches:
            any_load = self.plain(self.largest, self._first[1])
            self._in_patches[load, tilt] = any_load.patches_under(load, tilt)
        return self._in_patches[load, tilt]

    @property
    def period(self) -> float:
        return self.scene.profile.period

    @cached_property
    def in_one_patch(self) -> bool:
        """Whether the contact is one patch under every load of the path, by a slope that rises."""
        plain = self.plain(self.largest, self._first[1])
        if not isinstance(plain.normal, Normal):
            return False
        slope = plain.normal.slope(self.scene.profile)
        return self.scene.profile.convex or slope_rises(plain.slope_density, slope)

    def patches(self, P: float, turn: float) -> tuple[tuple[float, float], ...]:
        """The patches of contact under P."""
        if not self.in_one_patch:
            return self.under(P, self.plain(self.largest, turn).tilt).patches
        contact = self.dissipation(turn).contacts.contact(P).interval
        return ((contact.x1, contact.x2),)

    def rows(self) -> list[dict[str, Any]]:
        """For files: the loads of each point, its stick zones, and the energy dissipated up to
        it.
        """
        names = ("normal_load", "tangential_load", "bulk_stress")
        rows = []
        for loads, point in zip(self.path.points, self, strict=True):
            stick = [list(zone) for zone in point.stick] if loads[0] else []
            energy = point.energy_lost if loads[0] else 0.0
            row = dict(zip(names, loads, strict=True))
            rows.append(row | {"stick": stick, "energy_lost": energy})
        return rows

    def energy(self, index: int) -> float:
        """The energy lost from the beginning of the path to a turning point."""
        known = len(self._energy)
        if index >= known:
            lost = self._step_energies(range(known, index + 1))
            self._energy += list(accumulate(lost, initial=self._energy[-1] if known else 0.0))[1:]
        return self._energy[index]

    def _step_energies(self, steps: range) -> list[float]:
        """The energies lost in the steps that end at these points."""
        lost = dict.fromkeys(steps, 0.0)
        upright: dict[float, list[tuple[int, SlippedLayer]]] = {}
        for k in steps:
            state = self.turning_points[k]
            for event in state.slips:
                for o in event.layers:
                    depths = o.upper, o.lower, *o.surface
                    if state.turned or self.curved or any(depth.imag for depth in depths):
                        lost[k] += o.jump * self._heat(k, o, event.timed)
                        continue
                    upright.setdefault(state.loads.turn, []).append((k, o))
        for turn, fronts in upright.items():
            owners, layers = zip(*fronts, strict=True)
            loads = [self.turning_points[k].loads.P for k in owners]
            work_of = self.dissipation(turn) if self.in_one_patch else self.work_in_patches(turn)
            heats = np.array(work_of.of_fronts(loads, layers, self.scene.friction))
            for k, o, heat in zip(owners, layers, heats.tolist(), strict=True):
                lost[k] += o.jump * heat
        return list(lost.values())

    def _heat(self, index: int, o: SlippedLayer, timed: bool) -> float:
        """The energy that an overwritten layer dissipated, per jump, on a path with bulk stress or
        tilt.
        """
        state = self.turning_points[index]
        if not any(o.surface):
            upper, lower = (self._depth_energy(state, depth) for depth in (o.upper, o.lower))
            return lower - upper
        if not timed:
            raise ContactError(
                f"step {index} of the path, to {state.loads}: one end of the stick zone is held up "
                "or passes an earlier one before the other while P or the tilt changes, and the "
                "energy lost meanwhile depends on the way; the state at its end does not",
                step=index,
            )
        if self.curved:
            raise ContactError(
                f"step {index} of the path, to {state.loads}: the tilt follows from the moment, "
                "and the energy lost while it changes is not covered; give tilt in place of moment",
                step=index,
            )
        start, end = self.turning_points[index - 1].loads, state.loads
        rise = self.level(end) - self.level(start)
        times = [1.0 - (surface / rise).real for surface in o.surface]

        def on_the_way(share: float) -> Slip:
            time = times[0] + share * (times[1] - times[0])
            surface = o.surface[0] + share * (o.surface[1] - o.surface[0])
            depth = o.upper + share * (o.lower - o.upper) - surface
            plain = self._frictionless(*start.towards(end, time).normal)
            if not depth:
                return NoSlip(plain.as_one_patch.edges.contact, self.scene.friction)
            return self._loaded(plain, depth, state.turned)

        part = times[1] - times[0]
        strain = 0.5 * self.scene.Estar * (end.turn - start.turn)
        return work(on_the_way, part * (end.P - start.P), part * strain)

    def _depth_energy(self, state: TurningPoint, depth: complex) -> float:
        if not depth:
            return 0.0
        found = self.first_loading(state.loads.normal, depth, state.turned)
        return found.energy if isinstance(found, PatchSlip) else dissipated(found)

    def dissipation(self, turn: float) -> Dissipation:
        """The dissipated energy, and the contacts under all loads of the path, at one tilt."""
        if turn not in self._dissipation:
            normal = self.plain(self.largest, turn).as_one_patch
            self._dissipation[turn] = Dissipation(self.scene, normal, self.tol, self.economy)
        return self._dissipation[turn]

    def work_in_patches(self, turn: float) -> PatchDissipation:
        """The dissipated energy where the contact is not one patch under every load."""
        if turn not in self._work_in_patches:
            widest = self.plain(self.largest, turn).in_patches

            def under(P: float) -> SeveralPatches | FullContact | Untouched:
                tilt = widest.edges.tilt
                if P > 0.0:
                    return self.under(P, tilt)
                return Untouched(self.scene.profile, tilt, widest.patches)

            self._work_in_patches[turn] = PatchDissipation(under, self.largest, self.period)
        return self._work_in_patches[turn]


class KnownZones:
    """Stick zones already computed under one P, by depth.

    A cubic through the nearest four estimates the next one.
    """

    def __init__(self) -> None:
        self._depths: list[float] = []
        self._contacts: list[Interval] = []

    def add(self, depth: float, contact: Interval) -> None:
        k = bisect_left(self._depths, depth)
        self._depths.insert(k, depth)
        self._contacts.insert(k, contact)

    def guess(self, depth: float) -> Interval | None:
        if not self._depths:
            return None
        first = max(min(bisect_left(self._depths, depth) - 2, len(self._depths) - 4), 0)
        at, zones = self._depths[first : first + 4], self._contacts[first : first + 4]
        base = zones[0]
        # Neville's scheme for the distances of both edges from those of the first zone
        moves = [
            (c.x1 - base.x1 + (c.tail1 - base.tail1), c.x2 - base.x2 + (c.tail2 - base.tail2))
            for c in zones
        ]
        for order in range(1, len(at)):
            for k in range(len(at) - order):
                t = (depth - at[k]) / (at[k + order] - at[k])
                (a, b), (c, d) = moves[k], moves[k + 1]
                moves[k] = (a + t * (c - a), b + t * (d - b))
        return base.moved(*moves[0])


class PathSolution(Solution):
    """The solution at one point of a path."""

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
    def _plain(self) -> Solution:
        return self.history.plain(*self.history.turning_points[self.index].loads.normal)

    @cached_property
    def normal(self) -> Normal | SeveralPatches | FullContact:
        return self._plain.normal

    @cached_property
    def in_patches(self) -> SeveralPatches | FullContact:
        return self._plain.in_patches

    @cached_property
    def pressure(self) -> SlopeDensity:
        return self._plain.slope_density

    @property
    def sheared(self) -> bool:
        """Whether there is friction, and a load that shears."""
        return self.history.scene.friction != 0.0

    @cached_property
    def tangential(self) -> Slip:
        return PathSlip(self.history, self.index)

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
        raise ValueError(
            "this solution is a point of a path: change the scene or the path, and follow it again"
        )

    def __repr__(self) -> str:
        return f"sie.follow({self.history.scene!r}, {self.history.path!r})[{self.index}]"


# -- one point -------------------------------------------------------------------------------------


class PathSlip(Slip):
    """Stick, slip and shear at a point of a path.

    The shear is Σ weight × first loading over the corners of the memory.
    """

    kind = "after a path"

    def __init__(self, history: History, index: int) -> None:
        self.history, self.index = history, index
        self.state = history.turning_points[index]
        self.normal = self.state.loads.normal
        self.friction = history.scene.friction
        if self.state.straight:
            self._refuse_retreat()

    def _refuse_retreat(self) -> None:
        """Refuse a return from loads under which slip zones have retreated.

        A scene means one monotonic loading and has an answer; after a return the state depends on
        the path.
        """
        depth, returned = self.state.memory.deepest
        if returned and depth.imag and not self._loading(depth).advancing:
            Q, sigma = depth.real, depth.imag / self.history.shear(Loads(0.0, 0.0, 1.0)).imag
            raise ContactError(
                f"step {self.index} of the path: under the largest loads, Q = {Q:.6g} with σ = "
                f"{sigma:.6g}, zones of slip have "
                "retreated on the way, and what they left depends on that way; lower Q or σ",
                step=self.index,
            )

    @property
    def advancing(self) -> bool:  # type: ignore[override]
        memory = self.state.memory
        if not (self.state.straight and memory.total.imag):
            return True
        return all(loading.advancing for _, loading in self._terms)

    def _loading(self, depth: complex) -> Slip:
        return self.history.first_loading(self.normal, depth, self.state.turned)

    @property
    def contact(self) -> Interval:  # type: ignore[override]
        return self._plain.normal.edges.contact

    @property
    def _plain(self) -> Solution:
        return self.history.plain(*self.normal)

    @property
    def _terms(self) -> list[tuple[float, Slip]]:
        return [
            (weight, self._loading(depth)) for depth, weight in self.state.memory.corners if depth
        ]

    @property
    def _now(self) -> Slip | None:
        """The first loading whose depth is that of the last step's slip."""
        return (
            self._loading(self.state.memory.top.thickness)
            if self.state.last and self.state.memory.top
            else None
        )

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:  # type: ignore[override]
        now = self._now
        return self._plain.patches if now is None else now.stick

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        now, last = self._now, self.state.last
        zones = (
            ()
            if now is None or last is None
            else tuple((lo, hi, sign * last.sign) for lo, hi, sign in now.slipped)
        )
        return *self._slipped_and_gone, *zones

    @property
    def _slipped_and_gone(self) -> tuple[tuple[float, float, float], ...]:
        """Zones that slipped while P fell, and where slip reversed or stopped as they left."""
        zones: list[tuple[float, float, float]] = []
        for gone in self.state.slips:
            if gone is not self.state.last:
                start, end = (
                    self.normal[0] - depth.real / self.friction
                    for depth in (gone.layers[0].surface[0], gone.layers[-1].lower)
                )
                outer, inner = (self.history.patches(load, self.normal[1]) for load in (start, end))
                left = left_over(outer, inner, self.history.period)
                zones += [(lo, hi, gone.sign) for lo, hi in left]
        return tuple(zones)

    @property
    def untouched(self) -> tuple[float, float]:
        terms = self._terms
        if not terms:
            return self.contact.x1, self.contact.x2
        return terms[-1][1].stick[0] if terms[-1][1].stick else (0.0, 0.0)

    @property
    def levels(self) -> tuple[float, ...]:
        return tuple(end for _, loading in self._terms for zone_ in loading.stick for end in zone_)

    @property
    def condition(self) -> float:  # type: ignore[override]
        return max((loading.condition for _, loading in self._terms), default=1.0)

    @cached_property
    def shear(self) -> Density:
        terms = self._terms
        if not terms:
            return ZERO
        if len(terms) == 1 and terms[0][0] == 1.0:
            return terms[0][1].shear
        full = 0.0  # times the pressure, which is taken once
        rest: list[tuple[float, Density]] = []
        for weight, loading in terms:
            scale, others = loading.parts
            full += weight * scale
            rest += [(weight * factor, density) for factor, density in others]
        return superposed((full, self._plain.pressure), *rest)

    @property
    def contacts(self) -> tuple[Any, ...]:
        return tuple(contact for _, loading in self._terms for contact in loading.contacts)

    def slip(self, x: Array) -> Array:
        """Relative slip since x came into contact."""
        past = self.history.turning_points[: self.index + 1]
        if all(state.loads.normal == self.normal for state in past):
            return sum(
                (weight * loading.slip(x) for weight, loading in self._terms), np.zeros(x.shape)
            )
        total = np.zeros(x.shape)
        for index, (before, state) in enumerate(pairwise((past[0], *past))):
            if state.loads.P == 0.0:
                continue
            if state.slips and index:
                self._refuse_new(x, index, before.loads, state.loads)
            stayed = self._touches(x, before.loads) & self._touches(x, state.loads)
            total = np.where(stayed, total, 0.0) + step_slip(self.history, index, x)
        return total

    def _touches(self, x: Array, loads: Loads) -> NDArray[np.bool_]:
        if loads.P == 0.0:
            return np.zeros(x.shape, dtype=bool)
        return within(x, self.history.plain(*loads.normal).patches, self.history.period)

    def _refuse_new(self, x: Array, index: int, before: Loads, loads: Loads) -> None:
        new = self._touches(x, loads) & ~self._touches(x, before)
        if new.any():
            raise ContactError(
                f"step {index} of the path brings x = {float(x[new][0]):.6g} into contact while it "
                "slips: how far it slipped since is not "
                f"covered; ask for points within the contact under P = {before.P:.6g}",
                step=index,
            )

    def slip_now(self, x: Array) -> Array:
        return step_slip(self.history, self.index, x)

    @cached_property
    def shift(self) -> float:
        past = self.history.turning_points[: self.index + 1]
        loads = [
            (state.loads.normal, before.loads.normal)
            for before, state in pairwise((past[0], *past))
            if state.memory.top
        ]
        if any(normal != self.normal for pair in loads for normal in pair):
            raise ContactError(
                "the rigid-body shift is counted against a contact of constant width: P changed "
                "while it was sheared"
            )
        return sum(weight * loading.shift for weight, loading in self._terms)


def step_slip(history: History, index: int, x: Array) -> Array:
    """The slip in one step, where x was in contact all along it."""
    state = history.turning_points[index]
    normal, out = state.loads.normal, np.zeros(x.shape)
    if state.last is not None:  # zones that slipped before have left the contact
        for o in state.last.layers:
            for depth, sign in ((o.lower, 1.0), (o.upper, -1.0)):
                if sign < 0.0 and depth == o.surface[0]:
                    continue  # slip began at the edges
                at, under = depth, normal
                if state.turned and sign < 0.0 and any(o.surface):
                    at = depth - o.surface[0]
                    under = history.turning_points[index - 1].loads.normal
                if at.real > 0.0 or at.imag:
                    loading = history.first_loading(under, at, state.turned)
                    out += sign * o.jump * state.last.sign * loading.slip(x)
    return out
