"""The quantities that can be asked for, and the work that the solver may skip."""

from __future__ import annotations

from collections.abc import Iterable

from sie import arguments

# What can be asked for in a scene file, on the command line and of `sie.plan`.
WANTS = (
    "edges", "pressure", "gap", "shear", "energy", "check", "stress", "yield", "tension", "cycle",
    "crack",
)  # fmt: skip
# Attributes of the solution, and the quantities that they belong to.
ALSO = {
    "half_width": "edges",
    "centre": "edges",
    "elastic_limit": "yield",
    "peak_tension": "tension",
    "energy_lost": "energy",
}
ALSO |= dict.fromkeys(("stick", "slip", "shift"), "shear")
# The answer where nothing is asked for: the contact. The stress is asked for by name, as it may
# need Poisson's ratio, and the energy if it comes with the shear (`energy_costs`).
UNASKED = ("edges", "pressure", "gap", "shear", "check")
# Points of a table in the contact, and of a grid in the body, where no number is asked for.
POINTS = 401
GRID = (201, 101)
# Quantities that depend on the shear traction.
NEED_SHEAR = frozenset({"shear", "energy", "stress", "yield", "tension", "check", "cycle", "crack"})
# Work that the solver may skip; `sie.solve(..., economy=())` switches all of it off.
ECONOMY = frozenset({"symmetry", "transform", "zero panels", "convexity", "shear", "sliding"})


def wanted(want: str | Iterable[str]) -> tuple[str, ...]:
    """The names among WANTS that are asked for."""
    remedy = f"a name; ask for {', '.join(WANTS)}"
    asked = (want,) if isinstance(want, str) else arguments.listed("want", want, remedy)
    for name in asked:
        if not arguments.among(name, {*WANTS, *ALSO}):
            raise ValueError(f"want = {name!r} is not known: ask for {', '.join(WANTS)}")
    names = tuple(ALSO.get(name, name) for name in asked)
    if not names:
        raise ValueError(f"nothing is wanted: ask for {', '.join(WANTS)}")
    return names
