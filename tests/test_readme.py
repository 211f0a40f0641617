"""The README is true: its snippets run, its commands, its picture and its table exist."""

import re
import tomllib
from pathlib import Path

from sie.certificate.result import PROMISE

ROOT = Path(__file__).parent.parent
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
