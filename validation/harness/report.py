"""One HTML page without other files: claims with verdicts, figures as inline SVG, tables.

It is readable on a phone and without a network.
"""

from __future__ import annotations

import math
import os
import platform
import re
import time
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np
import scipy

from validation.harness.drawing import Drawn
from validation.harness.records import Claim, Found, Table

CSS = """
:root { color-scheme: light dark; --line: light-dark(#d8dee4, #3d444d);
  --soft: light-dark(#57606a, #a4adb8) }
* { box-sizing: border-box }
body { margin: 0 auto; max-width: 62rem; padding: 1rem; font: 16px/1.5 system-ui, sans-serif;
  color: light-dark(#1f2328, #e6e8eb); background: light-dark(#fff, #14181e) }
a { color: light-dark(#0a58a8, #7db4ee) }
h1 { font-size: 1.5rem }
h2 { margin-top: 2.5rem; border-bottom: 1px solid var(--line); font-size: 1.25rem }
h3 { font-size: 1rem }
nav a { display: inline-block; margin-right: .8rem }
p.intro { white-space: pre-line; color: var(--soft) }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 25rem), 1fr));
  gap: 1rem }
figure { margin: 0; min-width: 0 } figure svg { width: 100%; height: auto; display: block;
  background: #fff }
figcaption, .note { font-size: .87rem; color: var(--soft) }
.scroll { overflow-x: auto } table { border-collapse: collapse; font-size: .87rem; width: 100% }
th, td { text-align: left; vertical-align: top; padding: .3rem .6rem .3rem 0;
  border-bottom: 1px solid var(--line) }
td.number { font-variant-numeric: tabular-nums; white-space: nowrap }
.badge { color: #1f2328; border-radius: .6rem; padding: 0 .5rem; font-weight: 600;
  white-space: nowrap }
.holds { background: #dafbe1 } .refuted { background: #fff8c5 }
.fails, .blind { background: #ffebe9; color: #a40e26 }
@media (max-width: 40rem) {
  table.claims thead { display: none }
  table.claims tr { display: block; padding: .5rem 0; border-bottom: 1px solid var(--line) }
  table.claims td { display: block; border: 0; padding: .05rem 0 }
  table.claims td[data-label]::before { content: attr(data-label) ": "; color: var(--soft) }
}
"""
HEADER = ("verdict", "claim", "by", "measured", "bar", "on a wrong input")


@dataclass(frozen=True)
class Section:
    """One topic, computed and drawn."""

    name: str
    title: str
    introduction: str
    found: Found
    figures: Sequence[Drawn]
    seconds: float

    @property
    def code(self) -> str:
        """The file of the topic, from the root of the repository."""
        return f"validation/topics/{self.name}.py"


def page(sections: Sequence[Section], seconds: float, quick: bool) -> str:
    """The page, which needs no other file."""
    claims = [c for s in sections for c in s.found.claims]
    counts = ", ".join(
        f"{sum(c.verdict == v for c in claims)} {v}" for v in ("holds", "refuted", "fails", "blind")
    )
    links = "".join(f'<a href="#{s.name}">{escape(s.title)}</a> ' for s in sections)
    kind = "quick run" if quick else "whole run"
    body = [
        f"<h1>plane-contact: every claim computed anew</h1><p><b>{len(claims)} claims</b>: "
        f"{counts}. A {kind} of {seconds:.0f} s, {escape(machine())}.</p><p class=note>Each claim "
        "has a number measured in this run, a bar, and the same measure on a wrong input, which "
        "must miss it: a measure that its wrong input passes is called blind, and proves nothing. "
        "Refuted: a claim of the paper that is listed among its errata; there the control is the "
        "corrected form, which must meet the bar. Below each topic stands the file of the "
        f"repository that measures its claims.</p><nav>{links}</nav>"
    ]
    body += [_section(s) for s in sections]
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" '
        'content="width=device-width, initial-scale=1">'
        f"<title>plane-contact: "
        f"validation</title><style>{CSS}</style></head><body>{''.join(body)}</body></html>\n"
    )


def machine() -> str:
    """The machine on which the times were measured."""
    return (
        f"{time.strftime('%Y-%m-%d')}, Python {platform.python_version()}, NumPy {np.__version__}, "
        f"SciPy {scipy.__version__}, "
        f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores"
    )


def _section(s: Section) -> str:
    parts = [f'<section id="{s.name}"><h2>{escape(s.title)}</h2>{_prose(s.introduction)}']
    if s.found.claims:
        parts.append(_claims(s.found.claims))
    if s.figures:
        parts.append('<div class="figures">' + "".join(map(_figure, s.figures)) + "</div>")
    parts += [_table(t) for t in s.found.tables]
    return "".join(parts) + f"<p class=note>{s.code}, {s.seconds:.1f} s</p></section>"


def _prose(text: str) -> str:
    """A docstring as paragraphs; indented lines keep their breaks."""
    paragraphs = re.split(r"\n\s*\n", text.strip())
    return "".join(
        f"<p class=intro>{escape(p)}</p>"
        if re.search(r"^ {4}", p, flags=re.MULTILINE)
        else f"<p>{escape(' '.join(p.split()))}</p>"
        for p in paragraphs
    )


def _claims(claims: Sequence[Claim]) -> str:
    rows = []
    for c in claims:
        what = escape(c.what) + (
            f"<br><span class=note>{escape(c.erratum)}</span>" if c.erratum else ""
        )
        control = f"{number(c.control)} <span class=note>{escape(c.wrong)}</span>"
        cells: tuple[str, ...] = (
            f'<td><span class="badge {c.verdict}">{c.verdict}</span></td>',
            f"<td>{what}</td>",
            _cell("by", escape(c.by)),
        )
        cells += (
            _cell("measured", number(c.measured), "number"),
            _cell("bar", escape(c.bar), "number"),
            _cell(HEADER[-1], control),
        )
        rows.append(f"<tr>{''.join(cells)}</tr>")
    head = "".join(f"<th>{h}</th>" for h in HEADER)
    body = "".join(rows)
    return f'<table class="claims"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'


def _cell(label: str, inner: str, kind: str = "") -> str:
    return f'<td data-label="{label}"{f" class={kind}" if kind else ""}>{inner}</td>'


def _figure(figure: Drawn) -> str:
    return f"<figure>{figure.element}<figcaption>{escape(figure.caption)}</figcaption></figure>"


def _table(table: Table) -> str:
    head = "".join(f"<th>{escape(h)}</th>" for h in table.header)
    rows = "".join("<tr>" + "".join(_data(v) for v in row) + "</tr>" for row in table.rows)
    note = f"<p class=note>{escape(table.note)}</p>" if table.note else ""
    inside = f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"
    return f'<h3>{escape(table.title)}</h3>{note}<div class="scroll">{inside}</div>'


def _data(value: Any) -> str:
    return (
        f"<td>{escape(value)}</td>"
        if isinstance(value, str)
        else f"<td class=number>{number(value)}</td>"
    )


def number(value: Any) -> str:
    """A number to four figures, with a power of ten where it is far from one."""
    if value is None:
        return "—"
    if isinstance(value, bool) or not isinstance(value, (int, float, np.floating)):
        return escape(str(value))
    if isinstance(value, int) or not math.isfinite(value) or value == 0:
        return str(value)
    return f"{value:.4g}" if 1e-3 <= abs(float(value)) < 1e5 else f"{value:.1e}"
