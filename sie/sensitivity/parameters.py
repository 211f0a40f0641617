"""The change of a scene by each of its numbers: what it does to the contact, the shear, the body.

P, b, tilt, M, f, Q, σ      themselves
E, ν                        1/E* = C1 + C2, C the compliances, and τ = E*/2 of the bulk strain
a parameter of the profile  its direction (`directions`)
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

from sie.errors import ContactError
from sie.problem.material import Elastic
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.sampled import Sampled

from .directions import directions


@dataclass(frozen=True)
class Change:
    """A direction in which the numbers of a scene change.

    profile          the change of h; None for none
    load             that of P; None where the half-width is given in its place
    half_width       that of the half-width, where it is given
    tilt             that of the tilt; None where the moment is given in its place
    moment           that of M, where it is given
    modulus          δE*/E*
    friction, tangential_load, tau, bulk_stress, poisson  those of f, Q, τ, σ and ν of the body
    """

    profile: Profile | None = None
    load: float | None = 0.0
    half_width: float = 0.0
    tilt: float | None = 0.0
    moment: float = 0.0
    modulus: float = 0.0
    friction: float = 0.0
    tangential_load: float = 0.0
    tau: float = 0.0
    bulk_stress: float = 0.0
    poisson: float = 0.0


Makers = dict[str, Callable[[], Change]]


def change_by(scene: Scene, name: str | Profile) -> Change:
    """The change of a scene by a number of that name, or by adding so much of a profile."""
    if isinstance(name, Profile):
        return replace(held(scene), profile=name)
    own = dict(_of_loads(scene)) | dict(_of_bodies(scene))
    known = own if name in own else parameters(scene)
    if name not in known:
        shown = ", ".join(list(known)[:24]) + (", ..." if len(known) > 24 else "")
        raise ValueError(f'derivative by "{name}" is not known for this scene: choose {shown}')
    return known[name]()


def parameters(scene: Scene, *, heights: bool = True) -> Makers:
    """The numbers of a scene that a derivative is taken by, each with what makes its change.

    `heights`: with those of a trace, one by one.
    """
    found = dict(_of_loads(scene)) | dict(_of_bodies(scene))
    if heights or not isinstance(scene.profile, Sampled):
        for name, make in directions(scene.profile).items():
            found[f"profile.{name}"] = partial(_along, scene, make)
    return found


def held(scene: Scene) -> Change:
    """No change; what is found instead of given is left open."""
    return Change(
        load=0.0 if scene.half_width is None else None, tilt=0.0 if scene.moment is None else None
    )


def _along(scene: Scene, make: Callable[[], Profile]) -> Change:
    return replace(held(scene), profile=make())


def _of_loads(scene: Scene) -> Iterator[tuple[str, Callable[[], Change]]]:

    def by(**numbers: float) -> Callable[[], Change]:
        return partial(replace, held(scene), **numbers)

    yield ("half_width", by(half_width=1.0)) if scene.half_width else ("normal_load", by(load=1.0))
    if scene.moment is not None:
        yield "moment", by(moment=1.0)
    elif scene.profile.period == float("inf"):
        yield "tilt", by(tilt=1.0)
    if scene.friction:
        yield "friction", by(friction=1.0)
    if scene.friction and not scene.sliding:
        yield "tangential_load", by(tangential_load=1.0)
    yield "bulk_stress", by(bulk_stress=1.0, tau=replace(scene, bulk_stress=1.0).tau)


def _of_bodies(scene: Scene) -> Iterator[tuple[str, Callable[[], Change]]]:
    if scene.modulus is not None:
        yield "modulus", partial(replace, held(scene), modulus=1.0 / scene.modulus)
        if scene.poisson is not None:
            yield "poisson", partial(replace, held(scene), poisson=1.0)
        return
    pair = {"body": scene.body, "indenter": scene.indenter}
    for constant in ("young", "poisson"):
        if scene.body == scene.indenter:
            yield constant, partial(_of_material, scene, tuple(pair), constant)
            continue
        for one, body in pair.items():
            if isinstance(body, Elastic):
                yield f"{one}.{constant}", partial(_of_material, scene, (one,), constant)


def _of_material(scene: Scene, bodies: tuple[str, ...], constant: str) -> Change:
    """The change by a constant of one body, or of both."""
    if scene.friction and len(bodies) == 1 and scene.dundurs is None:
        raise ContactError(
            "a constant of one body changes β, and with it the shear: give dundurs = 0 to neglect "
            "β, or bodies of one material"
        )
    grown = {one: _compliance_grows(getattr(scene, one), constant) for one in bodies}
    modulus = -scene.Estar * sum(grown.values())
    strained = 0.5 * scene.Estar * grown.get("body", 0.0) * scene.bulk_stress
    # of two bodies of one material τ is half of the strain of each, whatever it is
    tau = strained + modulus * scene.tau if len(bodies) == 1 else 0.0
    poisson = 1.0 if constant == "poisson" and "body" in bodies else 0.0
    return replace(held(scene), modulus=modulus, tau=tau, poisson=poisson)


def _compliance_grows(body: Elastic, constant: str) -> float:
    """The derivative of (1 - ν²)/E in plane strain, of 1/E in plane stress."""
    E, nu = body.young, body.poisson if body.plane == "strain" else 0.0
    return -(1.0 - nu * nu) / E**2 if constant == "young" else -2.0 * nu / E
