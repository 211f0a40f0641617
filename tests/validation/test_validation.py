"""Verdicts come from numbers, and a measure that cannot fail is called blind."""

import math

import numpy as np
import pytest
from validation_claims import claim

import sie
from sie import charts
from validation.__main__ import TOPICS, main, summary
from validation.harness import measures
from validation.harness.measures import largest, smallest
from validation.harness.records import Claim, Found
from validation.harness.report import Section
from validation.harness.running import run
from validation.rivals import solvers
from validation.rivals.problems import kinked, sliding, wavy
from validation.topics import paper, speed, stability, sweeps
from validation.topics.sweeps import SPOILED
from validation.wrong_programs.mutants import BAR, MUTANTS


@pytest.mark.parametrize(
    ("made", "verdict"),
    [
        (claim(0.5, 2.0), "holds"),
        (claim(1.5, 2.0), "fails"),
        (claim(math.nan, 2.0), "fails"),
        (claim(0.5, 0.9), "blind"),
        (claim(0.5, math.nan), "blind"),
        (claim(math.nan, 0.5, erratum="it is not so"), "fails"),
        (claim(2.0, 0.5, erratum="it is not so"), "refuted"),
        (claim(0.5, 0.5, erratum="it is not so"), "fails"),
        (claim(2.0, 3.0, erratum="it is not so"), "blind"),
        (claim(2.0, 0.0, low=1.0, high=math.inf), "holds"),
        (claim(0.5, 0.0, low=1.0, high=math.inf), "fails"),
    ],
)
def test_a_verdict_follows_from_the_numbers(made, verdict):
    assert made.verdict == verdict
    assert made.ok == (verdict in ("holds", "refuted"))


@pytest.mark.parametrize("place", [0, 1, 2])
def test_no_measure_ignores_a_nan(place):
    assert math.isnan(largest([1e-16, math.nan, 1e-15]))
    assert math.isnan(smallest([1e-16, math.nan, 1e-15]))
    found = [1.0, 2.0, 3.0]
    outcome = sweeps._outcome(None, found, [1, 2, 3], 1.0, 0.0)
    assert measures.apart(found, [1, 2, 3]) == outcome.error == 0.0
    found[place] = math.nan
    assert math.isnan(measures.apart(found, [1, 2, 3]))
    assert math.isnan(sweeps._outcome(None, found, [1, 2, 3], 1.0, 0.0).error)


def test_a_pressure_of_nan_fails_the_figures_of_the_paper(monkeypatch):
    """In the last of ten contacts, at one of the points only."""

    class Holed(sie.Solution):
        def __getattribute__(self, name):
            right = super().__getattribute__(name)
            holed = lambda x: np.where(np.arange(len(x)) == 3, np.nan, right(x))  # noqa: E731
            return holed if name == "pressure" else right

    def punch(ratio, right=charts.punch):
        return Holed(right(ratio).scene, 1e-13) if ratio == 0.9 else right(ratio)

    monkeypatch.setattr(charts, "punch", punch)
    made = next(r for r in paper.figure_2() if isinstance(r, Claim))
    assert not made.ok


def test_a_refusal_in_a_map_fails_its_claim(monkeypatch):
    right = sweeps.scale

    def refused(length, modulus):
        if length > 1.0 < modulus:
            raise sie.ContactError("no")
        return right(length, modulus)

    monkeypatch.setattr(sweeps, "scale", refused)
    claims = (r for r in stability.maps(quick=True) if isinstance(r, Claim))
    assert next(made for made in claims if "lengths" in made.what).verdict == "fails"


def test_an_interrupt_ends_the_run_with_a_message(monkeypatch, tmp_path, capsys):
    def interrupted(*given):
        raise KeyboardInterrupt

    monkeypatch.setattr("validation.__main__.run", interrupted)
    assert main(["--out", str(tmp_path)]) == 130
    assert "interrupted: nothing was written" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_failing_claim_is_printed_and_sets_the_exit_status(capsys, tmp_path):
    sections = [Section("one", "One", "", Found([claim(0.5, 2.0), claim(3.0, 2.0)]), (), 0.1)]
    assert summary(sections, 0.1, tmp_path) == 1
    assert "FAILS: one: what" in capsys.readouterr().out
    sections = [Section("one", "One", "", Found([claim(0.5, 2.0)]), (), 0.1)]
    assert summary(sections, 0.1, tmp_path) == 0


