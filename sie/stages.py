"""Which results of a solution a change of its scene keeps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any

from .problem.scene import Scene

FIELDS = frozenset(f.name for f in fields(Scene))
# The fields and properties of a scene that each stage depends on.
LOADS = ("normal_load", "half_width", "tilt", "moment")
NORMAL = frozenset(
    ("profile", "body", "indenter", "modulus", *LOADS, "epsilon", "bonded", "coupled")
)
TANGENTIAL = ("friction", "tangential_load", "sliding", "bulk_stress")
SHEAR = NORMAL | {*TANGENTIAL, "dundurs", "coupling"}
OF_SHEAR = ("bonded", "coupled", "tangential", "dissipated", "certificate", "coupling_notes")
PRESSED = (NORMAL - {"coupled"}) | {"friction", "dundurs", "coupling"}
STAGES = {
    **dict.fromkeys(("rises", "unverified", "density", "normal", "in_patches", "pressure"), NORMAL),
    **dict.fromkeys(OF_SHEAR, SHEAR),
    **dict.fromkeys(("pressed", "locked_in"), PRESSED),
}


def changed_scene(scene: Scene, changes: Mapping[str, Any]) -> Scene:
    """The scene with other values of some fields.

    `normal_load` and `half_width` replace each other, and so do `tilt` and `moment`, and `modulus`
    and the bodies.
    """
    for name in changes:
        if name not in FIELDS:
            raise ValueError(
                f"{name} is not a field of a scene: change {', '.join(sorted(FIELDS))}"
            )
    replaced: dict[str, Any] = {}
    for one, other in (("normal_load", "half_width"), ("tilt", "moment")):
        for given, taken_out in ((one, other), (other, one)):
            if changes.get(given) is not None:
                replaced[taken_out] = 0.0 if taken_out == "tilt" else None
    if "modulus" in changes and scene.body is not None:
        replaced |= {"body": None, "indenter": None, "dundurs": None}
    return replace(scene, **(replaced | dict(changes)))


def kept_stages(old: Scene, new: Scene) -> frozenset[str]:
    """The stages that depend on nothing in which the scenes differ."""
    pairs = ((name, getattr(new, name), getattr(old, name)) for name in SHEAR)
    changed = {name for name, now, before in pairs if now is not before and now != before}
    # One equation then gives pressure and shear: what changes the one changes the other.
    if changed:
        changed |= {name for name in ("bonded", "coupled") if getattr(old, name)}
    return frozenset(stage for stage, needs in STAGES.items() if not changed & needs)
