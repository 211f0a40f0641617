"""Traces: what a file holds is what is solved; splines are SciPy's; noise is smoothed."""

import itertools
import json
import re
import sys

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline, make_smoothing_spline

import sie
from sie.cli import main
from sie.contact import normal
from sie.io import scene_file
from sie.io.mesh_result import read_mesh

X = np.linspace(-2.0, 2.2, 211)
H = 0.5 * X**2 + 0.03 * X**3 + 0.01 * X**4


def pressed(profile, load=1.0):
    return sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=load))


# -- the spline -----------------------------------------------------------------------------------


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
    """Against the definition, with the matrix from h to f(x) column by column from SciPy's
    spline.
    """
    x, rng = np.linspace(0.0, 1.0, 60), np.random.default_rng(5)
    h = np.cos(4.0 * x) + 0.05 * rng.standard_normal(60)

    def score(lam):
        A = np.stack([make_smoothing_spline(x, unit, lam=lam)(x) for unit in np.eye(60)], axis=1)
        return 60 * np.sum((h - A @ h) ** 2) / (60 - np.trace(A)) ** 2

    found = sie.Sampled(x, h, "gcv").lam
    assert score(found) <= min(score(found * factor) for factor in (0.5, 0.8, 1.25, 2.0))


def test_knots_that_are_left_out_change_less_than_a_thousandth_of_what_smoothing_does(monkeypatch):
    x, rng = np.linspace(-1.0, 1.0, 2001), np.random.default_rng(1)
    h = 0.5 * x * x + 1e-3 * rng.standard_normal(2001)
    few = sie.Sampled(x, h, 1e-2)
    assert len(few.pieces.breaks) < 1001
    monkeypatch.setattr("sie.profiles.splines.ALL_KNOTS", 10_000)
    every = sie.Sampled(x, h, 1e-2)
    assert len(every.pieces.breaks) == 2001
    assert np.abs(few.height(x) - every.height(x)).max() <= 1e-3 * np.abs(h - every.height(x)).max()


def test_a_noisy_trace_presses_as_the_smooth_one_within_a_percent():
    x, rng = np.linspace(-2.0, 2.0, 20_001), np.random.default_rng(7)
    smooth = np.cosh(x) - 1.0
    noisy = sie.Sampled(x, smooth + 0.01 * smooth.max() * rng.standard_normal(len(x)), "gcv")
    exact = sie.FromFunction(np.sinh, domain=(-2.0, 2.0))
    for load in (0.3, 1.0):
        assert pressed(noisy, load).half_width == pytest.approx(
            pressed(exact, load).half_width, rel=1e-2
        )


# -- what is not a trace --------------------------------------------------------------------------


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
        ([0, 1, 2, 3], [0, 1j, 4, 9], "h is not a list of numbers"),
        ([0, 1, 2, 10**400], [0, 1, 4, 9], "x is not a list of numbers"),
        ([1], [1], "1 points are no trace"),
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


def test_a_contact_that_would_reach_the_end_of_the_trace_is_refused():
    with pytest.raises(sie.ContactError, match="end"):
        pressed(sie.Sampled(X, H), 100.0).edges  # noqa: B018 -- computes it


# -- files ----------------------------------------------------------------------------------------

TABLE = [
    (x, h) for x, h in zip([-2.0, -1.0, 0.0, 1.0, 2.5], [4.0, 1.25, 0.0, 1.5, 6.0], strict=True)
]


