"""Load paths: turning points of the loads, as a value, and the scene that a path starts from."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from numbers import Integral
from typing import Any

from sie import arguments
from sie.arguments import abridged
from sie.errors import ContactError

from .scene import Scene, refuse_no_scene

MOST_POINTS = 10**6  # of a path cut into parts
TOUCHING = "the bodies must touch all along the path, which may begin at (0, 0, 0)"
# as of a scene
LARGEST = ("P", arguments.LARGEST_LOAD), ("Q", arguments.LARGEST_LOAD), ("σ", arguments.LARGEST)


@dataclass(frozen=True)
class Path:
    """A load path: the turning points (P, Q, σ) of its loads.

    Parameters
    ----------
    points : iterable of sequence of float
        (P, Q, σ) or (P, Q): normal load and tangential load in force per length, bulk stress in
        units of stress. Loads change in proportion to time from each point to the next. The path
        may begin unloaded, at (0, 0, 0).
    tilt : iterable of float, optional
        For each point an angle that is added to the tilt of the scene.
    moment : iterable of float, optional
        In place of `tilt`: for each point ∫p x dx about x = 0, force per length times length, which
        is added to the moment of the scene.

    Raises
    ------
    ValueError
        For values that are no loads, or where the bodies do not touch.

    Examples
    --------
    >>> Path([(10.0, 0.0), (10.0, 2.0), (10.0, -2.0)]).points[1]
    (10.0, 2.0, 0.0)
    """

    points: tuple[tuple[float, float, float], ...]
    tilt: tuple[float, ...] = ()
    moment: tuple[float, ...] = ()

    def __init__(
        self,
        points: Iterable[Sequence[float]],
        tilt: Iterable[float] = (),
        moment: Iterable[float] = (),
    ) -> None:
        given = arguments.listed("points", points, "[(P, Q, σ), ...]")
        found = tuple(loads_at(f"point {k}", point) for k, point in enumerate(given))
        if not found:
            raise ValueError("the path has no points: give [(P, Q, σ), ...]")
        touching = next((k for k, (P, _, _) in enumerate(found) if P > 0.0), None)
        if touching is None:
            raise ValueError(
                "P = 0 at every point of the path: nothing ever touches; add a point with P > 0"
            )
        for k, (P, _, _) in enumerate(found):
            if P == 0.0 and k > touching:
                raise ValueError(f"P of point {k} = 0 is not positive: {TOUCHING}")
        object.__setattr__(self, "points", found)
        for name, values in (("tilt", tilt), ("moment", moment)):
            object.__setattr__(self, name, _of_points(name, values, len(found)))
        if self.tilt and self.moment:
            raise ValueError("both tilt and moment of a path given: give one, the other follows")

    @property
    def turns(self) -> tuple[float, ...]:
        """What is added to the scene's tilt or moment at each point."""
        return self.tilt or self.moment or (0.0,) * len(self.points)

    @property
    def first_contact(self) -> tuple[float, float]:
        """P, and the tilt or moment added, at the first point at which the bodies touch."""
        loads = zip(self.points, self.turns, strict=True)
        return next((P, turn) for (P, _, _), turn in loads if P > 0.0)

    def __len__(self) -> int:
        return len(self.points)

    def subdivided(self, parts: int) -> Path:
        """The same path with every step, but that to the first point, in equal parts.

        Parameters
        ----------
        parts : int
            Into how many parts a step is cut, at least 1.

        Returns
        -------
        Path
            The path that shows what happens between two turning points.

        Raises
        ------
        ValueError
            If `parts` is no whole number of at least 1.

        Examples
        --------
        >>> Path([(10.0, 0.0), (10.0, 2.0)]).subdivided(2)
        Path([(10.0, 0.0, 0.0), (10.0, 1.0, 0.0), (10.0, 2.0, 0.0)])
        """
        if isinstance(parts, bool) or not isinstance(parts, Integral) or parts < 1:
            raise ValueError(
                f"parts = {parts!r} is not a whole number of at least 1: give how many parts a "
                "step gets"
            )
        if parts * len(self.points) > MOST_POINTS:
            raise ValueError(
                f"parts times the {len(self.points)} points of the path are more than "
                f"{MOST_POINTS}: give fewer parts"
            )
        shares = [k / int(parts) for k in range(1, int(parts))]
        rows = [(*point, turn) for point, turn in zip(self.points, self.turns, strict=True)]
        cut = rows[:1]
        for start, end in pairwise(rows):
            both = tuple(zip(start, end, strict=True))
            cut += [tuple(a + share * (b - a) for a, b in both) for share in shares] + [end]
        points, turns = [row[:3] for row in cut], [row[3] for row in cut]
        return Path(points, turns if self.tilt else (), turns if self.moment else ())

    def __repr__(self) -> str:
        more = ("tilt", self.tilt), ("moment", self.moment)
        shown = "".join(f", {name}=[{abridged(values)}]" for name, values in more if values)
        return f"Path([{abridged(self.points)}]{shown})"


