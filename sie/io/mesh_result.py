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

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie import files
from sie.profiles.trace_files import MESH

from .mesh_files import abaqus_report, by_meshio, calculix_frd, node_lists, text_table
from .mesh_files.names import QUANTITIES, STRESSES, TRACTIONS, chosen_names
from .mesh_files.raw import Columns, Raw, chosen, row_means

Array = NDArray[np.float64]

# Parts of the largest distance in the file: points as near as this coincide, and heights as near
# as this are one. A .frd file has six digits.
COINCIDENT = 1e-8
# Σ_yy at one end of the file has to be this many times that at the other.
CLEARLY_LARGER = 2.0
# CalculiX: "contact stress (slave node,press,tang1,tang2) for all contact elements and time 1.0".
_PRINTED = re.compile(r"^ [a-z ]+\([^)\n]*\).* for .*\btime\b", re.MULTILINE)


class Points(NamedTuple):
    """A quantity at points (x, depth), by ascending x."""

    x: Array
    y: Array
    values: Array

    def chosen(self, which: Any) -> Points:
        """Some of the points, or all of them in another order."""
        return Points(*(column[which] for column in self))


def joined(parts: Sequence[Points]) -> Points:
    """The points of all parts, by ascending x."""
    both = Points(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))
    return both.chosen(np.lexsort((both.y, both.x)))


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

    def scattered(self, quantity: str) -> bool:
        """Whether its points are not on a line at one depth."""
        x, y, _ = self.fields[quantity]
        return bool(np.ptp(y) > 0.0 or np.ptp(x) == 0.0)

    def weights(self, quantity: str) -> Array:
        """Weights of the points: lengths of a line, equal ones where points are scattered.

        The lengths reach half-way to the next points, and at an end as far outwards as inwards: the
        pressure goes on beyond the last node or centre in contact.
        """
        x = self.fields[quantity].x
        if self.scattered(quantity):
            return np.ones_like(x)
        middle = 0.5 * (x[1:] + x[:-1])
        ends = np.concatenate(([2.0 * x[0] - middle[0]], middle, [2.0 * x[-1] - middle[-1]]))
        return np.diff(ends)


# -- files -----------------------------------------------------------------------------------------


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
    path, columns = Path(path), columns or {}
    raw = _raw(path, None if nodes is None else Path(nodes), columns)
    for quantity, name in columns.items():
        if not any(quantity in group for group in raw.groups):
            raise ValueError(
                f'{path.name} has no column "{name}" for {quantity}: '
                "give the name as it stands in the file"
            )
    return _placed(raw, surface, body)


def _raw(path: Path, nodes: Path | None, columns: Mapping[str, str]) -> Raw:
    """What the file holds, by the reader that its suffix or its first lines ask for."""
    means = chosen_names(columns)
    mesh = None if nodes is None else node_lists.coordinates(nodes)
    suffix = path.suffix.lower()
    if suffix == ".frd":
        return calculix_frd.read(path, means)
    if suffix in by_meshio.SUFFIXES:
        return by_meshio.read(path, means)
    text = files.content(path, MESH.size).decode("latin-1")
    if _PRINTED.search(text):
        raise ValueError(
            f"{path.name} is printed output of CalculiX, without coordinates: have a .frd written, "
            "by *CONTACT FILE with CSTR and *EL FILE with S, and compare that"
        )
    if abaqus_report.TITLE in text:
        return abaqus_report.read(path, mesh, means)
    return node_lists.read(path, mesh, means) or text_table.read(path, means)


# -- places ----------------------------------------------------------------------------------------


def _placed(raw: Raw, surface: float | None, body: str) -> Mesh:
    """The quantities in the axes of the package; without y they are on the surface."""
    notes = list(raw.notes)
    groups = [{"y": np.zeros_like(group["x"])} | group for group in raw.groups]
    heights = (height for height in map(_level, groups) if height is not None)
    height = surface if surface is not None else next(heights, None)
    parts: dict[str, list[Points]] = {}
    for group in groups:
        for names, other, place in (
            (TRACTIONS, STRESSES, _on_surface),
            (STRESSES, TRACTIONS, _in_body),
        ):
            columns = {n: v for n, v in group.items() if n not in other}
            if columns.keys() & set(names):
                placed, more = _averaged(*place(raw, columns, height, body))
                for name in columns.keys() & set(names):
                    points = Points(placed["x"], placed["y"], placed[name])
                    parts.setdefault(name, []).append(points)
                notes += [note for note in more if note not in notes]
    fields = {name: joined(parts[name]) for name in QUANTITIES if name in parts}
    for name, (x, _, _) in fields.items():
        if len(x) < 2 or (name in TRACTIONS and x[0] == x[-1]):
            where = " on the surface, y = 0, where it is compared" if name in TRACTIONS else ""
            raise ValueError(
                f"{raw.file} holds {len(x) or 'no'} point{'s' * (len(x) != 1)} of {name}{where}: "
                "a comparison needs at least two; --surface gives the height of the surface"
            )
    return Mesh(raw.file, fields, raw.others, tuple(notes))


def _near(values: Array, level: float) -> NDArray[np.bool_]:
    """Which heights are the level, to the digits of a file."""
    extent = max(float(np.abs(values).max()), abs(level))
    result: NDArray[np.bool_] = np.abs(values - level) <= COINCIDENT * extent
    return result


