"""Both tractions of a contact as values, for what is measured on them."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import Interval

Array = NDArray[np.float64]


class InContact(NamedTuple):
    """p and q between the edges of a contact.

    contact     the edges
    marks       places where p or q is not smooth, with the edges, ascending
    rows        p and q (2, n) at places x (n,) at distances (n,) from the nearer edge
    origin      the place that x is counted from
    exact       whether these distances count, and not those of the rounded x
    """

    contact: Interval
    marks: tuple[float, ...]
    rows: Callable[[Array, Array], Array]
    origin: float = 0.0
    exact: bool = False
