"""The scene that a load path starts from, and scenes without load paths."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

from sie.errors import ContactError
from sie.numerics.interval import EPS

from .load_path import Path
from .scene import Scene, refuse_no_scene


def in_proportion(scene: Scene, path: Path) -> bool:
    """Whether P and Q of dissimilar bodies in partial slip grow in proportion from zero."""
    if not _dissimilar(scene) or scene.tilt or scene.moment or not _by_loads_alone(path):
        return False
    start, *points = path.points
    if not points:
        return False
    last, Q, _ = points[-1]
    growing = all(a[0] < b[0] for a, b in zip(path.points, points, strict=False))
    in_line = all(abs(q * last - Q * p) <= 8.0 * EPS * abs(Q) * p for p, q, _ in points)
    return not any(start) and growing and in_line


def one_after_the_other(scene: Scene, path: Path) -> bool:
    """Whether P of dissimilar bodies grows, and then Q: each state is that of its loads."""
    if not _dissimilar(scene) or not _by_loads_alone(path):
        return False
    one_way = len({Q > 0.0 for _, Q, _ in path.points if Q}) <= 1
    pairs = pairwise([(P, abs(Q)) for P, Q, _ in path.points])
    return one_way and all(p >= P and q >= Q and (p == P or not q) for (P, Q), (p, q) in pairs)


def _dissimilar(scene: Scene) -> bool:
    if not (scene.beta and scene.friction) or scene.bonded or scene.sliding:
        return False
    return scene.coupling == "full"


def _by_loads_alone(path: Path) -> bool:
    return not any(path.turns) and not any(sigma for _, _, sigma in path.points)


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
            f"a path of dissimilar bodies (β = {scene.beta:.4g}) with friction is solved where P "
            "grows and then Q alone, or both in proportion from zero; give such a path, or "
            "dundurs = 0 to neglect β"
        )


def unsheared(scene: Scene, path: Path) -> Scene:
    """The scene under the first normal load of a path alone.

    Raises ValueError or ContactError where a scene has no load paths, or the path is none, or one
    of them turns the indenter by tilt and the other by moment.
    """
    given = isinstance(path, Path) and isinstance(scene, Scene)
    if not (given and (in_proportion(scene, path) or one_after_the_other(scene, path))):
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
