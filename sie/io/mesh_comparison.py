"""A mesh result beside the exact answer: error norms, and the shift in x that fits best.

With e = f_mesh - f at the points of the file, and integrals over x by the trapezoidal rule on them
(over points scattered in the body, sums with equal weights)

    l1 = ∫|e| / ∫|f|,      l2 = (∫e² / ∫f²)^(1/2),      largest = max|e| / max|f|
    resultant = ∫f_mesh over that of f on the whole contact, less 1
    shift     the d for which f(x - d) is nearest to f_mesh in l2: another origin of the mesh, or
              a contact that creeps
    factor    the c for which c f is nearest to f_mesh in l2; given where it shows other units or
              signs, and not a lack of accuracy

A comparison passes if l2 <= tol for every quantity. Points where f is infinite (sharp edges,
corners) are left out and counted.

Tractions p and q are compared on the surface, y = 0; stresses wherever the file has points. Depth
is y >= 0, as everywhere here. In a file whose y points out of the body (none is positive) depth is
-y, and σ_xy has the other sign.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.messages import nearest
from sie.profiles.trace_files import MESH, Table, read_table
from sie.solution import Solution

Array = NDArray[np.float64]

Exact = Callable[[Solution, Array, Array], Array]

# The columns of a file that can be compared: their names, and the exact values at points (x,
# depth).
TRACTIONS: dict[str, Exact] = {
    "p": lambda solution, x, y: solution.pressure(x),
    "q": lambda solution, x, y: solution.shear(x),
}
STRESSES: dict[str, Exact] = {
    "sxx": lambda solution, x, y: solution.stress(x, y).xx,
    "syy": lambda solution, x, y: solution.stress(x, y).yy,
    "sxy": lambda solution, x, y: solution.stress(x, y).xy,
    "szz": lambda solution, x, y: solution.stress(x, y).zz,
    "mises": lambda solution, x, y: solution.stress(x, y).mises,
}
QUANTITIES = TRACTIONS | STRESSES
RESULTANTS: dict[str, Callable[[Solution], float]] = {
    "p": lambda s: s.normal_load,
    "q": lambda s: s.tangential_load,
}
# Their names in mesh codes, in lower case.
NAMES = {
    **{
        name.format(axis): axis
        for axis in "xy"
        for name in ("{}-coordinate", "{}_coordinate", "{}-coord", "{}_coord", "coord_{}")
    },
    **dict(zip(("coor1", "coord1", "coor2", "coord2", "depth"), "xxyyy", strict=True)),
    **dict.fromkeys(("pressure", "cpress", "contact pressure", "contact_pressure"), "p"),
    **dict.fromkeys(("shear", "cshear1", "traction"), "q"),
    **{
        name: q
        for q, ij in zip(STRESSES, ("11", "22", "12", "33"), strict=False)
        for name in (f"s{ij}", f"s-s{ij}", f"s:s{ij}", f"s.s{ij}")
    },
    **{
        f"{word}{q[1:]}": q
        for q in ("sxx", "syy", "sxy", "szz")
        for word in ("sigma_", "sigma", "stress_", "s_", "σ_", "σ")
    },
    **{"tau_xy": "sxy", "txy": "sxy", "τ_xy": "sxy"},
    **dict.fromkeys(
        ("von mises", "von_mises", "s_mises", "s-mises", "s.mises", "seqv", "sigma_mises"), "mises"
    ),
}
FARTHEST_SHIFT = 0.5  # half-widths
SHIFTS = 41  # in the first scan
REFINED = 1e-9  # half-widths
LARGEST = 1e100  # of a column: no length or stress, and its square is finite
# Between these factors a mesh is inaccurate; beyond them its units or signs differ.
FACTORS = (0.5, 2.0)


@dataclass(frozen=True)
class Mesh:
    """The columns of a file, by ascending x: x, depth y (0 on the surface) and its quantities.

    `others` are the columns that were passed over, by name, or by number where there is no header.
    """

    name: str
    x: Array
    y: Array
    values: dict[str, Array]
    others: tuple[str, ...] = ()

    def points(self, quantity: str) -> tuple[Array, Array, Array]:
        """(x, y, values) where the quantity is compared: all points, or those on the surface."""
        chosen = (self.y == 0.0) if quantity in TRACTIONS else np.ones(len(self.x), dtype=bool)
        return self.x[chosen], self.y[chosen], self.values[quantity][chosen]

    def scattered(self, quantity: str) -> bool:
        """Whether these points are not on a line at one depth."""
        x, y, _ = self.points(quantity)
        return bool(np.ptp(y) > 0.0 or np.ptp(x) == 0.0)


@dataclass(frozen=True)
class Difference:
    """The relative difference of a mesh result from the exact one.

    It is largest at the position `at` (x) and `depth` (y); `infinite` points were left out.
    """

    points: int
    infinite: int
    l1: float
    l2: float
    largest: float
    at: float
    depth: float
    resultant: float | None
    shift: float
    l2_shifted: float
    factor: float
    l2_scaled: float

    @property
    def suspicion(self) -> str:
        """The cause of a factor far from 1, if it explains over half of the difference."""
        if FACTORS[0] <= self.factor <= FACTORS[1] or self.l2_scaled > abs(self.factor):
            return ""
        return (
            "are the signs the same?"
            if -FACTORS[1] <= self.factor <= -FACTORS[0]
            else "are the units of load and length the same?"
        )

    def lines(self, name: str, file: str) -> list[str]:
        """The difference of the quantity `name` as lines of a report."""
        left_out = f" ({self.infinite} left out, where {name} is infinite)" if self.infinite else ""
        depth = f", y = {self.depth:.6g}" if self.depth else ""
        lines = [
            f"{name}: {self.points} points of {file}{left_out}",
            f"  l1     {self.l1:.3e}",
            f"  l2     {self.l2:.3e}",
            f"  max    {self.largest:.3e} of the largest, at x = {self.at:.6g}{depth}",
        ]
        if self.resultant is not None:
            lines.append(f"  load   {self.resultant:+.3e}")
        best = "fits best, and leaves l2 ="
        lines.append(f"  shift  {self.shift:+.6g} {best} {self.l2_shifted:.3e}")
        if self.suspicion:
            text = f"{self.factor:+.6g} {best} {self.l2_scaled:.3e}: {self.suspicion}"
            lines.append(f"  factor {text}")
        return lines


@dataclass(frozen=True)
class Comparison:
    """All quantities of a file against a tolerance of l2."""

    mesh: Mesh
    tol: float
    differences: dict[str, Difference]

    @property
    def ok(self) -> bool:
        """Whether the l2 error of every quantity is within the tolerance."""
        return all(d.l2 <= self.tol for d in self.differences.values())

    def as_dict(self) -> dict[str, Any]:
        """All differences, as JSON can hold them."""
        return {
            "file": self.mesh.name,
            "tol": self.tol,
            "ok": self.ok,
            "differences": {name: asdict(d) for name, d in self.differences.items()},
            "not_compared": list(self.mesh.others),
        }

    def __str__(self) -> str:
        lines: list[str] = []
        for name, difference in self.differences.items():
            lines += difference.lines(name, self.mesh.name)
        if self.mesh.others:
            lines.append(
                f"not compared: the columns {', '.join(self.mesh.others)} of {self.mesh.name}"
            )
        verdict = f"l2 {'is within' if self.ok else 'EXCEEDS'} {self.tol:g}"
        return "\n".join([*lines, verdict])


def read_mesh(path: str | Path) -> Mesh:
    """The columns x, y and those of QUANTITIES that the header names; x and p without a header."""
    table = read_table(path, MESH)
    names = [NAMES.get(name, name) for name in table.header] or ["x", "p"]
    names += map(str, range(len(names), table.width))  # of columns without a name
    columns = _columns(table, names)
    y = _depths(table.file, columns)
    order = np.lexsort((y, columns["x"]))
    values = {name: columns[name][order] for name in columns if name in QUANTITIES}
    others = tuple(name for name in names if name and name not in columns)
    mesh = Mesh(table.file, columns["x"][order], y[order], values, others)
    for name in values:
        x, _, _ = mesh.points(name)
        if len(x) < 2 or (name in TRACTIONS and x[0] == x[-1]):
            where = " on the surface, y = 0, where it is compared" if name in TRACTIONS else ""
            raise ValueError(
                f"{table.file} holds {len(x)} points of {name}{where}: "
                "a comparison needs at least two"
            )
    return mesh


def _columns(table: Table, names: list[str]) -> dict[str, Array]:
    """The columns that can be compared, by name. ValueError unless there are x and a quantity."""
    known = [name for name in names if name in ("x", "y", *QUANTITIES)]
    if "x" not in known or not any(name in QUANTITIES for name in known):
        words = [word for word in ("x", *QUANTITIES, *NAMES) if NAMES.get(word, word) not in known]
        near = next((name for name in table.header if nearest(name, words)), "")
        hint = f' (is "{near}" meant as "{nearest(near, words)}"?)' if near else ""
        raise ValueError(
            f"{table.file} has the columns {', '.join(table.header)}{hint}: "
            f"name one x and one {' or '.join(QUANTITIES)}, on the first line"
        )
    columns = dict(zip(known, table.columns(tuple(map(names.index, known))), strict=True))
    for name, values in columns.items():
        largest = float(np.abs(values).max())
        if largest > LARGEST:
            raise ValueError(
                f"{table.file} has {name} up to {largest:g}, as what is missing may be marked: "
                "delete such lines"
            )
    return columns


def _depths(name: str, columns: dict[str, Array]) -> Array:
    """y >= 0; a file whose y points the other way is turned over, and σ_xy in it."""
    y = columns.get("y")
    if y is None:
        return np.zeros(len(columns["x"]))
    if y.min() < 0.0 < y.max():
        raise ValueError(
            f"{name} has y from {y.min():.6g} to {y.max():.6g}: "
            "the body is on one side of y = 0, leave the other out"
        )
    if y.min() < 0.0 and "sxy" in columns:
        columns["sxy"] = -columns["sxy"]
    return np.abs(y)


def compare(solution: Solution, mesh: Mesh, tol: float) -> Comparison:
    """Every quantity of the mesh against the exact one. ValueError if no point is in contact."""
    x1, x2 = solution.edges
    if np.count_nonzero((mesh.x > x1) & (mesh.x < x2)) < 2:
        raise ValueError(
            f"fewer than two points of {mesh.name} are in the contact [{x1:.6g}, {x2:.6g}], "
            f"x runs from {mesh.x[0]:.6g} to {mesh.x[-1]:.6g}: "
            "are the units of length, or the origins, the same?"
        )
    return Comparison(mesh, tol, {name: _difference(name, solution, mesh) for name in mesh.values})


def _difference(name: str, solution: Solution, mesh: Mesh) -> Difference:
    x, y, values = mesh.points(name)
    weight = np.ones_like(x) if mesh.scattered(name) else _weights(x)

    def exact_at(shift: float) -> Array:
        return QUANTITIES[name](solution, x - shift, y)

    exact = exact_at(0.0)
    finite = np.isfinite(exact)
    f, e, w = exact[finite], (values - exact)[finite], weight[finite]
    # A quantity that is zero everywhere is measured by the pressure.
    measure = f if f.any() else solution.pressure(x[finite])
    whole = RESULTANTS[name](solution) if name in RESULTANTS else 0.0
    shift = _best_shift(exact_at, values, weight, solution.half_width)
    below = w @ measure**2
    l2 = float(np.sqrt(w @ e**2 / below))
    factor = float(w @ (f * values[finite]) / (w @ f**2)) if f.any() else 1.0
    worst = np.abs(e).argmax()
    return Difference(
        points=len(f),
        infinite=int(np.count_nonzero(~finite)),
        l1=float(w @ np.abs(e) / (w @ np.abs(measure))),
        l2=l2,
        largest=float(np.abs(e).max() / np.abs(measure).max()),
        at=float(x[finite][worst]),
        depth=float(y[finite][worst]),
        resultant=float(weight @ values) / whole - 1.0 if whole else None,
        shift=shift,
        l2_shifted=_misfit(exact_at(shift), values, weight) if shift else l2,
        factor=factor,
        l2_scaled=float(np.sqrt(w @ (values[finite] - factor * f) ** 2 / below)),
    )


def _misfit(exact: Array, values: Array, weight: Array) -> float:
    finite = np.isfinite(exact)
    f, w = exact[finite], weight[finite]
    below = float(w @ f**2)
    return float(np.sqrt(w @ (values[finite] - f) ** 2 / below)) if below > 0.0 else float("inf")


def _best_shift(
    exact_at: Callable[[float], Array], values: Array, weight: Array, r: float
) -> float:
    from scipy.optimize import minimize_scalar  # noqa: PLC0415 -- heavy, and for comparisons only

    def misfit(shift: float) -> float:
        return _misfit(exact_at(shift), values, weight)

    grid = np.linspace(-FARTHEST_SHIFT * r, FARTHEST_SHIFT * r, SHIFTS)
    best = int(np.argmin([misfit(d) for d in grid.tolist()]))
    around = float(grid[max(best - 1, 0)]), float(grid[min(best + 1, SHIFTS - 1)])
    options = {"xatol": REFINED * r}
    shift = float(minimize_scalar(misfit, bounds=around, method="bounded", options=options).x)
    return shift if np.isfinite(misfit(0.0)) and misfit(shift) < misfit(0.0) else 0.0


def _weights(x: Array) -> Array:
    """Weights of the trapezoidal rule."""
    step = np.diff(x)
    return 0.5 * (np.append(step, 0.0) + np.append(0.0, step))
