"""The live page's answers are those of the solver, and a browser shows them at two widths."""

import base64
import json
import math
import shutil
import signal
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import sie
from sie.cli import main
from sie.io.scene_file import Units, example, parse
from sie.live.answer import PARTS, answer
from sie.live.frame import frame_of, surface
from sie.live.setting import ACROSS, DOWN, LIVE, SAVED, Setting, shapes, sliders

pytest.importorskip("bokeh", reason="the live page needs the extra `live`")
from sie.live.page import saved
from sie.live.server import LiveServer, Turns

SHAPES = shapes(None)
FILES = ["partial-slip", "dissimilar", "flat", "sliding", "wedge"]


@pytest.mark.parametrize("shape", SHAPES)
def test_the_page_shows_what_the_solver_answers(shape):
    setting = Setting(shape=shape, tilt=0.25, share=-0.5)
    shown, solution = answer(setting, "contact"), sie.solve(setting.scene)
    inside = slice(5, -5)
    exact = solution.pressure(np.array(shown["x"][inside]))
    finite = np.isfinite(exact)
    found = np.array(shown["p"][inside])
    # x has five digits on the page
    assert np.abs(found - exact)[finite].max() < 0.01 * exact[finite].max()
    stick = [(lo, hi) for lo, hi, kind in shown["zones"] if kind == "stick"]
    assert np.allclose(stick, solution.stick, rtol=1e-4)


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("shape", SHAPES)
def test_an_answer_is_json_without_nan_or_infinity(shape, part):
    text = json.dumps(answer(Setting(shape=shape, share=1.0), part), allow_nan=False)
    assert "refusal" not in text


@pytest.mark.parametrize("share", [0.0, 0.6, 1.0])
def test_the_zones_cover_the_contact(share):
    setting = Setting(shape="two parabolas", share=share)
    zones, solution = answer(setting, "contact")["zones"], sie.solve(setting.scene)
    covered = sum(hi - lo for lo, hi, _ in zones)
    assert math.isclose(covered, sum(hi - lo for lo, hi in solution.patches), rel_tol=1e-3)


@pytest.mark.parametrize("name", FILES)
def test_the_deformed_surface_touches_the_indenter_and_stays_below_it(name):
    solution = sie.solve(parse(example(name)).scene)
    (lo, hi), x = solution.edges, np.linspace(-9.0, 9.0, 200)
    punch, body = surface(solution, x)
    inside = (x > lo) & (x < hi)
    assert np.array_equal(punch[inside], body[inside])
    outside = ~inside & np.isfinite(punch)
    assert np.all(body[outside] <= punch[outside])
    assert np.isfinite(body).all()


def test_the_surface_beside_a_flat_punch_is_that_of_the_closed_form():
    P, a, x = 0.7, 2.0, np.array([-5.0, -2.01, 2.3, 4.0])
    solution = sie.solve(sie.Scene(profile=sie.Flat(a), modulus=3.0, normal_load=P))
    _, body = surface(solution, x)
    exact = 2.0 * P / (math.pi * 3.0) * np.arccosh(np.abs(x) / a)  # Johnson (1985), (2.40)
    assert np.abs(body - exact).max() < 0.003 * exact.max()  # less than a pixel


@pytest.mark.parametrize("shape", SHAPES)
def test_the_axes_hold_every_load_of_the_slider(shape):
    frame = frame_of(shape, None)
    assert all(0.0 < value < 1.0 for value in (frame.hi, frame.p, frame.q, frame.height))
    for load in (0.1, 1.0, 2.0):
        shown = answer(Setting(shape=shape, load=load), "contact")
        assert frame.lo < shown["x"][0] < shown["x"][-1] < frame.hi
        assert shown["tops"][0] <= 1.001 * frame.p
        assert shown["tops"][1] <= 1.001 * frame.q
        assert max(shown["body"]) < 1500  # the picture has that room


