"""The search for the contact of dissimilar bodies pressed with friction: P' and the half-width.

Here the profile is symmetric and convex; others are those of `uneven_contact`.

The half-width b comes from P = ∫P' ds. It is not larger than without friction, as friction
stiffens the contact: the frictionless contact bounds the search, and refuses what no contact can
carry. Where b reaches a corner at the indenter's end, what is left of the load is that of a flat
punch.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from sie.contact.known_contact import Edges, Normal
from sie.errors import ContactError, LoadError
from sie.numerics.interval import EPS, interval_about
from sie.numerics.root_finding import false_position
from sie.problem.scene import Scene
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope
from sie.progress_bar import reported

from .contact import FALLING, CoupledContact
from .functions import FlatFunctions, flat_functions
from .growth import Piece, power_law_growth, solved_growth
from .load_rate import GrowthPanel
from .uneven_contact import UnevenContact, uneven_contact

Array = NDArray[np.float64]

WIDER = 1.0 + 64.0 * EPS  # than the frictionless contact: as far as P' is known
NEARLY = 1e-6  # of P: then Newton's steps find the rest
SETTLED, NEWTONS = 1e-8, 6  # part of the half-width that a step moves the edge at last; most steps
TINIEST = 1e-30  # of the frictionless contact: no load is so light beside it
# Points where the symmetry of a profile is measured, and to what part of its largest slope.
LOOKS, EVEN = 64, 1e-10
AXIS_ROUNDING = (
    256.0 * EPS
)  # half-widths: such is the rounding of the frictionless contact's centre


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


def _growth(
    flat: FlatFunctions, scene: Scene, widest: float, axis: float
) -> tuple[tuple[GrowthPanel, ...], tuple[float, ...]]:
    """dP/db as far as the widest contact, and the kinks of the slope."""
    law, half_modulus = scene.profile.power_law, 0.5 * scene.Estar
    if law is not None:
        slope = half_modulus * law.exponent * law.coefficient * widest ** (law.exponent - 1.0)
        return (power_law_growth(flat, law.exponent, slope, widest * WIDER),), ()
    pieces = _pieces(scene.profile.pieces, axis, widest, half_modulus)
    kinks = tuple(piece.lo for piece in pieces[1:] if piece.kinked)
    return solved_growth(flat, pieces) if pieces else (), kinks


def _without_friction(scene: Scene) -> Scene:
    """The scene whose contact bounds the search."""
    P, b = scene.normal_load, scene.half_width
    return Scene(profile=scene.profile, modulus=scene.Estar, normal_load=P, half_width=b)


@reported("contact of dissimilar bodies")
def coupled_contact(
    scene: Scene, frictionless: Callable[[Scene], Normal]
) -> tuple[Edges, CoupledContact | UnevenContact]:
    """The edges and the state; ContactError where no contact answers.

    `frictionless` solves the normal problem of a scene; its contact bounds the search.
    """
    beta = scene.beta
    flat = flat_functions(abs(beta), scene.friction)
    half_modulus = 0.5 * scene.Estar
    bound = frictionless(_without_friction(scene))
    widest, sharp = bound.edges.contact.r, bound.edges.sharp[0]
    axis = symmetry_axis(scene, bound.edges)
    if axis is None:
        return uneven_contact(scene, bound)
    growth, kinks = _growth(flat, scene, widest, axis)
    ahead, load, corner = _width(growth, widest, sharp, scene)
    _refuse_falling(growth, ahead, axis)
    b = (growth[0].origin if growth else 0.0) + ahead
    contact = interval_about(axis, b).rounded((axis,))
    state = CoupledContact(
        flat,
        growth,
        corner,
        axis,
        ahead,
        load,
        math.copysign(1.0, beta),
        half_modulus,
        tuple(k for k in kinks if k < b),
    )
    edges = Edges(
        contact, load, contact.m * load, 0.0, (corner > 0.0, corner > 0.0), 0.0, 0.0, 0.0, 0
    )
    return edges, state


def _pieces(slope: Slope, axis: float, widest: float, half_modulus: float) -> list[Piece]:
    """E*/2 h' on the right of the axis, piece by piece, without a flat base."""
    hi = slope.domain[1]
    end = min(axis + widest * WIDER, hi)
    resolved = refined(slope, axis, end, EPS)
    inner = resolved.breaks[(resolved.breaks > axis) & (resolved.breaks < end)]
    ends = [axis, *inner.tolist(), end]
    declared = set(slope.breaks.tolist())
    rises = dict(slope.rises)
    pieces: list[Piece] = []
    for left, right in itertools.pairwise(ends):
        k = int(
            np.clip(
                np.searchsorted(resolved.breaks, left, "right") - 1, 0, len(resolved.origins) - 1
            )
        )
        if not pieces and resolved.is_zero[k]:
            continue

        def H(ahead: Array, k: int = k, left: float = left) -> Array:
            at = np.array([left])
            values: Array = resolved.local(np.array([k]), at, np.zeros(1), ahead.reshape(1, -1))
            return half_modulus * values.reshape(ahead.shape)

        jumps = left in rises or (not pieces and left > axis and float(H(np.zeros(1))[0]) > 0.0)
        pieces.append(Piece(left - axis, right - axis, H, jumps, left in declared))
    return pieces


