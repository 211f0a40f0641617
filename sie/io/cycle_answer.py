"""The last closed cycle of a load path: slip, energy, stress ranges, fatigue parameters, cracks.

The cycle runs from the last earlier point of the path that has the loads of its last point. Each of
its steps is examined at a few states, as [fatigue] parts says.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from sie.arguments import named_rows
from sie.cracks.stress_intensity import stress_intensity
from sie.errors import ContactError
from sie.problem.material import Elastic
from sie.progress_bar import reported
from sie.stress.fretting import Cycle
from sie.stress.surface_search import ROUNDS, columns, largest

from .scene_keys import EDGES

if TYPE_CHECKING:
    from sie.problem.load_path import Path
    from sie.stress.half_plane import Tractions

    from .beside_scene import Fatigue, Units
    from .scene_file import SceneFile

Array = NDArray[np.float64]

COMPONENTS = ("xx", "yy", "xy")
DEPTHS = (0.01, 0.1)  # of the largest half-width, where none is given
SLIP_ROUNDS = 4  # of narrowing for what depends on the slip
NAMES = {"swt": "SWT", "findley": "Findley", "fatemi_socie": "Fatemi-Socie"}
# Why a parameter is 0.
ZERO = {
    "swt": "no plane is in tension while its strain changes",
    "findley": "no stress on any plane",
    "fatemi_socie": "no shear changes on a plane with k σ_n > -σ_y",
}
# A stress that changes by less, relative to its size, does not change but for rounding.
NOTHING = 1e-12
# A smaller angle out of the plane, in degrees, is rounding.
IN_PLANE = 1e-3


def start_of_cycle(path: Path | None) -> int:
    """The index of the point at which the last cycle of a path begins.

    ValueError without a path, or where it does not come back to earlier loads.
    """
    if path is None:
        raise ValueError(
            "--want cycle needs a load path, and the scene has none: give [load] path, which comes "
            "back to earlier loads"
        )
    start = _earlier(path)
    if start >= 0:
        return start
    loads = ", ".join(f"{value:g}" for value in path.points[-1])
    raise ValueError(
        f"the path does not come back to the loads ({loads}) of its last point: "
        "end it at the loads at which its last cycle begins"
    )


def _earlier(path: Path) -> int:
    """The index of the last earlier point with the loads of the last point, -1 for none."""
    points = [(*loads, turn) for loads, turn in zip(path.points, path.turns, strict=True)]
    return next((k for k in range(len(points) - 2, -1, -1) if points[k] == points[-1]), -1)


@reported("cycle")
def cycle_of(solution: Any, file: SceneFile) -> dict[str, Any]:
    """What JSON and the report say of the last cycle of a path."""
    start = start_of_cycle(file.load_path)
    assert solution.history is not None
    history, parts = solution.history, file.fatigue.parts
    states = _states(history, start, parts)
    cycle = Cycle(states)
    answer: dict[str, Any] = {"from": start, "to": len(history) - 1, "states": cycle.size}
    answer |= _energy(history, start)
    widest = max(states, key=lambda state: state.half_width)
    tractions = [state.tractions for state in states]
    answer |= _slip(Cycle(history[start:]), tractions, widest)
    x = columns(tractions, 0.0)
    answer["surface"] = {name: _stress_range(cycle, x, name) for name in COMPONENTS}
    given = file.fatigue.depth or tuple(part * widest.half_width for part in DEPTHS)
    depths = given if isinstance(given, tuple) else (given,)
    known = isinstance(history.scene.body, Elastic)
    return answer | _parameters(cycle, file.fatigue, (0.0, *depths), known)


def _states(history: Any, start: int, parts: int) -> Sequence[Any]:
    """The solutions over the cycle; steps that are followed part by part are not divided."""
    if parts == 1 or any(point.parts for point in history.turning_points):
        return history[start:]
    return history.subdivided(parts)[start * parts :]


def _energy(history: Any, start: int) -> dict[str, float]:
    """The energy that one cycle dissipates; {} where it is not known."""
    try:
        return {"energy": history[-1].energy_lost - history[start].energy_lost}
    except ContactError:
        return {}


def _slip(turning: Cycle, tractions: Sequence[Tractions], widest: Any) -> dict[str, Any]:
    """The largest slip amplitude and Ruiz' parameters, by the states at the turning points.

    In each step a point slips in one direction, so that no other states are needed; the slip of
    points that come into contact takes milliseconds each.
    """
    x = np.concatenate((columns(tractions, widest.half_width), *(t.marks for t in tractions)))
    touching = np.unique(x[(x >= widest.edges[0]) & (x <= widest.edges[1])])
    quantities = {
        "slip_amplitude": lambda x: turning.slip_range(x).amplitude,
        "friction_work": turning.friction_work,
        "ruiz": turning.ruiz,
    }
    return {
        name: _largest(touching, quantity, SLIP_ROUNDS) for name, quantity in quantities.items()
    }


def _largest(x: Array, quantity: Callable[[Array], Array], rounds: int = ROUNDS) -> dict[str, Any]:
    """The largest value of a quantity on the surface and its place, or why it is not known."""
    try:
        values = quantity(x)
        infinite = ~np.isfinite(values)
        if infinite.any():
            return {"reason": f"infinite at x = {x[infinite][0]:g}, a sharp edge or a corner"}
        place, value = largest(x, values, quantity, rounds)
    except ContactError as problem:
        return {"reason": str(problem)}
    return {"value": value, "x": place}


def _stress_range(cycle: Cycle, x: Array, name: str) -> dict[str, Any]:
    """The largest range of a stress on the surface, its place, and the stresses there."""
    found = _largest(x, lambda x: cycle.range(x, 0.0)[name].range)
    if "reason" in found:
        return found
    there = cycle.range(found["x"], 0.0)[name]
    ends = {"lowest": float(there.lowest), "highest": float(there.highest)}
    return {"range": found["value"], "x": found["x"]} | ends


def _parameters(
    cycle: Cycle, material: Fatigue, depths: Sequence[float], elastic: bool
) -> dict[str, list[dict[str, Any]]]:
    """The fatigue parameters for which the material is known, at each depth."""
    asked: dict[str, Callable[[float], Any]] = {}
    if elastic:
        asked["swt"] = lambda y: cycle.swt(y=y)
    if material.findley_k:
        asked["findley"] = lambda y: cycle.findley(y=y, k=material.findley_k)
    if material.fatemi_socie_k:
        constants = {"k": material.fatemi_socie_k, "yield_stress": material.yield_stress}
        asked["fatemi_socie"] = lambda y: cycle.fatemi_socie(y=y, **constants)
    return {name: [_at_depth(find, y) for y in depths] for name, find in asked.items()}


def _at_depth(find: Callable[[float], Any], y: float) -> dict[str, Any]:
    """The largest value of a parameter at a depth, or why there is none."""
    try:
        worst = find(y)
    except ContactError as problem:
        return {"y": y, "reason": str(problem)}
    names = ("value", "x", "y", "angle", "out_of_plane", "amplitude", "normal_stress")
    values = {name: float(getattr(worst, name)) for name in names}
    return values | {name: math.degrees(values[name]) for name in ("angle", "out_of_plane")}


# -- cracks ----------------------------------------------------------------------------------------


@reported("crack")
def crack_answer(solution: Any, file: SceneFile) -> dict[str, Any]:
    """What JSON and the report say of the cracks."""
    assert file.crack is not None
    states, crack = _of_cracks(solution, file), file.crack
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


def _of_cracks(solution: Any, file: SceneFile) -> Sequence[Any]:
    """The turning points of the last cycle, all points of another path, or the one state."""
    history = solution.history
    if history is None or file.load_path is None:
        return (solution,)
    return history[max(_earlier(file.load_path), 0) :]


def _edge(states: Sequence[Any], name: str) -> float:
    """The edge of the contact under the largest tangential load."""
    pushed = max(states, key=lambda state: abs(state.tangential_load))
    Q = pushed.tangential_load
    if not Q:
        raise ValueError(
            f'[crack] at = "{name}": no tangential load makes an edge trail; give at = x'
        )
    return pushed.edges[0 if (Q > 0.0) == (name == EDGES[0]) else 1]


# -- words -----------------------------------------------------------------------------------------


def cycle_summary(cycle: dict[str, Any], file: SceneFile) -> str:
    """The answer of `cycle_of` in lines."""
    units = file.units
    work = f"{units.stress} {units.length}"
    span = f"from point {cycle['from']} to point {cycle['to']} of the path"
    rows = [("cycle", f"{span}, {cycle['states']} states")]
    if "energy" in cycle:
        rows.append(("energy", f"{cycle['energy']:.6g} {units.moment} in the cycle"))
    for name, key, unit in (
        ("slip amplitude", "slip_amplitude", units.length),
        ("Ruiz' κ1", "friction_work", work),
        ("Ruiz' κ2", "ruiz", f"{units.stress}² {units.length}"),
    ):
        found = cycle[key]
        value = found.get("reason") or f"{found['value']:.6g} {unit}{_at(found)}"
        rows.append((name, value if "reason" in found or found["value"] else "0"))
    rows += [
        (f"range of σ_{component}", found.get("reason") or _range(found, units.stress))
        for component, found in cycle["surface"].items()
    ]
    for key, name in NAMES.items():
        unit = "" if key == "fatemi_socie" else f" {units.stress}"
        texts = [
            found.get("reason") or _plane(found, unit, ZERO[key]) for found in cycle.get(key, ())
        ]
        if key == "findley" and file.fatigue.shear_limit:
            texts += _share(cycle.get(key, ()), file.fatigue.shear_limit, units.stress)
        rows += zip([name, *[""] * len(texts)], texts, strict=False)
    return named_rows(*rows)


def _range(found: dict[str, Any], unit: str) -> str:
    scale = max(abs(found["lowest"]), abs(found["highest"]))
    if found["range"] <= NOTHING * scale:
        return "0: it does not change"
    ends = f"from {_shown(found['lowest'])} to {_shown(found['highest'])}"
    return f"{found['range']:.6g} {unit}{_at(found)}, {ends}"


def _share(values: Sequence[dict[str, Any]], limit: float, unit: str) -> list[str]:
    """The largest value as a part of the limit."""
    known = [found["value"] for found in values if "value" in found]
    return [f"{max(known) / limit:.4g} of the limit, {limit:g} {unit}"] if known else []


def _shown(value: float) -> str:
    return f"{value + 0.0:.5g}"


def _at(found: dict[str, Any]) -> str:
    return f" at x = {_shown(found['x'])}"


def _plane(found: dict[str, Any], unit: str, zero: str) -> str:
    """The value of a parameter, its place and the normal of its plane; why it is 0."""
    depth = f", y = {_shown(found['y'])}" if found["y"] else " on the surface"
    if not found["value"]:
        return f"0{depth}: {zero}"
    angle = round(found["angle"], 2) % 180.0  # rounding may have turned 0° into 180°
    out = found["out_of_plane"]
    turned = f", {out:.4g}° out of plane" if out > IN_PLANE else ""
    return f"{found['value']:.6g}{unit}{_at(found)}{depth}, normal {angle:.4g}°{turned}"


def crack_summary(crack: dict[str, Any], units: Units) -> str:
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