def _of_points(name: str, values: Any, number: int) -> tuple[float, ...]:
    """The tilt or the moment of each point; () for neither."""
    given = arguments.listed(name, values, f"one {name} for each point")
    if len(given) not in (0, number):
        raise ValueError(
            f"{len(given)} values of {name} for {number} points of the path: give one for each"
        )
    return tuple(arguments.measure(f"{name} of point {k}", v) for k, v in enumerate(given))


def loads_at(place: str, point: Any, touching: str = TOUCHING) -> tuple[float, float, float]:
    """(P, Q, σ) of a point that messages name by its place. Raises ValueError for no loads."""
    try:
        values = tuple(point)
    except TypeError:
        values = ()
    if len(values) not in (2, 3):
        raise ValueError(f"{place} of the path is {point!r}: give (P, Q) or (P, Q, σ)")
    P, Q, sigma = (
        arguments.measure(f"{name} of {place}", v, largest)
        for (name, largest), v in zip(LARGEST, (*values, 0.0)[:3], strict=True)
    )
    if P < 0.0 or (P == 0.0 and (Q != 0.0 or sigma != 0.0)):
        raise ValueError(f"P of {place} = {P:g} is not positive: {touching}")
    if P:
        arguments.positive(f"P of {place}", P, arguments.LARGEST_LOAD)
    return P, Q, sigma


# -- the scene of a path ---------------------------------------------------------------------------


def pressed_first(scene: Scene, path: Path) -> bool:
    """Whether P of dissimilar bodies grows alone, and is constant while Q and σ change."""
    if not (scene.beta and scene.friction) or scene.bonded or scene.sliding:
        return False
    if any(path.turns):
        return False
    pairs = pairwise([(P, bool(Q or sigma)) for P, Q, sigma in path.points])
    alone = path.points[0][0] != 0.0 or not any(path.points[0][1:])
    return alone and all(p == P or (p > P and not sheared) for (P, sheared), (p, _) in pairs)


def refuse_without_paths(scene: Scene) -> None:
    """Raises ValueError or ContactError for a scene without load paths."""
    refuse_no_scene(scene)
    if scene.bonded:
        raise ValueError(
            "a bonded contact never slips, so its path does not matter: give a finite friction, "
            "or solve the last point as a scene"
        )
    if scene.beta and scene.friction and not scene.sliding:
        raise ContactError(
            f"a path of dissimilar bodies (β = {scene.beta:.4g}, friction = {scene.friction:g}) is "
            "solved where P grows alone and then stays, as from (P, 0, 0) to (P, Q, σ); hold P at "
            "its mean, or give dundurs = 0"
        )


def unsheared(scene: Scene, path: Path) -> Scene:
    """The scene under the first normal load of a path alone.

    Raises ValueError or ContactError where a scene has no load paths, or the path is none, or one
    of them turns the indenter by tilt and the other by moment.
    """
    given = isinstance(path, Path) and isinstance(scene, Scene)
    if not (given and pressed_first(scene, path)):
        refuse_without_paths(scene)
    if not isinstance(path, Path):
        raise ValueError(f"{path!r} is not a path: give sie.Path([(P, Q, σ), ...])")
    for turned, held, name in (
        (path.tilt, scene.moment is not None, "moment"),
        (path.moment, scene.tilt != 0.0, "tilt"),
    ):
        if turned and held:
            raise ValueError(
                f"the scene has a {name}, which what the path turns by would change: give both "
                "as tilt or both as moment"
            )
    return replace(
        scene,
        normal_load=path.first_contact[0],
        half_width=None,
        tangential_load=0.0,
        sliding=0,
        bulk_stress=0.0,
    )
