"""The figures of `validation.topics.appendix`."""

from __future__ import annotations

from collections.abc import Iterator

from oracles.principal_value import GUARD
from validation.appendix_equations import DIGITS
from validation.harness.drawing import Figure, axes, draw, labelled, legend
from validation.harness.records import Found


def figures(found: Found) -> Iterator[Figure]:
    drawing, ax = axes(height=4.6, foot=1.1)
    curves = found.curves("digits")
    draw(ax, curves)
    names = curves[0].about["names"]
    ax.set_xticks(range(len(names)), names, rotation=60, ha="right")
    labelled(ax, "equation of the paper", "digits agreed with quadrature")
    ax.set_ylim(-4, DIGITS + GUARD + 40)
    legend(ax, ncols=2, loc="upper left")
    yield Figure(
        "appendix-digits", drawing,
        f"Digits to which each form agrees with principal-value quadrature ({DIGITS + GUARD} "
        "digits carried): the identities and closed forms in mpmath to all of 50, doubles to 15 "
        "or 16; the printed forms of (26), (29), (31), (34) and after (25) to none.",
    )  # fmt: skip