@pytest.mark.parametrize(
    "text",
    [
        "x,h\n" + "\n".join(f"{x},{h}" for x, h in TABLE),
        "# from a stylus\n# x h\n" + "\n".join(f"{x}  {h}   # point" for x, h in TABLE),
        "Weg [mm];Höhe [mm]\n" + "\n".join(f"{x};{h}".replace(".", ",") for x, h in TABLE),
        "\n".join(f"{x}\t{h}\t17" for x, h in TABLE) + "\n\n",
        "% 3 lines\nfrom\nhere on\n" + "\n".join(f'"{x}","{h:e}"' for x, h in TABLE),
        "\n".join(f"{x} {h}" for x, h in TABLE).replace("\n", "\r\n"),
        "x h\n" + "\n".join(f"{x}  {h}".replace(".", ",") for x, h in TABLE),
        "a trace of 5 points in 2 columns\n"
        + "\n".join(f"{x}\t{h}".replace("\t", "  ") for x, h in TABLE),
    ],
    ids=[
        "comma",
        "blanks",
        "semicolon",
        "tab",
        "quoted",
        "windows",
        "decimal commas between blanks",
        "numbers in a sentence",
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16"])
def test_text_in_common_formats_is_read(text, encoding, tmp_path):
    file = tmp_path / "trace.csv"
    file.write_bytes(text.encode(encoding))
    assert sie.Sampled.read(file) == sie.Sampled(*zip(*TABLE, strict=True))


@pytest.mark.parametrize("scale", [1e308, (1e308, 1.0), (1.0, -1e308)])
def test_a_scale_beyond_the_range_of_doubles_is_refused(scale, tmp_path):
    file = tmp_path / "trace.csv"
    file.write_text("".join(f"{x},{x * x}\n" for x in range(-20, 21)))
    with pytest.raises(
        ValueError, match=r"scale = .*beyond the range of doubles: choose other units"
    ):
        sie.Sampled.read(file, scale=scale)


def test_columns_scale_and_skip(tmp_path):
    file = tmp_path / "trace.txt"
    file.write_text(
        "1 2 3\nno, height (um), x (um)\n"
        + "\n".join(f"{k}, {-1000 * h}, {1000 * x}" for k, (x, h) in enumerate(TABLE))
    )
    found = sie.Sampled.read(file, columns=("x", "height"), scale=(1e-3, -1e-3), skip=1)
    assert found.points == pytest.approx([x for x, _ in TABLE])
    assert found.heights == pytest.approx([h for _, h in TABLE])
    assert sie.Sampled.read(file, columns=(2, 1), scale=(1e-3, -1e-3), skip=1) == found


def test_a_column_may_be_named_as_in_the_header_with_its_unit(tmp_path):
    file = tmp_path / "trace.csv"
    file.write_text(
        "n,X (um),Z [um]\n" + "\n".join(f"{k},{x},{h}" for k, (x, h) in enumerate(TABLE))
    )
    assert (
        sie.Sampled.read(file, columns=("X (um)", "Z [um]"))
        == sie.Sampled.read(file, columns=("x", "z"))
        == sie.Sampled.read(file, (1, 2))
    )


def test_numbers_of_columns_and_lines_may_be_numpy_s(tmp_path):
    file = tmp_path / "trace.txt"
    file.write_text("7 7\n" + "\n".join(f"{h} {x}" for x, h in TABLE))
    assert sie.Sampled.read(file, columns=tuple(np.array([1, 0])), skip=np.int64(1)) == sie.Sampled(
        *zip(*TABLE, strict=True)
    )


def test_missing_values_of_a_file_are_named_by_their_lines(tmp_path):
    file = tmp_path / "trace.csv"
    file.write_text("x,h\n-2,4\n-1,\n0,0\n1,nan\n2,4\n3,9\n4,16\n")
    with pytest.raises(ValueError, match="lacks a value in lines 3, 5: delete such lines"):
        sie.Sampled.read(file)
    assert sie.Sampled.read(file, mend=True).points.tolist() == [-2, 0, 2, 3, 4]
    file.write_text("x,h\n-2,4\n-1,abc\n0,0\n1,1\n2,4\n")
    with pytest.raises(ValueError, match="text where a number is wanted, in line 3"):
        sie.Sampled.read(file)
    with pytest.raises(ValueError, match="no column 'z', its header names x, h"):
        sie.Sampled.read(file, columns=("x", "z"))
    with pytest.raises(FileNotFoundError):
        sie.Sampled.read(tmp_path / "nothing.csv")


@pytest.mark.parametrize("skip", [0, 1, 3])
def test_skipped_lines_count_in_the_line_numbers_of_messages(skip, tmp_path):
    file = tmp_path / "trace.csv"
    table = "-2,4\n-1,\n0,0\n1,abc\n2,4\n3,9\n"
    file.write_text("of an instrument\n" * skip + table.replace("abc", "1"))
    with pytest.raises(ValueError, match=f"lacks a value in line {skip + 2}:"):
        sie.Sampled.read(file, skip=skip)
    file.write_text("of an instrument\n" * skip + table)
    with pytest.raises(ValueError, match=f"text where a number is wanted, in line {skip + 4}:"):
        sie.Sampled.read(file, skip=skip)


def test_other_formats_are_surface_topography_s(tmp_path, monkeypatch):
    file = tmp_path / "trace.opd"
    file.write_bytes(b"\0\1")
    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)
    with pytest.raises(ValueError, match=r"plane-contact\[traces\]"):
        sie.Sampled.read(file)


def test_a_line_scan_of_surface_topography_is_taken(tmp_path, monkeypatch):
    class Scan:
        dim = 1

        def positions_and_heights(self):
            return np.arange(5.0), np.ma.masked_array(
                [4.0, 1.0, 0.0, 1.0, 4.0], mask=[0, 0, 0, 0, 0]
            )

    class Library:
        @staticmethod
        def read_topography(path):
            return Scan()

    monkeypatch.setitem(sys.modules, "SurfaceTopography", Library)
    file = tmp_path / "trace.opd"
    file.write_bytes(b"\0\1")
    assert sie.Sampled.read(file, scale=(1e-3, 1.0)).points == pytest.approx(
        [0.0, 1e-3, 2e-3, 3e-3, 4e-3]
    )


# -- what a trace is like -------------------------------------------------------------------------


def test_levelling_takes_out_the_line_and_nothing_else():
    tilted = sie.Sampled(X, H + 0.3 * X - 2.0)
    assert tilted.levelled().heights == pytest.approx(
        sie.Sampled(X, H).levelled().heights, abs=1e-13
    )
    flat = sie.Sampled(X, np.maximum(np.abs(X) - 1.0, 0.0) ** 2 + 0.3 * X).levelled((-0.9, 0.9))
    assert flat.heights[np.abs(X) < 0.9] == pytest.approx(0.0, abs=1e-14)
    with pytest.raises(ValueError, match="0 points of the trace"):
        tilted.levelled((5.0, 6.0))


@given(
    a=st.floats(0.1, 0.7),
    R=st.floats(0.5, 200.0),
    centre=st.floats(-0.1, 0.1),
    tilt=st.floats(-1e-3, 1e-3),
    offset=st.floats(-1.0, 1.0),
)
def test_the_flat_with_rounded_edges_in_a_trace_is_found(a, R, centre, tilt, offset):
    x = np.linspace(-1.0, 1.0, 301)
    fit = sie.Sampled(
        x, offset + tilt * x + np.maximum(np.abs(x - centre) - a, 0.0) ** 2 / (2.0 * R)
    ).fit_rounded_flat()
    assert (fit.half_flat, fit.radius, fit.centre) == pytest.approx(
        (a, R, centre), rel=1e-4, abs=1e-5
    )
    assert fit.largest <= 1e-6 * max(0.01 / R, 1e-3)


def test_a_trace_of_heights_upside_down_fits_no_pad():
    with pytest.raises(ValueError, match=r"scale = \(1, -1\)"):
        sie.Sampled(X, -H).fit_rounded_flat()


# -- several patches ------------------------------------------------------------------------------


WAVY = sie.Sampled(X, H + 0.1 * np.cos(12.0 * X))


def test_one_patch_of_a_rough_trace_is_refused_with_its_intervals_and_what_helps():
    says = r"for x in \[.*\], \[.*give normal_load.*or smooth the profile"
    with pytest.raises(sie.ContactError, match=says):
        sie.solve(sie.Scene(profile=WAVY, modulus=1.0, half_width=0.6)).one_patch()


@pytest.mark.parametrize(
    "made",
    [
        lambda t: t,
        lambda t: t.mirrored().shifted(3.0),
        lambda t: t.tilted(0.01) + sie.Parabola(50.0),
    ],
    ids=["trace", "mirrored and shifted", "tilted, in a sum"],
)
def test_the_least_smoothing_makes_one_patch_of_the_profile_that_was_asked(made):
    scene = sie.Scene(profile=made(WAVY), modulus=1.0, normal_load=0.3)
    lam = sie.least_smoothing(scene)
    assert pressed(made(WAVY.smoothed(lam)), 0.3).check().ok
    assert len(pressed(made(WAVY.smoothed(0.3 * lam)), 0.3).patches) > 1


def test_a_trace_that_touches_in_one_patch_needs_no_more_smoothing_than_it_has():
    assert sie.least_smoothing(pressed(sie.Sampled(X, H)).scene) == 0.0


def test_a_trace_that_no_smoothing_helps_and_a_profile_without_trace_are_refused():
    with pytest.raises(sie.ContactError, match="no smoothing of the trace"):
        sie.least_smoothing(pressed(sie.Sampled(X, -H)).scene)
    with pytest.raises(ValueError, match="is no trace"):
        sie.least_smoothing(pressed(sie.Parabola(1.0)).scene)


@pytest.mark.parametrize("load", [1e-3, 0.3, 2.0])
def test_a_rough_trace_costs_at_most_one_search_for_one_patch(load, monkeypatch):
    searches, smoothings = [], []
    whole = normal.normal_contact
    counted = lambda *args: searches.append(args) or whole(*args)  # noqa: E731
    monkeypatch.setattr("sie.frictionless.normal_contact", counted)
    monkeypatch.setattr("sie.profiles.sampled.cross_validated", smoothings.append)
    rough = sie.Sampled(X, H + 0.1 * np.cos(40.0 * X))
    assert len(pressed(rough, load).patches) > 1
    # none where the load is light and several valleys are known to touch
    assert len(searches) <= 1
    assert smoothings == []


@pytest.mark.parametrize(
    ("h", "says"),
    [
        (-H, r"arches upwards.*scale = \(1, -1\)"),
        (0.0 * X + 3.0, "straight line"),
        (0.2 * X - 1e6, "straight line"),
        (H - 4.0 * X, "lowest at its end.*levelled"),
        (H - 3.0 * X, "measure further out$"),
    ],
    ids=["upside down", "flat", "tilted flat", "tilted", "askew"],
)
def test_a_contact_at_the_end_of_a_trace_is_refused_with_the_trace_s_own_reason(h, says):
    with pytest.raises(sie.ContactError, match=says) as refused:
        pressed(sie.Sampled(X, h), 1.0).edges  # noqa: B018 -- computes it
    assert ("other sign" in str(refused.value)) == ("arches" in says)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_refusal_names_places_of_the_trace(sign):
    """One of both edges is searched for in the mirror image."""
    x, places = np.linspace(1500.0, 1530.0, 301), []
    for slope, load in itertools.product((0.05, 0.2, 0.5), (0.01, 0.1, 1.0, 5.0)):
        trace = sie.Sampled(x, 0.1 * np.cos(2.0 * (x - 1500.0)) - sign * slope * (x - 1500.0))
        try:
            pressed(trace, load).edges  # noqa: B018 -- computes it
        except sie.ContactError as refused:
            places += re.findall(r"x[12]? = ([-\d.]*\d)|\[([-\d.]+), ([-\d.]+)\]", str(refused))
    named = [float(place) for group in places for place in group if place]
    assert len(named) > 6
    assert all(1500.0 <= place <= 1530.0 for place in named)


def wavy_pad(height, waves):
    x = np.linspace(-3.0, 3.0, 601)
    return sie.Sampled(
        x,
        np.maximum(np.abs(x) - 1.0, 0.0) ** 2 / 60.0 + height * np.cos(waves * x + 0.3) + 1e-3 * x,
    )


@pytest.mark.parametrize("load", [3e-3, 1e-2])
def test_waves_on_a_base_do_not_hide_the_contact_that_presses_them_flat(load):
    # Contacts that begin at the lowest wave and grow with the load end in it.
    solution = pressed(wavy_pad(1e-4, 6.0), load)
    assert solution.check().ok
    same = sie.solve(
        sie.Scene(profile=solution.scene.profile, modulus=1.0, half_width=solution.half_width)
    )
    assert (same.edges, same.normal_load) == (
        pytest.approx(solution.edges, rel=1e-12),
        pytest.approx(load, rel=1e-12),
    )


@given(st.floats(1e-5, 3e-4), st.floats(3.0, 30.0), st.floats(1e-5, 1e-2))
# An edge within some ulp of a point of the trace
@example(3.208964811676877e-05, 9.81311208978229, 0.0031236263147810506)
@settings(max_examples=20)
def test_waves_on_a_base_are_solved_or_refused(height, waves, load):
    try:
        found = pressed(wavy_pad(height, waves), load).check()
        says = "" if found.ok or found.error <= 1e-11 else "not certified"
    except sie.ContactError as refused:
        says = str(refused)
    assert not says or "smooth" in says


# -- all that follows from the pressure -----------------------------------------------------------


def test_friction_stress_yield_and_tension_of_a_trace_are_those_of_its_function():
    x = np.linspace(-2.0, 2.0, 401)
    given = {
        "modulus": 1.0,
        "normal_load": 0.5,
        "friction": 0.5,
        "tangential_load": 0.1,
        "poisson": 0.3,
    }
    sampled = sie.solve(sie.Scene(profile=sie.Sampled(x, np.cosh(x) - 1.0), **given))
    exact = sie.solve(sie.Scene(profile=sie.FromFunction(np.sinh, domain=(-2.0, 2.0)), **given))
    assert sampled.check().ok
    (c1, c2), (d1, d2) = sampled.stick[0], exact.stick[0]
    assert (c1, c2) == pytest.approx((d1, d2), abs=1e-8)  # the spline's own error
    at = np.linspace(-0.9, 0.9, 9) * exact.half_width
    assert sampled.shear(at) == pytest.approx(exact.shear(at), abs=1e-6)
    assert sampled.stress(at, 0.3).mises == pytest.approx(exact.stress(at, 0.3).mises, abs=1e-8)
    assert sampled.elastic_limit().stress == pytest.approx(exact.elastic_limit().stress, rel=1e-6)
    assert sampled.peak_tension().value == pytest.approx(exact.peak_tension().value, rel=1e-5)


# -- a mesh result beside it ----------------------------------------------------------------------

SCENE = """
[profile]
kind = "rounded-flat"
half_flat = 0.5
radius = 10.0
[body]
young = 1e4
poisson = 0.3
[load]
normal_load = 100.0
friction = 0.4
tangential_load = 20.0
"""


@pytest.fixture
def mesh(tmp_path, capsys):
    """A scene file, its solution, and a writer of mesh results."""
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE)

    def run(columns, *options):
        file = tmp_path / "fem.csv"
        np.savetxt(
            file,
            np.stack([np.ravel(c) for c in columns.values()], axis=1),
            delimiter=",",
            header=",".join(columns),
            comments="",
        )
        code = main(["compare", str(scene), str(file), *options])
        return code, *capsys.readouterr()

    return sie.solve(scene_file.read(str(scene)).scene), run


