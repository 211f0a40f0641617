"""A mesh result beside the exact answer, all quantities of a file.

A comparison passes if l2 <= tol for every quantity (`sie.io.mesh_difference`). Before that

    half a model      of a symmetric contact without a tangential load is mirrored
    the sign of q     is found: it is that of one of the two bodies, and of the direction in which
                      a code walks along its surface
    stresses          are compared near the contact: farther away a block is no half-plane

and each of these is noted.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.io.mesh_difference import EXACT, Comparison, difference
from sie.io.mesh_files.names import STRESSES, TRACTIONS
from sie.io.mesh_result import Mesh, Points, joined
from sie.io.targets import peaks

if TYPE_CHECKING:
    from sie.solution import Solution

Array = NDArray[np.float64]

NEAR = 4.0  # half-widths beside the contact and in depth, within which stresses are compared
ODD = ("q", "sxy")  # change their sign in a mirror
SAME = 1e-6  # half-widths
FARTHEST_FIRST = 0.25  # half-widths from the centre to the first point of half a model
LOADED, WITHIN = 0.05, 1.25  # parts of the largest traction and of the half-width
LEAST_COVERED = 0.02  # of the contact: a mesh that covers less has another unit of length
POWERS = (1e3, 1e-3, 1e6, 1e-6, 25.4, 1.0 / 25.4)


def compare(solution: Solution, mesh: Mesh, tol: float) -> Comparison:
    """Every quantity of the mesh against the exact one. ValueError if no point is in contact."""
    _refuse_elsewhere(solution, mesh)
    for step in (_known, _near_contact, _mirrored, _with_sign_of_shear):
        mesh = step(solution, mesh)
    guess = _offset(solution, mesh)
    differences = {name: difference(name, solution, mesh, guess) for name in mesh.fields}
    return Comparison(mesh, tol, differences, peaks(solution, mesh))


def _refuse_elsewhere(solution: Solution, mesh: Mesh) -> None:
    x1, x2 = solution.edges
    x = np.concatenate([field.x for field in mesh.fields.values()])

    def inside(scale: float) -> int:
        return int(np.count_nonzero((scale * x > x1) & (scale * x < x2)))

    tiny = 0.0 < np.ptp(x) < LEAST_COVERED * (x2 - x1)
    if inside(1.0) >= 2 and not tiny:
        return
    far = (s for s in POWERS if inside(s) >= 2 and 0.5 < np.ptp(x) * s / (x2 - x1) < 2.0 * NEAR)
    scale = next(far, 0.0)
    what = "all" if inside(1.0) >= 2 else "fewer than two"
    hint = f" (x times {scale:g} would lie there)" if scale else ""
    raise ValueError(
        f"{what} points of {mesh.name} are in the contact [{x1:.6g}, {x2:.6g}], "
        f"x runs from {x.min():.6g} to {x.max():.6g}{hint}: "
        "are the units of length, or the origins, the same?"
    )


def _known(solution: Solution, mesh: Mesh) -> Mesh:
    """The mesh without what the scene does not determine. ValueError if nothing remains."""
    fields, notes = dict(mesh.fields), list(mesh.notes)
    for name, (x, y, _, _) in mesh.fields.items():
        try:
            EXACT[name](solution, x[:1], y[:1])
        except ValueError as problem:
            del fields[name]
            if not fields:
                raise
            notes.append(f"{name} is not compared: {problem}")
    return replace(mesh, fields=fields, notes=tuple(notes))


def _near_contact(solution: Solution, mesh: Mesh) -> Mesh:
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


def _mirrored(solution: Solution, mesh: Mesh) -> Mesh:
    """The whole of a symmetric contact, of which the mesh has half."""
    r, centre = solution.half_width, 0.5 * sum(solution.edges)
    traction = next((name for name in TRACTIONS if name in mesh.fields), None)
    if traction is None:
        return mesh
    x, _, values = mesh.points(traction)
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
    x, y, values, widths = field
    sign = -1.0 if name in ODD else 1.0
    image = Points(2.0 * centre - x, y, sign * values, widths)
    return joined([image.chosen(np.abs(x - centre) > SAME * np.ptp(x)), field])


def _with_sign_of_shear(solution: Solution, mesh: Mesh) -> Mesh:
    """The mesh with q turned over where that is nearer to the exact one."""
    if "q" not in mesh.fields:
        return mesh
    x, _, q, _ = field = mesh.fields["q"]
    exact = solution.shear(x)
    finite = np.isfinite(exact)
    if mesh.weights("q")[finite] @ (exact * q)[finite] >= 0.0:
        return mesh
    note = "q has the other sign in the file, as the shear on the other body: it is turned over"
    fields = mesh.fields | {"q": field._replace(values=-q)}
    return replace(mesh, fields=fields, notes=(*mesh.notes, note))


def _offset(solution: Solution, mesh: Mesh) -> float:
    """The centre of the mesh's pressure less that of the exact one, 0 without a pressure."""
    if "p" not in mesh.fields:
        return 0.0
    x, _, p = mesh.points("p")
    weight = np.maximum(p, 0.0) * mesh.weights("p")
    fine = np.linspace(*solution.edges, 203)[1:-1]
    exact = np.nan_to_num(solution.pressure(fine), posinf=0.0)
    if not weight.any() or not exact.any():
        return 0.0
    return float(weight @ x / weight.sum() - exact @ fine / exact.sum())
