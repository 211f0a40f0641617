"""The documents name modules, files and links that exist; the picture is that of the imports."""

import importlib
import re
import runpy
import shutil
import tomllib
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import sie
from sie import charts
from sie.certificate.result import PROMISE
from sie.cli import main

ROOT = Path(__file__).parent.parent
DOCUMENTS = sorted(
    [*(ROOT / "docs").rglob("*.md"), *(ROOT / name for name in ("README.md", "CONTRIBUTING.md"))]
)
GALLERY_OF = ROOT / "docs" / "gallery"
GALLERY = sorted(GALLERY_OF.glob("*/plot_*.py"))
each = pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
PACKAGES = "sie|analytic|validation|oracles"


def quoted(document):
    return re.findall(r"`([^`\n]+)`", document.read_text(encoding="utf-8"))


def resolve(name):
    """The module or the attribute that a dotted name stands for."""
    module, _, attribute = name.rpartition(".")
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError:
        return getattr(resolve(module), attribute)


@each
def test_every_module_that_a_document_names_exists(document):
    names = {n for n in quoted(document) if re.fullmatch(rf"({PACKAGES})(\.\w+)+", n)}
    for name in names:
        assert resolve(name) is not None


@each
def test_every_file_that_a_document_names_exists(document):
    folders = f"{PACKAGES}|docs|tests|benchmarks"
    paths = {n for n in quoted(document) if re.fullmatch(rf"({folders})/[\w./-]*", n)}
    links = re.findall(r"\]\(([^)#:]+)\)", document.read_text(encoding="utf-8"))
    for place in [*(ROOT / path for path in paths), *(document.parent / link for link in links)]:
        assert place.exists() or place.stem == "KIND", place


def listed(page):
    """The pages in the tables of contents of a page, by their paths without a suffix."""
    text = page.read_text(encoding="utf-8")
    entries = re.findall(r"```\{toctree\}\n(.*?)```", text, flags=re.DOTALL)
    names = [
        re.sub(r".*<(.*)>", r"\1", line.strip())
        for block in entries
        for line in block.splitlines()
        if line.strip() and not line.startswith(":")
    ]
    return {(page.parent / name).resolve() for name in names}


def test_every_page_of_the_site_stands_in_a_table_of_contents():
    pages = sorted((ROOT / "docs").rglob("*.md"))
    pages = [page for page in pages if not {"_build", "built-gallery"} & {*page.parts}]
    contents = set().union(*map(listed, pages))
    lost = [page for page in pages if page.with_suffix("") not in contents]
    assert lost == [ROOT / "docs" / "index.md"]


def test_the_reference_has_every_public_name():
    page = (ROOT / "docs" / "api" / "index.md").read_text(encoding="utf-8")
    listed = {line.strip().strip("`").removeprefix("sie.") for line in page.splitlines()}
    assert {*sie.__all__} - listed <= {"__version__"}


EXPLANATION = sorted(
    {*(ROOT / "docs" / "explanation").glob("*.md")} - {ROOT / "docs" / "explanation" / "index.md"}
)


@pytest.mark.parametrize("page", EXPLANATION, ids=lambda path: path.stem)
def test_every_page_of_the_explanation_ends_with_three_exercises_or_more(page):
    exercises = page.read_text(encoding="utf-8").split("\n## Exercises\n")[1]
    assert len(re.findall(r"^\d+\. ", exercises, flags=re.MULTILINE)) >= 3


@pytest.mark.parametrize("page", EXPLANATION, ids=lambda path: path.stem)
def test_a_page_of_the_explanation_opens_with_a_sketch_and_has_equations_of_its_number(page):
    text, index = (path.read_text(encoding="utf-8") for path in (page, page.parent / "index.md"))
    assert "```{sketch}" in text.split("\n## ")[0]
    number = 1 + re.findall(r"^\w+$", index, flags=re.MULTILINE).index(page.stem)
    assert {*re.findall(r"\\tag\{(\d+)\.\d+\}", text)} <= {str(number)}


def test_the_picture_of_the_architecture_is_that_of_the_imports():
    script = runpy.run_path(str(ROOT / "docs" / "draw_architecture.py"))
    drawn = (ROOT / "docs" / "architecture.svg").read_text(encoding="utf-8")
    assert drawn == script["picture"](), "run python docs/draw_architecture.py"


@cache
def drawn(script):
    """The names of a script and the axes that it draws."""
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot as plt  # noqa: PLC0415 -- after the choice of Agg

    plt.close("all")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(plt, "show", lambda: None)
        names = runpy.run_path(str(script))
    axes = [ax for number in plt.get_fignums() for ax in plt.figure(number).axes]
    plt.close("all")
    return names, [ax for ax in axes if ax.get_label() != "<colorbar>"]


@pytest.mark.slow(but=3)
@pytest.mark.parametrize("script", GALLERY, ids=lambda path: path.stem)
def test_every_script_of_the_gallery_draws_a_labelled_picture(script):
    names, axes = drawn(script)
    assert names["__doc__"].strip()
    assert axes and all(ax.get_xlabel() and ax.get_ylabel() for ax in axes)


# N mm of a slice of 1 mm are N = mJ/mm, and N/mm times µm is µJ/mm.
IN_NEWTON = {"mJ per mm": 1.0, "µJ per mm": 1e-3, "N in the cycle": 1.0}
ENERGY = re.compile(rf"([\d.e-]+) ({'|'.join(IN_NEWTON)})")


def energies(text):
    """The energies per length in a text, in N."""
    return [float(number) * IN_NEWTON[unit] for number, unit in ENERGY.findall(text)]


