"""The end of a stick zone that advances while the other one recedes: here it must go on to advance.

With e and the zones of `zone_table` it is at m ± r g(e), g = 1 - the slip zone beside it, so that

    ± du2/dr = ± dm/dr + g + g'(e) (± (du/dr - dm/dr) - (e - 1)),

where dm/dr may jump, while u, the end that recedes, has one derivative by the load.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev

from .spells import Course, Spell
from .zone_table import ZoneTable

Array = NDArray[np.float64]

LOOKS = 400  # places at which the end is looked at
TURNING = 1e-9  # of the half-width: an end that recedes by so little is rounding
NEXT = 1e-3  # of half a course: so far behind its beginning rates are taken
APART = 1e-5  # of the scale of e, for a derivative by it
BACKWARDS = 1e-3  # of dr: an end that moves back faster does so surely


def refuse_both(spell: Spell) -> None:
    """Raises ContactError where the other end recedes as well in this spell."""
    other = spell.side * spell.series[4 if spell.side > 0 else 3]
    places = chebyshev.evaluate(other, np.linspace(-1.0, 1.0, LOOKS + 1))
    back = np.maximum.accumulate(places) - places
    if back.max() > TURNING * spell.values(np.ones(1), 5)[4, 0]:
        raise _both_recede(spell.course)


def refuse_both_behind(previous: Spell, course: Course, zones: ZoneTable) -> None:
    """Raises ContactError where the other end recedes as this course begins."""
    side = previous.side
    place = course.first + 0.5 * NEXT * (course.last - course.first)
    r, m, rate = (float(c[0]) for c in course.contacts(np.array([NEXT - 1.0])))
    by_y = 0.5 * (course.last - course.first) * course.panel.scale * math.sinh(2.0 * place)
    turn = float(course.turn(np.array([place]))[0])
    load_rate = float(np.polynomial.chebyshev.chebval(1.0, previous.series[2]))
    speed = end_rate(previous.receding) / load_rate * rate / by_y
    u = float(previous.ends[1, 2 if side > 0 else 3])
    e = 1.0 + side * (u - m) / r
    near = e + APART * zones.scale * np.array([-1.0, 0.0, 1.0])
    g = 1.0 - zones.zone(near, zones.ratio(near)).right_slip
    by_e = float(g[2] - g[0]) / float(near[2] - near[0])
    if side * turn + float(g[1]) + by_e * (side * (speed - turn) - (e - 1.0)) < -BACKWARDS:
        raise _both_recede(course)


def end_rate(series: Array) -> float:
    """The derivative of a series by y at its end."""
    return float(np.polynomial.chebyshev.chebval(1.0, np.polynomial.chebyshev.chebder(series)))


def _both_recede(course: Course) -> ContactError:
    r = float(course.contacts(np.array([-1.0]))[0][0])
    return ContactError(
        f"both ends of the stick zone recede at once from a half-width of {r:.6g} on, as the "
        "contact first moves aside and then back, which Goodman's approximation does not solve; "
        "raise the friction, reduce the tilt or the load, or give dundurs = 0 to neglect β"
    )
