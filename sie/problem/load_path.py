"""Load paths: the turning points of the loads, as a value."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from numbers import Integral
from typing import Any

from sie import arguments
from sie.arguments import abridged

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
            cut += [
                tuple(a + share * (b - a) for a, b in zip(start, end, strict=True))
                for share in shares
            ]
            cut.append(end)
        turns = [row[3] for row in cut]
        return Path(
            [row[:3] for row in cut],
            tilt=turns if self.tilt else (),
            moment=turns if self.moment else (),
        )

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
