"""A mesh result beside the exact answer, all quantities of a file.

With e = f_mesh - f at the points of the file, and integrals over x as sums with the lengths that
reach half-way to the next points (over points scattered in the body, with equal weights)

    l1 = ∫|e| / ∫|f|,      l2 = (∫e² / ∫f²)^(1/2),      largest = max|e| / max|f|
    resultant = ∫f_mesh over that of f on the whole contact, less 1

Points where f is infinite (sharp edges, corners) are left out and counted. A comparison passes if
l2 <= tol for every quantity. Before that

    half a model      of a symmetric contact without a tangential load is mirrored
    the sign of q     is found: it is that of one of the two bodies, and of the direction in which
                      a code walks along its surface
    stresses          are compared near the contact: farther away a block is no half-plane

and each of these is noted.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .mesh_files.names import STRESSES, TRACTIONS
from .mesh_result import Mesh, Points, joined
from .sample_points import inside, peak

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
RESULTANTS = {"p": "normal_load", "q": "tangential_load"}
STRESS_PEAKS = ("sxx_max", "mises_max")  # the last is the peak stress: σ_xx has a spike
NEAR = 4.0  # half-widths beside the contact and in depth, within which stresses are compared
ODD = ("q", "sxy")  # change their sign in a mirror
SAME = 1e-6  # half-widths
FARTHEST_FIRST = 0.25  # half-widths from the centre to the first point of half a model
LOADED, WITHIN = 0.05, 1.25  # parts of the largest traction and of the half-width
LEAST_COVERED = 0.02  # of the contact: a mesh that covers less has another unit of length


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
        return lines + ([] if self.resultant is None else [f"  load   {self.resultant:+.3e}"])


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
        mesh, found = self.mesh, self.differences
        lines = [line for name, d in found.items() for line in d.lines(name, mesh.name)]
        lines += [
            f"{peak.name}: {peak.mesh:.6g}, exactly {peak.exact:.6g}, {peak.error:+.1%}"
            for peak in self.peaks
        ]
        lines += [f"note: {note}" for note in mesh.notes]
        if mesh.others:
            lines.append(f"not compared: the columns {', '.join(mesh.others)} of {mesh.name}")
        parts = [f"{name} to {d.l2:.1%}" for name, d in found.items() if name in "pq" and d.l2]
        stress = [abs(peak.error) for peak in self.peaks if peak.name in STRESS_PEAKS]
        parts += [f"peak stress to {stress[-1]:.1%}"] if stress else []
        lines += [f"this mesh: {', '.join(parts)}"] if parts else []
        within = ", ".join(name for name in found if name not in self.exceeding)
        verdict = f"l2 of {', '.join(self.exceeding)} EXCEEDS {self.tol:g}"
        if self.ok:
            verdict = f"l2 is within {self.tol:g}"
        elif within:
            verdict += f"; that of {within} is within it"
        return "\n".join([*lines, verdict])


def compare(solution: Any, mesh: Mesh, tol: float) -> Comparison:
    """Every quantity of the mesh against the exact one. ValueError if no point is in contact."""
    _refuse_elsewhere(solution, mesh)
    for step in (_known, _near_contact, _mirrored, _with_sign_of_shear):
        mesh = step(solution, mesh)
    differences = {name: _difference(name, solution, mesh) for name in mesh.fields}
    return Comparison(mesh, tol, differences, _peaks(solution, mesh))


def _difference(name: str, solution: Any, mesh: Mesh) -> Difference:
    (x, y, values), weight = mesh.fields[name], mesh.weights(name)
    exact = EXACT[name](solution, x, y)
    finite = np.isfinite(exact)
    f, e, w = exact[finite], (values - exact)[finite], weight[finite]
    # A quantity that is zero everywhere is measured by the pressure.
    measure = f if f.any() else solution.pressure(x[finite])
    whole = getattr(solution, RESULTANTS[name]) if name in RESULTANTS else 0.0
    worst = np.flatnonzero(finite)[np.abs(e).argmax()]
    return Difference(
        points=int(np.count_nonzero(finite)),
        infinite=int(np.count_nonzero(~finite)),
        l1=float(w @ np.abs(e) / (w @ np.abs(measure))),
        l2=math.sqrt(w @ e**2) / max(math.sqrt(w @ measure**2), np.finfo(float).tiny),
        largest=float(np.abs(e).max() / np.abs(measure).max()),
        at=float(x[worst]),
        depth=float(y[worst]),
        resultant=float(weight @ values) / whole - 1.0 if whole else None,
    )


def _peaks(solution: Any, mesh: Mesh) -> tuple[Peak, ...]:
    """The peaks of what the mesh has: p, q, σ_xx on its surface, Mises; finite ones."""
    fields = mesh.fields
    rows: list[tuple[str, float, float]] = []
    if "p" in fields:
        rows.append(("p_max", peak(solution)[0], float(fields["p"].values.max())))
    if "q" in fields and solution.carries_shear:
        largest = float(np.abs(fields["q"].values).max())
        rows.append(("q_max", abs(largest_shear(solution)[0]), largest))
    if "sxx" in fields and (on := fields["sxx"].y == 0.0).any():
        largest = float(fields["sxx"].values[on].max())
        rows.append(("sxx_max", solution.peak_tension().value, largest))
    if (mises := _mises(mesh)) and solution.stress(0.0, 0.0).knows_zz:
        rows.append(("mises_max", math.sqrt(3.0) * solution.elastic_limit().stress, mises))
    return tuple(Peak(*row) for row in rows if row[1] > 0.0 and math.isfinite(row[1]))


def largest_shear(solution: Any) -> tuple[float, float]:
    """The shear of the largest size, and its place: among sample points and the ends of stick."""
    x = np.concatenate((inside(solution), *solution.stick[-1:]))
    q = solution.shear(x)
    k = int(np.argmax(np.abs(q)))
    return float(q[k]), float(x[k])


def _mises(mesh: Mesh) -> float:
    """The largest Mises stress of the mesh, from its components if it has no other; 0 without."""
    if "mises" in mesh.fields:
        return float(mesh.fields["mises"].values.max())
    parts = [mesh.fields[name].values for name in STRESSES[:4] if name in mesh.fields]
    if len(parts) < 4 or len({len(values) for values in parts}) > 1:
        return 0.0
    xx, yy, xy, zz = parts
    squares = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * xy**2
    return float(np.sqrt(squares.max()))


# -- what is compared ------------------------------------------------------------------------------


def _refuse_elsewhere(solution: Any, mesh: Mesh) -> None:
    x1, x2 = solution.edges
    x = np.concatenate([field.x for field in mesh.fields.values()])
    count = np.count_nonzero((x > x1) & (x < x2))
    if count >= 2 and not 0.0 < np.ptp(x) < LEAST_COVERED * (x2 - x1):
        return
    what = "all" if count >= 2 else "fewer than two"
    raise ValueError(
        f"{what} points of {mesh.name} are in the contact [{x1:.6g}, {x2:.6g}], "
        f"x runs from {x.min():.6g} to {x.max():.6g}: "
        "are the units of length, or the origins, the same?"
    )


def _known(solution: Any, mesh: Mesh) -> Mesh:
    """The mesh without what the scene does not determine. ValueError if nothing remains."""
    fields, notes = dict(mesh.fields), list(mesh.notes)
    for name, (x, y, _) in mesh.fields.items():
        try:
            EXACT[name](solution, x[:1], y[:1])
        except ValueError as problem:
            del fields[name]
            if not fields:
                raise
            notes.append(f"{name} is not compared: {problem}")
    return replace(mesh, fields=fields, notes=tuple(notes))


def _near_contact(solution: Any, mesh: Mesh) -> Mesh:
    """The mesh with those points of stresses that are near the contact."""
    (x1, x2), reach = solution.edges, NEAR * solution.half_width
    fields, notes = dict(mesh.fields), dict.fromkeys(mesh.notes)
    for name in STRESSES:
        if name not in fields:
            continue
        x, y = fields[name][:2]
        near = (x > x1 - reach) & (x < x2 + reach) & (y < reach)
        if near.all() or np.count_nonzero(near) < 2:
            continue
        fields[name] = fields[name].chosen(near)
        notes[
            f"stress is compared at {near.sum()} of {len(x)} points, those within {NEAR:g} "
            "half-widths of the contact"
        ] = None
    return replace(mesh, fields=fields, notes=tuple(notes))


def _mirrored(solution: Any, mesh: Mesh) -> Mesh:
    """The whole of a symmetric contact, of which the mesh has half."""
    r, centre = solution.half_width, 0.5 * sum(solution.edges)
    traction = next((name for name in TRACTIONS if name in mesh.fields), None)
    if traction is None:
        return mesh
    x, _, values = mesh.fields[traction]
    first, last = x[[0, -1]] - centre
    one_sided = first >= -SAME * r or last <= SAME * r
    loaded = x[np.abs(values) > LOADED * np.abs(values).max()]
    farthest = np.abs(loaded - centre).max(initial=0.0)
    if not one_sided or min(abs(first), abs(last)) > FARTHEST_FIRST * r or farthest > WITHIN * r:
        return mesh
    side = f"x runs from {first + centre:.6g} to {last + centre:.6g}, half of the contact"
    t = r * np.linspace(0.05, 0.95, 10)
    p, opposite = solution.pressure(centre + t), solution.pressure(centre - t)
    if solution.tangential_load or np.abs(p - opposite).max() > SAME * np.abs(p).max():
        why = "has a tangential load" if solution.tangential_load else "is not symmetric"
        note = f"{side}: load is that of this half, as the contact {why}"
        return replace(mesh, notes=(*mesh.notes, note))
    fields = {name: _with_image(name, field, centre) for name, field in mesh.fields.items()}
    return replace(mesh, fields=fields, notes=(*mesh.notes, f"{side}: mirrored"))


def _with_image(name: str, field: Points, centre: float) -> Points:
    """The points and their mirror images; those on the axis once."""
    x, y, values = field
    image = Points(2.0 * centre - x, y, -values if name in ODD else values)
    return joined([image.chosen(np.abs(x - centre) > SAME * np.ptp(x)), field])


def _with_sign_of_shear(solution: Any, mesh: Mesh) -> Mesh:
    """The mesh with q turned over where that is nearer to the exact one."""
    if "q" not in mesh.fields:
        return mesh
    x, _, q = field = mesh.fields["q"]
    exact = solution.shear(x)
    finite = np.isfinite(exact)
    if mesh.weights("q")[finite] @ (exact * q)[finite] >= 0.0:
        return mesh
    note = "q has the other sign in the file, as the shear on the other body: it is turned over"
    fields = mesh.fields | {"q": field._replace(values=-q)}
    return replace(mesh, fields=fields, notes=(*mesh.notes, note))
