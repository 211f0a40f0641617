"""The page of the validation, and the table of the README that is taken from it."""

import json
import math
import re

import numpy as np
import pytest
from validation_claims import claim

from validation import cases, readme
from validation.__main__ import main
from validation.harness.drawing import Figure, axes, draw, drawn, labelled
from validation.harness.records import Curve, Found, Map, Table, plain
from validation.harness.report import Section, page
from validation.harness.running import run
from validation.topics import economy, pressure


def a_section(name="one"):
    found = Found(
        [
            claim(0.5, 2.0),
            claim(5.0, 0.5, erratum="not <b>so</b>"),
            Table("A table", ("x", "y"), [("a < b", 1e-9)]),
        ]
    )
    found.append(Curve("figure", "curve", [1.0, 2.0], [1e-3, math.inf]))
    drawing, ax = axes()
    draw(ax, found.curves("figure"))
    labelled(ax, "x [mm]", "y", log="y")
    figures = [drawn(Figure(name, drawing, "What is seen."))]
    return Section(name, "Title", "Words.\n\nMore words.", found, figures, 0.1)


def test_the_page_needs_no_network_and_fits_a_phone():
    html = page([a_section("one"), a_section("paper")], 1.0, quick=True)
    assert "validation/topics/paper.py" in html
    assert not re.search(r"<(script|link|iframe|img)|@import|url\((?!#)", html)
    assert not re.search(r'(src|href)="(?!#)', html)
    assert 'name="viewport"' in html
    assert "@media (max-width" in html
    assert html.count("<svg") == 2
    assert "a &lt; b" in html and "&lt;b&gt;so" in html  # text is escaped
    assert html.count('class="badge holds"') == html.count('class="badge refuted"') == 2
    names = re.findall(r'\bid="([^"]*)"', html)
    assert len(set(names)) == len(names) > 20
    assert set(re.findall(r'(?:url\(#|href="#)([^)"]*)', html)) <= {*names}
    assert "<figcaption>What is seen." in html
    assert "x [mm]" in html


def test_every_number_is_in_the_json():
    found = Found(
        [
            claim(0.5, 2.0),
            Curve("f", "c", np.arange(3.0), [1, math.nan, 2]),
            Map("m", [1], [2], np.ones((1, 1))),
        ]
    )
    text = json.dumps(found.as_json(), allow_nan=False)
    back = json.loads(text)
    assert back[0]["verdict"] == "holds"
    assert back[1]["y"] == [1, "nan", 2]
    assert back[2]["values"] == [[1.0]]
    assert plain(np.float64(0.1)) == 0.1


def test_a_topic_that_breaks_off_fails_and_keeps_what_it_found(monkeypatch, capsys):
    def broken(quick):
        yield claim(0.5, 2.0)
        raise ZeroDivisionError("nothing to divide by")

    monkeypatch.setattr(economy, "compute", broken)
    (section,), _ = run(["economy"], quick=True)
    assert [c.verdict for c in section.found.claims] == ["holds", "fails"]
    assert not section.found.claims[1].ok
    assert "ZeroDivisionError: nothing to divide by" in section.found.claims[1].what
    assert "nothing to divide by" in capsys.readouterr().err
    assert not section.figures


@pytest.mark.slow
def test_topics_beside_each_other_find_what_they_find_alone():
    alone, beside = (
        run(["mutation"], quick=True)[0][0],
        run(["mutation", "appendix"], quick=True)[0],
    )
    assert [s.name for s in beside] == ["mutation", "appendix"]
    assert alone.found.as_json() == beside[0].found.as_json()


def test_one_topic_by_the_command_line(tmp_path, capsys):
    assert main(["--quick", "--only", "mutation", "--out", str(tmp_path)]) == 0
    numbers = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    assert list(numbers["topics"]) == ["mutation"]
    assert "NOT caught" not in (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "report.html" in capsys.readouterr().out


KEPT = json.loads(readme.KEPT.read_text(encoding="utf-8"))


@pytest.mark.parametrize("document", [readme.README, readme.PAGE], ids=lambda path: path.name)
def test_a_table_is_the_one_that_was_measured_and_a_change_by_hand_is_detected(document):
    text = document.read_text(encoding="utf-8")
    table = readme.tables(KEPT["rows"])[document]
    assert readme.with_table(text, table) == text
    assert readme.with_table(text, table.replace("e-16", "e-17", 1)) != text


@pytest.mark.parametrize("kept_row", KEPT["rows"], ids=lambda row: row[0])
def test_the_numbers_of_the_readme_still_hold(kept_row):
    """Errors within a factor of ten, or both below 1e-15; times are the machine's."""
    case = next(c for c in cases.chosen(quick=True) if str(c) == kept_row[0])
    now = pressure.row(case)
    for then, fresh in zip(kept_row[1:4], (now.error, now.load, now.estimated), strict=True):
        assert max(then, 1e-15) / 10 <= max(fresh, 1e-15) <= 10 * max(then, 1e-15)
    assert now.evaluations <= kept_row[4]
