"""What slip costs, and what it shifts, in a part of a step."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.graded_panels import OF_SERIES, Rule
from sie.numerics.zones import united

from .potentials import GainedSlip
from .state import SAME, Contact, Ends, State, intervals

Array = NDArray[np.float64]


def paired(slip: GainedSlip, density: Callable[[Rule], Array], contact: Contact) -> float:
    """∫ d s Δg dx of a density d on a contact, s the direction of slip."""
    total = 0.0
    for lo, hi, sense, pieces in slip.slipped:
        marks = np.unique(np.concatenate((pieces.marks, contact.limit.marks)))
        rule = Rule.graded(intervals([(lo, hi)], marks, SAME * contact.width), OF_SERIES)
        total += sense * float(rule.weight @ (density(rule) * pieces.on(rule)))
    return total


def drag(before: State, after: State, stuck: Ends) -> float:
    """π E*/2 times the shift of the indenter, but for a multiple of ΔQ that is always the same.

    It is -∫Δq ln|x_s - t| dt + π Δτ x_s, x_s in the longest of the zones that stuck all along.
    """
    old, new = before.contact, after.contact
    if not stuck:
        raise ContactError("no point stuck all along: how far slip shifts is not covered")
    lo, hi = max(stuck, key=lambda zone: zone[1] - zone[0])
    x_s = 0.5 * (lo + hi)
    marks = np.unique(np.concatenate((before.marks, after.marks, [x_s])))
    rule = Rule.graded(intervals(united((*old.patches, *new.patches)), marks, SAME * new.width))
    change = rule.weight * (after.shear.on(rule) - before.shear.on(rule))
    log = np.log(np.abs(rule.apart_from(x_s)))
    return float(-(change @ log) + math.pi * (new.tau - old.tau) * x_s)
