"""What certificates have in common, and what is measured on an answer of several patches."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, replace
from html import escape
from typing import Any

import numpy as np

LEAST = 8.0 * float(np.finfo(float).eps)  # rounding of single values, which integrals average out
WIDE = 79  # columns of a terminal
CLOSE = 1e4  # condition from which a patch is about to appear, or two to merge


class Measured:
    """Measures as data; a certificate adds `error` and `ok`."""

    def as_dict(self) -> dict[str, Any]:
        """The certificate as numbers, lists and strings by name, for JSON.

        The shear is left out where there is none.
        """
        values = {f.name: getattr(self, f.name) for f in fields(self)}  # type: ignore[arg-type]
        found = {name: _plain(value) for name, value in values.items() if value is not None}
        return found | {name: getattr(self, name) for name in ("error", "ok")}

    def __bool__(self) -> bool:
        """Whether it is `ok`, so that `assert solution.check()` means what it says."""
        return bool(self.ok)  # type: ignore[attr-defined]

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_plain(v) for v in value]
    return value.as_dict() if isinstance(value, Measured) else value


def table(rows: Iterable[tuple[str, str]]) -> list[str]:
    """Measures with their values, one a line."""
    return [f"{name:<48} {value:>9}".rstrip() for name, value in rows]


@dataclass(frozen=True)
class PatchCertificate(Measured):
    """The measured errors, relative to the peak pressure, to P and to P r.

    residual          of the integral equation
    force, moment     of equilibrium
    gap               of the gap, relative to the largest one
    lowest_pressure   the lowest bound of p over its root, relative to the largest, 0 if positive
    patches           how many there are
    condition         relative change of the narrowest patch or gap per relative change of the load;
                      in full contact that of the lowest pressure
    measured_to       what the rounding of the edges to doubles changes in them
    tol               what was asked for
    tension, overlap  intervals where p < 0 in contact, gap < 0 beside it: () if verified by bounds
    notes             sentences
    shear             the certificate of the shear traction
    resolution        the difference between a function and its resolution, as a pressure
    lowest_gap        the lowest gap over the largest one beside it, 0 if none is negative
    """

    residual: float
    force: float
    moment: float
    lowest_pressure: float
    patches: int
    condition: float
    measured_to: float
    tol: float
    tension: tuple[tuple[float, float], ...] = ()
    overlap: tuple[tuple[float, float], ...] = ()
    notes: tuple[str, ...] = ()
    shear: Any = None
    gap: float = 0.0
    resolution: float = 0.0
    lowest_gap: float = 0.0

    @property
    def error(self) -> float:
        """The estimated relative error of the pressure and of the gap."""
        return max(LEAST, self.residual, self.force, self.moment, self.gap, self.resolution)

    @property
    def ok(self) -> bool:
        holds = self.error <= self.allowed and not self.tension and not self.overlap
        return bool(holds and (self.shear is None or self.shear.ok))

    @property
    def allowed(self) -> float:
        """What the error may be: the tolerance, or what rounding of the edges changes."""
        return max(self.tol, self.measured_to)

    def __str__(self) -> str:
        """The verdict first, then what it means, then its parts."""
        verdict = f"{'' if self.ok else 'NOT '}certified to {self.allowed:.0e}"
        rows = [
            ("patches of contact", f"{self.patches}"),
            ("estimated relative error of the pressure", f"{self.error:.1e}"),
            ("integral equation (1), residual / peak", f"{self.residual:.1e}"),
            ("equilibrium of forces, |∫p - P| / P", f"{self.force:.1e}"),
            ("equilibrium of moments, |∫px - M| / (P r)", f"{self.moment:.1e}"),
            ("gap, by a sum of its own / largest gap", f"{self.gap:.1e}"),
            ("lowest bound of p / root, over the largest", f"{self.lowest_pressure:+.1e}"),
            ("lowest gap outside / the largest beside it", f"{self.lowest_gap:+.1e}"),
            ("a function's difference from its resolution / peak", f"{self.resolution:.1e}"),
            ("narrowest patch or gap, per change of the load", f"{self.condition:.1e}"),
        ]
        rows += [] if self.shear is None else self.shear.rows
        remarks = [] if self.shear is None else self.shear.remarks
        promise = (
            "The pressure is wrong by about that part of its peak. p >= 0 in contact and gap >= 0 "
            "beside it hold by bounds, panel by panel."
        )
        told = textwrap.wrap(promise, WIDE) if self.ok else []
        return "\n".join([verdict, *told, "", *table(rows), *remarks, *self.notes])


def worst_of(found: Sequence[PatchCertificate]) -> PatchCertificate:
    """The first certificate, that of the pressure, with the worst numbers of all.

    What a shear is made of counts as well.
    """
    most = ("residual", "force", "moment", "gap", "condition", "measured_to", "resolution")
    worst: dict[str, Any] = {name: max(getattr(c, name) for c in found) for name in most}
    for name in ("lowest_pressure", "lowest_gap"):
        worst[name] = min(getattr(c, name) for c in found)
    for name in ("tension", "overlap"):
        worst[name] = tuple(interval for c in found for interval in getattr(c, name))
    return replace(found[0], **worst)
