"""The stress intensity of the cracks of a scene file.

Of a load path that comes back to earlier loads the cracks see the turning points of the last cycle,
of another path all points, and of a scene without path its one state.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from sie.cracks.stress_intensity import stress_intensity
from sie.progress_bar import reported

from .crack_table import EDGES
from .scene_file import SceneFile

if TYPE_CHECKING:
    from sie.solution import Solution


@reported("crack")
def crack_answer(solution: Solution, file: SceneFile) -> dict[str, Any]:
    """What JSON and the report say of the cracks."""
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
