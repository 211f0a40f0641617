"""The scene that a load path starts from, and scenes without load paths."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

from sie.errors import ContactError

from .load_path import Path
from .scene import Scene, refuse_no_scene


def pressed_first(scene: Scene, path: Path) -> bool:
    """Whether P of dissimilar bodies grows alone, and is constant while Q and σ change."""
    if not (scene.beta and scene.friction) or scene.bonded or scene.sliding:
        return False
    if any(path.turns):
        return False
    pairs = pairwise([(P, bool(Q or sigma)) for P, Q, sigma in path.points])
    alone = path.points[0][0] != 0.0 or not any(path.points[0][1:])
    return alone and all(p == P or (p > P and not sheared) for (P, sheared), (p, _) in pairs)


def refuse_uncovered(scene: Scene) -> None:
    """Raises ValueError or ContactError for a scene without load paths."""
    refuse_no_scene(scene)
    if scene.bonded:
        raise ValueError(
            "a bonded contact never slips, so its path does not matter: give a finite friction, "
            "or solve the last point as a scene"
        )
    if scene.beta and scene.friction and not scene.sliding:
        raise ContactError(
            f"a path of dissimilar bodies (β = {scene.beta:.4g}, friction = {scene.friction:g}) is "
            "solved where P grows alone and then stays, as from (P, 0, 0) to (P, Q, σ); hold P at "
            "its mean, or give dundurs = 0"
        )


def unsheared(scene: Scene, path: Path) -> Scene:
    """The scene under the first normal load of a path alone.

    Raises ValueError or ContactError where a scene has no load paths, or the path is none, or one
    of them turns the indenter by tilt and the other by moment.
    """
    given = isinstance(path, Path) and isinstance(scene, Scene)
    if not (given and pressed_first(scene, path)):
        refuse_uncovered(scene)
    if not isinstance(path, Path):
        raise ValueError(f"{path!r} is not a path: give sie.Path([(P, Q, σ), ...])")
    for turned, held, name in (
        (path.tilt, scene.moment is not None, "moment"),
        (path.moment, scene.tilt != 0.0, "tilt"),
    ):
        if turned and held:
            raise ValueError(
                f"the scene has a {name}, which what the path turns by would change: give both "
                "as tilt or both as moment"
            )
    return replace(
        scene,
        normal_load=path.first_contact[0],
        half_width=None,
        tangential_load=0.0,
        sliding=0,
        bulk_stress=0.0,
    )
