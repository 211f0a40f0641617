"""The certificates of a pressure and of a shear traction: the errors measured on an answer."""

from __future__ import annotations

import math
import textwrap
from dataclasses import dataclass

from sie.patches.result import LEAST, WIDE, Measured, table

Intervals = tuple[tuple[float, float], ...]

PROMISE = (
    "At a distance d from the nearer edge the pressure is wrong by at most 3 (error + edges "
    "sqrt(r/d)) of its peak."
)
BESIDES = (
    "Where p(x) is larger than the peak it is so much of p(x); with a sharp edge read p sqrt(1 - "
    "(x/r)²) for p, x from the centre. Not counted: errors below 1e-15 of the peak, what one ulp "
    "of x changes, and what a function does on less than 5e-4 of the contact."
)
# r over the distances from an edge at which the promise is given in numbers
NEARER = {1.0: "r, half of the width", 1e2: "r/100", 1e4: "r/10000"}
TOLERATED = 1e-11  # of the peak: tension or overlap below it is rounding
NAMED = 3  # intervals that a message names
# what one ulp of x does may add up to this multiple in a principal value next to a corner
EXPLAINED = 16.0
MOST_EXPLAINED = 0.1  # of the peak: where rounding of x can do more than that, nothing is certified
UNRESOLVED = (
    "One ulp of x changes these sums by more than is certified, so that they measure nothing: "
    "doubles of x do not tell the pressure next to an edge; raise the load."
)
RETREAT = "with Q and σ in proportion the zones of slip would retreat on the way here"


@dataclass(frozen=True)
class Certificate(Measured):
    """The measures of accuracy of an answer.

    Numbers are relative: to the peak pressure (residual, inequalities), to P and P r (equilibrium).
    At a distance d from the nearer edge the pressure is wrong by at most 3 (error + edges
    sqrt(r/d)) of its peak. Where p(x) is larger than the peak it is so much of p(x); with a sharp
    edge read p sqrt(1 - (x/r)²) for p, x from the centre. Not counted: errors below 1e-15 of the
    peak, what one ulp of x changes, and what a function does on less than 5e-4 of the contact.

    Parameters
    ----------
    residual : float
        Largest residual of the integral equation.
    implied : float
        The error of the pressure that would leave this residual.
    force, moment : float
        Defect of equilibrium.
    lowest_pressure, lowest_gap : float
        0 where p >= 0 in the contact and gap >= 0 beside it, otherwise negative.
    abscissae : float
        The part of the above that is input rounding error, where p changes within one ulp of x.
    tol : float
        Tolerance that was asked for.
    tension, overlap : tuple of tuple of float
        Intervals of x where p < 0 in the contact and gap < 0 beside it, as closely as these were
        scanned.
    shear : ShearCertificate or None
        The certificate of the shear traction.
    resolution : float
        The difference between a function and its resolution at further points, as a pressure.
    edges : float
        The uncertainty of the edges by the load and rounding, as an error of the pressure at a
        distance r from them.
    notes : tuple of str
        Sentences on strains that are not small; they do not count for `ok`.
    root : float
        The power of r/d in the promise: 1/2, and 1/2 + |ε| where dissimilar bodies slide, with
        exponents 1/2 ± ε at the edges.
    """

    residual: float
    implied: float
    force: float
    moment: float
    lowest_pressure: float
    lowest_gap: float
    abscissae: float
    tol: float
    tension: Intervals = ()
    overlap: Intervals = ()
    shear: ShearCertificate | None = None
    resolution: float = 0.0
    edges: float = 0.0
    notes: tuple[str, ...] = ()
    root: float = 0.5

    @property
    def error(self) -> float:
        """Estimated relative error of the pressure: the largest of the defects."""
        return _largest(
            self.residual, self.implied, self.force, self.moment, self.resolution, self.edges
        )

    @property
    def ok(self) -> bool:
        """Whether every defect is within tol, but for what rounding of x explains."""
        allowed = _allowed(self.tol, self.abscissae)
        if self.shear is not None and not self.shear.ok:
            return False
        return (
            self.error <= allowed
            and self.lowest_pressure >= -max(allowed, TOLERATED)
            and self.lowest_gap >= -max(allowed, TOLERATED)
        )

    def wrong_by(self, nearer: float) -> float:
        """What the promise is at a distance r/nearer from an edge, as a part of the peak."""
        return 3.0 * (self.error + self.edges * nearer**self.root)

    def __str__(self) -> str:
        """The verdict first, then what it means, then its parts."""
        verdict = (
            f"certified to {max(self.tol, EXPLAINED * self.abscissae):.0e}"
            if self.ok
            else f"NOT certified to {self.tol:.0e}"
        )
        meaning: list[tuple[str, str]] = [
            (f"  at d = {place}", f"{self.wrong_by(nearer):.1e}")
            for nearer, place in NEARER.items()
        ]
        rows: list[tuple[str, str]] = [
            ("error: estimated relative error of the pressure", f"{self.error:.1e}"),
            ("edges, as p / peak at a distance r from them", f"{self.edges:.1e}"),
            ("integral equation (1), residual / peak", f"{self.residual:.1e}"),
            ("error of the pressure that would leave it / peak", f"{self.implied:.1e}"),
            ("equilibrium of forces, |∫p - P| / P", f"{self.force:.1e}"),
            ("equilibrium of moments, |∫px - M| / (P r)", f"{self.moment:.1e}"),
            ("function against its resolution, as p / peak", f"{self.resolution:.1e}"),
            ("lowest pressure in contact / peak", f"{self.lowest_pressure:+.1e}"),
            ("lowest gap outside / indentation scale", f"{self.lowest_gap:+.1e}"),
            ("of these, rounding of x itself", f"{self.abscissae:.1e}"),
        ]
        for name, intervals in (("p < 0", self.tension), ("gap < 0", self.overlap)):
            rows += [(f"{name} for {shown(intervals)}", "")] if intervals else []
        rows += self.shear.rows if self.shear is not None else ()
        remarks = self.shear.remarks if self.shear is not None else ()
        told = [*textwrap.wrap(PROMISE, WIDE), *table(meaning), *textwrap.wrap(BESIDES, WIDE)]
        return "\n".join([verdict, *told, "", *table(rows), *remarks, *self.notes])


