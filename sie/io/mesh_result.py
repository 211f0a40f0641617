"""A mesh result in the axes of the package: x along the surface, and the depth below it.

Tractions act on the surface. Its height in the file is, in this order

    the one that is given
    y = 0, if the contact pressure acts there, else the height at which it acts
    the top of the lower of two parts of a mesh (the foot of the upper part, if that is chosen)
    y = 0, unless |σ_yy|, which decreases with depth, is larger at the other end of the file

Points below it have the depth surface - y and, as y points out of the body, the other sign of σ_xy;
points above it have the depth y - surface. Points that coincide, as those of two elements or of the
two sides of an extruded mesh, are averaged.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.io.mesh_files import formats
from sie.io.mesh_files.names import QUANTITIES, STRESSES, TRACTIONS
from sie.io.mesh_files.raw import Group, Raw, row_means

Array = NDArray[np.float64]

# Parts of the largest distance in the file: points as near as this coincide, and heights as near
# as this are one. A .frd file has six digits.
COINCIDENT = 1e-8
# Σ_yy at one end of the file has to be this many times that at the other.
CLEARLY_LARGER = 2.0


class Points(NamedTuple):
    """A quantity at points (x, depth), by ascending x; widths of element faces, or ()."""

    x: Array
    y: Array
    values: Array
    widths: Array | tuple[()] = ()


@dataclass(frozen=True, eq=False)
class Mesh:
    """The quantities of a file, each at its points.

    others       columns that were passed over, by name, or by number where there is no header
    notes        sentences on what was chosen, averaged or turned over
    """

    name: str
    fields: dict[str, Points]
    others: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    def points(self, quantity: str) -> tuple[Array, Array, Array]:
        """(x, y, values) where the quantity is compared."""
        field = self.fields[quantity]
        return field.x, field.y, field.values

    def scattered(self, quantity: str) -> bool:
        """Whether these points are not on a line at one depth."""
        x, y, _ = self.points(quantity)
        return bool(np.ptp(y) > 0.0 or np.ptp(x) == 0.0)

    def weights(self, quantity: str) -> Array:
        """Weights of the points: lengths of a line, equal ones where points are scattered.

        The lengths are those of the element faces. Between nodes they reach half-way to the next
        ones, and at an end as far outwards as inwards: the pressure goes on beyond the last node
        or centre in contact.
        """
        x, _, _ = self.points(quantity)
        widths = self.fields[quantity].widths
        if isinstance(widths, np.ndarray):
            return widths
        if self.scattered(quantity):
            return np.ones_like(x)
        middle = 0.5 * (x[1:] + x[:-1])
        ends = np.concatenate(([2.0 * x[0] - middle[0]], middle, [2.0 * x[-1] - middle[-1]]))
        return np.diff(ends)


def read_mesh(
    path: str | Path,
    nodes: str | Path | None = None,
    surface: float | None = None,
    body: str = "",
    columns: Mapping[str, str] | None = None,
) -> Mesh:
    """The quantities of a file of a finite-element code.

    `nodes` is the file with the coordinates of the nodes, `surface` the height of the surface,
    `body` "below" or "above" it, and `columns` has names of columns by x, y, p, q, sxx, ....
    ValueError where the file cannot be compared.
    """
    return _placed(formats.read(path, nodes, columns), surface, body)


def _placed(raw: Raw, surface: float | None, body: str) -> Mesh:
    """The quantities in the axes of the package."""
    notes = list(raw.notes)
    fields: dict[str, Points] = {}
    height = surface if surface is not None else _height_of_contact(raw)
    for group in raw.groups:
        for names, place in ((TRACTIONS, _on_surface), (STRESSES, _in_body)):
            columns = {n: v for n, v in group.columns.items() if n in ("x", "y", *names)}
            if set(columns) & set(names):
                part = replace(group, columns=columns)
                placed, more = _averaged(*place(raw, part, height, body))
                for name in set(columns) & set(names):
                    fields[name] = _joined(fields.get(name), placed, name)
                notes += [note for note in more if note not in notes]
    fields = {name: fields[name] for name in QUANTITIES if name in fields}
    for name, (x, _, _, _) in fields.items():
        if len(x) < 2 or (name in TRACTIONS and x[0] == x[-1]):
            where = " on the surface, y = 0, where it is compared" if name in TRACTIONS else ""
            raise ValueError(
                f"{raw.file} holds {len(x) or 'no'} point{'s' * (len(x) != 1)} of {name}{where}: "
                "a comparison needs at least two; --surface gives the height of the surface"
            )
    return Mesh(raw.file, fields, raw.others, tuple(notes))


def _joined(before: Points | None, group: Group, name: str) -> Points:
    """The points of a group, with those of the groups before it, by ascending x."""
    new = Points(group.columns["x"], group.columns["y"], group.columns[name], group.widths)
    if before is not None:
        widths = (before.widths, new.widths)
        both = all(isinstance(w, np.ndarray) for w in widths)
        x, y, values = (np.concatenate(pair) for pair in zip(before[:3], new[:3], strict=True))
        new = Points(x, y, values, np.concatenate(widths) if both else ())
    order = np.lexsort((new.y, new.x))
    widths_ = new.widths[order] if isinstance(new.widths, np.ndarray) else ()
    return Points(new.x[order], new.y[order], new.values[order], widths_)


def _near(values: Array, level: float) -> NDArray[np.bool_]:
    """Which heights are the level, to the digits of a file."""
    extent = max(float(np.abs(values).max()), abs(level))
    result: NDArray[np.bool_] = np.abs(values - level) <= COINCIDENT * extent
    return result


def _height_of_contact(raw: Raw) -> float | None:
    """The height at which the contact pressure acts, None where it is not known or not one."""
    for group in raw.groups:
        height = _level(group)
        if height is not None:
            return height
    return None


def _level(group: Group) -> float | None:
    loads = [np.abs(group.columns[name]) for name in TRACTIONS if name in group.columns]
    if not loads or "y" not in group.columns or not any(load.any() for load in loads):
        return None
    y = group.columns["y"][np.any([load > 0.5 * load.max() for load in loads], axis=0)]
    if np.count_nonzero(_near(y, 0.0)) > 1:
        return 0.0
    return float(y[0]) if _near(y, float(y[0])).all() else None


def _on_surface(raw: Raw, group: Group, height: float | None, body: str) -> tuple[Group, list[str]]:
    """The points on the surface; on a curved one, those where a traction acts.

    Codes write the traction of one of two bodies, and zero on the other.
    """
    acts = np.any([group.columns[n] != 0.0 for n in TRACTIONS if n in group.columns], axis=0)
    if isinstance(group.bodies, np.ndarray) and acts.any():
        own = np.isin(group.bodies, group.bodies[acts])
        group, acts = group.chosen(own), acts[own]
    y = group.columns.get("y")
    zeros = np.zeros(len(group.columns["x"]))
    if y is None:
        return replace(group, columns=group.columns | {"y": zeros}), []
    notes = []
    level = height if height is not None else 0.0
    chosen = _near(y, level)
    known = isinstance(group.bodies, np.ndarray)
    if known and np.count_nonzero(chosen) < 2:
        chosen = acts
        notes = ["tractions are compared where they act: no level surface holds their points"]
    elif level:
        notes = [f"the surface is at y = {level:.6g}"]
    if not known and not body and y.min() < level < y.max() and acts[~chosen].any():
        raise _two_sides(raw.file, y, level)
    place = _clusters(group.columns["x"], COINCIDENT * float(np.abs(group.columns["x"]).max()))
    other = ~acts & np.isin(place, place[acts & chosen])
    if (other & chosen).any():
        notes.append(f"{(other & chosen).sum()} zeros beside a traction are those of another body")
    placed = group.chosen(chosen & ~other)
    return replace(
        placed, columns=placed.columns | {"y": np.zeros(len(placed.columns["x"]))}
    ), notes


def _in_body(raw: Raw, group: Group, height: float | None, body: str) -> tuple[Group, list[str]]:
    """The points of one body, with their depth, and the sign of σ_xy that belongs to it."""
    if "y" not in group.columns:
        zeros = np.zeros(len(group.columns["x"]))
        return replace(group, columns=group.columns | {"y": zeros}), []
    notes: list[str] = []
    parts = len(raw.tops)
    if parts > 1 and isinstance(group.bodies, np.ndarray):
        wanted = _part(raw, body)
        group = group.chosen(group.bodies == wanted)
        if not len(group.columns["x"]):
            return group, []
        foot = float(group.columns["y"].min())
        side = "above" if wanted else "below"
        height = height if height is not None else foot if wanted else raw.tops[wanted]
        notes = [f"stress is that of part {wanted + 1} of {parts}, counted from below"]
    else:
        height, side = _height_by_stress(group, notes) if height is None else height, body
    y = group.columns["y"] - height
    y[_near(group.columns["y"], height)] = 0.0
    if not side and y.min() < 0.0 < y.max():
        raise _two_sides(raw.file, group.columns["y"], height)
    side = side or ("below" if y.min() < 0.0 else "above")
    inside = y <= 0.0 if side == "below" else y >= 0.0
    if height:
        notes.append(f"the body is {side} y = {height:.6g}")
    if body == "above":
        notes.append("the body above has the shear -q: give the scene the other tangential load")
    columns = group.columns | {"y": np.abs(y)}
    if "sxy" in columns and side == "below" and y.min() < 0.0:
        columns["sxy"] = -columns["sxy"]
    return replace(group, columns=columns).chosen(inside), notes


def _part(raw: Raw, body: str) -> int:
    """The lowest part of the mesh that has stress, or the highest one for the body above."""
    present = np.concatenate(
        [g.bodies for g in raw.groups if set(g.columns) & set(STRESSES) and len(g.bodies)]
    )
    return int(present.max() if body == "above" else present.min())


def _height_by_stress(group: Group, notes: list[str]) -> float:
    """0, or the end of the file that is farther from it if σ_yy is clearly larger there."""
    y = group.columns["y"]
    stress = next((np.abs(group.columns[n]) for n in ("syy", "sxx") if n in group.columns), None)
    near, far = sorted((float(y.min()), float(y.max())), key=abs)
    if stress is None or near == far or near * far < 0.0:
        return 0.0
    band = 0.05 * abs(far - near)
    at_near, at_far = (float(stress[np.abs(y - end) <= band].max()) for end in (near, far))
    if at_far > CLEARLY_LARGER * at_near:
        notes.append(f"the stress is largest at y = {far:.6g}: --surface gives another height")
        return far
    return 0.0


def _two_sides(file: str, y: Array, height: float = 0.0) -> ValueError:
    return ValueError(
        f"{file} has y from {y.min():.6g} to {y.max():.6g}: the body is on one side of "
        f"y = {height:.6g}, leave the other out, or choose it by --body below (or above) and "
        "--surface, the height of the surface"
    )


def _averaged(group: Group, notes: list[str]) -> tuple[Group, list[str]]:
    """The group with one value at each point, and a note where there were several."""
    x, y = group.columns["x"], group.columns["y"]
    if not len(x):
        return group, notes
    extent = max(float(np.abs(x).max()), float(np.abs(y).max()))
    place = _clusters(x, COINCIDENT * extent) * len(x) + _clusters(y, COINCIDENT * extent)
    count = len(np.unique(place))
    if count == len(x):
        return group, notes
    names = list(group.columns)
    table = np.stack([group.columns[name] for name in names], axis=1)
    _, mean = row_means(place.tolist(), table)
    _, inverse = np.unique(place, return_inverse=True)
    quantities = [k for k, name in enumerate(names) if name in QUANTITIES]
    spread = np.abs(table - mean[inverse]).max(axis=0)[quantities]
    largest = np.abs(table).max(axis=0)[quantities]
    apart = float(np.max(spread / np.where(largest > 0.0, largest, 1.0)))
    told = ", ".join(names[k] for k in quantities)
    notes = [
        *notes,
        f"{len(x)} values of {told} stand at {count} places: averaged, they differ by up to "
        f"{apart:.1e} of the largest",
    ]
    widths = group.widths
    if isinstance(widths, np.ndarray):
        widths = row_means(place.tolist(), widths[:, None])[1][:, 0]
    return Group(dict(zip(names, mean.T, strict=True)), widths), notes


def _clusters(values: Array, tolerance: float) -> NDArray[np.int64]:
    """The number, by ascending value, of the cluster that each value belongs to."""
    order = np.argsort(values, kind="stable")
    number = np.empty(len(values), dtype=np.int64)
    number[order] = np.cumsum(np.diff(values[order], prepend=values[order][0]) > tolerance)
    return number
