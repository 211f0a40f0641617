"""The plan of a scene: the steps that it needs, those that are skipped, and the reasons.

All of it is known before anything is computed.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from html import escape

from .problem.coverage import sheared
from .problem.request import ECONOMY, wanted
from .problem.scene import Scene, refuse_no_scene

BODY = ("stress", "yield", "tension", "cycle", "crack")  # what is asked of the stress in the body
# The stages of `Solution` that answer what is asked for, beside the contact itself: where the shear
# follows from the pressure, and where one problem gives both.
TWO_PROBLEMS: dict[str, tuple[str, ...]] = {
    "edges": (),
    **dict.fromkeys(("pressure", "gap"), ("pressure",)),
    **dict.fromkeys(("shear", "energy"), ("pressure", "tangential")),
    "check": ("pressure", "tangential", "certificate"),
    **dict.fromkeys(BODY, ("pressure", "tangential", "tractions")),
}
ONE_PROBLEM: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("edges", "gap", "shear", "energy"), ()),
    "pressure": ("pressure",),
    "check": ("certificate",),
    **dict.fromkeys(BODY, ("pressure", "tractions")),
}
NO_ECONOMY = "economy is switched off"
KNOWN = "the slope is polynomial on each piece: known exactly"


@dataclass(frozen=True)
class Step:
    """One step of a plan.

    Parameters
    ----------
    name : str
        What it does.
    run : bool
        Whether it is done.
    reason : str
        Why it is done or skipped.
    stage : str
        The stage of `Solution` that it fills, "" for a decision inside a stage.
    """

    name: str
    run: bool
    reason: str
    stage: str = ""


@dataclass(frozen=True)
class Plan:
    """The work for a scene, step by step; printed as a table.

    Parameters
    ----------
    steps : tuple of Step
        The steps in the order of the work, those that are skipped included.
    """

    steps: tuple[Step, ...]

    @property
    def stages(self) -> frozenset[str]:
        """The stages of the solution that will be filled, a frozenset of str."""
        return frozenset(s.stage for s in self.steps if s.run and s.stage)

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"

    def __str__(self) -> str:
        width = max(len(s.name) for s in self.steps)
        return "\n".join(
            f"{'run ' if s.run else 'skip'}  {s.name:<{width}}  {s.reason}" for s in self.steps
        )


def plan(
    scene: Scene, want: str | Iterable[str] = "pressure", economy: Collection[str] = ECONOMY
) -> Plan:
    """The steps that a scene needs, those that are skipped, and the reasons.

    Nothing is computed here.

    Parameters
    ----------
    scene : Scene
        The question.
    want : str or iterable of str, optional
        What is asked for: "edges", "pressure", "gap", "shear", "check", "stress", "yield",
        "tension", "cycle", "crack", or attributes of the solution such as "stick", "slip" and
        "half_width".
    economy : collection of str, optional
        The savings that are allowed, as in `solve`.

    Returns
    -------
    Plan
        The steps in the order of the work.

    Raises
    ------
    ValueError
        If a name in `want` is not known.

    Examples
    --------
    >>> import sie
    >>> scene = sie.Scene(profile=sie.Parabola(100.0), modulus=80e3, normal_load=50.0)
    >>> sorted(sie.plan(scene, want="pressure").stages)
    ['normal', 'pressure']
    """
    refuse_no_scene(scene)
    names = wanted(want)
    if scene.bonded or scene.coupled:
        stages = {stage for name in names for stage in ONE_PROBLEM[name]}
        return Plan((*_of_one_problem(scene, names, stages), *_last(names, stages)))
    no_shear: dict[str, tuple[str, ...]] = dict.fromkeys(("shear", "energy"), ())
    needed = TWO_PROBLEMS | ({} if sheared(scene, economy) or scene.epsilon else no_shear)
    stages = {stage for name in names for stage in needed[name]}
    steps = (
        *_of_contact(scene, economy),
        _tilt(scene),
        _if_asked("pressure", "pressure" in stages, _expansion(scene, economy), "pressure"),
        _convexity(scene, economy),
        _coupling(scene),
        _slip(scene, "tangential" in stages, economy),
        _corrective(scene, economy),
    )
    return Plan((*steps, *_last(names, stages)))


def _step(name: str, skipped: Iterable[tuple[bool, str]], how: str, stage: str = "") -> Step:
    """The step, skipped for the first reason that holds."""
    why = next((why for holds, why in skipped if holds), "")
    return Step(name, not why, why or how, stage)


def _if_asked(name: str, asked: bool, how: str, stage: str = "") -> Step:
    return _step(name, [(not asked, "not asked for")], how, stage)


def _last(names: tuple[str, ...], stages: set[str]) -> tuple[Step, ...]:
    """The steps after the tractions."""
    stress = "from the potentials of the tractions, each once; no complex arithmetic on the surface"
    maxima = (("yield", "J2 in the body"), ("tension", "σ_xx on the surface"))
    found = " and ".join(what for name, what in maxima if name in names)
    certificate = "residual, equilibrium and inequalities on other points"
    return (
        _if_asked("stress", "tractions" in stages, stress, "tractions"),
        _if_asked("maxima", bool(found), f"{found}: scanned, then polished with exact gradients"),
        _if_asked("certificate", "certificate" in stages, certificate, "certificate"),
    )


# -- pressure and shear are one problem ------------------------------------------------------------


def _of_one_problem(scene: Scene, names: tuple[str, ...], stages: set[str]) -> Iterable[Step]:
    """The steps of full stick, and of dissimilar bodies in partial slip."""
    beta = f"β = {scene.beta:.4g}: p and q are one problem"
    coupled = "β q is left out: Goodman's approximation" if scene.neglects_beta else beta
    slip, energy = "the shear and the slip come with the pressure", list[Step]()
    if scene.bonded:
        first = [("full stick", "one equation for p + iq, solved on the whole punch", "bonded")]
        slip = "infinite friction: nothing slips"
    elif scene.tangential_load or scene.tau:
        first = [
            ("coupling", f"{coupled}; first under P alone", "pressed"),
            ("zones", "of the slip gradient that P left, edges together, by Newton", "coupled"),
        ]
        energy = [_if_asked("energy", "energy" in names, "the power of friction, over states")]
    else:
        first = [("coupling", f"{coupled}; the contact grows by flat punches", "coupled")]
    return (
        *(Step(name, True, how, stage) for name, how, stage in first),
        Step("edges", True, "known with it", "normal"),
        *energy,
        _if_asked("pressure", "pressure" in stages, "a part of the solution", "pressure"),
        Step("inequalities", False, "the certificate measures them"),
        Step("slip", False, slip),
    )


# -- first the pressure ----------------------------------------------------------------------------


def _of_contact(scene: Scene, economy: Collection[str]) -> tuple[Step, ...]:
    """The steps to the edges, of one patch or of a profile that may touch in several."""
    profile, pieces, several = scene.profile, scene.profile.pieces, scene.profile.of_several
    series = "one Chebyshev series in the contact, or pieces on a window"
    if several:
        series = "pieces of Chebyshev series where contact is possible"
    ends = any(abs(end) != float("inf") for end in profile.domain)
    given = "half-width" if scene.half_width is not None else "load"
    sharp = " or sharp at the ends of the indenter" * ends
    edges = f"{given} given: smooth edges{sharp}, by bracketed Newton with exact derivatives"
    if several:
        edges = "load given: patches from a grid, their edges by Newton, verified by bounds"
    uneven = (
        (several, "not used for patches: the edges of all"),
        ("symmetry" not in economy, f"{NO_ECONOMY}: both edges"),
        (scene.tilt != 0.0, "the tilt breaks it: both edges"),
        (bool(scene.epsilon), "friction breaks it: both edges"),
        (profile.axis is None, "the profile has no axis: both edges"),
    )
    why = [(holds, f"{reason} are unknown") for holds, reason in uneven]
    extra = " while the tilt is zero" * (scene.moment is not None)
    even = f"about x = {profile.axis or 0.0:g}{extra}: half the unknowns, half the pieces"
    flat = int(pieces.is_zero.sum()) if scene.tilt == 0.0 and not several else 0
    free = (
        (several, "not told apart: values of h' on all pieces are summed"),
        (not flat, "there are none"),
        ("zero panels" in economy, f"{flat} of {len(pieces.origins)} cost nothing: h' = 0 there"),
    )
    return (
        _step("resolution", [(not pieces.functions, KNOWN)], f"the slope is a function: {series}"),
        Step("edges", True, edges, "normal"),
        _step("symmetry", why, even),
        _step("flat pieces", free, f"{flat} integrated although zero: {NO_ECONOMY}"),
    )


def _tilt(scene: Scene) -> Step:
    how = "the moment is given: the tilt is found by Newton, dM/d(tilt) known in closed form"
    return _step("tilt", [(scene.moment is None, f"given: {scene.tilt:g}")], how)


def _expansion(scene: Scene, economy: Collection[str]) -> str:
    """How the pressure is written."""
    if scene.profile.of_several:
        return "values of the slope on all patches, summed: no unknown but the edges"
    if scene.epsilon or "transform" not in economy:
        return "exact panels on the pieces of the slope in the contact"
    return "one DCT where the slope in the contact is smooth, else exact panels on its pieces"


def _convexity(scene: Scene, economy: Collection[str]) -> Step:
    profile = scene.profile
    skipped = (
        (profile.of_several, "not asked: patches are found whatever the profile"),
        (
            profile.convex and "convexity" in economy,
            "the profile is known to be convex: one patch, p > 0",
        ),
    )
    why = NO_ECONOMY if profile.convex else "the profile is not known to be convex"
    how = f"{why}: one patch where h' rises, otherwise as patches"
    return _step("convexity", skipped, how, "rises")


# -- then the shear --------------------------------------------------------------------------------


def _coupling(scene: Scene) -> Step:
    beta = f"β = {scene.beta:.4g}"
    skipped = (
        (scene.beta == 0.0, "β = 0: pressure and shear are uncoupled"),
        (scene.neglects_beta, "β q is left out: Goodman's approximation"),
        (not scene.slides, f"{beta}, but f = 0: no shear acts back on the pressure"),
    )
    edges = f"edges with exponents 1/2 ± {abs(scene.epsilon):.3g}"
    shear = f"{beta} and q = {scene.slides * scene.friction:g} p"
    return _step("coupling", skipped, f"{shear}: {edges}, panels with Lerch's function")


def _slip(scene: Scene, asked: bool, economy: Collection[str]) -> Step:
    sliding = "full sliding: the shear traction is f times the pressure, nothing to solve"
    skipped = (
        (scene.friction == 0.0, "f = 0: there is no shear traction"),
        (bool(scene.epsilon), sliding),
        (not sheared(scene, economy), "Q = 0 and no bulk stress: there is no shear traction"),
        (not asked, "not asked for"),
    )
    patches = " on all patches" * scene.profile.of_several
    how = f"zones of stick and slip for Q at constant P, slip in one direction{patches}"
    both = "zones of stick and slip for Q and σ in proportion: one direction or two, by the"
    return _step("slip", skipped, f"{both} inequalities" if scene.tau else how, "tangential")


def _corrective(scene: Scene, economy: Collection[str]) -> Step:
    """A decision inside the slip stage."""
    skipped = (
        (not sheared(scene, economy), "there is no shear traction"),
        (
            bool(scene.slides) and "sliding" in economy,
            "|Q| = f P, full sliding: q is f times the pressure, no second solve",
        ),
    )
    how = "the contact under P - |Q|/f is the stick zone: found as that under P"
    if scene.tau:
        how += "; not where slip goes both ways"
    elif scene.profile.pieces.has_zero:
        how += "; none if nothing but the flat base sticks"
    if scene.profile.of_several:
        how = "the patches under P - |Q|/f are the stick zones: found as those under P"
    return _step("corrective", skipped, how)