def test_the_picture_of_the_stress_is_that_of_the_solver():
    setting = Setting(shape="parabola")
    shown, frame = answer(setting, "stress"), frame_of("parabola", None)
    steps = np.frombuffer(base64.b64decode(shown["steps"]), np.uint8).reshape(DOWN, ACROSS)
    levels = np.cumsum(np.cumsum(steps, axis=0, dtype=np.uint8), axis=1, dtype=np.uint8)
    found = levels / 255.0 * shown["top"]
    exact = sie.solve(setting.scene).stress(frame.columns[None, :], frame.rows[:, None]).mises
    assert np.abs(found - np.minimum(exact, shown["top"])).max() < shown["top"] / 400


def test_the_axes_of_a_file_have_its_units():
    scene = parse(example("partial-slip")).scene
    setting = Setting.of_words({}, scene)
    assert answer(setting, "contact", Units())["axes"]["p"] == "p (MPa)"
    assert answer(setting, "contact")["axes"]["p"] == "p"
    assert answer(Setting(), "contact")["axes"]["p"] == "p / E*"


def test_the_error_of_the_textbook_is_put_in_words():
    def lesson(**given):
        return answer(Setting(**given), "contact")["textbook"]["lesson"]

    assert "4 nodes give all digits" in lesson(shape="parabola")
    assert "like 1/n^1." in lesson(shape="rounded flat")
    assert "hardly lower" in lesson(shape="wedge")
    assert "here are 2" in lesson(shape="two parabolas")
    assert "no term with β" in lesson(shape="parabola", beta=0.3)


def test_a_setting_without_an_answer_is_refused_in_the_words_of_the_sliders():
    setting = {"shape": "two parabolas", "beta": 0.3}
    (sentence,) = answer(Setting(**setting), "contact").values()
    assert sentence == "These settings together have no answer. Set “Dundurs' β” to 0."
    assert "refusal" not in answer(Setting(**{**setting, "beta": 0.0}), "contact")


@pytest.mark.parametrize("name", FILES)
def test_the_sliders_start_from_the_values_of_the_file(name):
    scene = parse(example(name)).scene
    setting = Setting.of_words({}, scene)
    start = {control.name: control.start for control in sliders(scene)}
    assert setting.scene == scene
    assert start["friction"] == scene.friction
    assert start["beta"] == scene.beta
    assert "refusal" not in answer(setting, "contact")
    solution = sie.solve(scene)
    limit = scene.friction * solution.normal_load
    assert math.isclose(start["share"] * limit, solution.tangential_load, abs_tol=1e-9 * limit)


def test_a_slider_that_moves_leaves_the_others_where_the_file_has_them():
    scene = parse(example("partial-slip")).scene
    moved = Setting.of_words({"load": "2"}, scene).scene
    assert moved.normal_load == 2.0 * scene.normal_load
    assert math.isclose(moved.tangential_load, 2.0 * scene.tangential_load)
    assert (moved.friction, moved.body) == (scene.friction, scene.body)
    assert math.isclose(moved.bulk_stress, scene.bulk_stress)


def test_the_tilt_of_a_file_is_where_its_slider_starts():
    scene = sie.Scene(profile=sie.Parabola(2.0), modulus=3.0, normal_load=0.7, tilt=0.01)
    start = {control.name: control.start for control in sliders(scene)}["tilt"]
    assert Setting.of_words({"load": "2"}, scene).scene.tilt == scene.tilt
    moved = Setting.of_words({"tilt": "0"}, scene).scene
    assert (start != 0.0, moved.tilt, moved.normal_load) == (True, 0.0, scene.normal_load)


def test_a_bonded_file_has_no_place_on_the_sliders():
    scene = sie.Scene(
        profile=sie.Flat(1.0), modulus=1.0, dundurs=0.2, normal_load=1.0, friction=math.inf
    )
    with pytest.raises(ValueError, match="finite friction"):
        sliders(scene)


