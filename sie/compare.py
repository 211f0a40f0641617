"""A mesh result beside the exact answer: error norms, and the shift in x that fits best.

With e = f_mesh - f at the points of the file, and integrals over x by the trapezoidal rule on them

    l1 = ∫|e| / ∫|f|,      l2 = (∫e² / ∫f²)^(1/2),      largest = max|e| / max|f|
    resultant = ∫f_mesh over that of f on the whole contact, less 1
    shift     the d for which f(x - d) is nearest to f_mesh in l2: a mesh whose origin is elsewhere, or a contact that creeps

A comparison passes if l2 <= tol for every quantity. Points where f is infinite (sharp edges, corners) are left out and counted.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .scenefile import nearest
from .solution import Solution
from .traces import header_of, read_columns

Array = NDArray[np.float64]

# The columns of a file that can be compared: their names, and the exact values at points (x, y). Stresses inside would join here.
QUANTITIES: dict[str, Callable[[Solution, Array, Array], Array]] = {
    "p": lambda solution, x, y: solution.pressure(x),
    "q": lambda solution, x, y: solution.shear(x),
}
RESULTANTS: dict[str, Callable[[Solution], float]] = {"p": lambda s: s.normal_load, "q": lambda s: s.tangential_load}
NAMES = {"pressure": "p", "cpress": "p", "contact pressure": "p", "shear": "q", "cshear1": "q", "traction": "q"}
WITH_DEPTH: frozenset[str] = frozenset()  # quantities that y belongs to; the others are on the surface
FARTHEST_SHIFT = 0.5  # half-widths
SHIFTS = 41  # in the first look
REFINED = 1e-9  # half-widths


@dataclass(frozen=True)
class Mesh:
    """The columns of a file: x, y (0 on the surface), and the quantities that were found in it."""

    name: str
    x: Array
    y: Array
    values: dict[str, Array]


@dataclass(frozen=True)
class Difference:
    """What a mesh result differs by from the exact one, relative; `at` is where it differs most, `infinite` points were left out."""

    points: int
    infinite: int
    l1: float
    l2: float
    largest: float
    at: float
    resultant: float | None
    shift: float
    l2_shifted: float


@dataclass(frozen=True)
class Comparison:
    """All quantities of a file against a tolerance of l2."""

    mesh: Mesh
    tol: float
    differences: dict[str, Difference]

    @property
    def ok(self) -> bool:
        return all(d.l2 <= self.tol for d in self.differences.values())

    def as_dict(self) -> dict[str, Any]:
        found = {name: asdict(d) for name, d in self.differences.items()}
        return {"file": self.mesh.name, "tol": self.tol, "ok": self.ok, "differences": found}

    def __str__(self) -> str:
        lines = []
        for name, d in self.differences.items():
            left_out = f" ({d.infinite} left out, where {name} is infinite)" if d.infinite else ""
            lines += [
                f"{name}: {d.points} points of {self.mesh.name}{left_out}",
                f"  l1     {d.l1:.3e}",
                f"  l2     {d.l2:.3e}",
                f"  max    {d.largest:.3e} of the largest, at x = {d.at:.6g}",
                *([f"  load   {d.resultant:+.3e}"] if d.resultant is not None else []),
                f"  shift  {d.shift:+.6g} fits best, and leaves l2 = {d.l2_shifted:.3e}",
            ]
        verdict = f"l2 {'is within' if self.ok else 'EXCEEDS'} {self.tol:g}"
        return "\n".join([*lines, verdict])


def read_mesh(path: str | Path) -> Mesh:
    """The columns x, y and whatever of QUANTITIES the header names; without a header the first two are x and p."""
    path = Path(path)
    header, width = header_of(path)
    names = [NAMES.get(name, name) for name in header] or ["x", "p"]
    known = [name for name in names[:width] if name in ("x", "y", *QUANTITIES)]
    found = [name for name in known if name in QUANTITIES]
    if "x" not in known or not found:
        near = next((name for name in header if nearest(name, ("x", *QUANTITIES, *NAMES))), "")
        hint = f' (is "{near}" one of them?)' if near else ""
        raise ValueError(
            f"{path.name} has the columns {', '.join(header)}{hint}: name one x and one {' or '.join(QUANTITIES)}, on the first line"
        )
    columns = dict(zip(known, read_columns(path, tuple(names.index(name) for name in known)), strict=True))
    order = np.argsort(columns["x"], kind="stable")
    x, y = columns["x"][order], columns.get("y", np.zeros(len(order)))[order]
    if len(x) < 2 or x[0] == x[-1]:
        raise ValueError(f"{path.name} holds {len(x)} points at one x: a comparison needs at least two")
    if np.any(y != 0.0) and not WITH_DEPTH.intersection(found):
        surface = y == 0.0
        if np.count_nonzero(surface) < 2:
            raise ValueError(f"{path.name} has no points on the surface, y = 0: {' and '.join(found)} are compared there")
        return Mesh(path.name, x[surface], y[surface], {name: columns[name][order][surface] for name in found})
    return Mesh(path.name, x, y, {name: columns[name][order] for name in found})


def compare(solution: Solution, mesh: Mesh, tol: float) -> Comparison:
    """Every quantity of the mesh against the exact one. Raises ValueError where the points miss the contact."""
    x1, x2 = solution.edges
    if np.count_nonzero((mesh.x > x1) & (mesh.x < x2)) < 2:
        raise ValueError(
            f"fewer than two points of {mesh.name} are in the contact [{x1:.6g}, {x2:.6g}], "
            f"x runs from {mesh.x[0]:.6g} to {mesh.x[-1]:.6g}: are the units of length, or the origins, the same?"
        )
    return Comparison(mesh, tol, {name: _difference(name, solution, mesh) for name in mesh.values})


def _difference(name: str, solution: Solution, mesh: Mesh) -> Difference:
    def exact_at(shift: float) -> Array:
        return QUANTITIES[name](solution, mesh.x - shift, mesh.y)

    exact = exact_at(0.0)
    finite = np.isfinite(exact)
    x, f, e = mesh.x[finite], exact[finite], (mesh.values[name] - exact)[finite]
    weight = _weights(x)
    measure = np.where(f.any(), f, solution.pressure(x))  # a traction that ought to be zero is measured by the pressure
    whole = RESULTANTS[name](solution) if name in RESULTANTS else 0.0
    shift = _best_shift(exact_at, mesh.values[name], mesh.x, solution.half_width)
    l2 = float(np.sqrt(weight @ e**2 / (weight @ measure**2)))
    return Difference(
        points=len(x),
        infinite=int(np.count_nonzero(~finite)),
        l1=float(weight @ np.abs(e) / (weight @ np.abs(measure))),
        l2=l2,
        largest=float(np.abs(e).max() / np.abs(measure).max()),
        at=float(x[np.abs(e).argmax()]),
        resultant=float(_weights(mesh.x) @ mesh.values[name]) / whole - 1.0 if whole else None,
        shift=shift,
        l2_shifted=_misfit(exact_at(shift), mesh.values[name], mesh.x) if shift else l2,
    )


def _misfit(exact: Array, values: Array, x: Array) -> float:
    finite = np.isfinite(exact)
    weight = _weights(x[finite])
    f = exact[finite]
    below = float(weight @ f**2)
    return float(np.sqrt(weight @ (values[finite] - f) ** 2 / below)) if below > 0.0 else float("inf")


def _best_shift(exact_at: Callable[[float], Array], values: Array, x: Array, r: float) -> float:
    from scipy.optimize import minimize_scalar  # noqa: PLC0415 -- heavy, and for comparisons only

    def misfit(shift: float) -> float:
        return _misfit(exact_at(shift), values, x)

    grid = np.linspace(-FARTHEST_SHIFT * r, FARTHEST_SHIFT * r, SHIFTS)
    best = int(np.argmin([misfit(d) for d in grid.tolist()]))
    around = float(grid[max(best - 1, 0)]), float(grid[min(best + 1, SHIFTS - 1)])
    found = float(minimize_scalar(misfit, bounds=around, method="bounded", options={"xatol": REFINED * r}).x)
    return found if np.isfinite(misfit(0.0)) and misfit(found) < misfit(0.0) else 0.0


def _weights(x: Array) -> Array:
    """Of the trapezoidal rule."""
    step = np.diff(x)
    return 0.5 * (np.append(step, 0.0) + np.append(0.0, step))
