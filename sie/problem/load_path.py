"""Load paths: the turning points of the loads, as a value."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from numbers import Integral
from typing import Any

from sie import arguments

MOST_POINTS = 10**6  # of a path cut into parts
TOUCHING = "the bodies must touch all along the path, which may begin at (0, 0, 0)"


@dataclass(frozen=True)
class Path:
    """A load path: the turning points (P, Q, σ) of its loads.

    Parameters
    ----------
    points : iterable of sequence of float
        (P, Q, σ) or (P, Q): normal load and tangential load in force per length, bulk stress in
        units of stress. Loads change in proportion to time from each point to the next. The path
        may begin unloaded, at (0, 0, 0).

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

    def __init__(self, points: Iterable[Sequence[float]]) -> None:
        given = arguments.listed("points", points, "[(P, Q, σ), ...]")
        found = tuple(_point(k, point) for k, point in enumerate(given))
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
        points = [self.points[0]]
        for end in self.points[1:]:
            start = points[-1]
            points += [
                tuple(a + share * (b - a) for a, b in zip(start, end, strict=True))
                for share in shares
            ]
            points.append(end)
        return Path(points)

    def __repr__(self) -> str:
        return f"Path({list(self.points)!r})"


def _point(k: int, point: Any) -> tuple[float, float, float]:
    try:
        values = tuple(point)
    except TypeError:
        values = ()
    if len(values) not in (2, 3):
        raise ValueError(f"point {k} of the path is {point!r}: give (P, Q) or (P, Q, σ)")
    P, Q, sigma = (
        arguments.finite(f"{name} of point {k}", v)
        for name, v in zip("PQσ", (*values, 0.0)[:3], strict=True)
    )
    if P < 0.0 or (P == 0.0 and (Q != 0.0 or sigma != 0.0)):
        raise ValueError(f"P of point {k} = {P:g} is not positive: {TOUCHING}")
    return P, Q, sigma
