"""The last cycle of a load path to read: slip, energy, stress ranges and fatigue parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sie.arguments import named_rows

from .scene_file import SceneFile

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


def cycle_summary(cycle: dict[str, Any], file: SceneFile) -> str:
    """The answer of `cycle_answer` in lines."""
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
