"""Slip over a load path: a lazy sequence of solutions, one for each turning point.

The first point is answered like a scene: P alone, then Q and σ in proportion. From each point to
the next all loads change in proportion to time. What is exact, and covered:

    constant P, any Q                  every unloading, reloading and nested loop
    constant P, σ in proportion to Q   the same where the slip zones of the largest amplitude
                                       opened monotonically; P may change before
    P and Q at will, σ = 0             Mindlin & Deresiewicz (1953) and Jäger (1998): P grows with
                                       |dQ/dP| on either side of f, or falls

With σ = 0 the contacts of one profile at one tilt must be nested: a given moment would tilt it (but
for moment = 0 of a symmetric profile). `friction.memory` computes the layers that a step changes,
and `friction.partial_slip` the slip of a single step.

Everything else raises ContactError, which names the step and the reason. A path may begin unloaded,
at (0, 0, 0).
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Collection, Iterable, Iterator, Sequence
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
from .friction.memory import SlippedLayer, direction, turning_points
from .friction.states import OneSignedSlip, Slip
from .numerics.interval import EPS, Interval
from .numerics.zones import left_over, within
from .patches.answer import SeveralPatches
from .patches.dissipation import PatchDissipation, Untouched
from .patches.full import FullContact
from .problem.load_path import Path
from .problem.request import ECONOMY
from .problem.scene import Scene, refuse_no_scene
from .solution import Solution, solve
from .traction.base import ZERO, Density
from .traction.combination import superposed
from .traction.of_slope import SlopeDensity

Array = NDArray[np.float64]


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
    refuse_no_scene(scene)
    if not isinstance(path, Path):
        raise ValueError(f"{path!r} is not a path: give sie.Path([(P, Q, σ), ...])")
    if scene.bonded:
        raise ValueError(
            "a bonded contact never slips, so its path does not matter: give a finite friction, "
            "or solve the last point as a scene"
        )
    if scene.beta and scene.friction and not scene.sliding:
        raise ContactError(
            f"a path of dissimilar bodies (β = {scene.beta:.4g}) with friction is not solved: "
            "pressure and shear "
            "are coupled, and only a normal load that grows is solved then; solve its points as "
            "scenes, "
            "or give dundurs = 0 to neglect β"
        )
    return History(scene, path, tol, economy)


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

    Notes
    -----
    A history is a sequence: `history[k]` is the `Solution` at turning point k, made when it is
    asked for. Stages that the points share are solved once. `history.path` is the path.
    """

    def __init__(self, scene: Scene, path: Path, tol: float, economy: Collection[str]) -> None:
        first = next(P for P, _, _ in path.points if P > 0.0)
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
        self.unit = direction(path)
        self.turning_points = turning_points(scene, path)
        self.largest = max(P for P, _, _ in path.points)
        self._plain: dict[float, Solution] = {}
        self._in_patches: dict[tuple[float, float], SeveralPatches | FullContact] = {}
        self._first_loadings: dict[tuple[float, float], Slip] = {}
        self._points: dict[int, PathSolution] = {}
        self._energy: list[float] = []
        self._tau = replace(self.scene, bulk_stress=1.0).tau  # of a unit of bulk stress
        self._known: dict[float, KnownZones] = {}

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

    def plain(self, P: float) -> Solution:
        """The contact under P without shear."""
        if P not in self._plain:
            if P == 0.0:
                raise LoadError("the path is at P = 0 here: nothing touches; ask for a later point")
            self._plain[P] = Solution(replace(self.scene, normal_load=P), self.tol, self.economy)
        return self._plain[P]

    def under(self, load: float, tilt: float) -> SeveralPatches | FullContact:
        """The contact in several patches under a load at a tilt."""
        if (load, tilt) not in self._in_patches:
            any_load = self.plain(self.largest)
            self._in_patches[load, tilt] = any_load.patches_under(load, tilt)
        return self._in_patches[load, tilt]

    def first_loading(self, P: float, depth: float) -> Slip:
        """The state of the contact under P that never slipped, after the loads depth × unit."""
        key = (P, depth)
        if key not in self._first_loadings:
            plain, f = self.plain(P), self.scene.friction
            Q, sigma = depth * self.unit[0], depth * self.unit[1]
            if abs(Q) >= f * P * (1.0 - 4.0 * EPS):
                Q = math.copysign(f * P, Q)
            near = self._known.setdefault(P, KnownZones())
            found = plain.first_loading((Q, sigma * self._tau), self.under, near.guess(depth))
            if isinstance(found, OneSignedSlip):
                near.add(depth, found.found.edges.contact)
            self._first_loadings[key] = found
        return self._first_loadings[key]

    @property
    def period(self) -> float:
        return self.scene.profile.period

    @cached_property
    def in_one_patch(self) -> bool:
        """Whether the contact is one patch under every load of the path, by a slope that rises."""
        plain = self.plain(self.largest)
        if not isinstance(plain.normal, Normal):
            return False
        slope = plain.normal.slope(self.scene.profile)
        return self.scene.profile.convex or slope_rises(plain.slope_density, slope)

    def patches(self, P: float) -> tuple[tuple[float, float], ...]:
        """The patches of contact under P."""
        if not self.in_one_patch:
            return self.under(P, self.plain(self.largest).tilt).patches
        contact = self.dissipation.contacts.contact(P).interval
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
        fronts = [
            (k, o) for k in steps for slip in self.turning_points[k].slips for o in slip.layers
        ]
        lost = dict.fromkeys(steps, 0.0)
        if fronts:
            owners, layers = zip(*fronts, strict=True)
            loads = [self.turning_points[k].loads[0] for k in owners]
            for k, o, heat in zip(owners, layers, self._heat(loads, layers), strict=True):
                lost[k] += o.jump * heat
        return list(lost.values())

    def _heat(self, loads: Sequence[float], layers: Sequence[SlippedLayer]) -> Iterable[float]:
        """The energy that each overwritten layer dissipated, per jump."""
        if self.unit[1]:
            return [
                self._depth_energy(P, o.lower) - self._depth_energy(P, o.upper)
                for P, o in zip(loads, layers, strict=True)
            ]
        of_fronts = (self.dissipation if self.in_one_patch else self.work_in_patches).of_fronts
        return of_fronts(loads, layers, self.scene.friction).tolist()

    def _depth_energy(self, P: float, depth: float) -> float:
        return dissipated(self.first_loading(P, depth)) if depth else 0.0

    @cached_property
    def dissipation(self) -> Dissipation:
        """The dissipated energy, and the contacts under all loads of the path."""
        return Dissipation(
            self.scene,
            self.plain(self.largest).as_one_patch,
            self.tol,
            self.economy,
        )

    @cached_property
    def work_in_patches(self) -> PatchDissipation:
        """The dissipated energy where the contact is not one patch under every load."""
        widest = self.plain(self.largest).in_patches

        def under(P: float) -> SeveralPatches | FullContact | Untouched:
            tilt = widest.edges.tilt
            if P > 0.0:
                return self.under(P, tilt)
            return Untouched(self.scene.profile, tilt, widest.patches)

        return PatchDissipation(under, self.largest, self.period)


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
        P, Q, sigma = self.history.turning_points[self.index].loads
        plain = self.history.scene
        return replace(plain, normal_load=P, tangential_load=Q, bulk_stress=sigma) if P else plain

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
    def _plain(self) -> Solution:
        return self.history.plain(self.history.turning_points[self.index].loads[0])

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
        self.P = self.state.loads[0]
        self.friction = history.scene.friction
        if history.unit[1]:
            self._refuse_retreat()

    def _refuse_retreat(self) -> None:
        """Refuse a return from loads under which slip zones have retreated.

        A scene means one monotonic loading and has an answer; after a return the state depends on
        the path.
        """
        depth, turned = self.state.memory.deepest
        if turned and not self.history.first_loading(self.P, depth).advancing:
            Q, sigma = (depth * unit for unit in self.history.unit)
            raise ContactError(
                f"step {self.index} of the path: under the largest loads, Q = {Q:.6g} with σ = "
                f"{sigma:.6g}, zones of slip have "
                "retreated on the way, and what they left depends on that way; lower Q or σ",
                step=self.index,
            )

    @property
    def advancing(self) -> bool:  # type: ignore[override]
        return not self.history.unit[1] or all(loading.advancing for _, loading in self._terms)

    @property
    def contact(self) -> Interval:  # type: ignore[override]
        return self._plain.normal.edges.contact

    @property
    def _plain(self) -> Solution:
        return self.history.plain(self.P)

    @property
    def _terms(self) -> list[tuple[float, Slip]]:
        return [
            (weight, self.history.first_loading(self.P, depth))
            for depth, weight in self.state.memory.corners
            if depth
        ]

    @property
    def _now(self) -> Slip | None:
        """The first loading whose depth is that of the last step's slip."""
        return (
            self.history.first_loading(self.P, self.state.memory.top.thickness)
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
                    self.P - depth / self.friction
                    for depth in (gone.layers[0].surface[0], gone.layers[-1].lower)
                )
                outer, inner = (self.history.patches(load) for load in (start, end))
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
        if all(state.loads[0] == self.P for state in self.history.turning_points[: self.index + 1]):
            return sum(
                (weight * loading.slip(x) for weight, loading in self._terms), np.zeros(x.shape)
            )
        total, P0 = np.zeros(x.shape), 0.0
        for index, state in enumerate(self.history.turning_points[: self.index + 1]):
            P = state.loads[0]
            if P == 0.0:
                continue
            if index and P > P0 and state.slips:
                self._refuse_new(x, index, P0, P)
            total = np.where(self._touches(x, min(P0, P) if index else P), total, 0.0) + _step_slip(
                self.history, index, x
            )
            P0 = P
        return total

    def _touches(self, x: Array, P: float) -> NDArray[np.bool_]:
        if P == 0.0:
            return np.zeros(x.shape, dtype=bool)
        return within(x, self.history.plain(P).patches, self.history.period)

    def _refuse_new(self, x: Array, index: int, P0: float, P: float) -> None:
        new = self._touches(x, P) & ~self._touches(x, P0)
        if new.any():
            raise ContactError(
                f"step {index} of the path brings x = {float(x[new][0]):.6g} into contact while it "
                "slips: how far it slipped since is not "
                f"covered; ask for points within the contact under P = {P0:.6g}",
                step=index,
            )

    def slip_now(self, x: Array) -> Array:
        return _step_slip(self.history, self.index, x)

    @cached_property
    def shift(self) -> float:
        past = self.history.turning_points[: self.index + 1]
        loads = [
            (state.loads[0], before.loads[0])
            for before, state in pairwise((past[0], *past))
            if state.memory.top
        ]
        if any(P != self.P for pair in loads for P in pair):
            raise ContactError(
                "the rigid-body shift is counted against a contact of constant width: P changed "
                "while it was sheared"
            )
        return sum(weight * loading.shift for weight, loading in self._terms)


def _step_slip(history: History, index: int, x: Array) -> Array:
    """The slip in one step, where x was in contact all along it."""
    state = history.turning_points[index]
    P, out = state.loads[0], np.zeros(x.shape)
    if state.last is not None:  # zones that slipped before have left the contact
        for o in state.last.layers:
            for depth, sign in ((o.lower, 1.0), (o.upper, -1.0)):
                if depth > 0.0:
                    out += sign * o.jump * state.last.sign * history.first_loading(P, depth).slip(x)
    return out
