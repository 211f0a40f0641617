"""The points of a sweep in chunks that take a worker some tenths of a second.

To send a chunk to a worker costs some milliseconds. How long a scene takes is measured on the
chunks that are done, the latest of which count most. Scenes of a grid may differ in cost by orders
of magnitude; a worker gives back what it has not begun within `LIMIT`.
"""

from __future__ import annotations

import math

AIM = 0.2  # seconds a chunk, so that chunks stay above 0.1 s where the estimate is somewhat high
LIMIT = 1.0  # seconds after which a worker begins no further point of a chunk


class Chunks:
    """What is left of the points 0, 1, ..., n-1.

    Parameters
    ----------
    points : int
        Their number n.
    size : int, optional
        Points in a chunk; None sizes chunks by their time.
    """

    def __init__(self, points: int, size: int | None) -> None:
        self.limit = LIMIT if size is None else math.inf
        self._size = size
        self._left = [range(points)] if points else []
        self._points, self._seconds = 0.0, 0.0

    def take(self) -> range | None:
        """The next chunk, or None where none is left."""
        if not self._left:
            return None
        points, size = self._left.pop(), self._size or self._timed_size()
        if len(points) > size:
            self._left.append(points[size:])
        return points[:size]

    def measured(self, chunk: range, done: int, seconds: float) -> None:
        """Learn from a chunk whose first points are done, and take back the others."""
        self._points = 0.5 * self._points + done
        self._seconds = 0.5 * self._seconds + seconds
        if done < len(chunk):
            self._left.append(chunk[done:])

    def _timed_size(self) -> int:
        """As many points as take the time aimed at; one where no time is known yet."""
        share = min(AIM / self._seconds, 1e9) if self._seconds else 0.0
        return max(math.ceil(share * self._points), 1)
