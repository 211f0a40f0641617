"""The plan of a scene: the steps that it needs, those that are skipped, and the reasons.

All of it is known before anything is computed.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from html import escape

from .problem.request import ECONOMY, sheared, wanted
from .problem.scene import Scene, refuse_no_scene
from .profiles.row import asks_for_patches

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
    normal = _of_patches if asks_for_patches(scene.profile) else _of_one_patch
    steps = (
        *normal(scene, economy),
        _tilt(scene),
        _pressure(scene, "pressure" in stages, economy),
        _convexity(scene, economy),
        _coupling(scene),
        _slip(scene, "tangential" in stages, economy),
        _corrective(scene, economy),
    )
    return Plan((*steps, *_last(names, stages)))


def _if_asked(name: str, asked: bool, how: str, stage: str = "") -> Step:
    return Step(name, asked, how if asked else "not asked for", stage)


def _last(names: tuple[str, ...], stages: set[str]) -> tuple[Step, ...]:
    """The steps after the tractions."""
    stress = "from the potentials of the tractions, each once; no complex arithmetic on the surface"
    maxima = (("yield", "J2 in the body"), ("tension", "σ_xx on the surface"))
    found = " and ".join(what for name, what in maxima if name in names)
    search = f"{found}: scanned, then polished with exact gradients"
    certificate = "residual, equilibrium and inequalities on other points"
    return (
        _if_asked("stress", "tractions" in stages, stress, "tractions"),
        _if_asked("maxima", bool(found), search),
        _if_asked("certificate", "certificate" in stages, certificate, "certificate"),
    )


# -- pressure and shear are one problem ------------------------------------------------------------


def _of_one_problem(scene: Scene, names: tuple[str, ...], stages: set[str]) -> Iterable[Step]:
    """The steps of full stick, and of dissimilar bodies in partial slip."""
    if scene.bonded:
        first, pressure = _full_stick(scene), "its real part"
        inequalities = "bonded surfaces can pull, and touch all over"
    elif scene.tangential_load or scene.tau:
        first, pressure = _pressed_then_sheared(scene, names), "with the edges"
        inequalities = "the certificate measures p >= 0 and |q| <= f p"
    else:
        first, pressure = _pressed(scene), "flats superposed"
        inequalities = "dP/ds > 0 is verified: p > 0 and |q| <= f p follow"
        if scene.profile.axis is None or scene.tilt:
            inequalities += ", where the stick zone grows at both ends, which is verified too"
    together = "the shear and the slip come with the pressure"
    return (
        *first,
        _if_asked("pressure", "pressure" in stages, pressure, "pressure"),
        Step("inequalities", False, inequalities),
        Step("slip", False, "infinite friction: nothing slips" if scene.bonded else together),
    )


def _full_stick(scene: Scene) -> tuple[Step, ...]:
    exponents = f"-1/2 ± iη, tanh πη = β = {scene.beta:.4g}"
    if scene.beta == 0.0:
        exponents = "-1/2: β = 0 leaves p and q uncoupled"
    tilt = "given" if scene.moment is None else "that of the moment, which is linear in it"
    how = f"one equation for p + iq, exponents {exponents}; the tilt is {tilt}"
    return (
        Step("edges", True, "the ends of the punch", "normal"),
        Step("full stick", True, how, "bonded"),
    )


def _pressed(scene: Scene) -> tuple[Step, ...]:
    how = f"{_one_problem(scene)}; the stick zone is that of a flat punch"
    growth = "dP/ds in closed form or by a Volterra equation; the edges from its integral"
    if scene.profile.axis is None or scene.tilt:
        growth = (
            "dP/ds by a Volterra equation and, if the contact has no axis, its middle by a second "
            "one; the edges from the integral of dP/ds"
        )
    return Step("coupling", True, how, "coupled"), Step("edges", True, growth, "normal")


def _one_problem(scene: Scene) -> str:
    if scene.neglects_beta:
        return "β q is left out: Goodman's approximation"
    return f"β = {scene.beta:.4g}: p and q are one problem"


def _pressed_then_sheared(scene: Scene, names: tuple[str, ...]) -> tuple[Step, ...]:
    how = f"{_one_problem(scene)}; first under P alone"
    return (
        Step("coupling", True, how, "pressed"),
        Step("slip gradient", True, "that of P alone, kept in stick", "locked_in"),
        Step("zones", True, "four edges, of contact and stick zone, by Newton", "coupled"),
        Step("edges", True, "found with the zones", "normal"),
        _if_asked("energy", "energy" in names, "the power of friction, summed over states"),
    )


# -- first the pressure ----------------------------------------------------------------------------


def _of_patches(scene: Scene, _economy: Collection[str]) -> tuple[Step, ...]:
    """The steps to the edges of a profile that may touch in several patches."""
    function = bool(scene.profile.pieces.functions)
    known = "the slope is polynomial on each piece: known exactly"
    pieces = "the slope is a function: pieces of Chebyshev series where contact is possible"
    edges = "load given: patches from a grid, their edges by Newton, verified by bounds"
    none = "not used for patches: the edges of all are unknown"
    return (
        Step("resolution", function, pieces if function else known),
        Step("edges", True, edges, "normal"),
        Step("symmetry", False, none),
        Step("flat pieces", False, "not told apart: values of h' on all pieces are summed"),
    )


def _of_one_patch(scene: Scene, economy: Collection[str]) -> tuple[Step, ...]:
    ends = any(abs(end) != float("inf") for end in scene.profile.domain)
    edges = "smooth edges" + (" or sharp at the ends of the indenter" if ends else "")
    edges += ", by bracketed Newton with exact derivatives"
    given = "half-width" if scene.half_width is not None else "load"
    return (
        _resolution(scene),
        Step("edges", True, f"{given} given: {edges}", "normal"),
        _symmetry(scene, economy),
        _flat_pieces(scene, economy),
    )


def _resolution(scene: Scene) -> Step:
    if scene.profile.pieces.functions:
        how = "one Chebyshev series in the contact, or pieces on a window fitted to it"
        return Step("resolution", True, f"the slope is a function: {how}")
    return Step("resolution", False, "the slope is polynomial on each piece: known exactly")


def _symmetry(scene: Scene, economy: Collection[str]) -> Step:
    reasons = (
        ("symmetry" not in economy, NO_ECONOMY),
        (scene.tilt != 0.0, "the tilt breaks it"),
        (scene.epsilon, "friction breaks it"),
        (scene.profile.axis is None, "the profile has no axis"),
    )
    for holds, why in reasons:
        if holds:
            return Step("symmetry", False, f"{why}: both edges are unknown")
    extra = " while the tilt is zero" if scene.moment is not None else ""
    about = f"about x = {scene.profile.axis:g}{extra}"
    return Step("symmetry", True, f"{about}: half the unknowns, half the pieces")


def _flat_pieces(scene: Scene, economy: Collection[str]) -> Step:
    pieces = scene.profile.pieces
    flat = int(pieces.is_zero.sum()) if scene.tilt == 0.0 else 0
    if flat and "zero panels" not in economy:
        return Step("flat pieces", True, f"{flat} integrated although zero: {NO_ECONOMY}")
    cost = f"{flat} of {len(pieces.origins)} cost nothing: h' = 0 there"
    return Step("flat pieces", False, cost if flat else "there are none")


def _tilt(scene: Scene) -> Step:
    how = "the moment is given: the tilt is found by Newton, dM/d(tilt) known in closed form"
    given = scene.moment is None
    return Step("tilt", not given, f"given: {scene.tilt:g}" if given else how)


def _pressure(scene: Scene, asked: bool, economy: Collection[str]) -> Step:
    how = _expansion(scene, economy)
    return _if_asked("pressure", asked, how, "pressure")


def _expansion(scene: Scene, economy: Collection[str]) -> str:
    if asks_for_patches(scene.profile):
        return "values of the slope on all patches, summed: no unknown but the edges"
    if scene.epsilon:
        return "exact panels with the edges' exponents"
    if "transform" not in economy:
        return f"exact panels: {NO_ECONOMY}"
    if not scene.profile.breaks:
        return "the slope is smooth: one DCT, no linear system"
    return "exact panels on the pieces in the contact; one DCT if no break falls inside"


def _convexity(scene: Scene, economy: Collection[str]) -> Step:
    name, stage, profile = "convexity", "rises", scene.profile
    if asks_for_patches(profile):
        return Step(name, False, "not asked: patches are found whatever the profile", stage)
    if profile.convex and "convexity" in economy:
        return Step(name, False, "the profile is known to be convex: one patch, p > 0", stage)
    unknown = "the profile is not known to be convex"
    why = "economy is switched off" if profile.convex else unknown
    return Step(name, True, f"{why}: one patch where h' rises, otherwise as patches", stage)


# -- then the shear --------------------------------------------------------------------------------


def _coupling(scene: Scene) -> Step:
    if scene.beta == 0.0:
        return Step("coupling", False, "β = 0: pressure and shear are uncoupled")
    if scene.neglects_beta:
        return Step("coupling", False, "β q is left out: Goodman's approximation")
    beta = f"β = {scene.beta:.4g}"
    if not scene.slides:
        return Step("coupling", False, f"{beta}, but f = 0: no shear acts back on the pressure")
    shear = f"q = {scene.slides * scene.friction:g} p"
    edges = f"edges with exponents 1/2 ± {abs(scene.epsilon):.3g}"
    how = "panels with Lerch's function for the logarithm"
    return Step("coupling", True, f"{beta} and {shear}: {edges}, {how}")


def _slip(scene: Scene, asked: bool, economy: Collection[str]) -> Step:
    sliding = "full sliding: the shear traction is f times the pressure, nothing to solve"
    skipped = (
        (scene.friction == 0.0, "f = 0: there is no shear traction"),
        (scene.epsilon != 0.0, sliding),
        (not sheared(scene, economy), "Q = 0 and no bulk stress: there is no shear traction"),
        (not asked, "not asked for"),
    )
    for holds, why in skipped:
        if holds:
            return Step("slip", False, why, "tangential")
    if scene.tau == 0.0:
        how = "zones of stick and slip for Q at constant P, slip in one direction"
        how += " on all patches" if asks_for_patches(scene.profile) else ""
    else:
        how = "zones of stick and slip for Q and σ in proportion: one direction or two, by the"
        how += " inequalities"
    return Step("slip", True, how, "tangential")


def _corrective(scene: Scene, economy: Collection[str]) -> Step:
    """A decision inside the slip stage."""
    skipped = (
        (not sheared(scene, economy), "there is no shear traction"),
        (
            scene.slides and "sliding" in economy,
            "|Q| = f P, full sliding: q is f times the pressure, no second solve",
        ),
    )
    for holds, why in skipped:
        if holds:
            return Step("corrective", False, why)
    if asks_for_patches(scene.profile):
        how = "the patches under P - |Q|/f are the stick zones: found as those under P"
        return Step("corrective", True, how)
    how = "the contact under P - |Q|/f is the stick zone: found as that under P"
    if scene.tau != 0.0:
        how += "; not where slip goes both ways"
    elif scene.profile.pieces.has_zero:
        how += "; none if nothing but the flat base sticks"
    return Step("corrective", True, how)
