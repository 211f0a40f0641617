"""The plan of a scene: the steps that it needs, those that are skipped, and the reasons.

All of it is known before anything is computed.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from html import escape

from .contact.pressure import upright_law
from .problem.request import ECONOMY, sheared, wanted
from .problem.scene import Scene, refuse_no_scene
from .profiles.row import asks_for_patches

BODY = ("stress", "yield", "tension", "cycle")  # what is asked of the stress in the body

# The stages of `Solution` that answer what is asked for ...
STAGES: dict[str, tuple[str, ...]] = {
    "edges": ("normal",),
    "pressure": ("normal", "pressure"),
    "gap": ("normal", "pressure"),
    **dict.fromkeys(("shear", "energy"), ("normal", "pressure", "tangential")),
    "check": ("normal", "pressure", "tangential", "certificate"),
    **dict.fromkeys(BODY, ("normal", "pressure", "tangential", "tractions")),
}
# ... for full stick, where one equation gives the pressure and the shear, ...
FULL_STICK: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("edges", "gap", "shear", "energy"), ("normal",)),
    "pressure": ("normal", "pressure"),
    "check": ("normal", "certificate"),
    **dict.fromkeys(BODY, ("normal", "pressure", "tractions")),
}
# ... and for dissimilar bodies in partial slip.
COUPLED = {name: ("coupled", *stages) for name, stages in FULL_STICK.items()}
# And for these under P, then Q.
SHEARED = {name: ("pressed", "locked_in", *stages) for name, stages in COUPLED.items()}


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
        "tension", "cycle", or attributes of the solution such as "stick", "slip" and "half_width".
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
    if scene.bonded:
        return _of_full_stick(scene, names)
    if scene.coupled:
        return _of_coupled(scene, names)
    no_shear = dict.fromkeys(("shear", "energy"), ("normal",))
    needed = STAGES if sheared(scene, economy) or scene.epsilon else STAGES | no_shear
    stages = {stage for w in names for stage in needed[w]}
    steps = (
        _resolution(scene, economy),
        Step("edges", True, _edges(scene, economy), "normal"),
        _symmetry(scene, economy),
        _flat_pieces(scene, economy),
        _tilt(scene),
        _pressure(scene, "pressure" in stages, economy),
        _inequalities(scene, economy),
        _coupling(scene),
        _slip(scene, "tangential" in stages, economy),
        _corrective(scene, economy),
    )
    return Plan(steps + _last(stages, names))


def _of_coupled(scene: Scene, names: tuple[str, ...]) -> Plan:
    if scene.tangential_load or scene.tau:
        return _of_sheared(scene, names)
    stages = {stage for name in names for stage in COUPLED[name]}
    how = f"β = {scene.beta:.4g}: p and q are one problem; the stick zone is that of a flat punch"
    growth = "dP/ds in closed form or by a Volterra equation; the edges from its integral"
    inequalities = "dP/ds > 0 is verified: p > 0 and |q| <= f p follow"
    if scene.profile.axis is None or scene.tilt:
        growth = (
            "dP/ds by a Volterra equation and, if the contact has no axis, its middle by a second "
            "one; the edges from the integral of dP/ds"
        )
        inequalities += ", where the stick zone grows at both ends, which is verified too"
    steps = (
        Step("coupling", True, how, "coupled"),
        Step("edges", True, growth, "normal"),
    )
    return Plan(steps + _of_both("flats superposed", inequalities, stages, names))


def _of_sheared(scene: Scene, names: tuple[str, ...]) -> Plan:
    """The steps of dissimilar bodies under P, then Q and bulk stress."""
    stages = {stage for name in names for stage in SHEARED[name]}
    how = f"β = {scene.beta:.4g}: p and q are one problem; first under P alone"
    steps = (
        Step("coupling", True, how, "pressed"),
        Step("slip gradient", True, "that of P alone, kept in stick", "locked_in"),
        Step("zones", True, "four edges, of contact and stick zone, by Newton", "coupled"),
        Step("edges", True, "found with the zones", "normal"),
        _if_asked("energy", "energy" in names, "the power of friction, summed over states"),
    )
    inequalities = "the certificate measures p >= 0 and |q| <= f p"
    return Plan(steps + _of_both("with the edges", inequalities, stages, names))


def _of_both(
    pressure: str, inequalities: str, stages: set[str], names: tuple[str, ...]
) -> tuple[Step, ...]:
    """The steps after the edges where pressure and shear are one problem."""
    return (
        _if_asked("pressure", "pressure" in stages, pressure, "pressure"),
        Step("inequalities", False, inequalities),
        Step("slip", False, "the shear and the slip come with the pressure"),
        *_last(stages, names),
    )


def _of_full_stick(scene: Scene, names: tuple[str, ...]) -> Plan:
    stages = {stage for name in names for stage in FULL_STICK[name]}
    uncoupled = "-1/2: β = 0 leaves p and q uncoupled"
    coupled = f"-1/2 ± iη, tanh πη = β = {scene.beta:.4g}"
    exponents = uncoupled if scene.beta == 0.0 else coupled
    tilt = "given" if scene.moment is None else "that of the moment, which is linear in it"
    how = f"one equation for p + iq, exponents {exponents}; the tilt is {tilt}"
    steps = (
        Step("edges", True, "the ends of the punch", "normal"),
        Step("full stick", True, how, "bonded"),
        _if_asked("pressure", "pressure" in stages, "its real part", "pressure"),
        Step("inequalities", False, "bonded surfaces can pull, and touch all over"),
        Step("slip", False, "infinite friction: nothing slips"),
    )
    return Plan(steps + _last(stages, names))


def _if_asked(name: str, asked: bool, how: str, stage: str = "") -> Step:
    return Step(name, asked, how if asked else "not asked for", stage)


def _last(stages: set[str], names: tuple[str, ...]) -> tuple[Step, ...]:
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


def _resolution(scene: Scene, economy: Collection[str]) -> Step:
    if asks_for_patches(scene.profile) and scene.profile.pieces.functions:
        how = "the slope is a function: pieces of Chebyshev series where contact is possible"
        return Step("resolution", True, how)
    if upright_law(scene, economy) is not None:
        return Step("resolution", False, "the slope is a power law: known exactly")
    if scene.profile.pieces.functions:
        how = "one Chebyshev series in the contact, or pieces on a window fitted to it"
        return Step("resolution", True, f"the slope is a function: {how}")
    return Step("resolution", False, "the slope is polynomial on each piece: known exactly")


def _edges(scene: Scene, economy: Collection[str]) -> str:
    if asks_for_patches(scene.profile):
        how = "patches from a grid, their edges by Newton, verified by bounds"
        return f"load given: {how}"
    given = "half-width" if scene.half_width is not None else "load"
    if upright_law(scene, economy) is not None and scene.moment is None:
        return f"{given} given: smooth edges, in closed form"
    ends = (
        " or sharp at the ends of the indenter"
        if any(abs(e) != float("inf") for e in scene.profile.domain)
        else ""
    )
    return f"{given} given: smooth edges{ends}, by bracketed Newton with exact derivatives"


def _symmetry(scene: Scene, economy: Collection[str]) -> Step:
    if asks_for_patches(scene.profile):
        return Step("symmetry", False, "not used for patches: the edges of all are unknown")
    tilted = scene.tilt != 0.0
    if scene.profile.axis is None or tilted or scene.epsilon or "symmetry" not in economy:
        reasons = (
            ("symmetry" not in economy, "economy is switched off"),
            (tilted, "the tilt breaks it"),
            (scene.epsilon, "friction breaks it"),
        )
        why = next((reason for holds, reason in reasons if holds), "the profile has no axis")
        return Step("symmetry", False, f"{why}: both edges are unknown")
    extra = " while the tilt is zero" if scene.moment is not None else ""
    return Step(
        "symmetry",
        True,
        f"about x = {scene.profile.axis:g}{extra}: half the unknowns, half the pieces",
    )


def _flat_pieces(scene: Scene, economy: Collection[str]) -> Step:
    name, flat = "flat pieces", int(scene.profile.pieces.is_zero.sum())
    if asks_for_patches(scene.profile):
        return Step(name, False, "not told apart: values of h' on all pieces are summed")
    if flat and scene.tilt == 0.0 and "zero panels" not in economy:
        return Step(name, True, f"{flat} integrated although zero: economy is switched off")
    if flat and scene.tilt == 0.0:
        pieces = len(scene.profile.pieces.origins)
        return Step(name, False, f"{flat} of {pieces} cost nothing: h' = 0 there")
    return Step(name, False, "there are none")


def _tilt(scene: Scene) -> Step:
    if scene.moment is None:
        return Step("tilt", False, f"given: {scene.tilt:g}")
    return Step(
        "tilt",
        True,
        "the moment is given: the tilt is found by Newton, dM/d(tilt) known in closed form",
    )


def _pressure(scene: Scene, asked: bool, economy: Collection[str]) -> Step:
    how = _expansion(scene, economy)
    if asked:
        return Step("pressure", True, how, "pressure")
    if _convex(scene, economy):
        return Step("pressure", False, "not asked for", "pressure")
    return Step("pressure", True, f"needed for the inequalities: {how}")


def _expansion(scene: Scene, economy: Collection[str]) -> str:
    if asks_for_patches(scene.profile):
        return "values of the slope on all patches, summed: no unknown but the edges"
    if scene.epsilon:
        return "exact panels with the edges' exponents"
    if "transform" not in economy:
        return "exact panels: economy is switched off"
    if scene.profile.breaks and upright_law(scene, economy) is not None:
        return "two series of a power law"
    if not scene.profile.breaks:
        return "the slope is smooth: one DCT, no linear system"
    return "exact panels on the pieces in the contact; one DCT if no break falls inside"


def _convex(scene: Scene, economy: Collection[str]) -> bool:
    return scene.profile.convex and "convexity" in economy


def _inequalities(scene: Scene, economy: Collection[str]) -> Step:
    name = "inequalities"
    if _convex(scene, economy):
        return Step(name, False, "the profile is convex: p > 0 and gap > 0 follow", name)
    unknown = "the profile is not known to be convex"
    why = "economy is switched off" if scene.profile.convex else unknown
    return Step(name, True, f"{why}: p >= 0 and gap >= 0 are verified", name)


def _coupling(scene: Scene) -> Step:
    if scene.beta == 0.0:
        return Step("coupling", False, "β = 0: pressure and shear are uncoupled")
    if scene.neglects_beta:
        return Step("coupling", False, "β q is left out: Goodman's approximation")
    if scene.slides:
        why = (
            f"β = {scene.beta:.4g} and q = {scene.slides * scene.friction:g} p: "
            f"edges with exponents 1/2 ± {abs(scene.epsilon):.3g}"
        )
        return Step("coupling", True, f"{why}, panels with Lerch's function for the logarithm")
    return Step(
        "coupling", False, f"β = {scene.beta:.4g}, but f = 0: no shear acts back on the pressure"
    )


def _slip(scene: Scene, asked: bool, economy: Collection[str]) -> Step:
    one_way = "zones of stick and slip for Q at constant P, slip in one direction"
    if asks_for_patches(scene.profile):
        one_way += " on all patches"
    either = "zones of stick and slip for Q and σ in proportion: one direction or two, by the"
    cases = (
        (scene.friction == 0.0, "f = 0: there is no shear traction"),
        (
            scene.epsilon != 0.0,
            "full sliding: the shear traction is f times the pressure, nothing to solve",
        ),
        (not sheared(scene, economy), "Q = 0 and no bulk stress: there is no shear traction"),
        (not asked, "not asked for"),
    )
    for holds, why in cases:
        if holds:
            return Step("slip", False, why, "tangential")
    if scene.goodman:
        how = "flats superposed while the load grew; Q changes what the shear lacks of f p"
        return Step("slip", True, how, "tangential")
    how = one_way if scene.tau == 0.0 else f"{either} inequalities"
    return Step("slip", True, how, "tangential")


def _corrective(scene: Scene, economy: Collection[str]) -> Step:
    """A decision inside the slip stage."""
    name = "corrective"
    if not sheared(scene, economy):
        return Step(name, False, "there is no shear traction")
    if scene.goodman:
        return Step(name, False, "the shear follows from how the contact grew")
    if scene.slides and "sliding" in economy:
        return Step(
            name, False, "|Q| = f P, full sliding: q is f times the pressure, no second solve"
        )
    if asks_for_patches(scene.profile):
        how = "the patches under P - |Q|/f are the stick zones: found as those under P"
        return Step(name, True, how)
    zero = scene.profile.pieces.has_zero and scene.tau == 0.0
    flat = "; none if nothing but the flat base sticks" if zero else ""
    how = f"the contact under P - |Q|/f is the stick zone: found as that under P{flat}"
    both = "; not where slip goes both ways" if scene.tau != 0.0 else ""
    return Step(name, True, how + both)
