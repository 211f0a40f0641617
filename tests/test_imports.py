"""Imports point downward, solver and closed forms share nothing, heavy packages wait."""

import ast
import functools
import graphlib
import subprocess
import sys
from pathlib import Path

import pytest

import analytic
import oracles
import sie
from sie.io import scene_file

HOUSES = {house.__name__: Path(house.__file__).parent for house in (sie, analytic, oracles)}
# What a house is measured by, or measures, shares no code with it.
APART = {
    "sie": {"analytic", "oracles", "validation"},
    "analytic": {"sie", "oracles", "validation", "mpmath", "scipy"},
    "oracles": {"sie", "analytic", "validation"},
}

# From the ground up: a folder or a module at the top imports only from its own row and from rows
# before it.
LAYERS = (
    ("inheritance", "errors", "files", "arguments", "progress_bar"),
    ("numerics",),
    ("profiles",),
    ("problem", "traction"),
    ("contact", "stress", "cauchy"),
    ("cracks",),
    ("friction",),
    ("patches",),
    ("certificate",),
    ("planning",),
    ("answers",),
    ("solution",),
    ("paths", "wear"),
    ("sensitivity", "many", "inverse"),
    ("sweeps",),
    ("later",),
    ("io",),
    ("plots", "live"),
    ("cli", "__main__"),
)


# Methods that stand where users look for them and hand their work to a module above, which they
# import when they are called.
HANDED_UP = {
    ("sie.paths.history", "sie.plots.one_axes"),
    ("sie.problem.scene", "sie.io.scene_tables"),
    ("sie.profiles.indenter", "sie.profiles.pieces"),
    ("sie.io.benchmark_set", "sie.plots.contact_plot"),
    ("sie.io.benchmark_set", "sie.plots.style"),
    ("sie.answers.derivatives", "sie.sensitivity.derivative"),
    ("sie.answers.derivatives", "sie.sensitivity.gradient"),
    ("sie.sensitivity.derivative", "sie.io.sample_points"),
    ("sie.answers.body", "sie.io.boundary_data"),
    ("sie.solution", "sie.plots.contact_plot"),
    ("sie.solution", "sie.plots.one_axes"),
    ("sie.stress.fretting", "sie.cracks.stress_intensity"),
    ("sie.cracks.stress_intensity", "sie.plots.one_axes"),
}


def modules(house):
    return sorted(HOUSES[house].rglob("*.py"))


def imported(path):
    """(names of modules, line) of every import in a file, functions included."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from ((alias.name, node.lineno) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            package = "." * node.level + (node.module or "")
            dot = "." if node.module else ""
            yield from ((package + dot + alias.name, node.lineno) for alias in node.names)


@pytest.mark.parametrize("house", HOUSES)
def test_houses_share_no_code_and_change_no_settings(house):
    """Pure functions: a context like errstate is local, what is forbidden here is not."""
    forbidden = ("np.seterr(", "numpy.seterr(", "filterwarnings(", "mp.dps =", "mp.prec =")
    for path in modules(house):
        for name, line in imported(path):
            assert name.split(".")[0] not in APART[house], f"{path.name}:{line}"
        text = path.read_text(encoding="utf-8") if house != "oracles" else ""  # of own contexts
        assert not [word for word in forbidden if word in text], path.name


KNOWN = {
    ".".join(path.relative_to(HOUSES["sie"].parent).with_suffix("").parts).removesuffix(".__init__")
    for path in modules("sie")
}


def parts(name):
    """The layer of a module of the solver, by its full name."""
    return name.split(".")[1] if "." in name else ""


def dependencies():
    """Every import in the solver but those from a method to a module above."""
    return (one for one in every_dependency() if one[:2] not in HANDED_UP)


def every_dependency():
    """(importing module, imported module, line) in the solver, but for those of `sie` itself."""
    for path in modules("sie"):
        inside = path.relative_to(HOUSES["sie"].parent).with_suffix("").parts
        package = list(inside[:-1])
        for name, line in imported(path):
            dots = len(name) - len(name.lstrip("."))
            full = (
                ".".join([*package[: len(package) - dots + 1], name.lstrip(".")]) if dots else name
            )
            while full not in KNOWN and "." in full:
                full = full.rpartition(".")[0]  # a name that a module defines
            if full.startswith("sie.") and inside != ("sie", "__init__"):
                yield ".".join(inside).removesuffix(".__init__"), full, line


@pytest.mark.slow
def test_an_import_in_the_solver_points_only_downward():
    level = {name: k for k, row in enumerate(LAYERS) for name in row}
    for module, target, line in dependencies():
        assert level[parts(target)] <= level[parts(module)], f"{module}:{line} imports {target}"


@pytest.mark.slow
def test_no_module_of_the_solver_imports_itself_by_way_of_others():
    """Not for an annotation either, nor in a method that hands its work up."""
    below = {}
    for module, target, _ in every_dependency():
        below.setdefault(module, set()).add(target)
    graph = graphlib.TopologicalSorter(below)
    graph.prepare()


@pytest.mark.slow
def test_every_import_that_is_listed_as_upward_is_made():
    assert {(module, target) for module, target, _ in every_dependency()} >= HANDED_UP


def for_annotations(module):
    """The lines of a module's imports that only type checkers run."""
    path = HOUSES["sie"].parent.joinpath(*module.split("."))
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    return {
        inner.lineno
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        for inner in node.body
    }


