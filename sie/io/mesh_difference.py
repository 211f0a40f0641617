"""The difference of one quantity of a mesh from the exact one: norms, and what fits best.

With e = f_mesh - f at the points of the file, and integrals over x as sums with the lengths that
belong to nodes or element faces (over points scattered in the body, with equal weights)

    l1 = ∫|e| / ∫|f|,      l2 = (∫e² / ∫f²)^(1/2),      largest = max|e| / max|f|
    resultant = ∫f_mesh over that of f on the whole contact, less 1

Four things are found that are no lack of accuracy of the mesh. Each is given with the l2 that is
left without it, and `l2_fitted` is left without all of them:

    shift     the d for which f(x - d) is nearest to f_mesh in l2: another origin of the mesh, or
              a contact that creeps
    factor    the c for which c f is nearest to f_mesh in l2; told where it shows other units or
              signs
    uniform   of σ_xx, and of σ_zz which follows it: the stress s for which f + s is nearest, as of
              side guides, of the size of the block, or a bulk stress that the scene lacks

Points where f is infinite (sharp edges, corners) are left out and counted.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.io.mesh_result import Mesh

if TYPE_CHECKING:
    from sie.solution import Solution

Array = NDArray[np.float64]

Exact = Callable[[Any, Array, Array], Array]  # of a solution at x, y

# The exact values of what can be compared, at points (x, depth).
EXACT: dict[str, Exact] = {
    "p": lambda solution, x, y: solution.pressure(x),
    "q": lambda solution, x, y: solution.shear(x),
    "sxx": lambda solution, x, y: solution.stress(x, y).xx,
    "syy": lambda solution, x, y: solution.stress(x, y).yy,
    "sxy": lambda solution, x, y: solution.stress(x, y).xy,
    "szz": lambda solution, x, y: solution.stress(x, y).zz,
    "mises": lambda solution, x, y: solution.stress(x, y).mises,
}
RESULTANTS: dict[str, Callable[[Solution], float]] = {
    "p": lambda s: s.normal_load,
    "q": lambda s: s.tangential_load,
}
# A stress along the surface that does not change p and q is an answer of the block, not of contact.
WITH_UNIFORM = ("sxx", "szz")
FARTHEST_SHIFT = 0.5  # half-widths
SHIFTS = 41  # in the first scan
CLOSER, REFINED = 1e-6, 1e-12  # half-widths
MOST_FITTED = 2000  # points that a shift is fitted to: more do not change it
# Between these factors a mesh is inaccurate; beyond them its units or signs differ.
FACTORS = (0.5, 2.0)
# What the unit of the mesh is beside that of the scene, by the factor.
UNITS = {
    1e6: "Pa beside MPa",
    1e-6: "MPa beside Pa",
    1e3: "MPa beside GPa",
    1e-3: "GPa beside MPa",
    1e9: "Pa beside GPa",
    1e-9: "GPa beside Pa",
    145.0377: "psi beside MPa",
    1.0 / 145.0377: "MPa beside psi",
    0.1450377: "ksi beside MPa",
    1.0 / 0.1450377: "MPa beside ksi",
}
SAME_UNIT = 0.2
STRESS_PEAKS = ("sxx_max", "mises_max")  # the last is the peak stress: σ_xx has a spike


@dataclass(frozen=True)
class Difference:
    """The relative difference of a mesh result from the exact one.

    It is largest at the position `at` (x) and `depth` (y); `infinite` points were left out.
    `uniform` is None where none is looked for.
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
    uniform: float | None
    l2_uniform: float | None
    l2_fitted: float

    @property
    def suspicion(self) -> str:
        """The cause of a factor far from 1, if it explains over half of the difference."""
        if FACTORS[0] <= self.factor <= FACTORS[1] or self.l2_scaled >= abs(self.factor):
            return ""
        if -FACTORS[1] <= self.factor <= -FACTORS[0]:
            return "are the signs the same?"
        near = [u for f, u in UNITS.items() if abs(abs(self.factor) / f - 1.0) < SAME_UNIT]
        unit = f", as {near[0]}" if near else ""
        sign = ", and are the signs?" if self.factor < 0.0 else "?"
        return f"are the units of load and length the same{unit}{sign}"

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
        if self.uniform is not None:
            lines.append(f"  stress {self.uniform:+.6g} all over {best} {self.l2_uniform:.3e}")
        if self.suspicion:
            text = f"{self.factor:+.6g} {best} {self.l2_scaled:.3e}: {self.suspicion}"
            lines.append(f"  factor {text}")
        fits = (self.shift != 0.0, self.uniform is not None, bool(self.suspicion))
        if sum(fits) > 1:
            lines.append(f"  all of these together leave l2 = {self.l2_fitted:.3e}")
        return lines


