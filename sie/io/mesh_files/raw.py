"""What a file of a finite-element code holds, before anything is chosen from it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Labels = NDArray[np.int64]

ON_SURFACE = 1e-9  # of the largest depth: the digits of a deck

# Quantities that are given at the same n points, each (n,): x, y where the file has it, quantities
# and, where it is known, body: the number of the connected part of the mesh, 0 being the lowest.
Columns = dict[str, Array]


def chosen(columns: Columns, which: Any) -> Columns:
    """The columns at the points of a mask."""
    return {name: values[which] for name, values in columns.items()}


@dataclass(frozen=True, eq=False)
class Raw:
    """The columns of a file; those that are passed over, and notes on what was done to the rest.

    tops         height of the highest point of each part of the mesh, by number; () if not known
    """

    file: str
    groups: tuple[Columns, ...]
    others: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    tops: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False)
class MeshGeometry:
    """The nodes of a mesh, and its elements as labels of nodes."""

    file: str
    nodes: dict[int, tuple[float, float]]
    elements: dict[int, tuple[int, ...]]

    def points(self, labels: Iterable[int]) -> Array:
        """Coordinates (n, 2) of nodes. ValueError for a label without coordinates."""
        try:
            return np.array([self.nodes[label] for label in labels], dtype=float).reshape(-1, 2)
        except KeyError as missing:
            raise ValueError(
                f"{self.file} has no node {missing.args[0]}: list the nodes of the same mesh"
            ) from None

    def in_axes_of_depth(self, labels: Iterable[int], surface: float) -> Array:
        """Rows (x, depth) of nodes below or above the surface of this height, to the digits."""
        x, y = self.points(labels).T
        depth = surface - y
        depth[np.abs(depth) <= ON_SURFACE * np.abs(depth).max(initial=0.0)] = 0.0
        return np.column_stack((x, depth))

    def columns(self, labels: Sequence[int], values: Columns, bodies: dict[int, int]) -> Columns:
        """The values at nodes with the places of these, and their bodies where there are any."""
        x, y = self.points(labels).T
        part = {"body": np.array([bodies.get(n, 0) for n in labels], dtype=float)} if bodies else {}
        return {"x": x, "y": y, **values, **part}

    def bodies(self) -> dict[int, int]:
        """The number of the connected part that each node belongs to, 0 for the lowest part."""
        from scipy.sparse import coo_array  # noqa: PLC0415 -- for meshes only
        from scipy.sparse.csgraph import connected_components  # noqa: PLC0415

        index = {label: k for k, label in enumerate(self.nodes)}
        pairs = [
            (index[nodes[0]], index[node])
            for nodes in self.elements.values()
            for node in nodes[1:]
            if nodes[0] in index and node in index
        ]
        if not pairs:
            return {}
        rows, columns = np.array(pairs).T
        graph = coo_array((np.ones(len(rows)), (rows, columns)), shape=(len(index), len(index)))
        _, part = connected_components(graph, directed=False)
        heights = np.array([y for _, y in self.nodes.values()])
        used = [p for p in range(part.max() + 1) if np.count_nonzero(part == p) > 1]
        order = sorted(used, key=lambda p: float(heights[part == p].mean()))
        rank = {int(p): k for k, p in enumerate(order)}
        return {label: rank[int(part[k])] for label, k in index.items() if int(part[k]) in rank}

    def tops(self, bodies: dict[int, int]) -> tuple[float, ...]:
        """The height of the highest node of each part."""
        highest = [-np.inf] * (max(bodies.values(), default=-1) + 1)
        for label, body in bodies.items():
            highest[body] = max(highest[body], self.nodes[label][1])
        return tuple(highest)


def row_means(labels: Sequence[int], values: Array) -> tuple[Labels, Array]:
    """The labels in ascending order, once each, and the means of the rows that each has."""
    unique, inverse = np.unique(np.asarray(labels, dtype=np.int64), return_inverse=True)
    total = np.zeros((len(unique), values.shape[1]))
    np.add.at(total, inverse, values)
    return unique, total / np.bincount(inverse)[:, None]