TRIED = """appendix collocation cracks economy growth paper pressure speed stress slip sliding
sampled patches stability certificate mutation"""


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("name", TRIED.split())
def test_every_claim_of_a_topic_holds_and_its_control_does_not(name):
    (section,), _ = run([name], quick=True)
    assert section.found.claims
    for made in section.found.claims:
        assert made.ok, made
    for figure in section.figures:
        assert figure.caption
        assert figure.element.startswith("<svg")


def test_every_topic_has_a_title_and_an_introduction():
    import importlib  # noqa: PLC0415

    for name in TOPICS:
        topic = importlib.import_module(f"validation.topics.{name}")
        assert topic.__doc__
        assert topic.TITLE
        assert len(topic.SECONDS) == 2
        assert topic.TIMED in (False, True)


def test_no_claim_of_cost_is_decided_by_a_clock(monkeypatch):
    def stopped():
        raise AssertionError("a claim reads a clock")

    monkeypatch.setattr("validation.harness.timing.time.process_time", stopped)
    assert speed.claim().ok


def test_a_sweep_detects_a_wrong_answer():
    sweep = stability.all_sweeps(True)[0]
    outcome = sweep.run(0.5)
    assert outcome.error < 1e-13
    assert outcome.spoiled == pytest.approx(SPOILED, rel=0.5)


def test_the_peers_are_right_where_they_should_be():
    """Hertz, p = sqrt(1 - x²)/2 for E* = R = 1."""
    x = np.linspace(-0.95, 0.95, 41)
    exact = 0.5 * np.sqrt(1 - x * x)
    assert solvers.gauss_chebyshev(lambda t: t, -1.0, 1.0, 16, x) == pytest.approx(exact, rel=1e-14)
    assert solvers.erdogan_gupta(lambda t: t, -1.0, 1.0, 16, x) == pytest.approx(exact, rel=1e-13)
    errors = []
    for n in (128, 512):
        t = ((np.arange(n) + 0.5) / n - 0.5) * 3.2
        p = solvers.boundary_elements(0.5 * t * t, 3.2 / n, np.pi / 4)
        inner = np.abs(t) < 0.9
        errors.append(np.abs(p - 0.5 * np.sqrt(np.maximum(1 - t * t, 0)))[inner].max())
    assert errors[1] < errors[0] / 3 < 0.01


@pytest.mark.slow(but=2)
@pytest.mark.parametrize(
    "made", [lambda: kinked(0.5), wavy, sliding], ids=["kinked", "wavy", "sliding"]
)
def test_a_race_measures_the_error_that_it_states(made):
    problem = made()
    p = problem.solution.pressure(problem.x)
    assert problem.error(p) < 1e-13
    assert problem.error(p * (1 + 1e-9)) == pytest.approx(1e-9, rel=0.1)


@pytest.mark.slow
def test_the_truth_of_sliding_agrees_with_the_closed_form():
    from analytic import sliding_rounded_flat  # noqa: PLC0415
    from validation.rivals.problems import Sliding  # noqa: PLC0415

    truth, scene = Sliding(0.3), sliding().scene
    P = sie.solve(scene).normal_load
    for x in (-0.9, -0.2, 0.3, 0.7):
        closed = sliding_rounded_flat.pressure(
            x, normal_load=P, half_flat=0.5, radius=1.0, modulus=1.0, coupling=0.3
        )
        assert float(truth.pressure(x)) == pytest.approx(float(closed), rel=1e-12)


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda m: m.name)
def test_each_wrong_program_is_caught_and_the_right_one_is_not(mutant):
    assert mutant.number(False) <= BAR
    assert mutant.number(True) > BAR
    assert mutant.number(False) <= BAR  # nothing stays replaced


def test_the_list_names_each_once():
    assert len({m.name for m in MUTANTS}) == len(MUTANTS) > 20
