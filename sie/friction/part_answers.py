"""The slip in a part of a step, and what it shifts the indenter."""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial.chebyshev import chebval, chebvander
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.graded_panels import Rule

from .equations import Equations
from .gained_slip import GainedSlip
from .loading import LoadStep
from .part import Part
from .state import SAME, intervals, united
from .step_energy import Way
from .strip_part import StripPart
from .strips import TAU

Array = NDArray[np.float64]

HALVINGS = 52  # of the time at which a place comes into contact


def slip(part: Part | StripPart, step: LoadStep, x: Array) -> Array:
    """The slip at places (1-d); at one that came into contact in the part, since then."""
    found = GainedSlip(part.equations).at(x)
    old, new = (part.before.contact.patches, part.state.contact.patches)
    touches, touched = _within(x, new), _within(x, old)
    gained = touches & ~touched
    sticks = gained & _within(x, part.state.stick)  # since it touched
    found[sticks], gained = 0.0, gained & ~sticks
    if gained.any():
        found[gained] -= _slip_at_touch(part, step, x[gained])
    return np.where(touches, found, 0.0) * (2.0 / step.contacts.scene.Estar)


def drag(part: Part | StripPart) -> float:
    """π E*/2 times the shift of the indenter, but for a multiple of ΔQ that is always the same.

    It is -∫Δq ln|x_s - t| dt + π Δτ x_s, x_s a place that stuck all along.
    """
    before, after = part.before, part.state
    old, new = before.contact, after.contact
    x_s = _stuck_all_along(part)
    marks = np.unique(np.concatenate((before.marks, after.marks, [x_s])))
    rule = Rule.graded(intervals(united(old.patches, new.patches), marks, SAME * new.width))
    change = rule.weight * (after.shear.on(rule) - before.shear.on(rule))
    log = np.log(np.abs(rule.apart_from(x_s)))
    return float(-(change @ log) + math.pi * (new.tau - old.tau) * x_s)


def _within(x: Array, patches: tuple[tuple[float, float], ...]) -> NDArray[np.bool_]:
    out = np.zeros(x.shape, dtype=bool)
    for lo, hi in patches:
        out |= (x >= lo) & (x <= hi)
    return out


def _stuck_all_along(part: Part | StripPart) -> float:
    """The middle of the longest zone that stuck all along."""
    if not part.stuck:
        raise ContactError("no point stuck all along: how far slip shifts is not covered")
    lo, hi = max(part.stuck, key=lambda zone: zone[1] - zone[0])
    return 0.5 * (lo + hi)


# -- places that come into contact -----------------------------------------------------------------


def _slip_at_touch(part: Part | StripPart, step: LoadStep, x: Array) -> Array:
    """(E*/2) Δg at places when they come into contact, at an edge that grows steadily.

    The place of the edge and the slip there are series in τ, t = t0 + T τ².
    """
    old, new = part.before.contact.patches, part.state.contact.patches
    if len(old) != len(new):
        raise ContactError("the slip of a patch that appears or merges is not covered")
    found = np.zeros(x.shape)
    moments = _moments(part, step)
    for k, (was, now) in enumerate(zip(old, new, strict=True)):
        for side in (0, 1):
            a, b = sorted((was[side], now[side]))
            gained = (x >= a) & (x <= b)
            outward = (b == now[side]) == (side == 1)
            if outward and gained.any():
                edges = [equations.after.patches[k][side] for equations in moments]
                slips = [
                    GainedSlip(equations).at(np.array([e]))[0]
                    for equations, e in zip(moments, edges)
                ]
                tau = _time_at(_series([was[side], *edges]), x[gained], side == 1)
                found[gained] = chebval(2.0 * tau - 1.0, _series([0.0, *slips]))
    return found


def _moments(part: Part | StripPart, step: LoadStep) -> list[Equations]:
    """The equations at the moments of a part."""
    if isinstance(part, StripPart):
        return list(part.panel.equations)
    way = Way.back(part, step)
    shares = part.begun + (part.until - part.begun) * TAU[1:] ** 2
    return [way.equations(float(share)) for share in shares[::-1]][::-1]


def _series(values: list[float]) -> Array:
    return np.linalg.solve(chebvander(2.0 * TAU - 1.0, len(TAU) - 1), np.array(values))


def _time_at(series: Array, x: Array, rises: bool) -> Array:
    """The τ at which an edge is at places, by halving."""
    lo, hi = np.zeros(x.shape), np.ones(x.shape)
    for _ in range(HALVINGS):
        middle = 0.5 * (lo + hi)
        later = (chebval(2.0 * middle - 1.0, series) < x) == rises
        lo, hi = np.where(later, middle, lo), np.where(later, hi, middle)
    return 0.5 * (lo + hi)
