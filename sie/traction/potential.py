"""V(z) of a slope given in pieces, and V'(z), which give the pressure, the potential and the gap.

    V(z) = X(z) ∫ H(t) / (w(t) (t - z)) dt,        on the contact  w(x) PV∫ ...

with the root X, w and the functions L_e of `edge_functions`. With v(e) = (e - x1)(x2 - e)/w(e) and
H_k, Q_k the polynomials of piece k (`panels`), [lo, hi] its ends,

    V    = Σ_k H_k (L_hi - L_lo) + X Q_k,          L_e' = -v(e) X / ((z - x1)(z - x2)(z - e))
    V'   = Σ_k H_k' (L_hi - L_lo) + N X / ((z - x1)(z - x2))
    N    = Σ_k v(lo) D_lo - v(hi) D_hi + (z - x1)(z - x2) Q_k' + M Q_k  +  Σ_e v(e) [H]_e / (z - e)

where D_e = (H_k(z) - H_k(e)) / (z - e) is a polynomial, [H]_e the jump of the slope at a break, and
M = (1/2+ε)(z - x2) + (1/2-ε)(z - x1): no poles cancel next to a break. V' is the derivative of V;
H = (|t| - a)/R gives back Fp' of the rounded punch (Ciavarella, Hills & Monno 1998, after (23)).

Where a piece is far, its Gauss rule serves: V = X S and N = M S + (z - x1)(z - x2) S' with
S = ∫H/(w (t - z)) dt. Of many pieces whole branches are summed at once (`cauchy_sums`), and pairs
(piece, point) are left, a few for each point: they are taken in arrays, few pieces one by one. Of
a rounded flat, stresses one by one take 0.32 times the time of arrays, a solve with 1001 pressures
0.42 times. Far from the contact V is one series, see `far`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.cauchy_sums import CHUNK, add_pairs, chunks

from .edge_functions import BreakFunction
from .of_slope import FAR_FIELD, outer_series

if TYPE_CHECKING:
    from .panels import Panels

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

Index = NDArray[np.int64]

WHOLE = slice(None)
NONE = np.zeros(0, dtype=np.int64)


class Block(NamedTuple):
    """One piece k and the points with the indices i, or arrays of pairs (k, i)."""

    k: Any
    i: Any
    s: Any  # the points' places on the piece, where its closed form serves them; else None

    @property
    def closed(self) -> bool:
        """Whether the closed form serves the block."""
        return self.s is not None


Meetings = Callable[[Block], tuple[Any, Any]]


# -- on the line, 1-d arrays x that ascend ---------------------------------------------------------


def on_contact(p: Panels, x: Array) -> Array:
    """w(x) PV∫ H / (w (t - x)) dt inside the contact; infinite at a jump of H."""
    if p.many and len(x) > CHUNK:
        return np.concatenate([on_contact(p, x[part]) for part in chunks(len(x))])
    w, function_of = p.edge.on_contact(x, p.geometry.slope.continuous and not p.many)
    V, _ = _on_line(p, x, w, function_of, served=p.serves_contact)
    for e, infinite in p.jumps:
        V[x == e] = infinite
    return V


def beside(p: Panels, x: Array) -> tuple[Array, Array]:
    """(first, second) with V = first - π/cos(πε) second, for x on one side of the contact.

    The second is H of the piece at that edge, continued as a polynomial (0 where that piece is
    taken by quadrature). The first vanishes like the slope of the gap, and so to relative accuracy.
    """
    if p.many and len(x) > CHUNK:
        parts = [beside(p, x[part]) for part in chunks(len(x))]
        return np.concatenate([V for V, _ in parts]), np.concatenate([H for _, H in parts])
    on_right, g = bool(x[0] > p.contact.m), p.geometry
    edge = -1
    if g.cut_right if on_right else g.cut_left:
        edge = len(p.series) - 1 if on_right else 0
    V, continued = _on_line(p, x, *p.edge.beside(x, on_right), edge=edge)
    distant = np.abs(x - p.contact.m) > FAR_FIELD * 2.0 * p.contact.r
    if distant.any():
        V[distant], continued[distant] = far(p, x[distant])[0], 0.0
    return V, continued


def _on_line(
    p: Panels,
    x: Array,
    X: Array,
    function_of: BreakFunction,
    *,
    served: bool = False,
    edge: int = -1,
) -> tuple[Array, Array]:
    """V, and H of the piece `edge` where its closed form serves; `served`: all closed forms do."""
    if p.many:
        S, k, i = p.sums.far(x)
        V, blocks = X * S, _pairs(p, x, k, i)
    else:
        V, blocks = np.zeros_like(X), _regions(p, x, served)
    continued = np.zeros_like(V)
    shared: dict[float, Any] = {}
    for block in blocks:
        k, i, s = block
        if s is None:
            _add(V, block, X[i] * _cauchy_sums(p, k, x[i])[0])
            continue
        H, Q = p.slope_and_Q(k)
        slope = chebyshev.evaluate(H, s)
        difference = _difference(p, block, function_of, 0.0, shared)
        _add(V, block, slope * difference + X[i] * chebyshev.evaluate_second_kind(Q, s))
        if isinstance(k, int):
            if k == edge:
                continued[i] = slope
        elif edge >= 0:
            continued[i[k == edge]] = slope[k == edge]
    return V, continued


# -- in the upper half-plane -----------------------------------------------------------------------


def upper(p: Panels, z: Complex) -> tuple[Complex, Complex]:
    """(V, V') at z (1-d), Im z > 0."""
    distant = np.abs(z - p.contact.m) > FAR_FIELD * 2.0 * p.contact.r
    if not distant.any():
        return near(p, z) if z.size else (z.copy(), z.copy())
    V, dV = np.empty_like(z), np.empty_like(z)
    V[distant], dV[distant] = far(p, z[distant])
    if not distant.all():
        V[~distant], dV[~distant] = near(p, z[~distant])
    return V, dV


def near(p: Panels, z: Complex) -> tuple[Complex, Complex]:
    """(V, V') not far from the contact."""
    if not p.many:
        return _near(p, z)
    V, dV = np.empty_like(z), np.empty_like(z)
    for part in chunks(len(z)):
        V[part], dV[part] = _near(p, z[part])
    return V, dV


def _near(p: Panels, z: Complex) -> tuple[Complex, Complex]:
    at, function_of = p.edge.upper(z)
    V, N, dV = np.zeros_like(z), np.zeros_like(z), np.zeros_like(z)
    if p.many:
        S, dS, k, i = p.sums.far_pair(z)
        V, N = at.X * S, at.mean * S + at.left * at.right * dS
        blocks = _pairs(p, z, k, i)
    else:
        blocks = _regions(p, z)
    # Where all closed forms serve all points, nothing but jumps is left of the poles
    all_whole = all(block.i is WHOLE and block.closed for block in blocks)
    meetings = _meetings(p, blocks, len(z)) if p.jumps or not all_whole else None
    shared: dict[float, Any] = {}
    for block in blocks:
        k, i, s = block
        here = at if i is WHOLE else at.at(i)
        if s is None:
            S, dS = _cauchy_sums(p, k, here.z)
            _add(V, block, here.X * S)
            _add(N, block, here.mean * S + here.left * here.right * dS)
            continue
        c = p.polynomials(k)
        J0 = _difference(p, block, function_of, np.pi / p.edge.cos, shared)
        Q = chebyshev.evaluate_second_kind(c.Q, s)
        _add(V, block, chebyshev.evaluate(c.H, s) * J0)
        _add(V, block, here.X * Q)
        _add(dV, block, chebyshev.evaluate_second_kind(c.dH, s) * J0)
        steep = here.mean * Q
        steep += chebyshev.evaluate(c.ends, s) if len(c.ends) > 1 else c.ends[0]
        if len(c.dQ):
            steep += here.left * here.right * chebyshev.evaluate_second_kind(c.dQ, s)
        if meetings is not None:
            _add_poles(p, k, here.z, meetings(block), steep)
        _add(N, block, steep)
    N /= at.divisor
    dV += N
    return V, dV


def _regions(p: Panels, z: Any, served: bool = False) -> list[Block]:
    """Every piece with the points in the ellipse of its reach, and with those beyond."""
    blocks = []
    for k, rho in enumerate(p.reach.tolist()):
        s = p.s(k, z)
        # A square inside the ellipse is tried first
        square = 0.5 * (rho - 1.0 / rho) / math.sqrt(2.0)
        if served or not z.size or max(s.real.max(), -s.real.min(), s.imag.max()) <= square:
            blocks.append(Block(k, WHOLE, s))
            continue
        inside = 0.5 * (np.abs(s - 1.0) + np.abs(s + 1.0)) <= 0.5 * (rho + 1.0 / rho)
        for mask, closed in ((inside, True), (~inside, False)):
            i = WHOLE if mask.all() else np.flatnonzero(mask)
            if mask.any():
                blocks.append(Block(k, i, s[i] if closed else None))
    return blocks


def _meetings(p: Panels, blocks: list[Block], size: int) -> Meetings:
    """Whether, for each point of a block, the next and the previous piece join the block's own.

    They join if they meet it at a break and their closed forms serve the point too.
    """
    meets = p.breaks.meets_next
    if p.many:
        known = np.sort(np.concatenate([_number(p, b) for b in blocks if b.closed] or [NONE]))

        def of_pairs(block: Block) -> tuple[Any, Any]:
            k, pair = block.k, _number(p, block)
            return meets[k] & _among(known, pair + 1), meets[k - 1] & _among(known, pair - 1)

        return of_pairs
    served: Any = np.zeros((len(meets), size), dtype=bool)
    for block in blocks:
        served[block.k, block.i] = block.closed
    whole = served.all(axis=1).tolist()

    def meeting(first: int, other: int, i: Any) -> Any:
        if not meets[first]:
            return False
        return whole[other] or served[other][i]

    def of_piece(block: Block) -> tuple[Any, Any]:
        k, i = block.k, block.i
        return meeting(k, (k + 1) % len(meets), i), meeting(k - 1, k - 1, i)

    return of_piece


def _number(p: Panels, block: Block) -> Index:
    """A number for each pair; that of the same point and the next piece is larger by 1."""
    number: Index = block.i * (len(p.series) + 1) + block.k
    return number


def _among(known: Index, wanted: Index) -> NDArray[np.bool_]:
    place = np.minimum(np.searchsorted(known, wanted), len(known) - 1)
    found: NDArray[np.bool_] = known[place] == wanted
    return found


def _add_poles(p: Panels, k: Any, z: Complex, meet: tuple[Any, Any], N: Complex) -> None:
    """Σ_e v(e) [H]_e / (z - e).

    Where both pieces at a break serve, their poles cancel but for a jump.
    """
    b = p.breaks
    for end, value in (
        (1, np.where(meet[0], b.jump[k], -b.H[1, k])),
        (0, np.where(meet[1], 0.0, b.H[0, k])),
    ):
        if value.any():
            here = np.flatnonzero(np.broadcast_to(value, z.shape))
            jump, v, e = (
                np.broadcast_to(a, z.shape)[here] for a in (value, b.v[end, k], b.e[end, k])
            )
            N[here] += v * jump / (z[here] - e)


# -- of one block ----------------------------------------------------------------------------------


def _pairs(p: Panels, z: Any, k: Index, i: Index) -> list[Block]:
    """The pairs within reach of a closed form, and those beyond."""
    s = p.s(k, z[i])
    # Half the sum of the distances from ±1, which is |s| beyond these on the line
    inside = 0.5 * (np.abs(s - 1.0) + np.abs(s + 1.0)) <= p.reach_in_s[k]
    return [
        Block(k[mask], i[mask], s[mask] if closed else None)
        for mask, closed in ((~inside, False), (inside, True))
        if mask.any()
    ]


def _add(total: Any, block: Block, values: Any) -> None:
    if block.i is WHOLE:
        total += values
    elif isinstance(block.k, int):
        total[block.i] += values
    else:
        add_pairs(total, block.i, values)


def _difference(
    p: Panels, block: Block, function_of: BreakFunction, at_left: float, shared: dict[float, Any]
) -> Any:
    """L_hi - L_lo; it is 0 at the right edge and `at_left` at the left one.

    Pieces that serve all points share the function of the break between them.
    """
    g, k, i = p.geometry, block.k, block.i
    last = len(p.series) - 1
    edges = (0 if g.cut_left else -1, last if g.cut_right else -1)
    if isinstance(k, int):

        def of_end(end: int) -> Any:
            e, e_left, e_right = p.ends[end][k]
            if i is not WHOLE:
                return function_of(e, e_left, e_right, i)
            if e not in shared:
                shared[e] = function_of(e, e_left, e_right, i)
            return shared[e]

        lo = at_left if k == edges[0] else of_end(0)
        return -lo if k == edges[1] else of_end(1) - lo
    total = np.zeros(len(k), dtype=complex if at_left else float)
    for end, sign in ((1, 1.0), (0, -1.0)):
        inner = np.flatnonzero(k != edges[end])
        of = k[inner]
        total[inner] += sign * function_of(
            g.ends[end][of], g.root_left[end][of], g.root_right[end][of], i[inner]
        )
    if g.cut_left:
        total[k == 0] -= at_left
    return total


def _cauchy_sums(p: Panels, k: Any, z: Any) -> tuple[Any, Any]:
    """S = ∫H/(w (t - z)) dt over the piece, and S'."""
    offset, charge = p.rule(k)
    from_lo = p.from_lo(k, z)
    S, dS = np.zeros_like(z), np.zeros_like(z)
    for t, weight in zip(offset.T, charge.T, strict=True):
        pole = np.reciprocal(t - from_lo)
        S += weight * pole
        pole *= pole
        dS += weight * pole
    return S, dS


# -- far from the contact --------------------------------------------------------------------------


def far(p: Panels, z: Any, constant: bool = True) -> tuple[Any, Any]:
    """V and V' far from the contact, where they fall like 1/z and 1/z² but for the constant -I0.

    Singular ends take that constant away again, and without it V keeps its digits. With g_n the
    moments ∫ H T_n /w dt, and ρ of `outer_series`,

        V = -X(z) / (sqrt(z - x1) sqrt(z - x2)) (I0 + 2 Σ_{n>0} g_n ρ^n)
    """
    S, dS = outer_series(p.far_series, p.contact, z)
    less, steep = p.edge.quotient(z)  # less 1
    V = -S * (1.0 + less) - p.I0 * (1.0 + less if constant else less)
    return V, -dS * (1.0 + less) - (S + p.I0) * steep
