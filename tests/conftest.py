"""How hard hypothesis tries: "default" in minutes for the whole of the tests, "deep" for a long run
by hand.

HYPOTHESIS_PROFILE=deep pytest tests       or       pytest --hypothesis-profile=deep tests

The examples are new in every run, in continuous integration too: what holds for the same examples
only is no law. A failure prints what reproduces it (--hypothesis-seed, and a blob for its example).
"""

import os

from hypothesis import HealthCheck, Phase, settings

COMMON = {
    "deadline": None,
    "suppress_health_check": [HealthCheck.too_slow],
    "derandomize": False,
    "print_blob": True,
}

# Shrinking a contact can take minutes; the example found is small enough to read
QUICK = (Phase.explicit, Phase.reuse, Phase.generate)

settings.register_profile("default", max_examples=30, phases=QUICK, **COMMON)
settings.register_profile("deep", max_examples=2000, **COMMON)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "default"))
