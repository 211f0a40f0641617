"""The site's build: `make -C docs html`, without a request to another machine."""

import re
import subprocess
import sys
from pathlib import Path
from subprocess import DEVNULL
from types import MappingProxyType

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.util.docutils import SphinxDirective

sys.path.insert(0, str(Path(__file__).parent))  # for draw_sketches

import draw_sketches

import sie
from sie.live.answer import saved_answers
from sie.live.page import saved

project = "plane-contact"
author = "the plane-contact authors"
copyright = "2026, the plane-contact authors"
release = version = sie.__version__

extensions = [
    "myst_nb",
    "numpydoc",
    "sphinx_design",
    "sphinx-mathjax-offline",
    "sphinx.ext.autosummary",
    "sphinx.ext.viewcode",
    "sphinx_gallery.gen_gallery",
]
exclude_patterns = [
    "_build",
    "gallery/**",
    "built-gallery/**/*.ipynb",
    "built-gallery/**/*.py",
]
root_doc = "index"
nitpicky = False

myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_in_temp = True
nb_execution_timeout = 120
nb_merge_streams = True
mathjax3_config = {"chtml": {"scale": 0.9}}

autosummary_generate = True
numpydoc_show_class_members = False

sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "built-gallery",
    "filename_pattern": "/plot_",
    "abort_on_example_error": True,
    "show_memory": False,
    "write_computation_times": False,
    "min_reported_time": 1.0,
    "within_subsection_order": "FileNameSortKey",
}

html_theme = "pydata_sphinx_theme"
html_title = "plane-contact"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
# A page without pages below it has no bar for them; the landing page has none at all.
ALONE = (
    "index",
    "tutorial",
    "lesson-1",
    "lesson-1-sheet",
    "lesson-1-key",
    "validation",
    "accuracy",
)
html_sidebars = {page: [] for page in (*ALONE, "not-covered", "bibliography")}
html_theme_options = {
    "secondary_sidebar_items": {"**": ["page-toc"], "index": [], "lesson-1-sheet": []},
    "header_links_before_dropdown": 8,
    "show_prev_next": True,
    "navbar_align": "left",
    "show_toc_level": 2,
    "navigation_with_keys": False,
    "use_edit_page_button": False,
    "footer_start": ["copyright"],
    "footer_end": [],
}


SKETCHES = Path(__file__).parent / "_static" / "sketches"


class Sketch(SphinxDirective):
    """A drawing of draw_sketches.py with its caption, light or dark as the page is."""

    required_arguments = 1
    option_spec = MappingProxyType({"alt": directives.unchanged_required})
    has_content = True

    def run(self):
        up = "../" * self.env.docname.count("/")
        drawn = nodes.container()  # the theme hides a caption beside an image of the other theme
        for theme in draw_sketches.THEMES:
            uri = f"{up}_static/sketches/{self.arguments[0]}-{theme}.svg"
            drawn += nodes.image(uri=uri, alt=self.options["alt"], classes=[f"only-{theme}"])
        caption = nodes.caption()
        caption += self.parse_inline(" ".join(self.content))[0]
        return [nodes.figure("", drawn, caption, classes=["sketch"])]


SECTION = re.compile(r"-{3,}$")
LISTS = {"Parameters", "Returns", "Yields", "Raises", "Attributes", "See Also", "References"}


def _as_restructured_text(*event):
    """Docstrings are plain text to be read in a terminal: |x| is no substitution, and an indented
    block after a blank line is set as it stands.
    """
    lines = event[-1]
    out, section, margin = [], "", 0
    for k, line in enumerate(lines):
        text = line.replace("|", r"\|")
        if k and SECTION.match(line.strip()):
            section = lines[k - 1].strip()
        indent = len(line) - len(line.lstrip())
        begins = line.strip() and k and not lines[k - 1].strip() and indent > margin
        if begins and section not in LISTS and not line.lstrip().startswith((">>>", "- ")):
            out += ["::", ""]
            margin = indent
        if line.strip() and indent < margin:
            margin = 0
        out.append(line if margin else text)
    lines[:] = out


NUMBER = re.compile(r"[-+−]?[\d.]+(e[-+]?\d+)?( \D{1,4})?")


def _mark_numbers(app, doctree):
    """The cells of tables that hold a number alone get the class `number`."""
    for entry in doctree.findall(nodes.entry):
        if NUMBER.fullmatch(entry.astext().strip()):
            entry["classes"].append("number")


def _describe_pictures(app, doctree):
    """A picture that a cell draws is described by the first sentence before it."""
    said = ""
    for node in doctree.findall(lambda node: isinstance(node, nodes.paragraph | nodes.image)):
        if isinstance(node, nodes.paragraph):
            said = node.astext()
        elif not node.get("alt"):
            node["alt"] = re.split(r"(?<=[.:?]) ", " ".join(said.split()))[0]


def _save_live_page(app, failure):
    """The page of `sie live` with its answers inside, beside the site's own pages."""
    if failure is None and app.builder.name == "html":
        text = saved(saved_answers())
        (Path(app.outdir) / "live.html").write_text(text, encoding="utf-8")


def _validate(app, failure):
    """The report of a quick validation, which the page on validation links to.

    A claim that fails stands in it, and fails the build: counts decide, never a clock.
    """
    if failure is None and app.builder.name == "html":
        out = Path(app.outdir) / "validation"
        command = [sys.executable, "-m", "validation", "--quick", "--out", str(out)]
        subprocess.run(command, cwd=Path(__file__).parent.parent, stdout=DEVNULL, check=True)


def setup(app):
    draw_sketches.draw_all(SKETCHES)
    app.add_directive("sketch", Sketch)
    app.connect("doctree-read", _mark_numbers)
    app.connect("doctree-read", _describe_pictures)
    app.connect("build-finished", _save_live_page)
    app.connect("build-finished", _validate)
    app.connect("autodoc-process-docstring", _as_restructured_text, priority=100)
