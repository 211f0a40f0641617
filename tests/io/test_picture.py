"""The picture shows the numbers of the solution, and leaves Matplotlib as it was."""

import functools
import itertools

import numpy as np
import pytest
from scenes import scene

import sie
from sie.io.scene_file import Units, example, parse

matplotlib = pytest.importorskip("matplotlib")
plot = pytest.importorskip("sie.plots.contact_plot")
style = pytest.importorskip("sie.plots.style")

STEEL = sie.Elastic(210e3, 0.3)
PRESSED = {"body": STEEL, "normal_load": 50.0, "friction": 0.5}
SCENES = {
    "rounded flat": parse(example("rounded-flat")).scene,
    "wedge": parse(example("wedge")).scene,
    "flat": parse(example("flat")).scene,
    "tilted": scene(sie.RoundedFlat(2.0, 20.0).tilted(4e-4), body=STEEL, normal_load=500.0),
    "thin rim": scene(sie.RoundedFlat(0.999, 20.0), body=STEEL, half_width=1.0),
    "one sharp edge": scene(sie.Flat(5.0), body=STEEL, normal_load=50.0, tilt=1e-4),
    "far from x = 0": scene(sie.Parabola(0.01).shifted(1.0), body=STEEL, normal_load=1e-3),
}
EVERY = pytest.mark.parametrize("name", SCENES)


@functools.cache
def solved(name):
    return sie.solve(SCENES[name])


def lines(axes):
    return {line.get_label(): line for line in axes.lines}


def words(axes):
    return [text.get_text() for text in axes.texts]


def panels(solution, **options):
    upper, lower = plot.picture(solution, **options).axes
    return upper, lower


@EVERY
def test_both_edges_run_through_both_panels_and_are_named(name):
    solution = solved(name)
    upper, lower = panels(solution)
    factor, _ = style.scaled(solution.half_width, "mm")
    for axes in (upper, lower):
        dotted = {
            line.get_xdata()[0]
            for line in axes.lines
            if line.get_linestyle() != "-" and len(set(line.get_xdata())) == 1
        }
        assert set(np.multiply(solution.edges, factor)) <= dotted
    assert [word.split("$")[1] for word in words(upper) if word.startswith("$x_")] == ["x_1", "x_2"]


@pytest.mark.slow(but=2)
@EVERY
def test_nothing_that_is_written_leaves_the_picture_or_overlaps(name):
    figure = plot.picture(solved(name), title="A title")
    figure.draw_without_rendering()
    upper, lower = figure.axes
    labels = [upper.yaxis.label, lower.xaxis.label, lower.yaxis.label, figure._suptitle]
    texts = (*labels, *lower.get_legend().get_texts(), *upper.texts, *lower.texts)
    boxes = [(text.get_text(), text.get_window_extent()) for text in texts if text.get_text()]
    width, height = figure.get_size_inches() * figure.dpi
    for word, box in boxes:
        assert min(box.x0, box.y0) >= 0.0 and box.x1 <= width and box.y1 <= height, word
    for (one, box), (other, beside) in itertools.combinations(boxes, 2):
        assert not box.overlaps(beside), (one, other)


def test_the_curves_are_the_pressure_the_gap_and_the_unloaded_profile():
    solution = solved("tilted")
    upper, lower = plot.picture(solution).axes
    x, p = lines(upper)["pressure"].get_data()
    np.testing.assert_array_equal(p, solution.pressure(x))
    x, gap = lines(lower)["under load"].get_data()
    np.testing.assert_allclose(gap, 1e3 * solution.gap(x), rtol=1e-14)
    x, unloaded = lines(lower)["$h(x)$, unloaded"].get_data()
    assert unloaded.min() == 0.0
    np.testing.assert_allclose(
        np.diff(unloaded), 1e3 * np.diff(solution.scene.profile.height(x)), atol=1e-12
    )


def test_a_finite_peak_is_marked_by_dots_and_its_value():
    solution = solved("rounded flat")
    upper, _ = plot.picture(solution).axes
    dots = next(line for line in upper.lines if line.get_marker() == "o")
    (left, right), p = dots.get_data()
    assert right == pytest.approx(-left, abs=1e-6)
    np.testing.assert_allclose(p, solution.pressure(right), rtol=1e-12)
    assert f"$p_{{\\mathrm{{max}}}}$ = {p[0]:.1f} MPa" in words(upper)


@pytest.mark.parametrize(("name", "arrows"), [("flat", 2), ("one sharp edge", 1), ("wedge", 1)])
def test_an_infinite_pressure_is_cut_and_marked_by_arrows(name, arrows):
    upper, _ = panels(solved(name))
    assert np.isfinite(upper.get_ylim()).all()
    assert sum(getattr(text, "arrow_patch", None) is not None for text in upper.texts) == arrows
    assert r"$p \to \infty$" in words(upper)


def test_a_spike_is_cut_but_its_value_is_printed():
    upper, _ = panels(solved("thin rim"))
    largest, _ = plot.peak(solved("thin rim"))
    assert upper.get_ylim()[1] < 0.5 * largest
    assert f"$p_{{\\mathrm{{max}}}}$ = {largest:.3f} MPa" in words(upper)


def test_units_that_are_not_mm_keep_their_name_behind_a_power_of_ten():
    scene = sie.Scene(profile=sie.Parabola(1.0), body=sie.Elastic(210e9, 0.3), normal_load=1e4)
    upper, lower = panels(sie.solve(scene), units=Units("m", "N/m", "Pa"))
    assert upper.get_ylabel() == "$p$ ($10^{6}$ Pa)"
    assert lower.get_xlabel() == "$x$ ($10^{-6}$ m)"