@pytest.mark.parametrize("profile", [sie.Wedge(0.3), sie.Flat(1.0)])
def test_an_infinite_pressure_leaves_a_picture_of_the_finite_ones(profile):
    scene = sie.Scene(profile=profile, modulus=1.0, poisson=0.3, normal_load=0.4, friction=0.5)
    shown, solution = answer(Setting.of_words({}, scene), "contact"), sie.solve(scene)
    mean = solution.normal_load / (2.0 * solution.half_width)
    top, _ = shown["tops"]
    assert mean < top < 10.0 * mean
    assert max(shown["p"]) < 100.0 * mean
    assert np.mean(np.array(shown["p"]) < top) > 0.85


@pytest.fixture(scope="module")
def server():
    with LiveServer() as running:
        threading.Thread(target=running.serve_forever, args=(0.02,), daemon=True).start()
        yield running
        running.shutdown()


@pytest.mark.slow
def test_a_query_that_is_no_setting_is_a_bad_request(server):
    with pytest.raises(urllib.error.HTTPError) as refusal:
        urllib.request.urlopen(server.address + "answer?load=heavy")
    refusal.value.close()
    assert refusal.value.code == 400


@pytest.mark.parametrize("name", ["evil.example", "evil.example:80", "127.0.0.1.evil.example", ""])
def test_the_names_of_other_hosts_are_refused(server, name):
    request = urllib.request.Request(server.address, headers={"Host": name})
    with pytest.raises(urllib.error.HTTPError) as refusal:
        urllib.request.urlopen(request)
    with refusal.value as reply:
        assert reply.code == 403
        assert server.address in reply.read().decode()


def test_of_many_settings_that_wait_only_the_newest_is_solved():
    turns, solved = Turns(), []
    free = threading.Event()

    def ask(turn):
        with turns.taken("page", turn) as wanted:
            if wanted:
                solved.append(turn)
                assert free.wait(60)
            return wanted

    with ThreadPoolExecutor(40) as pool:
        first = pool.submit(ask, 0)
        while not solved:
            time.sleep(0.001)
        rest = [pool.submit(ask, turn) for turn in range(1, 40)]
        time.sleep(0.2)  # until all of them wait
        assert solved == [0]
        free.set()
        assert first.result(60)
        assert [request.result(60) for request in rest] == [False] * 38 + [True]
    assert solved == [0, 39]


def test_a_setting_that_a_page_has_left_is_answered_with_nothing(server):
    with urllib.request.urlopen(server.address + "answer?client=a&turn=2") as reply:
        assert json.load(reply)["zones"]
    with urllib.request.urlopen(server.address + "answer?client=a&turn=1") as reply:
        assert (reply.status, reply.read()) == (204, b"")