@dataclass(frozen=True)
class ShearCertificate(Measured):
    """The measures of accuracy of a shear traction (`shear_check`).

    Numbers are relative to the largest |q|, to ∫|q| dx, or to f times the peak pressure.

    Parameters
    ----------
    residual : float
        Largest residual of the equation where the contact never slipped.
    equilibrium : float
        Defect of ∫q dx = Q.
    excess : float
        Largest violation of |q| <= f p, and of |q| = f p in slip zones.
    opposing : float
        0 where all slip has the direction of q, otherwise negative.
    abscissae : float
        How much of the above is input rounding error.
    condition : float
        Relative error of the load on the stick zone over one of P or Q.
    advancing : bool
        Whether the slip zones only grow on the way to this state.
    kind : str
        Name of the state.
    tol : float
        Tolerance that was asked for.
    """

    residual: float
    equilibrium: float
    excess: float
    opposing: float
    abscissae: float
    condition: float
    advancing: bool
    kind: str
    tol: float

    @property
    def error(self) -> float:
        """Estimated relative error of the shear traction."""
        return _largest(self.residual, self.equilibrium, self.excess)

    @property
    def ok(self) -> bool:
        """Whether every defect is within tol, but for what rounding of x explains."""
        allowed = _allowed(self.tol, self.abscissae)
        return self.error <= allowed and self.opposing >= -max(allowed, TOLERATED)

    @property
    def rows(self) -> tuple[tuple[str, str], ...]:
        """The measures with their values, as printed."""
        return (
            ("shear equation (12) in stick, residual / peak", f"{self.residual:.1e}"),
            ("equilibrium, |∫q - Q| / ∫|q|", f"{self.equilibrium:.1e}"),
            ("friction, largest |q| - f p / peak of f p", f"{self.excess:+.1e}"),
            ("lowest slip along q / largest slip", f"{self.opposing:+.1e}"),
            ("of this, rounding of x itself", f"{self.abscissae:.1e}"),
            ("error of the stick zone's load per error of Q", f"{self.condition:.1e}"),
        )

    @property
    def remarks(self) -> tuple[str, ...]:
        """The kind of slip."""
        if self.advancing:
            return (f"slip: {self.kind}",)
        return (f"slip: {self.kind}, in total displacements: {RETREAT}",)


def unresolved(abscissae: float) -> tuple[str, ...]:
    """The note on a certificate where rounding of x explains more than may be certified."""
    return (UNRESOLVED,) if EXPLAINED * abscissae > MOST_EXPLAINED else ()


def _largest(*defects: float) -> float:
    return max(LEAST, *(math.inf if math.isnan(d) else d for d in defects))


def _allowed(tol: float, abscissae: float) -> float:
    return tol + min(EXPLAINED * abscissae, MOST_EXPLAINED)


def shown(intervals: Intervals) -> str:
    """Intervals as a message has them."""
    shown = ", ".join(f"[{lo:.6g}, {hi:.6g}]" for lo, hi in intervals[:NAMED])
    return f"x in {shown}{f' and {len(intervals) - NAMED} more' if len(intervals) > NAMED else ''}"
