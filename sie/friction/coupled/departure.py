"""How far Goodman's approximation is from the coupled answer: the stick zone and the peak."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from sie.contact.normal import normal_contact
from sie.contact.pressure import pressure
from sie.errors import ContactError
from sie.problem.scene import Scene

from .goodman import goodman_flat

NEGLECT = "note: β q is left out of the normal equation (Goodman's approximation)"


def departure(scene: Scene, tol: float, coupled_contact: Callable[..., Any]) -> str:
    """A sentence; with figures for the normal load on a symmetric convex profile.

    `coupled_contact` finds the contact with both couplings.
    """
    if scene.slides:
        return f"{NEGLECT}: in full sliding the pressure is that without friction"
    try:
        if scene.tilt or scene.moment:
            raise ContactError("not symmetric")
        upright = replace(scene, coupling="full", tangential_load=0.0, moment=None)
        _, state = coupled_contact(upright, lambda one: normal_contact(one, tol))
        if math.isnan(state.axis):
            raise ContactError("not symmetric")
    except ContactError:
        return f"{NEGLECT}; how far the answer is from the coupled one is not known here"
    k, c = goodman_flat(abs(scene.beta), scene.friction).c, state.flat.c
    found = f"c/b = {k:.6g} instead of {c:.6g} ({_percent(k, c)})"
    simple = normal_contact(scene, tol)
    axis = np.array([state.axis])
    p, coupled = float(pressure(simple, scene, tol)(axis)[0]), float(state.rows(axis)[0, 0])
    peak = f" and p = {p:.6g} instead of {coupled:.6g} ({_percent(p, coupled)}) on the axis"
    return f"{NEGLECT}: under the normal load {found}{peak if math.isfinite(p + coupled) else ''}"


def _percent(one: float, other: float) -> str:
    return f"{100.0 * (one - other) / other:+.2g} %"
