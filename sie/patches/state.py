"""The given loads, a state of the search for patches, events that stop it, what bounds find."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .panels import Patches

Array = NDArray[np.float64]

MOST_EFFORT = 1500.0
SAME = 1e-9  # half-widths: by which starts differ that do not lead to the same


class Given(NamedTuple):
    """The given load, and tilt or moment, in units of E*/2."""

    load: float
    tilt: float
    moment: float | None


@dataclass(frozen=True, eq=False)
class State:
    """Patches, charges of sharp edges (0 at smooth ones), and the tilt."""

    patches: Patches
    sharp: NDArray[np.bool_]  # (2N,)
    charge: Array  # (2N,)
    tilt: float

    @property
    def outward(self) -> Array:
        """-1 at a, 1 at b."""
        return np.tile([-1.0, 1.0], self.patches.number)

    @property
    def rounded(self) -> tuple[object, ...]:
        """What tells a start of Newton's method from another: edges, and which are sharp."""
        digits = SAME * np.repeat(self.patches.r, 2)
        return self.tilt, self.sharp.tobytes(), np.rint(self.patches.edges / digits).tobytes()


def balances(state: State, given: Given) -> bool:
    """Whether the given load acts between the outermost edges, as that of a pressure does."""
    P = state.patches
    return given.moment is None or bool(P.a[0] < given.moment / given.load < P.b[-1])


@dataclass
class Effort:
    """The effort of one search.

    A step of Newton's method with N patches is an effort of 1 + N/100: that of one patch takes
    milliseconds, and that of 1500 patches a second.
    """

    spent: float = 0.0

    def steps(self, patches: int) -> int:
        """How many steps are left."""
        return int((MOST_EFFORT - self.spent) / self._of_step(patches))

    def spend(self, steps: int, patches: int) -> None:
        self.spent += steps * self._of_step(patches)

    @staticmethod
    def _of_step(patches: int) -> float:
        return 1.0 + patches / 100.0


class Event(NamedTuple):
    """The event that stopped the search.

    It is "vanish" and patch k, "merge" and the gap after patch k, "sharp" or "smooth" and edge k.
    """

    kind: str
    number: int
    others: tuple[int, ...] = ()  # all patches that vanish, gaps that merge, the other such edges


class Tension(NamedTuple):
    """An interval with tension: [lo, hi] of patch k."""

    patch: int
    lo: float
    hi: float


class Overlap(NamedTuple):
    """An overlap of the bodies: [lo, hi] in gap k, most at x by `depth`.

    `largest` is the largest g of that gap.
    """

    gap: int
    lo: float
    hi: float
    x: float
    depth: float
    largest: float


class Unseen(NamedTuple):
    """What the pieces of a function have missed.

    resolution   the largest difference from it on the patches, a slope
    lowest_gap   the lowest gap over the largest one of the same gap, 0 where none is negative
    overlap      where the bodies overlap
    """

    resolution: float = 0.0
    lowest_gap: float = 0.0
    overlap: tuple[Overlap, ...] = ()


@dataclass(frozen=True)
class Findings:
    """The violations of the inequalities; none if the patches are the answer.

    lowest      the lowest bound of D over the largest D
    doubt       the largest rounding of h, a length, at a place where it hides whether the bodies
                overlap; place: where that is
    """

    tension: tuple[Tension, ...] = ()
    overlap: tuple[Overlap, ...] = ()
    lowest: float = 0.0
    doubt: float = 0.0
    place: float = 0.0

    @property
    def ok(self) -> bool:
        return not self.tension and not self.overlap
