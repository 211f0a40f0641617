"""An integral by halving, where the integrand is smooth but for a few places."""

from __future__ import annotations

from collections.abc import Callable

from sie.progress_bar import step_done

from . import chebyshev

# On each part: a rule, and the one that it is judged by.
NODES, FEWER = 10, 7
# of the scale: what the two rules may differ by, of which the error of the better one is 1e-3
SETTLED = 1e-9
MOST_HALVINGS = 6


def integral(
    rate: Callable[[float], float],
    scale: float,
    ends: tuple[float, float] = (0.0, 1.0),
    halvings: int = MOST_HALVINGS,
) -> float:
    """∫ rate dt, by halves until two rules agree to SETTLED of the scale."""
    step_done(0)
    start, end = ends
    known, judge = (
        (end - start) * sum(b * rate(start + (end - start) * a) for a, b in zip(g, w, strict=True))
        for g, w in (
            (x.tolist() for x in chebyshev.gauss_legendre(nodes)) for nodes in (NODES, FEWER)
        )
    )
    if not halvings or abs(known - judge) <= SETTLED * scale:
        return known
    middle = 0.5 * (start + end)
    return sum(
        integral(rate, scale, half, halvings - 1) for half in ((start, middle), (middle, end))
    )