@pytest.mark.slow
def test_the_command_serves_the_scene_of_a_file_until_it_is_interrupted(tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(example("wedge"), encoding="utf-8")
    # A shell's background jobs, and what they start, ignore Ctrl-C.
    program = """
import signal, sys
from sie.cli import main
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.exit(main(sys.argv[1:]))
"""
    command = [sys.executable, "-u", "-c", program, "live", str(scene), "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as running:
        try:
            address = running.stdout.readline().split()[0]
            with urllib.request.urlopen(address + "answer?friction=0.5&share=0.5") as reply:
                assert "stick" in {kind for _, _, kind in json.load(reply)["zones"]}
        finally:
            running.send_signal(signal.SIGINT)
        assert running.wait(timeout=60) == 130


@pytest.mark.slow
def test_a_port_that_is_taken_is_refused_before_the_page_is_made(server, capsys, monkeypatch):
    monkeypatch.setattr("sie.live.server.served", lambda *_: pytest.fail("the page is made"))
    port = str(server.server_port)
    assert main(["live", "--no-browser", "--port", port]) == 2
    assert f"port {port} cannot be served on" in capsys.readouterr().err


@pytest.mark.parametrize("mistake", [["--port", "70000"], ["no-such.toml"]])
def test_a_mistake_is_refused_before_anything_is_served(mistake, capsys):
    assert main(["live", "--no-browser", *mistake]) == 2
    assert mistake[-1] in capsys.readouterr().err


@pytest.fixture(scope="module")
def browser():
    playwright = pytest.importorskip("playwright.sync_api", reason="Playwright is not installed")
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("chromium is not installed")
    with playwright.sync_playwright() as running:
        yield running.chromium.launch(executable_path=chromium, args=["--no-sandbox"])


def opened(browser, address, width, scheme="light"):
    page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
    page.mistakes = []
    page.on("pageerror", lambda mistake: page.mistakes.append(str(mistake)))
    page.on("request", lambda request: page.mistakes.append(request.url)
            if not request.url.startswith((address, "data:", "blob:")) else None)  # fmt: skip
    page.goto(address)
    page.wait_for_function("document.body.dataset.shown", timeout=120_000)
    return page


def settled(page, act):
    """The page's text after an act that changes the setting."""
    before = page.evaluate("document.body.dataset.settled")
    act()
    page.wait_for_function(f"document.body.dataset.settled != '{before}'", timeout=120_000)
    return page.inner_text("#numbers") + page.inner_text("#status")


def moved(page, name, key="ArrowRight"):
    """The page's text after one step of a slider by the keyboard."""
    page.focus(f"#{name}")
    return settled(page, lambda: page.keyboard.press(key))


def axes(page):
    return page.evaluate(
        "['punch', 'pressure', 'shear'].flatMap((n) => [figures[n].x_range.start, "
        "figures[n].x_range.end, figures[n].y_range.end])"
    )


@pytest.mark.slow
@pytest.mark.parametrize(("width", "scheme"), [(390, "dark"), (1280, "light")])
def test_every_slider_moves_the_answer_by_the_keyboard(server, browser, width, scheme):
    page = opened(browser, server.address, width, scheme)
    page.click("#more summary")
    for control in LIVE:
        before, fixed = page.inner_text("#numbers"), axes(page)
        value = page.get_attribute(f"#{control.name}", "aria-valuetext")
        assert value == f"{control.start:g}"
        assert moved(page, control.name) != before, control.name
        assert page.get_attribute(f"#{control.name}", "aria-valuetext") != value
        if control.name == "load":
            assert axes(page) == fixed
            assert page.evaluate("sources.ghost[0].data.p.length") > 100
        moved(page, control.name, "ArrowLeft")
        assert page.inner_text("#numbers") == before, control.name
    for shape in SHAPES[1:]:
        settled(page, lambda shape=shape: page.select_option("#shape", shape))
        assert page.inner_text("#status") == ""
    assert page.is_disabled("#beta")
    assert page.inner_text("#beta-why") == "not for two parabolas with friction and β ≠ 0"
    settled(page, lambda: page.select_option("#shape", "wedge"))
    moved(page, "beta")
    assert page.inner_text("#tilt-why") == "tilt with β ≠ 0 only where Q = ±f P"
    moved(page, "share", "End")
    assert page.is_enabled("#tilt")
    moved(page, "tilt")
    assert page.is_disabled("#share")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert not page.mistakes
    page.close()


@pytest.mark.slow
def test_a_saved_page_works_from_a_file_and_leaves_out_what_has_no_answer(browser, tmp_path):
    first = {control.name: control.start for control in SAVED}
    answers = {}
    for bulk in (0.0, 0.4):
        given = {**first, "bulk": bulk}
        name = "|".join(["rounded flat", *(f"{value:g}" for value in given.values())])
        setting = Setting(shape="rounded flat", **given)
        answers[name] = {part: answer(setting, part) for part in PARTS}
    text = saved(answers)
    place = tmp_path / "live.html"
    place.write_text(text, encoding="utf-8")
    assert len(text.encode()) < 0.6e6  # without the other answers
    page = opened(browser, place.as_uri(), 390)
    assert f"{setting.scene.normal_load:g}" in page.inner_text("#numbers")
    assert page.locator("canvas").count() >= 4
    assert page.get_attribute("nav a", "href") == "index.html"
    page.click("#more summary")
    moved(page, "bulk")
    assert page.inner_text("#bulk-value") == "0.4"
    assert page.is_disabled("#load")
    assert "no other value" in page.inner_text("#load-why")
    assert page.inner_text("#status") == ""
    assert not page.mistakes
    page.close()
