"""What the package says when a question has no answer.

A bad question (a negative radius, a load of nan) is a `ValueError`, raised where the value is built. A good question
without an answer (a load that no single contact patch can carry) is a `ContactError`, raised by the stage that found out,
with whatever was reached until then in its attributes. Messages are sentences: what, how much, what to do.
"""

from __future__ import annotations

from typing import Any


class ContactError(Exception):
    """A well-posed contact question that has no answer within what the package covers.

    `reached` holds what is known at that point (edges, the largest load, the place of the violation ...), by name.
    """

    def __init__(self, message: str, **reached: Any) -> None:
        super().__init__(message)
        self.reached = reached

    def __reduce__(self) -> tuple[Any, ...]:
        # The default would lose `reached` on the way through a process pool.
        return (_rebuilt, (type(self), self.args[0], self.reached))


class LoadError(ContactError):
    """The profile cannot carry the load (or moment) in one patch of contact."""


class InequalityError(ContactError):
    """A single patch would need tension inside the contact (p < 0) or overlap outside it (gap < 0)."""


class ResolutionError(ContactError):
    """A function does not settle to the tolerance: noise, a singularity, or a break that was not declared."""


def _rebuilt(kind: type[ContactError], message: str, reached: dict[str, Any]) -> ContactError:
    return kind(message, **reached)
