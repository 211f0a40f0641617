"""What runs, and how hard hypothesis tries: "default" in two minutes for the whole of the tests,
"many" and "deep" for longer runs by hand.

`python -m pytest` leaves out what is marked slow, `python -m pytest -m ""` runs everything. The
first cases of a slow test with many, `@pytest.mark.slow(but=2)`, are its fast siblings.

HYPOTHESIS_PROFILE=deep pytest tests       or       pytest --hypothesis-profile=deep tests

The examples are new in every run, in continuous integration too: what holds for the same examples
only is no law. A failure prints what reproduces it (--hypothesis-seed, and a blob for its example).
"""

import os
from collections import Counter

import pytest
from hypothesis import HealthCheck, Phase, settings

# Before NumPy is imported: each worker of pytest-xdist has a core of its own, and threads of linear
# algebra that wait for each other took it from the others, up to a hundred times as long.
for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(threads, "1")

COMMON = {
    "deadline": None,
    "suppress_health_check": [HealthCheck.too_slow],
    "derandomize": False,
    "print_blob": True,
}

# Shrinking a contact can take minutes; the example found is small enough to read
QUICK = (Phase.explicit, Phase.reuse, Phase.generate)

settings.register_profile("default", max_examples=10, phases=QUICK, **COMMON)
settings.register_profile("many", max_examples=40, phases=QUICK, **COMMON)
settings.register_profile("deep", max_examples=2000, **COMMON)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "default"))


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """The first cases of a slow test lose the mark, before pytest selects by marks."""
    cases = Counter()
    for item in items:
        mark = item.get_closest_marker("slow")
        if mark is None:
            continue
        name = item.nodeid.partition("[")[0]
        cases[name] += 1
        if cases[name] <= mark.kwargs.get("but", 0):
            item.own_markers = [m for m in item.own_markers if m.name != "slow"]
            item.keywords = {k: v for k, v in item.keywords.items() if k != "slow"}