def test_the_fretting_loop_encloses_the_energy_in_its_title():
    _, (_, loop) = drawn(GALLERY_OF / "2_friction" / "plot_fretting_loop.py")
    assert (loop.get_xlabel()[-2:], loop.get_ylabel()[-4:]) == ("µm", "N/mm")
    shift, force = loop.lines[0].get_data()
    area = abs(np.trapezoid(force[9:], shift[9:]))
    assert energies(loop.get_title()) == pytest.approx([1e-3 * area], rel=0.02)


def test_a_rounded_punch_is_stronger_than_hertz_up_to_the_ratio_that_the_gallery_gives():
    text = (GALLERY_OF / "1_punches" / "plot_05_elastic_limit.py").read_text(encoding="utf-8")
    ratio = float(re.findall(r"Up to a/b = ([\d.]+)", text)[0])
    loads = charts.elastic_limits((0.0, ratio - 0.005, ratio + 0.005), (0.0,)).limit[:, 0]
    assert loads[1] > loads[0] > loads[2]


@pytest.mark.slow
def test_the_class_sheet_runs_and_answers_its_third_question():
    pytest.importorskip("marimo", reason="the class sheet needs the extra `teach`")
    pytest.importorskip("matplotlib").use("Agg")
    sheet = runpy.run_path(str(ROOT / "docs" / "class_sheet.py"))["app"]
    _, names = sheet.run()
    assert names["by_misfit"] == pytest.approx(names["tilted"].centre, abs=1e-12)


PAGES = [page for page in DOCUMENTS if "{code-cell}" in page.read_text(encoding="utf-8")]
GUIDES = sorted({*(ROOT / "docs" / "how-to").glob("*.md")} - {*PAGES})
NEEDED = {"cluster": "xarray"}


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("guide", GUIDES, ids=lambda path: path.stem)
def test_the_snippets_and_commands_of_a_guide_run_in_order(guide, tmp_path, monkeypatch, capsys):
    """Python, scene files ("Save this as `name`") and commands, beside the guide's data."""
    if guide.stem in NEEDED:
        pytest.importorskip(NEEDED[guide.stem], reason="the guide writes a file of a sweep")
    for data in guide.parent.glob("*.csv"):
        shutil.copy(data, tmp_path)
    monkeypatch.chdir(tmp_path)
    text = guide.read_text(encoding="utf-8")
    saved = next(iter(re.findall(r"Save this as `([\w.-]+)`", text)), None)
    names = {}
    for kind, block in re.findall(r"```(python|toml|sh)\n(.*?)```", text, flags=re.DOTALL):
        if kind == "python":
            exec(compile(block, guide.name, "exec"), names)
        elif kind == "toml":
            Path(saved).write_text(block, encoding="utf-8")
        else:
            for line in block.splitlines():
                assert main(line.split()[1:]) == 0, capsys.readouterr().err


def test_every_refusal_of_a_path_that_is_listed_is_one_that_is_raised():
    page = (ROOT / "docs" / "derivations" / "layered-memory.md").read_text(encoding="utf-8")
    table = page.split("## What is refused")[1].split("\n## ")[0]
    raised = " ".join(path.read_text(encoding="utf-8") for path in (ROOT / "sie").rglob("*.py"))
    raised = re.sub(r'"\s+f?"', "", raised)
    for phrase in re.findall(r'"([^"]+)"', table):
        assert phrase in raised, phrase


@pytest.mark.slow(but=6)
@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.stem)
def test_the_cells_of_a_page_run_in_order(page, tmp_path, monkeypatch, capsys):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot as plt  # noqa: PLC0415 -- after the choice of Agg

    monkeypatch.setattr(plt, "show", lambda: plt.close("all"))
    monkeypatch.chdir(tmp_path)
    text, names = page.read_text(encoding="utf-8"), {}
    for cell in re.findall(r"```\{code-cell\}\n(?::tags:.*?\n)?(.*?)```", text, flags=re.DOTALL):
        exec(compile(cell, page.name, "exec"), names)
    told = energies(capsys.readouterr().out)
    assert bool(told) == (page.stem == "dovetail-cycle")
    assert all(energy == pytest.approx(told[0], rel=0.01) for energy in told)


README = (ROOT / "README.md").read_text(encoding="utf-8")
SNIPPETS = re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)


def test_the_three_snippets_run_one_after_the_other(capsys):
    assert len(SNIPPETS) == 3
    names: dict[str, object] = {}
    for snippet in SNIPPETS:
        exec(compile(snippet, "README.md", "exec"), names)
    assert "\ncertified to 1e-13" in capsys.readouterr().out


def test_the_commands_install_extras_that_exist():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = re.findall(r'pip install -e "\.\[(\w+)\]"', README)
    # The two commands, what the validation races against, and the site
    assert extras == ["plot", "test", "peers", "docs"]
    assert set(extras) <= set(project["optional-dependencies"])
    assert "sie" in project["scripts"]


def test_the_promise_of_the_certificate_is_the_one_that_is_printed():
    assert f'"{PROMISE}"' in " ".join(README.split())


def test_every_picture_is_in_the_repository():
    for name in re.findall(r"!\[.*?\]\((.*?)\)", README):
        assert (ROOT / name).stat().st_size < 200_000


def test_the_architecture_names_every_folder():
    architecture = README.split("## Architecture")[1]
    for folder in sorted(path.parent.name for path in (ROOT / "sie").glob("*/__init__.py")):
        assert re.search(rf"\b{folder}/", architecture), (
            f"{folder} is not in the README's architecture"
        )