FRETTING = parse(example("fretting-cycle"))
SHEARED = {
    "partial slip": sie.solve(parse(example("partial-slip")).scene),
    "sharp edges": sie.solve(sie.Scene(profile=sie.Flat(5.0), **PRESSED, tangential_load=-10.0)),
    "both signs": sie.solve(sie.Scene(profile=sie.Parabola(10.0), **PRESSED, bulk_stress=300.0)),
    "sliding": sie.solve(sie.Scene(profile=sie.Wedge(0.01), **PRESSED, tangential_load=25.0)),
    "path": sie.follow(FRETTING.scene, FRETTING.load_path)[-1],
}


@pytest.mark.parametrize("solution", SHEARED.values(), ids=SHEARED)
def test_the_shear_lies_between_its_limits_with_the_stick_zones_shaded(solution):
    axes = plot.picture(solution).axes[2]
    drawn = lines(axes)
    x, q = drawn["$q$"].get_data()
    _, limit = next(line for label, line in drawn.items() if "f p" in label).get_data()
    assert (np.abs(q) <= limit + 1e-9 * limit.max()).all()
    factor, _ = style.scaled(solution.half_width, "mm")
    scale, _ = style.scaled(solution.scene.friction * plot._View(solution, Units()).shown, "MPa")
    middle = len(x) // 2 + 3
    assert q[middle] == pytest.approx(
        float(solution.shear(x[middle] / factor)) * scale, rel=1e-9, abs=1e-9 * limit.max()
    )
    shaded = [patch.get_extents().bounds[2] for patch in axes.patches]
    assert len(shaded) == len(solution.stick)


def test_after_a_path_the_loop_goes_through_its_turning_points():
    solution = SHEARED["path"]
    loop = plot.picture(solution).axes[-1]
    shift, Q = loop.lines[-2].get_data()
    assert pytest.approx([point[1] for point in FRETTING.load_path.points]) == Q
    factor, _ = style.scaled(max(abs(s.shift) for s in solution.history), "mm")
    assert shift == pytest.approx(
        [s.shift * factor for s in solution.history], abs=1e-9 * abs(shift).max()
    )


FEET = sie.Row([sie.Parabola(1.0).shifted(3.0 * k) for k in range(3)])
ROW = sie.Scene(profile=FEET, body=STEEL, normal_load=9e3, friction=0.4, tangential_load=1e3)
SOLVED_ROW = sie.solve(ROW)
WAVE = sie.Periodic(sie.FromFunction(lambda x: 1e-3 * np.pi * np.sin(np.pi * x)), period=2.0)


def repeated(load):
    return sie.solve(sie.Scene(profile=WAVE, body=STEEL, normal_load=load))


def test_the_pressure_of_several_patches_is_interrupted_between_them():
    solution = SOLVED_ROW
    x, p = lines(plot.picture(solution).axes[0])["pressure"].get_data()
    assert np.count_nonzero(np.isnan(x)) == len(solution.patches) - 1
    inside = np.zeros(x.shape, dtype=bool)
    for lo, hi in solution.patches:
        inside |= (lo <= x) & (x <= hi)
    assert inside[np.isfinite(x)].all() and np.isfinite(p[inside]).all()


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("scene", [ROW, parse(example("dissimilar")).scene], ids=["row", "Spence"])
def test_the_slip_is_drawn_below_the_shear(scene):
    solution = sie.solve(scene)
    axes = plot.picture(solution).axes[3]
    x, slip = lines(axes)["slip"].get_data()
    there = np.isfinite(x)
    exact = solution.slip(x[there])
    assert slip[there] == pytest.approx(exact * (np.abs(slip[there]).max() / np.abs(exact).max()))
    assert len(axes.patches) == len(solution.stick)


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("load", [100.0, 10.0, 300.0, 4e3])
def test_the_picture_of_a_contact_that_repeats_ends_within_one_period(load):
    solution = repeated(load)
    factor, _ = style.scaled(solution.half_width, "mm")
    left, right = plot.picture(solution).axes[0].get_xlim()
    assert (right - left) / factor <= WAVE.period * (1.0 + 1e-12)


WITH_WALLS = {
    "flats": sie.Row([sie.Flat(1.0), sie.Flat(0.5).shifted(3.0)]),
    "flats that repeat": sie.Periodic(sie.Flat(1.0), period=4.0),
}


@pytest.mark.parametrize("profile", WITH_WALLS.values(), ids=WITH_WALLS)
def test_a_place_without_an_indenter_is_left_out_of_the_picture(profile):
    _, lower = panels(sie.solve(sie.Scene(profile=profile, body=STEEL, normal_load=20.0)))
    low, high = lower.get_ylim()
    assert -np.inf < low < 0.0 < high < np.inf


stress = pytest.importorskip("sie.plots.stress_plot")


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("width", [3.35, 7.0])
@pytest.mark.parametrize("draw", [plot.picture, stress.contours])
def test_a_picture_is_as_wide_as_asked_with_its_words_inside(draw, width):
    figure = draw(SHEARED["partial slip"], title="A contact " * 9, width=width)
    figure.draw_without_rendering()
    assert figure.get_figwidth() == width
    box = figure.get_tightbbox()
    assert box.x0 >= -0.02 and box.x1 <= width + 0.02
