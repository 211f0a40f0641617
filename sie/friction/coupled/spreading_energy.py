"""Energy dissipated under P, then Q, while what the contact gains sticks as it is touched.

Friction works in the slip zone along Q, and in the strip at the left edge against it,

    E*/2 dW/dQ = ∫ f p (∫_e2^x γ̇ dt) dx + ∫ f p (∫_x^e0 γ̇ dt) dx,       W = ∫ dW/dQ w ds,

over [e2, x2] and [x1, e0], with the rates of `edge_rate` and p at every s of the march
(`spreading_history`). On each of its panels ln dW/dQ is smooth in ln s. dW/dQ grows with s, so that
the sum may end where the rest of Q, times it, counts no more. As Q tends to 0 it tends to that of
the slip zone that P left, if this was not narrow.

docs/derivations/coupled_slip.md
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.gauss_jacobi import with_weight
from sie.progress_bar import reported, step_done

from .panels import graded, totals
from .spreading_march import SpreadingMarch
from .spreading_zones import Places, SpreadingPanel

Array = NDArray[np.float64]

CERTIFIED = 1e-6  # of the energy
PARTS, NODES = (3, 6), 24  # of a panel in ln s; of the sum over it
ENOUGH = 3e-8  # of the energy: what smaller loads may add, at most, where the sum ends
NEAREST = 1e-7  # of a zone: within it p is a power of the distance from its end
AT_ONCE = 1e-25  # the same of γ̇, which is infinite there
THIN = 1e-9  # of s: narrower strips dissipate less than 1e-12 of the whole


class SpreadingPower:
    """E*/2 dW/dQ at any s of a march."""

    def __init__(self, march: SpreadingMarch) -> None:
        self.march, self.history = march, march.history
        self.friction, self.theta = march.beginning.friction, march.history.rates.theta

    def __call__(self, s: float) -> float:
        step_done()
        e2, e3 = self.history.zones(s)
        power = self._ahead(s, e2, e3)
        strip = self.history.strip_width(s, e2, e3)
        return power + (self._of_strip(s, e2, e3, strip) if strip > THIN * s else 0.0)

    def _ahead(self, s: float, e2: float, e3: float) -> float:
        """That of the slip zone along Q."""
        history = self.history
        length = np.array([history.rest + e2 - e3])
        near = NEAREST * length
        _, ahead, left, weight = graded(length, near, near, (0.5 - self.theta, 0.5 + self.theta))
        ahead, left, weight = ahead.ravel(), left.ravel(), weight.ravel()
        owner, from_e2, to_x, mass = graded(ahead, AT_ONCE * ahead, left, (-0.5 - self.theta, 0.0))
        to_x2 = to_x + left[owner][:, None]
        whole = history.b + history.c + s - e2
        rate = history.gradient_rate(s, (whole + from_e2, -from_e2, to_x2), (e2, e3))
        slip = totals(owner, rate * mass, len(ahead))
        from_b = history.b + history.c - e2 + ahead
        p = self._pressure(Places(from_b, e2 - ahead, e3 + left, np.full(len(ahead), s)))
        return self.friction * float(weight @ (p * slip))

    def _of_strip(self, s: float, e2: float, e3: float, width: float) -> float:
        """That of the strip."""
        history, length = self.history, np.array([width])
        near = NEAREST * length
        _, ahead, left, weight = graded(length, near, near, (0.5 + self.theta, 1.5 - self.theta))
        ahead, left, weight = ahead.ravel(), left.ravel(), weight.ravel()
        owner, from_x, _, mass = graded(left, ahead, AT_ONCE * left, (0.0, 0.5 - self.theta))
        from_x1 = ahead[owner][:, None] + from_x
        b, c = history.b, history.c
        ends = from_x1, (b + c + s - e2) - from_x1, (2.0 * b + s - e3) - from_x1
        slip = totals(owner, history.gradient_rate(s, ends, (e2, e3)) * mass, len(ahead))
        places = Places(ahead - s, b + c + s - ahead, 2.0 * b + s - ahead, np.full(len(ahead), s))
        return self.friction * float(weight @ (self._pressure(places) * slip))

    def _pressure(self, places: Places) -> Array:
        p, normal = self.history.inside(places)[0], self.march.normal
        u = np.abs(places.from_b - normal.b)
        old = u <= normal.b
        p[old] += normal.pressure(u[old])
        return p


@reported("dissipated energy, state")
def spreading_energy(march: SpreadingMarch, s: float) -> float:
    """The energy dissipated while Q grew up to where the contact gained s.

    Raises ContactError where it is known less surely than to a part CERTIFIED.
    """
    power, history = SpreadingPower(march), march.history
    total = error = 0.0
    for panel in reversed([p for p in history.panels if p.start < s]):
        hi = min(s, panel.hi)
        value, missed = _on_panel(power, panel, panel.lo, hi)
        total, error = total + value, error + missed
        rest = power(panel.lo) * history.load(panel.lo)
        if rest < ENOUGH * total:
            break
    # Before, dW/dQ goes with Q like a power between 0 and that on the last panel
    m = math.log(power(hi) / power(panel.lo)) / math.log(history.load(hi) / history.load(panel.lo))
    rest /= 1.0 + max(m, 0.0)
    total, error = total + rest, error + rest * min(abs(m), 1.0)
    if error > CERTIFIED * total:
        raise ContactError(
            f"the energy that dissimilar bodies dissipate is known to {error / total:.1g} of it "
            "only; give another |Q|, or set tangential_load = 0 for the energy under the normal "
            "load"
        )
    return total / march.normal.half_modulus


def _on_panel(
    power: SpreadingPower, panel: SpreadingPanel, lo: float, hi: float
) -> tuple[float, float]:
    """∫w dW/dQ ds from lo to hi on a panel, and its error."""
    half, n, found = 0.5 * math.log(hi / lo), PARTS[-1], []
    x, _, weight = with_weight(NODES, 0.0, 0.0)

    def place(part: Array) -> Array:
        values: Array = np.clip(lo * np.exp(2.0 * half * part), lo, hi)
        return values

    y = -np.cos(math.pi * np.arange(n + 1) / n)
    # dW/dQ goes with about the second power of s: its logarithm is smoother
    logs = np.log([power(s) for s in place(0.5 * (1.0 + y)).tolist()])
    for parts in PARTS:
        k = np.arange(0, n + 1, n // parts)
        T = np.polynomial.chebyshev.chebvander(y[k], parts)
        series = np.asarray(np.linalg.solve(T, logs[k]), dtype=float)
        rate = np.exp(chebyshev.evaluate(series, 2.0 * x - 1.0))
        s = place(x)
        found.append(2.0 * half * float(weight @ (rate * panel(s)[0] * s)))
    return found[-1], abs(found[-1] - found[0])
