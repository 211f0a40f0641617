"""The numbers by which another code is judged: edges, peaks and their places, stick, approach."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .answers import energy_of
from .mesh_difference import Peak
from .mesh_result import Mesh
from .sample_points import inside, peak

if TYPE_CHECKING:
    from sie.solution import Solution

PLACES = (0.0, 0.25, 0.5, 0.75, 0.9)  # of the half-width, from the centre of the last patch
ROUNDING = 1e-12  # half-widths


class Target(NamedTuple):
    """A quantity, its exact value and its unit: length, force, stress, or the product of two."""

    name: str
    value: float
    unit: str


def targets(solution: Solution) -> list[Target]:
    """All that the scene determines; of a symmetric contact the places on x > 0."""
    (lo, hi), (height, places) = solution.patches[-1], peak(solution)
    found = [
        Target("x1, edge of the contact", lo, "length"),
        Target("x2, edge of the contact", hi, "length"),
        Target("P", solution.normal_load, "force"),
        Target("p_max", height, "stress"),
        Target("x of p_max", places[-1], "length"),
    ]
    for place in PLACES:
        x = _place(solution, 0.5 * (lo + hi) + 0.5 * place * (hi - lo))
        found.append(Target(f"p at x = {x!r}", float(solution.pressure(x)), "stress"))
    if solution.carries_shear:
        found += _of_shear(solution)
    found += [*of_stress(solution), _approach(solution)]
    of_length = (t._replace(value=_place(solution, t.value)) for t in found if t.unit == "length")
    return [next(of_length) if t.unit == "length" else t for t in found]


def _place(solution: Solution, x: float) -> float:
    """The place, 0 where it is 0 to rounding."""
    return x if abs(x) > ROUNDING * solution.half_width else 0.0


def _of_shear(solution: Solution) -> list[Target]:
    found = [Target("Q", solution.tangential_load, "force")]
    zone = solution.stick[-1:]
    for lo, hi in zone:
        found += [Target("stick from", lo, "length"), Target("stick to", hi, "length")]
    x = np.concatenate((inside(solution), *zone))
    q = solution.shear(x)
    k = int(np.argmax(np.abs(q)))
    found += [Target("q_max", float(q[k]), "stress"), Target("x of q_max", float(x[k]), "length")]
    return found + [Target("energy lost", v, "force") for v in energy_of(solution).values()]


def of_stress(solution: Solution) -> list[Target]:
    """The largest stresses of the body, and their places."""
    tension, yielding = solution.peak_tension(), solution.elastic_limit()
    x, y = yielding.places[-1]
    return [
        Target("sxx_max on the surface", tension.value, "stress"),
        Target("x of sxx_max", tension.x, "length"),
        Target("mises_max in the body", math.sqrt(3.0) * yielding.stress, "stress"),
        Target("x of mises_max", x, "length"),
        Target("y of mises_max, the depth", y, "length"),
    ]


def _approach(solution: Solution) -> Target:
    found = solution.displacement(solution.centre, 0.0)
    x, y = (_place(solution, v) for v in found.zero)
    return Target(f"approach of (x, ±y) = ({x!r}, {y!r})", found.approach, "length")


def peaks(solution: Solution, mesh: Mesh) -> tuple[Peak, ...]:
    """The peaks of what the mesh has: p, q, σ_xx on its surface, Mises; finite ones."""
    fields = mesh.fields
    rows: list[tuple[str, float, float]] = []
    if "p" in fields:
        rows.append(("p_max", peak(solution)[0], float(fields["p"].values.max())))
    if "q" in fields and solution.carries_shear:
        exact = next(t.value for t in _of_shear(solution) if t.name == "q_max")
        rows.append(("q_max", abs(exact), float(np.abs(fields["q"].values).max())))
    if "sxx" in fields and (on := fields["sxx"].y == 0.0).any():
        largest = float(fields["sxx"].values[on].max())
        rows.append(("sxx_max", solution.peak_tension().value, largest))
    if (mises := _mises(mesh)) and solution.stress(0.0, 0.0).knows_zz:
        rows.append(("mises_max", math.sqrt(3.0) * solution.elastic_limit().stress, mises))
    return tuple(Peak(*row) for row in rows if row[1] > 0.0 and math.isfinite(row[1]))


def _mises(mesh: Mesh) -> float:
    """The largest Mises stress of the mesh, from its components if it has no other; 0 without."""
    if "mises" in mesh.fields:
        return float(mesh.fields["mises"].values.max())
    parts = [mesh.fields.get(name) for name in ("sxx", "syy", "szz", "sxy")]
    sizes = {len(part.x) if part is not None else -1 for part in parts}
    if len(sizes) > 1 or -1 in sizes:
        return 0.0
    xx, yy, zz, xy = (part.values for part in parts if part is not None)
    squares = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * xy**2
    return float(np.sqrt(squares.max()))