def test_a_mesh_result_passes_or_fails_by_its_l2_error(mesh):
    solution, run = mesh
    x = np.linspace(*solution.edges, 101)
    columns = {"x": x, "CPRESS": 1.02 * solution.pressure(x), "CSHEAR1": solution.shear(x)}
    assert run(columns, "--tol", "0.03")[0] == 0
    code, printed, _ = run(columns, "--tol", "0.01")
    assert code == 1
    assert "EXCEEDS" in printed
    assert "l2     2.000e-02" in printed


def test_nodes_that_two_elements_share_leave_the_load_as_it_is(mesh):
    solution, run = mesh
    x = np.repeat(np.linspace(*solution.edges, 201), 2)
    found = json.loads(run({"x": x, "p": solution.pressure(x)}, "--json")[1])["differences"]["p"]
    assert found["resultant"] == pytest.approx(0.0, abs=1e-2)


def test_a_column_called_depth_is_one(mesh):
    solution, run = mesh
    x = np.linspace(*solution.edges, 21)
    code, _, _ = run(
        {"X-coordinate": x, "depth": np.full(21, 0.4), "S11": solution.stress(x, 0.4).xx}
    )
    assert code == 0


def test_the_shift_of_a_mesh_is_found(mesh):
    solution, run = mesh
    x = np.linspace(*solution.edges, 201)
    found = json.loads(run({"x": x + 0.01, "p": solution.pressure(x)}, "--json")[1])["differences"][
        "p"
    ]
    assert found["shift"] == pytest.approx(0.01, abs=1e-6)
    assert found["l2_shifted"] < 1e-6 < found["l2"]
    assert found["resultant"] == pytest.approx(0.0, abs=1e-2)


