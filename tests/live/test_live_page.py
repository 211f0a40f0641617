"""The live page's answers are those of the solver, and a browser shows them at two widths."""

import json
import math
import shutil
import signal
import subprocess
import sys
import threading
import urllib.error
import urllib.request

import numpy as np
import pytest

import sie
from sie.cli import main
from sie.io.scene_file import example, parse
from sie.live.answer import PARTS, Setting, answer, sliders
from sie.live.controls import LIVE, OF_FILE, SAVED, shapes

pytest.importorskip("bokeh", reason="the live page needs the extra `live`")
from sie.live.page import saved
from sie.live.server import LiveServer

SHAPES = shapes(None)


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
    assert np.allclose(shown["stick"], solution.stick, rtol=1e-4)


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("shape", SHAPES)
def test_an_answer_is_json_without_nan_or_infinity(shape, part):
    text = json.dumps(answer(Setting(shape=shape, share=1.0), part), allow_nan=False)
    assert "refusal" not in text


def test_a_setting_without_an_answer_gives_the_sentence_of_the_refusal():
    (sentence,) = answer(Setting(shape="parabola", beta=0.3, bulk=0.5), "contact").values()
    assert "bulk" in sentence


def test_the_sliders_change_the_scene_of_a_file():
    scene = sie.Scene(profile=sie.Parabola(2.0), modulus=3.0, poisson=0.3, normal_load=0.7)
    words = {"load": "2", "friction": "0.4", "share": "0.5"}
    setting = Setting.of_words(words, scene)
    assert setting.shape == OF_FILE
    assert setting.scene.normal_load == 1.4
    assert math.isclose(setting.scene.tangential_load, 0.5 * 0.4 * 1.4)


@pytest.mark.parametrize("name", ["partial-slip", "dissimilar", "flat", "sliding", "wedge"])
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


def test_a_load_off_the_centre_keeps_its_place():
    scene = parse(example("flat")).scene
    moved = Setting.of_words({"load": "2"}, scene).scene
    assert (moved.normal_load, moved.moment) == (2 * scene.normal_load, 2 * scene.moment)


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
                assert json.load(reply)["stick"]
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


def opened(browser, address, width):
    page = browser.new_page(viewport={"width": width, "height": 900})
    page.mistakes = []
    page.on("pageerror", lambda mistake: page.mistakes.append(str(mistake)))
    page.on("request", lambda request: page.mistakes.append(request.url)
            if not request.url.startswith((address, "data:", "blob:")) else None)  # fmt: skip
    page.goto(address)
    page.wait_for_function("document.body.dataset.shown", timeout=120_000)
    return page


def moved(page, name, key="ArrowRight"):
    """The table's text after one step of a slider by the keyboard."""
    before = page.evaluate("document.body.dataset.settled")
    page.focus(f"#{name}")
    page.keyboard.press(key)
    page.wait_for_function(f"document.body.dataset.settled != '{before}'", timeout=120_000)
    return page.inner_text("#numbers") + page.inner_text("#status")


@pytest.mark.slow
def test_a_scene_without_poissons_ratio_says_why_there_is_no_picture_of_the_stress(browser):
    scene = sie.Scene(profile=sie.Wedge(0.05), modulus=8.0, half_width=1.0)
    with LiveServer(scene) as running:
        threading.Thread(target=running.serve_forever, args=(0.02,), daemon=True).start()
        page = opened(browser, running.address, 1280)
        assert "give poisson beside modulus" in page.inner_text("#status")
        titles = page.evaluate("figures.map((figure) => figure.title.text)")
        assert "No Mises stress: the sentence above says why" in titles
        assert not page.mistakes
        running.shutdown()


@pytest.mark.slow
@pytest.mark.parametrize("width", [390, 1280])
def test_every_slider_moves_the_answer_by_the_keyboard(server, browser, width):
    page = opened(browser, server.address, width)
    for control in LIVE:
        before = page.inner_text("#numbers")
        assert moved(page, control.name) != before, control.name
        moved(page, control.name, "ArrowLeft")
        assert page.inner_text("#numbers") == before, control.name
    for shape in SHAPES[1:]:
        before = page.evaluate("document.body.dataset.settled")
        page.select_option("#shape", shape)
        page.wait_for_function(f"document.body.dataset.settled != '{before}'", timeout=120_000)
        assert page.inner_text("#status") == ""
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert not page.mistakes
    page.close()


@pytest.mark.slow
def test_a_saved_page_works_from_a_file_and_is_small(browser, tmp_path):
    first = {control.name: control.start for control in SAVED}
    name = "|".join(["rounded flat", *(f"{value:g}" for value in first.values())])
    setting = Setting(shape="rounded flat", **first)
    text = saved({name: {part: answer(setting, part) for part in PARTS}})
    place = tmp_path / "live.html"
    place.write_text(text, encoding="utf-8")
    assert len(text.encode()) < 0.6e6  # without the other answers
    page = opened(browser, place.as_uri(), 390)
    assert f"{setting.scene.normal_load:g}" in page.inner_text("#numbers")
    assert page.locator("canvas").count() >= 4
    assert not page.mistakes
    page.close()