def deepest_chain():
    """The longest chain of imports in the solver, top first."""
    below = {}
    annotations = functools.cache(for_annotations)
    for module, target, line in dependencies():
        if line not in annotations(module):
            below.setdefault(module, set()).add(target)

    @functools.cache
    def chain(module):
        return (module, *max(map(chain, sorted(below.get(module, ()))), key=len, default=()))

    return max(map(chain, sorted(below)), key=len)


@pytest.mark.slow
def test_the_imports_of_the_solver_have_at_most_thirteen_levels():
    chain = deepest_chain()
    assert len(chain) <= 13, " > ".join(chain)


def needed_by(module):
    """The modules that a module imports, directly or by way of others."""
    below = {}
    for name, target, _ in dependencies():
        below.setdefault(name, set()).add(target)
    found, left = set(), [module]
    while left:
        new = below.get(left.pop(), set()) - found
        found |= new
        left += new
    return found


@pytest.mark.slow
def test_reading_a_scene_file_imports_no_module_of_the_solver():
    """The names of the imports are followed, as `import sie` itself loads the whole package."""
    needed = needed_by("sie.io.scene_file")
    assert "sie.problem.scene" in needed
    solver = {"cauchy", "certificate", "contact", "friction", "plan", "solution", "stress"}
    assert not {name for name in needed if parts(name) in solver}


def modules_after(statement):
    code = f"import sys; {statement}; print(*sys.modules)"
    command = [sys.executable, "-c", code]
    return set(subprocess.run(command, capture_output=True, text=True, check=True).stdout.split())


SCENE = "sie.Scene(profile=sie.RoundedFlat(1.0, 2.0), modulus=1.0, normal_load=1.0)"


@pytest.mark.parametrize(
    "statement",
    [f"import sie; sie.solve({SCENE}).check()", "import analytic"],
    ids=["a normal contact", "the closed forms"],
)
def test_numpy_is_all_that_is_loaded(statement):
    heavy = {"mpmath", "matplotlib", "scipy", "sie", "analytic"} - {statement.split()[1].strip(";")}
    assert not modules_after(statement) & heavy


UNNEEDED = {"cauchy", "friction", "live", "paths", "plots", "sweeps"}
OF_CERTIFICATES = {"", ".panels", ".result", ".rule"}  # of patches: their sums and measures


@pytest.mark.slow
def test_a_contact_without_friction_imports_what_it_needs(tmp_path):
    """Of the command too: no friction, no patches, no report that it does not write."""
    loaded = {m for m in modules_after("import sie") if m.startswith("sie.")}
    unneeded = {
        *UNNEEDED,
        "answers",
        "certificate",
        "contact",
        "io",
        "patches",
        "solution",
        "stress",
    }
    assert not {parts(m) for m in loaded} & unneeded
    scene = tmp_path / "scene.toml"
    scene.write_text(scene_file.example("rounded-flat"))
    loaded = modules_after(f"from sie.cli import main; main(['solve', {str(scene)!r}, '--quiet'])")
    assert not {parts(m) for m in loaded if m.startswith("sie.")} & {*UNNEEDED, "cracks", "stress"}
    of_patches = {m for m in loaded if m.startswith("sie.patches")}
    assert of_patches <= {f"sie.patches{name}" for name in OF_CERTIFICATES}
    assert "sie.io.export" not in loaded and "sie.io.mesh_result" not in loaded


def test_every_public_name_is_there_and_documented():
    for name in sie.__all__:
        value = getattr(sie, name)
        if callable(value):
            assert (value.__doc__ or "").strip(), name