def _level(group: Columns) -> float | None:
    """The height at which the contact pressure acts, None where it is not known or not one."""
    loads = [np.abs(group[name]) for name in TRACTIONS if name in group]
    if not any(load.any() for load in loads):
        return None
    y = group["y"][np.any([load > 0.5 * load.max() for load in loads], axis=0)]
    if np.count_nonzero(_near(y, 0.0)) > 1:
        return 0.0
    return float(y[0]) if _near(y, float(y[0])).all() else None


def _on_surface(
    raw: Raw, group: Columns, height: float | None, body: str
) -> tuple[Columns, list[str]]:
    """The points on the surface; on a curved one, those where a traction acts.

    Codes write the traction of one of two bodies, and zero on the other.
    """
    acts = np.any([group[name] != 0.0 for name in TRACTIONS if name in group], axis=0)
    known = "body" in group
    if known and acts.any():
        own = np.isin(group["body"], group["body"][acts])
        group, acts = chosen(group, own), acts[own]
    y, notes = group["y"], []
    level = height if height is not None else 0.0
    on = _near(y, level)
    if known and np.count_nonzero(on) < 2:
        on = acts
        notes = ["tractions are compared where they act: no level surface holds their points"]
    elif level:
        notes = [f"the surface is at y = {level:.6g}"]
    if not known and not body and y.min() < level < y.max() and acts[~on].any():
        raise _two_sides(raw.file, y, level)
    place = _clusters(group["x"], COINCIDENT * float(np.abs(group["x"]).max()))
    other = ~acts & np.isin(place, place[acts & on])
    if (other & on).any():
        notes.append(f"{(other & on).sum()} zeros beside a traction are those of another body")
    placed = chosen(group, on & ~other)
    return placed | {"y": np.zeros_like(placed["x"])}, notes


def _in_body(
    raw: Raw, group: Columns, height: float | None, body: str
) -> tuple[Columns, list[str]]:
    """The points of one body, with their depth, and the sign of σ_xy that belongs to it."""
    notes: list[str] = []
    parts = len(raw.tops)
    if parts > 1 and "body" in group:
        wanted = _part(raw, body)
        group = chosen(group, group["body"] == wanted)
        if not len(group["x"]):
            return group, []
        foot = float(group["y"].min())
        side = "above" if wanted else "below"
        height = height if height is not None else foot if wanted else raw.tops[wanted]
        notes = [f"stress is that of part {wanted + 1} of {parts}, counted from below"]
    else:
        height, side = _height_by_stress(group, notes) if height is None else height, body
    y = np.where(_near(group["y"], height), 0.0, group["y"] - height)
    if not side and y.min() < 0.0 < y.max():
        raise _two_sides(raw.file, group["y"], height)
    side = side or ("below" if y.min() < 0.0 else "above")
    if height:
        notes.append(f"the body is {side} y = {height:.6g}")
    if body == "above":
        notes.append("the body above has the shear -q: give the scene the other tangential load")
    placed = group | {"y": np.abs(y)}
    if "sxy" in placed and side == "below" and y.min() < 0.0:
        placed["sxy"] = -placed["sxy"]
    return chosen(placed, y <= 0.0 if side == "below" else y >= 0.0), notes


def _part(raw: Raw, body: str) -> int:
    """The lowest part of the mesh that has stress, or the highest one for the body above."""
    present = np.concatenate(
        [g["body"] for g in raw.groups if g.keys() & set(STRESSES) and "body" in g]
    )
    return int(present.max() if body == "above" else present.min())


def _height_by_stress(group: Columns, notes: list[str]) -> float:
    """0, or the end of the file that is farther from it if σ_yy is clearly larger there."""
    y = group["y"]
    stress = next((np.abs(group[n]) for n in ("syy", "sxx") if n in group), None)
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


def _averaged(group: Columns, notes: list[str]) -> tuple[Columns, list[str]]:
    """The columns with one value at each point, and a note where there were several."""
    x, y = group["x"], group["y"]
    if not len(x):
        return group, notes
    extent = max(float(np.abs(x).max()), float(np.abs(y).max()))
    place = _clusters(x, COINCIDENT * extent) * len(x) + _clusters(y, COINCIDENT * extent)
    unique, inverse = np.unique(place, return_inverse=True)
    if len(unique) == len(x):
        return group, notes
    table = np.stack([*group.values()], axis=1)
    _, mean = row_means(place.tolist(), table)
    told = [k for k, name in enumerate(group) if name in QUANTITIES]
    spread = np.abs(table - mean[inverse]).max(axis=0)[told]
    largest = np.abs(table).max(axis=0)[told]
    apart = float(np.max(spread / np.where(largest > 0.0, largest, 1.0)))
    names = ", ".join(name for name in group if name in QUANTITIES)
    note = (
        f"{len(x)} values of {names} stand at {len(unique)} places: averaged, they differ by up to "
        f"{apart:.1e} of the largest"
    )
    return dict(zip(group, mean.T, strict=True)), [*notes, note]


def _clusters(values: Array, tolerance: float) -> NDArray[np.int64]:
    """The number, by ascending value, of the cluster that each value belongs to."""
    order = np.argsort(values, kind="stable")
    number = np.empty(len(values), dtype=np.int64)
    number[order] = np.cumsum(np.diff(values[order], prepend=values[order][0]) > tolerance)
    return number
