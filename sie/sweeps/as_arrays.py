"""A sweep as arrays, where `many` answers all of its points without `solve`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from sie import arguments
from sie.many.solve_many import ACTING, Many, many
from sie.problem.scene import Scene
from sie.profiles.shapes import Parabola, RoundedFlat

SIZES = "normal_load", "half_width"
KINDS = Parabola, RoundedFlat  # whose fields are their parameters
FEWEST = 32  # points: fewer are as soon solved one by one
PLAIN = "half_width", "centre", "normal_load", "moment", "tilt"
OF_ONE_PATCH: dict[str, Callable[[Many], Any]] = {
    "contact_length": lambda solved: 2.0 * solved.half_width,
    "gap_volume": lambda solved: np.zeros(solved.shape),
    "patches": lambda solved: np.ones(solved.shape),
}
KNOWN = (*PLAIN, "edges", *OF_ONE_PATCH)


def as_arrays(
    scene: Scene, axes: dict[str, list[Any]], wanted: dict[str, Any]
) -> tuple[dict[str, Any], Any] | None:
    """The wanted arrays and the reasons; None if some point has to be solved by itself."""
    numbers = all(type(v) in (int, float) for values in axes.values() for v in values)
    known = all(isinstance(of, str) and of in KNOWN for of in wanted.values())
    points = np.prod([len(values) for values in axes.values()])
    if not (numbers and known and points >= FEWEST and _takes(scene, axes)):
        return None
    solved = _solved(scene, axes)
    if (solved.refused != "").any():
        return None
    found: dict[str, Any] = {}
    for name, of in wanted.items():
        if of == "edges":
            found |= {"x1": solved.edges[..., 0], "x2": solved.edges[..., 1]}
        else:
            found[name] = OF_ONE_PATCH[of](solved) if of in OF_ONE_PATCH else getattr(solved, of)
    return {name: v for name, v in found.items() if name not in axes}, solved.refused


def _takes(scene: Scene, axes: dict[str, list[Any]]) -> bool:
    """Whether all scenes are of similar bodies, and all numbers those of arrays."""
    own = {f"profile.{name}" for name in _fields(scene)} & axes.keys()
    sheared = scene.friction or scene.bulk_stress or {"friction", "bulk_stress"} & axes.keys()
    return (
        not (scene.sliding or scene.moment is not None)
        and not (sheared and (scene.beta or scene.body != scene.indenter))
        and not {*SIZES} <= axes.keys()
        and axes.keys() <= {*SIZES, *ACTING, *own, *({"modulus"} if scene.body is None else ())}
        and all(1.0 / arguments.LARGEST <= v <= arguments.LARGEST for n in own for v in axes[n])
    )


def _solved(scene: Scene, axes: dict[str, list[Any]]) -> Many:
    """The scenes of the grid as arrays; what these do not answer is refused."""
    grid = dict(zip(axes, np.meshgrid(*axes.values(), indexing="ij"), strict=True))
    sizes = [name for name in SIZES if name in axes] or [
        name for name in SIZES if getattr(scene, name) is not None
    ]
    loads = {name: getattr(scene, name) for name in (*sizes, *ACTING)} | {"modulus": scene.Estar}
    loads |= {name: v for name, v in grid.items() if "." not in name}
    of_profile = {name: getattr(scene.profile, name) for name in _fields(scene)}
    of_profile |= {name.partition(".")[2]: v for name, v in grid.items() if "." in name}
    profile = type(scene.profile)(**of_profile) if of_profile else scene.profile
    return many(profile, loads, {}, alone=False)


def _fields(scene: Scene) -> tuple[str, ...]:
    """The parameters of the profile that may be arrays."""
    return kind.__match_args__ if (kind := type(scene.profile)) in KINDS else ()