def test_stresses_in_the_body_are_compared_whichever_way_y_points(mesh, tmp_path):
    solution, run = mesh
    x, y = np.meshgrid(np.linspace(-1.0, 1.2, 12), np.linspace(0.0, 1.0, 7))
    stress = solution.stress(x, y)
    down = {
        "x": x,
        "y": y,
        "sxx": stress.xx,
        "syy": stress.yy,
        "sxy": stress.xy,
        "szz": stress.zz,
        "mises": stress.mises,
    }
    up = {
        "x": x,
        "y": -y,
        "S-S11": stress.xx,
        "S-S22": stress.yy,
        "S-S12": -stress.xy,
        "S-S33": stress.zz,
        "S-Mises": stress.mises,
    }
    picture = tmp_path / "body.png"
    for columns in (down, up):
        code, printed, _ = run(columns, "--tol", "1e-12", "--plot", str(picture))
        assert code == 0, printed
    assert picture.stat().st_size > 1000
    assert run(down | {"sxy": -stress.xy}, "--tol", "1e-2")[0] == 1


@pytest.mark.parametrize(
    ("columns", "says"),
    [
        ({"x": [0, 0.1], "z": [1, 1]}, "has the columns x, z"),
        ({"x": [0, 0.1], "y": [-1, 1], "sxx": [1, 1]}, "on one side of y = 0"),
        ({"x": [0, 0.1], "y": [1, 2], "p": [1, 1]}, "no points of p on the surface"),
        ({"x": [100, 101], "p": [1, 1]}, "units of length, or the origins"),
    ],
)
def test_a_file_that_cannot_be_compared_is_refused_with_a_reason(columns, says, mesh):
    code, _, error = mesh[1](columns)
    assert code == 2
    assert says in error


