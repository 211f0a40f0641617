"""A sweep as arrays, where `many` answers all of its points without `solve`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from sie import arguments
from sie.many.loads import Loads
from sie.many.solve_many import Many, Question
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.shapes import Parabola, RoundedFlat

LOADS = ("normal_load", "half_width", "tilt", "friction", "tangential_load", "bulk_stress")
KINDS = (Parabola, RoundedFlat)  # whose fields are their parameters
FEWEST = 32  # points: fewer are as soon solved one by one
Quantity = Callable[[Many], Any]
PLAIN = ("half_width", "centre", "normal_load", "moment", "tilt")


def _plain(name: str) -> Quantity:
    return lambda many: getattr(many, name)


ARRAYS: dict[str, Quantity] = {
    **{name: _plain(name) for name in PLAIN},
    "contact_length": lambda many: 2.0 * many.half_width,
    "gap_volume": lambda many: np.zeros(many.shape),
    "patches": lambda many: np.ones(many.shape),
    "edges": lambda many: {"x1": many.edges[..., 0], "x2": many.edges[..., 1]},
}


def as_arrays(
    scene: Scene, axes: dict[str, list[Any]], wanted: dict[str, Any]
) -> tuple[dict[str, Any], Any] | None:
    """The wanted arrays and the reasons; None if some point has to be solved by itself."""
    numbers = all(type(v) in (int, float) for values in axes.values() for v in values)
    known = all(isinstance(v, str) and v in ARRAYS for v in wanted.values())
    points = np.prod([len(values) for values in axes.values()])
    if not (numbers and known and points >= FEWEST and _takes(scene, axes)):
        return None
    many = Many(_question(scene, axes))
    if (many.refused != "").any():
        return None
    found: dict[str, Any] = {}
    for name, of in wanted.items():
        values = ARRAYS[of](many)
        found |= values if isinstance(values, dict) else {name: values}
    return {name: v for name, v in found.items() if name not in axes}, many.refused


def _takes(scene: Scene, axes: dict[str, list[Any]]) -> bool:
    """Whether the scenes are of similar bodies, and the numbers those of arrays."""
    own = {f"profile.{name}" for name in _fields(scene.profile)} & axes.keys()
    sizes = [v for name in own for v in axes[name]]
    return (
        not (scene.sliding or scene.moment is not None)
        and not ((scene.friction or "friction" in axes) and scene.beta)
        and not ((scene.bulk_stress or "bulk_stress" in axes) and scene.body != scene.indenter)
        and not {"normal_load", "half_width"} <= axes.keys()
        and axes.keys() <= {*LOADS, *own, *({"modulus"} if scene.body is None else ())}
        and all(1.0 / arguments.LARGEST <= v <= arguments.LARGEST for v in sizes)
    )


def _question(scene: Scene, axes: dict[str, list[Any]]) -> Question:
    arrays = [np.array(v, dtype=float) for v in axes.values()]
    grid = dict(zip(axes, np.meshgrid(*arrays, indexing="ij"), strict=True))
    shape = tuple(map(len, axes.values()))
    loads = {name: getattr(scene, name) for name in LOADS} | {"modulus": scene.Estar}
    for one, other in (("normal_load", "half_width"), ("half_width", "normal_load")):
        if one in grid:
            loads[other] = None
    loads |= {name: v for name, v in grid.items() if "." not in name}
    flat: dict[str, Any] = {
        name: None if v is None else np.broadcast_to(v, shape).ravel() for name, v in loads.items()
    }
    own: dict[str, Any] = {k.partition(".")[2]: v for k, v in grid.items() if "." in k}
    kind, profile = type(scene.profile), scene.profile
    if own:
        profile = kind(**({name: getattr(profile, name) for name in _fields(profile)} | own))
    return Question(profile, {}, shape, Loads(**flat), alone=False)


def _fields(profile: Profile) -> tuple[str, ...]:
    """The parameters that may be arrays."""
    return kind.__match_args__ if (kind := type(profile)) in KINDS else ()
