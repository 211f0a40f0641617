"""What is released agrees with the package: its data, the conda-forge recipe, the paper."""

import re
import tomllib
from pathlib import Path

import pytest
import yaml

import sie

ROOT = Path(__file__).parent.parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
RECIPE = yaml.safe_load((ROOT / "packaging/conda-forge/recipe.yaml").read_text(encoding="utf-8"))
PAPER = (ROOT / "paper" / "paper.md").read_text(encoding="utf-8")
REFERENCES = (ROOT / "paper" / "paper.bib").read_text(encoding="utf-8")
CONDA_NAMES = {"matplotlib": "matplotlib-base"}


def conda(requirements):
    """Requirements as conda writes them, without that of Python."""
    split = (re.fullmatch(r"([\w-]+)(.*)", text).groups() for text in requirements)
    return sorted(f"{CONDA_NAMES.get(name, name)} {bound}" for name, bound in split)


def without_python(requirements):
    return sorted(text for text in requirements if not text.startswith("python "))


@pytest.mark.parametrize("package", ["sie", "analytic"])
def test_every_file_that_a_package_reads_is_in_its_data(package):
    patterns = PROJECT["tool"]["setuptools"]["package-data"]
    listed = {
        path
        for name, globs in patterns.items()
        for glob in globs
        for path in ROOT.joinpath(*name.split(".")).glob(glob)
    }
    files = {path for path in (ROOT / package).rglob("*") if path.is_file()}
    assert {path for path in files if path.suffix not in {".py", ".pyc"}} <= listed


def test_the_source_distribution_has_what_the_recipe_tests():
    rules = (ROOT / "MANIFEST.in").read_text(encoding="utf-8").split()
    always = ["MANIFEST.in", "README.md", "pyproject.toml"]
    for name in RECIPE["tests"][1]["files"]["source"]:
        assert (ROOT / name).exists()
        assert name.rstrip("/") in [*rules, *always]


def test_the_recipe_the_citation_and_the_changelog_have_the_version_of_the_package():
    assert RECIPE["context"]["version"] == sie.__version__
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["version"] == sie.__version__
    first = re.search("^## (.+)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.M)
    release, _, unreleased = sie.__version__.partition(".dev")
    assert first[1] == (f"Unreleased ({release})" if unreleased else release)


def test_the_recipe_has_the_requirements_and_the_commands_of_the_package():
    project, recipe = PROJECT["project"], RECIPE["requirements"]
    assert project["requires-python"] == f">={RECIPE['context']['python_min']}"
    assert without_python(recipe["run"]) == conda(project["dependencies"])
    assert set(conda(PROJECT["build-system"]["requires"])) <= set(recipe["host"])
    tested = without_python(RECIPE["tests"][1]["requirements"]["run"])
    assert tested == conda(project["optional-dependencies"]["test"])
    scripts = [f"{name} = {place}" for name, place in project["scripts"].items()]
    assert RECIPE["build"]["python"]["entry_points"] == scripts


def test_the_paper_cites_what_it_lists_and_lists_what_it_cites():
    _, _, text = PAPER.split("---\n", 2)
    cited = set(re.findall(r"@(\w+)", text))
    assert cited == set(re.findall(r"@\w+\{(\w+),", REFERENCES))


def test_the_numbers_of_the_paper_are_those_of_the_validation():
    def rows(text):
        lines = [line for line in text.splitlines() if re.match(r"\|.*\d\.\de[+-]\d\d", line)]
        return [re.split(r"(?<!\\)\|", line)[1:5] for line in lines]

    measured = rows((ROOT / "docs" / "validation.md").read_text(encoding="utf-8"))
    assert len(measured) > 0
    assert rows(PAPER) == measured
