"""The table [crack] of a scene file, where cracks begin and what they need to grow; its answer."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from sie.arguments import named_rows
from sie.progress_bar import reported

if TYPE_CHECKING:
    from sie.solution import Solution

    from .scene_file import SceneFile

EDGES = ("trailing edge", "leading edge")
TOGETHER = (("threshold", "fatigue_limit"), ("fatigue_limit", "threshold"))


@dataclass(frozen=True)
class Crack:
    """The content of [crack].

    Parameters
    ----------
    at : str or float
        Where the cracks begin: "trailing edge" or "leading edge" of the contact under the largest
        tangential load, or x.
    depths : list of float
        Depths of their tips, ascending.
    threshold : float
        ΔK0 of long cracks, stress times root of length.
    fatigue_limit : float
        Δσ0 of the smooth material, a range of stress.
    friction : float
        Friction between the faces of a crack: only 0.
    """

    at: str | float
    depths: tuple[float, ...]
    threshold: float = 0.0
    fatigue_limit: float = 0.0
    friction: float = 0.0


def crack_of(values: Mapping[str, Any]) -> Crack:
    """The content of [crack]. Raises ValueError for what is no crack."""
    for name, other in TOGETHER:
        if name in values and other not in values:
            raise ValueError(f"[crack] has {name} without {other}: give {other} = ... too")
    crack = Crack(**values)
    if isinstance(crack.at, str) and crack.at not in EDGES:
        raise ValueError(
            f'[crack] at = "{crack.at}" is not known: give "{EDGES[0]}", "{EDGES[1]}" or a place x'
        )
    return crack


@reported("crack")
def crack_answer(solution: Solution, file: SceneFile) -> dict[str, Any]:
    """What JSON and the report say of the cracks.

    Of a load path that comes back to earlier loads they see the turning points of the last cycle,
    of another path all points, and of a scene without path its one state.
    """
    from sie.cracks.stress_intensity import stress_intensity  # noqa: PLC0415 -- SciPy's parts

    assert file.crack is not None
    states, crack = _states(solution, file), file.crack
    x = crack.at if isinstance(crack.at, float) else _edge(states, crack.at)
    K = stress_intensity(states, x, crack.depths, crack.friction)
    answer = {
        "x": x,
        "depth": list(crack.depths),
        "mode_1": K.mode_1.tolist(),
        "mode_2": K.mode_2.tolist(),
        "range_1": K.range.tolist(),
        "range_2": K.shear_range.tolist(),
        "certificate": K.check()._asdict(),
    }
    if crack.threshold:
        limits = crack.threshold, crack.fatigue_limit
        answer |= {"threshold": K.threshold(*limits).tolist(), "arrest": K.arrest(*limits)}
    return answer


def _states(solution: Solution, file: SceneFile) -> Sequence[Solution]:
    history = solution.history
    if history is None or file.load_path is None:
        return (solution,)
    points = list(zip(file.load_path.points, file.load_path.turns, strict=True))
    closed = [k for k, point in enumerate(points[:-1]) if point == points[-1]]
    return history[closed[-1] if closed else 0 :]


def _edge(states: Sequence[Solution], name: str) -> float:
    """The edge of the contact under the largest tangential load."""
    pushed = max(states, key=lambda state: abs(state.tangential_load))
    Q = pushed.tangential_load
    if not Q:
        raise ValueError(
            f'[crack] at = "{name}": no tangential load makes an edge trail; give at = x'
        )
    return pushed.edges[0 if (Q > 0.0) == (name == EDGES[0]) else 1]


def crack_summary(crack: dict[str, Any], units: Any) -> str:
    """The answer of `crack_answer` in lines."""
    unit = f"{units.stress} √{units.length}"
    rows = [("cracks", f"from x = {crack['x']:.6g}, {len(crack['mode_1'])} states; K in {unit}")]
    for i, depth in enumerate(crack["depth"]):
        K_1, K_2 = ([K[i] for K in crack[name]] for name in ("mode_1", "mode_2"))
        text = (
            f"K_I {min(K_1):.5g} to {max(K_1):.5g}, range {crack['range_1'][i]:.5g};  "
            f"K_II {min(K_2):.5g} to {max(K_2):.5g}, range {crack['range_2'][i]:.5g}"
        )
        if "threshold" in crack:
            text += f";  threshold {crack['threshold'][i]:.5g}"
        rows.append((f"{depth:.6g} {units.length}", text))
    if "arrest" in crack:
        depth = crack["arrest"]
        grows = f"not down to {crack['depth'][-1]:.6g} {units.length}"
        rows.append(("arrest", grows if math.isinf(depth) else f"at {depth:.6g} {units.length}"))
    return named_rows(*rows)
