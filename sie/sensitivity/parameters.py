"""The change of a scene by one of its numbers: what it does to the contact, the shear, the body.

P, b, tilt, M, f, Q, σ      themselves
E, ν                        1/E* = C1 + C2, C the compliances, and τ = E*/2 of the bulk strain
a parameter of the profile  its direction (`directions`)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from sie.errors import ContactError
from sie.problem.material import Elastic
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.sampled import Sampled

from .contact_rate import Change
from .directions import directions


@dataclass(frozen=True)
class Parameter:
    """The change of a scene by one number.

    contact          that of the contact without shear
    friction         that of f
    tangential_load  that of Q
    tau              that of τ
    bulk_stress      that of σ
    poisson          that of Poisson's ratio of the body
    """

    contact: Change
    friction: float = 0.0
    tangential_load: float = 0.0
    tau: float = 0.0
    bulk_stress: float = 0.0
    poisson: float = 0.0


Makers = dict[str, Callable[[], Parameter]]


def parameter(scene: Scene, name: str | Profile) -> Parameter:
    """The change of a scene by a number of that name, or by adding so much of a profile."""
    if isinstance(name, Profile):
        return Parameter(Change(profile=name))
    own = _of_loads(scene)
    if name in own:
        return own[name]()
    known = parameters(scene)
    if name not in known:
        shown = ", ".join(list(known)[:24]) + (", ..." if len(known) > 24 else "")
        raise ValueError(f'derivative by "{name}" is not known for this scene: choose {shown}')
    return known[name]()


def parameters(scene: Scene, *, heights: bool = True) -> Makers:
    """The numbers of a scene that a derivative is taken by, each with what makes its change.

    `heights`: with those of a trace, one by one.
    """
    several = isinstance(scene.profile, Sampled) and not heights
    return _of_loads(scene) | ({} if several else _of_profile(scene.profile))


def _of_loads(scene: Scene) -> Makers:
    return _loads(scene) | _materials(scene)


def _loads(scene: Scene) -> Makers:
    names = {
        "normal_load" if scene.half_width is None else "half_width": Change(load=1.0),
        "tilt" if scene.moment is None else "moment": Change(tilt=1.0, moment=1.0),
    }
    if scene.half_width is not None:
        names["half_width"] = Change(half_width=1.0)
    if scene.profile.period < float("inf"):
        del names["tilt"]
    found: Makers = {name: partial(Parameter, change) for name, change in names.items()}
    if scene.friction:
        found["friction"] = partial(Parameter, Change(), friction=1.0)
    if scene.friction and not scene.sliding:
        found["tangential_load"] = partial(Parameter, Change(), tangential_load=1.0)
    by_stress = replace(scene, bulk_stress=1.0).tau
    found["bulk_stress"] = partial(Parameter, Change(), tau=by_stress, bulk_stress=1.0)
    return found


def _materials(scene: Scene) -> Makers:
    if scene.modulus is not None:
        modulus = Parameter(Change(modulus=1.0 / scene.modulus))
        poisson = partial(Parameter, Change(), poisson=1.0)
        found: Makers = {"modulus": lambda: modulus}
        return found | ({"poisson": poisson} if scene.poisson is not None else {})
    pair = {"body": scene.body, "indenter": scene.indenter}
    if scene.body == scene.indenter:
        return {name: partial(_of_material, scene, tuple(pair), name) for name in CONSTANTS}
    return {
        f"{one}.{name}": partial(_of_material, scene, (one,), name)
        for one, body in pair.items()
        for name in CONSTANTS
        if isinstance(body, Elastic)
    }


CONSTANTS = ("young", "poisson")


def _of_material(scene: Scene, bodies: tuple[str, ...], constant: str) -> Parameter:
    """The change by a constant of one body, or of both."""
    if scene.friction and len(bodies) == 1 and scene.dundurs is None:
        raise ContactError(
            "a constant of one body changes β, and with it the shear: give dundurs = 0 to neglect "
            "β, or bodies of one material"
        )
    Estar, grown = scene.Estar, {"body": 0.0, "indenter": 0.0}
    for one in bodies:
        grown[one] = _compliance_grows(getattr(scene, one), constant)
    modulus = -Estar * sum(grown.values())
    tau = 0.5 * Estar * grown["body"] * scene.bulk_stress + modulus * scene.tau
    if len(bodies) == 2:
        tau = 0.0  # half of the strain of each
    poisson = 1.0 if constant == "poisson" and "body" in bodies else 0.0
    return Parameter(Change(modulus=modulus), tau=tau, poisson=poisson)


def _compliance_grows(body: Elastic, constant: str) -> float:
    """The derivative of (1 - ν²)/E in plane strain, of 1/E in plane stress."""
    E, nu = body.young, body.poisson if body.plane == "strain" else 0.0
    return -(1.0 - nu * nu) / E**2 if constant == "young" else -2.0 * nu / E


def _of_profile(profile: Profile) -> Makers:
    def made(make: Callable[[], Profile]) -> Parameter:
        return Parameter(Change(profile=make()))

    return {f"profile.{name}": partial(made, make) for name, make in directions(profile).items()}
