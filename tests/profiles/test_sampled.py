"""Traces: what a file holds is what is solved; splines are SciPy's; noise is smoothed."""

import sys

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, make_smoothing_spline
from traces import H, X, pressed

import sie


def test_the_interpolating_spline_is_not_a_knot():
    profile, spline = sie.Sampled(X, H), CubicSpline(X, H)
    x = np.linspace(-1.9, 2.1, 77)
    assert profile.height(x) == pytest.approx(spline(x), abs=1e-14)
    assert profile.slope(x) == pytest.approx(spline(x, 1), abs=1e-12)
    assert np.isinf(profile.height([-2.1, 2.3])).all()


def test_a_cubic_slope_is_pressed_as_the_polynomial_it_is():
    h = 0.5 * X**2 + 0.03 * X**3
    sampled, exact = (
        pressed(sie.Sampled(X, h)),
        pressed(sie.Piecewise((-2.0, 2.2), ((0.0, 1.0, 0.09),))),
    )
    assert sampled.edges == pytest.approx(exact.edges, rel=1e-12)
    x = np.linspace(*exact.edges, 50)[1:-1]
    assert sampled.pressure(x) == pytest.approx(exact.pressure(x), rel=1e-11)
    assert sampled.check().ok


@pytest.mark.parametrize("lam", [1e-9, 1e-4, 1.0])
def test_the_smoothing_spline_is_that_of_scipy(lam):
    noisy = H + 1e-2 * np.random.default_rng(3).standard_normal(len(X))
    profile, spline = sie.Sampled(X, noisy, lam), make_smoothing_spline(X, noisy, lam=lam)
    x = np.linspace(-1.9, 2.1, 77)
    assert profile.height(x) == pytest.approx(spline(x), abs=1e-9)
    assert profile.lam == lam


@pytest.mark.parametrize("smoothing", ["gcv", 1e-4])
def test_a_smoothing_spline_does_not_depend_on_the_origin_or_the_units(smoothing):
    h = X * X + 1e-2 * np.random.default_rng(1).standard_normal(len(X))
    near = sie.Sampled(X, h, smoothing)
    far = sie.Sampled(1e6 + X, 1e6 + 1e-6 * h, smoothing)
    assert 1e6 * (far.height(1e6 + X) - 1e6) == pytest.approx(near.height(X), abs=1e-3)


@pytest.mark.parametrize("lam", [1e-300, 1e-60, 1e-30, 1e-24])
@pytest.mark.parametrize("n", [9, 300, 3000])
def test_a_smoothing_spline_tends_to_the_natural_one_through_the_points(n, lam):
    """Between the points too, where a spline of nearly no smoothing could be anything."""
    x = np.sort(np.random.default_rng(n).uniform(-1.0, 1.0, n))
    h = x**2 + 0.01 * np.sin(50.0 * x)
    between = 0.5 * (x[1:] + x[:-1])
    natural = CubicSpline(x, h, bc_type="natural")
    assert sie.Sampled(x, h, smoothing=lam).height(between) == pytest.approx(
        natural(between), abs=1e-12
    )


def test_cross_validation_finds_the_smallest_score():
    """By the matrix from h to f(x), column by column from SciPy's spline."""
    x, rng = np.linspace(0.0, 1.0, 60), np.random.default_rng(5)
    h = np.cos(4.0 * x) + 0.05 * rng.standard_normal(60)

    def score(lam):
        A = np.stack([make_smoothing_spline(x, unit, lam=lam)(x) for unit in np.eye(60)], axis=1)
        return 60 * np.sum((h - A @ h) ** 2) / (60 - np.trace(A)) ** 2

    found = sie.Sampled(x, h, "gcv").lam
    assert score(found) <= min(score(found * factor) for factor in (0.5, 0.8, 1.25, 2.0))


@pytest.mark.parametrize(
    ("x", "h", "says"),
    [
        ([0, 1, 2], [0, 1, 4], "3 points are no trace"),
        ([0, 1, 2, 3], [0, 1, 4], "4 values of x and 3 of h"),
        ([0, 2, 1, 3], [0, 4, 1, 9], r"x\[1\] = 2 is followed by 1"),
        ([0, 1, 1, 3], [0, 4, 1, 9], r"x\[1\] = 1 is given twice"),
        ([0, 1, 2, 3], [0, float("nan"), 1, 9], r"1 of 4 points .* h\[1\] = nan"),
        ([[0, 1], [2, 3]], [0, 1, 4, 9], "shape"),
        (["a", 1, 2, 3], [0, 1, 4, 9], "not a list of numbers"),
        ([0, 1, 2, 10**400], [0, 1, 4, 9], "x is not a list of numbers"),
        ([0, 1e-120, 2e-120, 3e-120], [0, 1, 4, 9], "3e-120 long: choose a unit"),
        ([0, 1, 2, 3], [0, 1, 4e200, 9], "reaches 4e.200: choose a unit"),
        ([0, 1, 1 + 2e-16, 3], [0, 1, 1, 9], "leave one of them out"),
    ],
)
def test_an_invalid_trace_is_refused_with_its_place(x, h, says):
    with pytest.raises(ValueError, match=says):
        sie.Sampled(x, h)


@pytest.mark.parametrize("smoothing", [-1.0, "gvc", float("nan"), 1e9])
def test_an_invalid_smoothing_is_refused(smoothing):
    with pytest.raises(ValueError, match="smoothing"):
        sie.Sampled(X, H, smoothing)


