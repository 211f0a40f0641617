"""The mark of a method that means what the one that it overrides means, as of Python 3.12.

Such a method has no docstring of its own: help() shows the inherited one, with all its sections.
"""

from typing import TYPE_CHECKING

__all__ = ["override"]

if TYPE_CHECKING:
    from typing_extensions import override  # every type checker brings this
else:

    def override(method):
        """The method itself; type checkers verify that there is one to override."""
        return method
