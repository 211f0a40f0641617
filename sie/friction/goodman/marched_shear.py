"""The shear before Q, where the stick zone receded at one end and growth is not in proportion.

On the stick zone q = f (V - p) in the left half and f (p - U) in the right one (`history`), exact
next to both ends; V and U are tabulated, as each value is an integral over all of the growth.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.slip_state import Step

from .history import lack
from .root_table import RootTable
from .spells import Spell

Array = NDArray[np.float64]

RESOLVED = 1e-12  # of the largest V: the last coefficients of its series
APART = 1e-7  # of the half-width: marks of the table nearer to each other are one
LIGHTER = (0.8, 0.9, 0.95, 0.98, 0.99, 0.995)  # of the load: the first of which enough sticks
KEPT = 0.5  # of the stick zone: that much must have stuck under the lighter load and ever since


@dataclass(frozen=True, eq=False)
class MarchedShear:
    """The shear after these spells, `touch` the place of first touch."""

    step: Step
    spells: tuple[Spell, ...]
    touch: float

    @property
    def stick(self) -> tuple[float, float]:
        lo, hi = self.spells[-1].ends[1, 2:]
        return self.touch + float(lo), self.touch + float(hi)

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Where the ends of contact and stick zone were as the growth changed."""
        places = {self.touch}
        for before, after in zip(self.spells, self.spells[1:], strict=False):
            if before.marked_before(after):
                places |= {self.touch + x for x in before.ends[1].tolist()}
        return tuple(sorted(places))

    @cached_property
    def _halves(self) -> tuple[RootTable, RootTable]:
        """V and U on both halves of the stick zone."""
        lo, hi = self.stick
        middle, apart = 0.5 * (lo + hi), APART * self.step.pressure.contact.r

        def table(first: float, last: float, sign: float) -> RootTable:
            marks = [first]
            for x in self.marks:
                if marks[-1] + apart < x < last - apart:
                    marks.append(x)

            def values(x: Array) -> Array:
                return lack(self.spells, x - self.touch, sign)

            return RootTable(values, np.array([*marks, last]), RESOLVED)

        return table(lo, middle, 1.0), table(middle, hi, -1.0)

    def __call__(self, x: Array) -> Array:
        """q in the contact."""
        step = self.step
        f, f_p = step.scene.friction, step.scene.friction * step.pressure(x)
        lo, hi = self.stick
        q = np.where(x >= hi, f_p, -f_p)
        middle = 0.5 * (lo + hi)
        low, high = (x > lo) & (x < middle), (x >= middle) & (x < hi)
        V, U = self._halves
        q[low], q[high] = f * V(x[low]) - f_p[low], f_p[high] - f * U(x[high])
        return q

    # -- under a lighter load ----------------------------------------------------------------------

    @cached_property
    def lighter(self) -> MarchedShear:
        for part in LIGHTER:
            before = self._under(part)
            lo, hi = self._kept(before)
            first, last = self.stick
            if hi - lo >= KEPT * (last - first):
                return before
        raise ContactError(
            "the stick zone moves so fast with the load that its shear in Goodman's approximation "
            "cannot be examined; give dundurs = 0 to neglect β"
        )

    @property
    def untouched(self) -> tuple[float, float]:
        return self._kept(self.lighter)

    def _under(self, part: float) -> MarchedShear:
        """The shear under a part of the load."""
        step = self.step
        found = step.contact_under(part * step.normal_load, step.normal.edges.tilt)
        before = replace(step, normal=found, pressure=step.pressure_on(found), Q=0.0)
        return MarchedShear(before, _until(self.spells, before.pressure.contact.r), self.touch)

    def _kept(self, before: MarchedShear) -> tuple[float, float]:
        since = self.spells[len(before.spells) - 1 :]
        zones = np.array([before.spells[-1].ends[1, 2:], *(spell.ends[1, 2:] for spell in since)])
        return self.touch + float(zones[:, 0].max()), self.touch + float(zones[:, 1].min())


def _until(spells: tuple[Spell, ...], r: float) -> tuple[Spell, ...]:
    """The spells up to a half-width."""
    done: list[Spell] = []
    for spell in spells:
        course = spell.course
        panel = course.panel
        v = np.arcsinh(np.sqrt(max(r - panel.begin, 0.0) / panel.scale))
        if v < course.last and r <= panel.hi:
            y = 2.0 * (v - course.first) / (course.last - course.first) - 1.0
            return (*done, spell.until(float(y))) if y > -1.0 else tuple(done)
        done.append(spell)
    return tuple(done)
