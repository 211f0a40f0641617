"""What depends on what: imports point downward, the solver and the closed forms know nothing of each other, heavy packages wait."""

import ast
import json
import subprocess
import sys
from pathlib import Path

import pytest

import analytic
import sie

HOUSES = {"sie": Path(sie.__file__).parent, "analytic": Path(analytic.__file__).parent}

# From the ground up: a module imports only from those before it.
ORDER = (
    "quiet", "errors", "interval", "power_law", "checks", "files", "entries",
    "expression", "chebyshev", "lerch", "slope", "touch", "adaptive", "unseen", "geometry", "moments",
    "summation", "batched", "batched_plane", "panels", "density", "potential", "slope_density", "validity", "superposition",
    "jacobi", "grading", "jacobi_density", "roundoff", "question", "kernel", "transform", "system", "collocation", "equation", "sliding",
    "material", "profile", "smoothing", "traces", "fits", "sampled", "indenters", "scene", "polish", "edges", "widest",
    "smooth", "normal", "noise", "ladder", "growth", "gap", "composite",
    "check", "bonded", "zones", "narrow", "shear", "states", "slip", "slipcheck", "field", "maxima", "strength", "plan",
    "solution", "remedy", "path", "history", "fretting", "charts", "workers", "sweep",
    "abscissae", "scenefile", "compare", "grid",
    "export", "summary", "plot", "contours", "overlay", "__main__",
)  # fmt: skip


def modules(house):
    return sorted(HOUSES[house].rglob("*.py"))


def imported(path):
    """(names of modules, line) of every import in a file, functions included."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from ((alias.name, node.lineno) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            if node.level and node.module is None:
                yield from (("." + alias.name, node.lineno) for alias in node.names)
            else:
                yield "." * node.level + (node.module or ""), node.lineno


@pytest.mark.parametrize(("house", "other"), [("sie", "analytic"), ("analytic", "sie")])
def test_the_solver_and_the_closed_forms_share_no_code(house, other):
    for path in modules(house):
        for name, line in imported(path):
            assert name.split(".")[0] != other, f"{path.name}:{line}"


def test_within_the_solver_an_import_points_only_downward():
    for path in modules("sie"):
        module = path.relative_to(HOUSES["sie"]).with_suffix("").parts[0]
        if module == "__init__":
            continue
        assert module in ORDER, f"{module} has no place in the order of the house"
        for name, line in imported(path):
            target = name.removeprefix("sie.").removeprefix(".").split(".")[0] if name.startswith((".", "sie.")) else None
            if target and target != "__version__":
                assert ORDER.index(target) < ORDER.index(module), f"{path.name}:{line} imports {target}"


def loaded_after(statement):
    code = f"import sys; {statement}; import json; print(json.dumps(sorted({{m.split('.')[0] for m in sys.modules}})))"
    return set(json.loads(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout))


def test_importing_the_solver_loads_neither_mpmath_nor_matplotlib_nor_scipy():
    assert not loaded_after("import sie") & {"mpmath", "matplotlib", "scipy", "analytic"}


def test_a_normal_contact_needs_numpy_only():
    solve = "sie.solve(sie.Scene(profile=sie.RoundedFlat(1.0, 2.0), modulus=1.0, normal_load=1.0)).check()"
    assert not loaded_after(f"import sie; {solve}") & {"mpmath", "matplotlib", "scipy", "analytic"}


def test_importing_the_closed_forms_loads_neither_mpmath_nor_the_solver():
    assert not loaded_after("import analytic") & {"mpmath", "matplotlib", "scipy", "sie"}


def test_every_public_name_is_there_and_documented():
    for name in sie.__all__:
        value = getattr(sie, name)
        if callable(value):
            assert (value.__doc__ or "").strip(), name


@pytest.mark.parametrize("house", HOUSES)
def test_no_module_changes_settings_of_numpy_warnings_or_mpmath(house):
    """Pure functions: a context like errstate is local, these are not."""
    forbidden = ("np.seterr(", "numpy.seterr(", "filterwarnings(", "mp.dps =", "mp.prec =")
    for path in modules(house):
        text = path.read_text(encoding="utf-8")
        for word in forbidden:
            assert word not in text, f"{path.name}: {word}"
