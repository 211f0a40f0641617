"""Axes go in and come out; a notebook shows pictures, a solution by its own."""

import sys
from html import escape

import pytest

import sie
from sie.io.scene_file import example, parse

matplotlib = pytest.importorskip("matplotlib")
from matplotlib.figure import Figure  # noqa: E402

PUNCH = sie.solve(parse(example("rounded-flat")).scene)
SHEARED = sie.solve(parse(example("partial-slip")).scene)
FRETTING = parse(example("fretting-cycle"))
HISTORY = sie.follow(FRETTING.scene, FRETTING.load_path)
PNG = b"\x89PNG"


@pytest.fixture
def axes():
    return Figure().subplots()


@pytest.mark.parametrize("what", ["pressure", "gap", "shear", "slip", "stress"])
def test_a_solution_is_drawn_on_given_axes(what, axes):
    assert SHEARED.plot(axes, what=what) is axes
    assert axes.get_xlabel() == "$x$ (mm)" and axes.get_ylabel()


def test_units_are_labels(axes):
    PUNCH.plot(axes, units={"length": "in", "stress": "psi"})
    assert axes.get_xlabel() == "$x$ (in)" and axes.get_ylabel() == "$p$ (psi)"


@pytest.mark.parametrize("draw", [PUNCH.plot, HISTORY.plot])
def test_axes_of_their_own_are_shown_in_a_notebook(draw):
    assert draw()._repr_png_().startswith(PNG)


def test_axes_without_x_and_y_are_refused():
    axes = Figure().add_subplot(projection="polar")
    for draw in (PUNCH.plot, HISTORY.plot):
        with pytest.raises(ValueError, match="is not an axes of Matplotlib with x and y"):
            draw(axes)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"what": "presure"}, 'did you mean "pressure"'),
        ({"what": "shear"}, "carries no shear"),
        ({"ax": 3}, "is not an axes"),
        ({"units": "mm"}, "are no labels"),
    ],
)
def test_a_bad_request_is_refused_in_a_sentence(given, said):
    with pytest.raises(ValueError, match=said):
        PUNCH.plot(**given)


def test_pictures_change_no_setting_and_leave_pyplot_alone():
    before, loaded = dict(matplotlib.rcParams), "matplotlib.pyplot" in sys.modules
    PUNCH.plot()._repr_png_()
    assert dict(matplotlib.rcParams) == before
    assert ("matplotlib.pyplot" in sys.modules) == loaded


def test_a_solution_is_shown_by_its_picture_where_there_is_matplotlib(monkeypatch):
    assert SHEARED._repr_png_().startswith(PNG)
    monkeypatch.setitem(sys.modules, "sie.plots.contact_plot", None)
    assert SHEARED._repr_png_() is None


@pytest.mark.parametrize("found", [SHEARED.check(), sie.plan(PUNCH.scene)], ids=["check", "plan"])
def test_a_certificate_and_a_plan_are_shown_as_their_tables(found):
    assert found._repr_html_() == f"<pre>{escape(str(found))}</pre>"


CELLS = [
    "import sie; from sie.io.scene_file import example, parse; from sie import progress_bar",
    "file = parse(example('fretting-cycle')); sie.solve(file.scene)",
    "sie.follow(file.scene, file.load_path).plot()",
    "progress_bar.PATIENCE = 0.0; _ = sie.sweep(file.scene, {'normal_load': [500.0, 600.0]})",
]


@pytest.mark.slow
def test_a_kernel_shows_the_pictures_and_the_bar():
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")
    pytest.importorskip("tqdm")
    cells = [nbformat.v4.new_code_cell(cell) for cell in CELLS]
    notebook = nbformat.v4.new_notebook(cells=cells)
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    _, solution, path, swept = (cell.outputs for cell in notebook.cells)
    assert "image/png" in solution[0].data and "image/png" in path[0].data
    assert any("sweep" in str(output) for output in swept)