class Peak(NamedTuple):
    """The largest value of a quantity, exact and in the mesh."""

    name: str
    exact: float
    mesh: float

    @property
    def error(self) -> float:
        """The relative error."""
        return self.mesh / self.exact - 1.0


@dataclass(frozen=True)
class Comparison:
    """All quantities of a file against a tolerance of l2."""

    mesh: Mesh
    tol: float
    differences: dict[str, Difference]
    peaks: tuple[Peak, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether the l2 error of every quantity is within the tolerance."""
        return not self.exceeding

    @property
    def exceeding(self) -> tuple[str, ...]:
        """The quantities whose l2 error is not within the tolerance."""
        return tuple(name for name, d in self.differences.items() if not d.l2 <= self.tol)

    def as_dict(self) -> dict[str, Any]:
        """All differences, as JSON can hold them."""
        return {
            "file": self.mesh.name,
            "tol": self.tol,
            "ok": self.ok,
            "differences": {name: asdict(d) for name, d in self.differences.items()},
            "peaks": [peak._asdict() | {"error": peak.error} for peak in self.peaks],
            "not_compared": list(self.mesh.others),
            "notes": list(self.mesh.notes),
        }

    def __str__(self) -> str:
        lines: list[str] = []
        for name, found in self.differences.items():
            lines += found.lines(name, self.mesh.name)
        lines += [
            f"{peak.name}: {peak.mesh:.6g}, exactly {peak.exact:.6g}, {peak.error:+.1%}"
            for peak in self.peaks
        ]
        lines += [f"note: {note}" for note in self.mesh.notes]
        if self.mesh.others:
            lines.append(
                f"not compared: the columns {', '.join(self.mesh.others)} of {self.mesh.name}"
            )
        within = ", ".join(name for name in self.differences if name not in self.exceeding)
        verdict = f"l2 of {', '.join(self.exceeding)} EXCEEDS {self.tol:g}"
        if self.ok:
            verdict = f"l2 is within {self.tol:g}"
        elif within:
            verdict += f"; that of {within} is within it"
        return "\n".join([*lines, *self._score(), verdict])

    def _score(self) -> list[str]:
        """A line that says how good the mesh is."""
        parts = [
            f"{name} to {d.l2:.1%}" for name, d in self.differences.items() if name in "pq" and d.l2
        ]
        stress = [abs(peak.error) for peak in self.peaks if peak.name in STRESS_PEAKS]
        parts += [f"peak stress to {stress[-1]:.1%}"] if stress else []
        return [f"this mesh: {', '.join(parts)}"] if parts else []


def difference(name: str, solution: Solution, mesh: Mesh, guess: float = 0.0) -> Difference:
    """The difference of the quantity; its shift is looked for near 0 and near `guess`."""
    x, y, values = mesh.points(name)
    weight = mesh.weights(name)
    exact = EXACT[name](solution, x, y)
    finite = np.isfinite(exact)
    v, f, e, w = values[finite], exact[finite], (values - exact)[finite], weight[finite]
    # A quantity that is zero everywhere is measured by the pressure.
    measure = f if f.any() else solution.pressure(x[finite])
    scale = 1.0 / max(float(np.sqrt(w @ measure**2)), np.finfo(float).tiny)

    def norm(error: Array) -> float:
        return scale * float(np.sqrt(w @ error**2))

    whole = RESULTANTS[name](solution) if name in RESULTANTS else 0.0

    def exact_at(d: float, k: slice) -> Array:
        return EXACT[name](solution, x[k] - d, y[k])

    shift = _best_shift(exact_at, (values, weight), solution.half_width, guess)
    moved = exact_at(shift, slice(None)) if shift else exact
    factor = float(w @ (f * v) / (w @ f**2)) if f.any() else 1.0
    uniform = float(w @ e / w.sum()) if name in WITH_UNIFORM else None
    return Difference(
        **_counted(finite, (x, y), e),
        l1=float(w @ np.abs(e) / (w @ np.abs(measure))),
        l2=norm(e),
        largest=float(np.abs(e).max() / np.abs(measure).max()),
        resultant=float(weight @ values) / whole - 1.0 if whole else None,
        shift=shift,
        l2_shifted=_misfit(moved, values, weight) if shift else norm(e),
        factor=factor,
        l2_scaled=norm(v - factor * f),
        uniform=uniform,
        l2_uniform=None if uniform is None else norm(e - uniform),
        # The shift is that of a mesh with the right sign and unit: else 0 may be nearer.
        l2_fitted=scale
        * min(_fitted(f, values, weight, uniform is not None) for f in (moved, exact)),
    )


def _counted(finite: NDArray[np.bool_], places: tuple[Array, Array], e: Array) -> dict[str, Any]:
    """How many points there are, and where the error is largest."""
    worst = np.flatnonzero(finite)[np.abs(e).argmax()]
    return {
        "points": int(np.count_nonzero(finite)),
        "infinite": int(np.count_nonzero(~finite)),
        "at": float(places[0][worst]),
        "depth": float(places[1][worst]),
    }


def _fitted(exact: Array, values: Array, weight: Array, uniform: bool) -> float:
    """The norm that is left without the best factor and, if asked for, the best uniform stress."""
    finite = np.isfinite(exact)
    root = np.sqrt(weight[finite])
    shapes = [exact[finite], np.ones(int(finite.sum()))] if uniform else [exact[finite]]
    matrix = np.stack([root * shape for shape in shapes], axis=1)
    size = np.linalg.norm(matrix, axis=0)
    matrix /= np.where(size > 0.0, size, 1.0)
    right = root * values[finite]
    best = np.linalg.lstsq(matrix, right, rcond=None)[0]
    return float(np.linalg.norm(right - matrix @ best))


def _misfit(exact: Array, values: Array, weight: Array) -> float:
    finite = np.isfinite(exact)
    f, w = exact[finite], weight[finite]
    below = float(w @ f**2)
    return float(np.sqrt(w @ (values[finite] - f) ** 2 / below)) if below > 0.0 else float("inf")


def _best_shift(
    exact_at: Callable[[float, slice], Array], mesh: tuple[Array, Array], r: float, guess: float
) -> float:
    """The shift that fits best, 0 if none fits better than 0."""
    from scipy.optimize import minimize_scalar  # noqa: PLC0415 -- heavy, and for comparisons only

    some = slice(None, None, -(-len(mesh[0]) // MOST_FITTED))
    values, weight = mesh[0][some], mesh[1][some]

    def misfit(shift: float) -> float:
        return _misfit(exact_at(shift, some), values, weight)

    near = np.linspace(-FARTHEST_SHIFT * r, FARTHEST_SHIFT * r, SHIFTS)
    grid = near if abs(guess) <= FARTHEST_SHIFT * r else np.concatenate((near, guess + near))
    step = float(near[1] - near[0])
    shift = float(grid[int(np.argmin([misfit(d) for d in grid.tolist()]))])
    # SciPy stops at 1e-8 of the variable: the second time, that is the distance from the first.
    for reach in (step, CLOSER * r):
        centre = shift
        found = minimize_scalar(
            lambda d, c=centre: misfit(c + d),
            bounds=(-reach, reach),
            method="bounded",
            options={"xatol": REFINED * r},
        )
        shift = centre + float(found.x)
    return shift if np.isfinite(misfit(0.0)) and misfit(shift) < misfit(0.0) else 0.0
