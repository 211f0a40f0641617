"""A sweep, and its values by name."""

from typing import Any

import numpy as np

import sie

SCENE = sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, poisson=0.3, normal_load=0.3)
LOADS, TILTS = [0.1, 0.2, 0.4], [0.0, 0.01]


def plain(found: Any) -> dict[str, Any]:
    """The arrays by name, whatever the kind of the result."""
    return (
        {name: np.asarray(found[name]) for name in found}
        if isinstance(found, dict)
        else {n: found[n].values for n in found.variables}
    )


def single(**changes: Any) -> sie.Solution:
    return sie.solve(SCENE).with_(**changes)
