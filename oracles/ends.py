"""The centre and the half-width of a contact between two ends, in any kind of number."""

from __future__ import annotations

from functools import cached_property
from typing import Any


class Between:
    """What has the ends x1 and x2."""

    x1: Any
    x2: Any

    @cached_property
    def m(self) -> Any:
        return (self.x1 + self.x2) / 2

    @cached_property
    def r(self) -> Any:
        return (self.x2 - self.x1) / 2