def _width(
    growth: tuple[GrowthPanel, ...], widest: float, sharp: bool, scene: Scene
) -> tuple[float, float, float]:
    """b beyond the flat base, P and what a corner at the end of the indenter carries of it."""
    if not growth:
        assert scene.normal_load is not None
        return widest, scene.normal_load, scene.normal_load
    farthest = widest - growth[0].origin
    if scene.normal_load is None:
        return farthest, _load(growth, farthest), 0.0
    P, most = scene.normal_load, _load(growth, farthest * WIDER)
    if most >= P:
        return _root(growth, P, farthest * WIDER), P, 0.0
    if sharp:
        return farthest, P, P - _load(growth, farthest)
    raise LoadError(
        f"the coupled contact of half-width {widest:.6g} carries {most:.6g} of {P:.6g}: "
        "friction should not make it softer; give dundurs = 0 to neglect β"
    )


def _load(growth: tuple[GrowthPanel, ...], ahead: float) -> float:
    """∫P' ds as far as that beyond the flat base."""
    return sum(panel.load(ahead) for panel in growth)


def _root(growth: tuple[GrowthPanel, ...], P: float, farthest: float) -> float:
    """The distance from the first place of contact at which ∫P' = P, to relative accuracy."""
    before = 0.0  # the load of the panels that are passed whole
    for panel in growth:
        whole = panel.load(min(panel.hi, farthest))
        if before + whole >= P or panel is growth[-1]:
            break
        before += whole
    missing, hi = P - before, min(panel.hi, farthest)
    if before + whole <= P:
        return hi
    nearby, close = _newton(panel, missing, hi)
    if close:
        return nearby
    lo = panel.lo or 0.5 * hi
    while panel.load(lo) > missing and hi > TINIEST * farthest:
        lo, hi = 0.5 * lo, lo
    ends = panel.load(lo) / P - missing / P, panel.load(hi) / P - missing / P
    root = false_position(
        lambda a: (panel.load(a) - missing) / P,
        lo,
        hi,
        ends,
        lambda a, b, missed: abs(missed) <= NEARLY,
    )
    return _newton(panel, missing, root)[0]


def _newton(panel: GrowthPanel, missing: float, start: float) -> tuple[float, bool]:
    """Where the load on a panel is that, by Newton's steps, and whether they ended."""
    root = start
    for _ in range(NEWTONS):
        load, rate = panel.load_and_rate(root)
        step = missing - load
        if not abs(step) < rate * (root - panel.lo):
            break
        root = min(root + step / rate, panel.hi)
        # Convergence is quadratic
        if abs(step) <= SETTLED * rate * root:
            return root, True
    return root, False


def _refuse_falling(growth: tuple[GrowthPanel, ...], ahead: float, axis: float) -> None:
    """Raises ContactError where P' < 0.

    The profile is then not convex, and the contact would recede there.
    """
    for panel in growth:
        inside, mass = panel.places
        s = panel.lo + inside
        near = s < ahead
        if (mass[near] < -FALLING * np.abs(mass).max()).any():
            where = axis + panel.origin + float(s[near][np.argmin(mass[near])])
            raise ContactError(
                "the contact of dissimilar bodies with friction would not grow steadily at x = "
                f"{where:.6g}: "
                "coupled slip is solved for convex profiles; smooth the profile, or give dundurs "
                "= 0 to neglect β"
            )
