"""A claim of the validation, for its tests."""

from typing import Any

from validation.harness.records import Claim


def claim(measured: float, control: float, **given: Any) -> Claim:
    return Claim("what", "who", measured, control, "wrong", **({"high": 1.0} | given))