def test_mending_sorts_averages_and_leaves_out():
    mended = sie.Sampled([3, 1, 1, 2, 0, 4], [9, 0.5, 1.5, 4, 0, float("nan")], mend=True)
    assert mended == sie.Sampled([0, 1, 2, 3], [0, 1, 4, 9])
    assert hash(mended) == hash(sie.Sampled([0, 1, 2, 3], [0, 1, 4, 9]))


TABLE = list(zip([-2.0, -1.0, 0.0, 1.0, 2.5], [4.0, 1.25, 0.0, 1.5, 6.0], strict=True))
READ = sie.Sampled(*zip(*TABLE, strict=True))


def lines(form):
    return "\n".join(form.format(k=k, x=x, h=h) for k, (x, h) in enumerate(TABLE))


TEXTS = {
    "comma": "x,h\n" + lines("{x},{h}"),
    "blanks": "# from a stylus\n# x h\n" + lines("{x}  {h}   # point"),
    "semicolon": "Weg [mm];Höhe [mm]\n" + lines("{x};{h}").replace(".", ","),
    "tab": lines("{x}\t{h}\t17") + "\n\n",
    "quoted": "% 3 lines\nfrom\nhere on\n" + lines('"{x}","{h:e}"'),
    "windows": lines("{x} {h}").replace("\n", "\r\n"),
    "decimal commas between blanks": "x h\n" + lines("{x}  {h}").replace(".", ","),
    "numbers in a sentence": "a trace of 5 points in 2 columns\n" + lines("{x}  {h}"),
}


@pytest.fixture
def trace(tmp_path):
    """The trace in a file of a text, read with options."""

    def trace(text, *columns, encoding="utf-8", **options):
        file = tmp_path / "trace.csv"
        file.write_text(text, encoding=encoding, newline="")
        return sie.Sampled.read(file, *columns, **options)

    return trace


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16"])
def test_text_in_common_formats_is_read(text, encoding, trace):
    assert trace(text, encoding=encoding) == READ


def test_columns_are_named_as_in_the_header_or_by_number_and_scaled(trace):
    text = "1 2 3\nno, height (um), X [um]\n" + "\n".join(
        f"{k}, {-1000 * h}, {1000 * x}" for k, (x, h) in enumerate(TABLE)
    )
    options = {"scale": (1e-3, -1e-3), "skip": 1}
    found = trace(text, ("x", "height"), **options)
    assert found.points == pytest.approx(READ.points)
    assert found.heights == pytest.approx(READ.heights)
    for columns in (("X [um]", "height (um)"), (2, 1), tuple(np.array([2, 1]))):
        assert trace(text, columns, **options) == found
    assert trace("7 7\n" + lines("{h} {x}"), (1, 0), skip=np.int64(1)) == READ


@pytest.mark.parametrize(
    ("text", "options", "says"),
    [
        ("-1,\n0,0\n1,nan\n", {}, "lacks a value in lines 3, 5: delete such lines"),
        ("-1,\n0,0\n", {"skip": 3}, "lacks a value in line 6:"),
        ("-1,abc\n0,0\n1,1\n", {}, "text where a number is wanted, in line 3"),
        ("-1,abc\n0,0\n", {"skip": 1}, "text where a number is wanted, in line 4"),
        ("-1,1\n0,0\n", {"columns": ("x", "z")}, "no column 'z', its header names x, h"),
    ],
)
def test_missing_values_of_a_file_are_named_by_their_lines(text, options, says, trace):
    before = "of an instrument\n" * options.get("skip", 0)
    with pytest.raises(ValueError, match=says):
        trace(f"{before}x,h\n-2,4\n{text}2,4\n3,9\n4,16\n", **options)


def test_lines_that_lack_a_value_are_left_out_if_that_is_asked(trace):
    assert trace("x,h\n-2,4\n-1,\n0,0\n1,nan\n2,4\n3,9\n", mend=True).points.tolist() == [
        *(-2, 0, 2, 3)
    ]


class Scan:
    dim = 1

    @staticmethod
    def read_topography(path):
        return Scan()

    def positions_and_heights(self):
        return np.arange(5.0), np.ma.masked_array([4.0, 1.0, 0.0, 1.0, 4.0], mask=[0] * 5)


def test_other_formats_are_surface_topography_s(tmp_path, monkeypatch):
    file = tmp_path / "trace.opd"
    file.write_bytes(b"\0\1")
    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)
    with pytest.raises(ValueError, match=r"plane-contact\[traces\]"):
        sie.Sampled.read(file)
    monkeypatch.setitem(sys.modules, "SurfaceTopography", Scan)
    read = sie.Sampled.read(file, scale=(1e-3, 1.0))
    assert read.points == pytest.approx(1e-3 * np.arange(5.0))


def test_levelling_takes_out_the_line_and_nothing_else():
    tilted = sie.Sampled(X, H + 0.3 * X - 2.0)
    assert tilted.levelled().heights == pytest.approx(
        sie.Sampled(X, H).levelled().heights, abs=1e-13
    )
    flat = sie.Sampled(X, np.maximum(np.abs(X) - 1.0, 0.0) ** 2 + 0.3 * X).levelled((-0.9, 0.9))
    assert flat.heights[np.abs(X) < 0.9] == pytest.approx(0.0, abs=1e-14)
    with pytest.raises(ValueError, match="0 points of the trace"):
        tilted.levelled((5.0, 6.0))