def test_columns_that_are_not_compared_are_named(mesh, tmp_path):
    solution, run = mesh
    x = np.linspace(*solution.edges, 21)
    columns = {"x": x, "p": solution.pressure(x), "tangential": solution.shear(x)}
    _, printed, _ = run(columns)
    assert "not compared: the columns tangential of" in printed
    assert json.loads(run(columns, "--json")[1])["not_compared"] == ["tangential"]
    assert "not compared" not in run({"x": x, "p": solution.pressure(x)})[1]
    bare = tmp_path / "bare.csv"
    np.savetxt(bare, np.column_stack(list(columns.values())), delimiter=",")
    assert read_mesh(bare).others == ("2",)


@pytest.mark.parametrize(
    ("factor", "asks"),
    [
        (-1.0, "factor -1 fits best, and leaves l2 = 0.000e+00: are the signs"),
        (1e-6, "factor +1e-06"),
        (1e6, "units of load"),
        (1.3, ""),
    ],
)
def test_other_units_and_signs_are_suspected_from_the_factor_that_fits(factor, asks, mesh):
    solution, run = mesh
    x = np.linspace(*solution.edges, 101)
    code, printed, _ = run({"x": x, "p": factor * solution.pressure(x), "q": solution.shear(x)})
    assert code == 1
    assert ("factor" in printed) == bool(asks)
    assert asks in printed


def test_noise_is_no_suspicion(mesh):
    solution, run = mesh
    x = np.linspace(*solution.edges, 101)
    noise = np.random.default_rng(0).normal(size=x.shape)
    assert "factor" not in run({"x": x, "p": noise})[1]


@pytest.mark.parametrize("path", [5, None, ["a.csv"], 1.5], ids=repr)
def test_what_is_no_name_of_a_file_is_refused(path):
    with pytest.raises(ValueError, match="is not the name of a file"):
        sie.Sampled.read(path)
