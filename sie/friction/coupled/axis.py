"""The axis of a contact whose profile is symmetric."""

from __future__ import annotations

import numpy as np

from sie.contact.known_contact import Edges
from sie.numerics.interval import EPS
from sie.problem.scene import Scene

AXIS_ROUNDING = 256.0 * EPS  # half-widths: the rounding of the frictionless contact's centre
LOOKS, EVEN = 64, 1e-10


def symmetry_axis(scene: Scene, bound: Edges) -> float | None:
    """The axis of the profile, or of the frictionless contact if h' is odd about it there.

    None if the profile is not symmetric.
    """
    profile, contact = scene.profile, bound.contact
    if profile.axis is not None:
        return profile.axis
    # Next to the edges too, as a light load only reaches the beginning of rounded edges
    part = np.append((np.arange(LOOKS) + 0.5) / LOOKS, 1.0 - 0.5 ** np.arange(2.0, 40.0))
    breaks = profile.pieces.breaks
    # Between a place where h' is not smooth and the mirror image of another too
    kinks = np.abs(breaks - contact.m)
    kinks = np.unique(np.append(kinks[kinks < contact.r], (0.0, contact.r)))
    y = np.append(contact.r * part, 0.5 * (kinks[:-1] + kinks[1:]))
    right, left = profile.slope(contact.m + y), profile.slope(contact.m - y)
    if float(np.abs(right + left).max()) > EVEN * float(np.abs(right).max()):
        return None
    nearest = float(breaks[np.argmin(np.abs(breaks - contact.m))])
    # The axis of a symmetric trace is one of its points, or half-way between two
    return nearest if abs(nearest - contact.m) <= AXIS_ROUNDING * contact.r else contact.m
