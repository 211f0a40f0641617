"""Results that are computed when they are read first, and the log that says which and how long.

The log is Python's: `logging.getLogger("sie")` and its children say nothing unless a program gives
them a handler and a level, like `logging.basicConfig(level="DEBUG")`.
"""

from __future__ import annotations

import logging
import time
from typing import TYPE_CHECKING, Any

LOG = logging.getLogger("sie")
LOG.addHandler(logging.NullHandler())

if TYPE_CHECKING:
    from functools import cached_property

    stage = cached_property
else:
    from functools import cached_property

    class stage(cached_property):  # a function's name, as cached_property has it
        """A `functools.cached_property` whose first reading is logged."""

        def __get__(self, owner: Any, kind: type | None = None) -> Any:
            """The value, computed if it is not there yet."""
            if owner is None or not LOG.isEnabledFor(logging.DEBUG):
                return super().__get__(owner, kind)
            start = time.perf_counter()
            value = super().__get__(owner, kind)
            LOG.debug("%s: %.3g ms", self.attrname, 1e3 * (time.perf_counter() - start))
            return value
