"""Exact data of a half-plane on the boundary of a finite-element mesh.

A mesh of a few half-widths has the half-plane's answer as its limit, if its boundary away from the
contact has the half-plane's displacements, or its tractions. With N_i the linear shape functions
between neighbours on a side, the forces on nodes do the work of the tractions:

    f_i = ∫ N_i σ n ds,        Σ f_i = ∫ σ n ds,        Σ x_i × f_i = ∫ x × σ n ds

In Python and in CSV the axes are those of the package, y downward. Keyword lines of Abaqus and
CalculiX have the axes of a mesh, y upward from the surface.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments, files
from sie.stress.displacement import Displacement
from sie.stress.half_plane import Stress, Tractions

Array = NDArray[np.float64]
Index = NDArray[np.int64]

KINDS = ("displacement", "traction")
PER_BOX = 40  # intervals of a box's width where no spacing is given
ON_SIDE = 1e-9  # of the extent: a point this near to a side is on it
ABSCISSAE, WEIGHTS = np.polynomial.legendre.leggauss(16)
MOST = 10**6  # points


@dataclass(frozen=True, eq=False)
class BoundaryData:
    """Exact displacements, or tractions and nodal forces, at points of a boundary.

    Parameters
    ----------
    kind : {"displacement", "traction"}
        What is given.
    x, y : ndarray of float
        The points, length, shape (n,); y is downward. A corner is a point of both of its sides
        where tractions are given.
    values : dict of str to ndarray of float
        Of displacements `u_x` and `u_y`, lengths. Of tractions the outward normal `n_x`, `n_y`,
        the traction `t_x`, `t_y`, stresses, and the nodal force `f_x`, `f_y`, per unit of
        thickness.
    labels : ndarray of int
        Numbers of the points as nodes; from 1 if none are given.
    head : tuple of str
        Of which contact and with which gauge they are.
    """

    kind: str
    x: Array
    y: Array
    values: dict[str, Array]
    labels: Index
    head: tuple[str, ...] = ()

    @property
    def resultant(self) -> tuple[float, float, float]:
        """The sums Σ f_x, Σ f_y and Σ x f_y - y f_x of the nodal forces.

        On three sides of a box below the contact they balance Q, P and M. ValueError for
        displacements.
        """
        if self.kind != "traction":
            raise ValueError("displacements have no resultant: ask for kind = 'traction'")
        f_x, f_y = self.values["f_x"], self.values["f_y"]
        return float(f_x.sum()), float(f_y.sum()), float(self.x @ f_y - self.y @ f_x)

    def csv(self) -> str:
        """The points and values as CSV below lines of comment."""
        columns = {"node": self.labels, "x": self.x, "y": self.y, **self.values}
        return files.table_of_columns((*self.head, "y is downward from the surface"), columns)

    def keywords(self) -> str:
        """The lines *BOUNDARY or *CLOAD of a deck, y upward; CalculiX reads 20 characters."""
        forces = self.kind == "traction"
        names, card, between = ("f_x", "f_y"), "*CLOAD", ""
        if not forces:
            names, card, between = ("u_x", "u_y"), "*BOUNDARY", "{0}, "
        labels, first, index = np.unique(self.labels, return_index=True, return_inverse=True)
        both = (self.values[names[0]], 0.0 - self.values[names[1]])
        columns = [np.bincount(index, v) if forces else v[first] for v in both]
        lines = [f"** {line}" for line in (*self.head, "y is upward, as in the mesh")] + [card]
        for label, *vector in zip(labels.tolist(), *(c.tolist() for c in columns), strict=True):
            freedoms = enumerate(vector, 1)
            lines += [f"{label}, {k}, {between.format(k)}{value:.13e}" for k, value in freedoms]
        return "\n".join(lines) + "\n"

    def write(self, path: str | Path) -> None:
        """Write a file: CSV, or with the suffix .inp keyword lines that a deck includes.

        Parameters
        ----------
        path : str or Path
            The file, .csv or .inp.

        Raises
        ------
        ValueError
            For another suffix.
        OSError
            If it cannot be written; what was there before is then still there.
        """
        path = files.writable(path)
        texts = {".csv": self.csv, ".inp": self.keywords}
        if path.suffix.lower() not in texts:
            raise ValueError(f"{path} is neither .csv nor .inp: give one of these suffixes")
        files.write_files({path: texts[path.suffix.lower()]().encode()})


def boundary_data(
    moved: Callable[[Array, Array], Displacement],
    stressed: Tractions | None,
    places: Array,
    kind: str,
    *,
    about: tuple[str, ...],
    labels: ArrayLike | None,
) -> BoundaryData:
    """The data at points (n, 2) of a body with these displacements and tractions."""
    x, y = places.T
    if labels is None:
        labels = np.arange(1, len(x) + 1)
    numbers = arguments.reals("labels", labels).astype(np.int64)
    if numbers.shape != x.shape or (numbers != labels).any():
        raise ValueError(f"{numbers.size} labels of {len(x)} points: give a whole number for each")
    if kind == "displacement":
        u = moved(x, y)
        held = (
            f"the body keeps its place at ({u.zero[0]!r}, {u.zero[1]!r}); rotation at "
            f"infinity {u.rotation!r}; approach {u.approach!r}"
        )
        return BoundaryData(kind, x, y, {"u_x": u.x, "u_y": u.y}, numbers, (*about, held))
    if stressed is None:
        raise ValueError("a rigid body has displacements, but no stress: leave out kind")
    parts = []
    for nodes, normal in _sides(x, y, sum(stressed.pressure.interval) / 2.0):
        forces = _forces(stressed, places[nodes], normal)
        parts.append(np.column_stack((nodes, np.tile(normal, (len(nodes), 1)), forces)))
    order, n_x, n_y, f_x, f_y = np.concatenate(parts).T
    at = order.astype(np.int64)
    t_x, t_y = _traction(stressed, places[at], np.column_stack((n_x, n_y))).T
    values = {"n_x": n_x, "n_y": n_y, "t_x": t_x, "t_y": t_y, "f_x": f_x, "f_y": f_y}
    return BoundaryData(kind, x[at], y[at], values, numbers[at], about)


def asked_places(
    points: ArrayLike | None, box: Sequence[float] | None, spacing: float | None, kind: str
) -> Array:
    """The points (n, 2) that are asked for. ValueError for what names none."""
    if not arguments.among(kind, KINDS):
        raise ValueError(f"kind = {kind!r} is not known: give 'displacement' or 'traction'")
    if box is not None and points is None:
        return _on_box(box, spacing)
    if points is None or box is not None:
        what = "neither" if points is None else "both"
        raise ValueError(f"{what} of points and box given: give one of them")
    places = arguments.reals("points", points)
    if places.ndim != 2 or places.shape[1] != 2 or not len(places):
        raise ValueError(f"points of shape {places.shape}: give rows (x, y), an array (n, 2)")
    return places


def _on_box(box: Sequence[float], spacing: float | None) -> Array:
    """Points on the sides of a box, in order around it; not on the surface."""
    given = arguments.listed("box", box, "(x0, x1, y0, y1)")
    if len(given) != 4:
        raise ValueError(f"box = {given!r} has {len(given)} numbers: give (x0, x1, y0, y1)")
    x0, x1, y0, y1 = (arguments.finite("box", value) for value in given)
    if not (x0 < x1 and y0 < y1):
        raise ValueError(f"box = {given!r} is empty: give x0 < x1 and y0 < y1")
    step = (x1 - x0) / PER_BOX if spacing is None else arguments.positive("spacing", spacing)
    if 2.0 * (x1 - x0 + y1 - y0) / step > MOST:
        raise ValueError(f"spacing = {step:g} gives more than {MOST} points: give a larger one")
    across, up = (max(round((b - a) / step), 1) for a, b in ((x0, x1), (y0, y1)))
    x, y = np.linspace(x0, x1, across + 1), np.linspace(y0, y1, up + 1)
    corners = (x0 + 0.0 * y[:-1], y[:-1]), (x[:-1], y1 + 0.0 * x[:-1])
    back = (x1 + 0.0 * y[:0:-1], y[:0:-1]), (x[:0:-1], y0 + 0.0 * x[:0:-1])
    places = np.concatenate([np.column_stack(side) for side in (*corners, *back)])
    inner = (places[:, 0] > x0) & (places[:, 0] < x1)
    return places[~(inner & (places[:, 1] == 0.0))]


def _sides(x: Array, y: Array, centre: float) -> list[tuple[Index, tuple[float, float]]]:
    """The sides of the box around the points, but for the surface. ValueError for points inside.

    Each is given by the indices of its points, in order along it, and the unit vector out of the
    body. The points of one line are a side that faces away from the contact.
    """
    near = ON_SIDE * max(float(np.ptp(x)), float(np.ptp(y)))
    lines = {(1, 0): (x, y, centre), (0, 1): (y, x, 0.0)}
    sides, placed = [], np.abs(y) <= near
    for (n_x, n_y), (level, along, inside) in lines.items():
        ends = [(-1.0, level.min()), (1.0, level.max())]
        if np.ptp(level) <= near:
            ends = [(float(np.sign(level[0] - inside)), level[0])]
        for sign, end in ends:
            if n_y and abs(end) <= near:
                continue  # the surface
            nodes = np.flatnonzero(np.abs(level - end) <= near)
            placed[nodes] = True
            order = nodes[np.argsort(along[nodes], kind="stable")]
            if len(nodes) > 1:
                sides.append((order, (sign * n_x, sign * n_y)))
    if not placed.all() or not sides:
        k = int(np.argmin(placed))
        raise ValueError(
            f"({x[k]:g}, {y[k]:g}) is on no side of the box around the points: tractions are known "
            "on the sides of a box; give its nodes, box=..., or ask for displacements"
        )
    return sides


def _traction(tractions: Tractions, places: Array, normals: Array) -> Array:
    """σ n, shape (n, 2); the indenter, y < 0, is a half-plane mirrored at the surface."""
    x, y = places.T
    s = Stress(tractions, x, np.abs(y))
    xy = s.xy if y.max() > 0.0 else -s.xy
    upright = normals[:, 1] == 0.0  # a side is upright or level: stresses may be infinite
    t = np.where(upright, (s.xx, xy), (xy, s.yy)).T
    return np.where(upright, normals[:, 0], normals[:, 1])[:, None] * t


def _forces(tractions: Tractions, places: Array, normal: tuple[float, float]) -> Array:
    """The nodal forces on a side, shape (nodes, 2)."""
    start, step = places[:-1], np.diff(places, axis=0)
    share = 0.5 * (1.0 + ABSCISSAE)[:, None]
    inner = (start[:, None] + share * step[:, None]).reshape(-1, 2)
    t = _traction(tractions, inner, np.tile(normal, (len(inner), 1)))
    weight = (0.5 * np.linalg.norm(step, axis=1)[:, None] * WEIGHTS)[..., None]
    t = t.reshape(len(step), -1, 2) * weight
    forces = np.zeros_like(places)
    forces[:-1] += (t * (1.0 - share)).sum(axis=1)
    forces[1:] += (t * share).sum(axis=1)
    return forces
