"""Refusals of questions that have no answer.

A bad question (a negative radius, a load of nan) is a `ValueError`, raised where the value is
built. A good question without an answer (a load that no single contact can carry) is a
`ContactError`, raised by the stage that notices it. Messages are sentences: what, how much, what
to do.
"""

from __future__ import annotations

from typing import Any


class ContactError(Exception):
    """A well-posed contact problem has no answer within what the package covers.

    Parameters
    ----------
    message : str
        What, how much, and what to do.
    **reached : Any
        What is known when the problem is refused, by name.

    Attributes
    ----------
    reached : dict
        The same: edges, the largest load that can be carried, the place of a violation, ...

    Examples
    --------
    >>> import sie
    >>> wavy = sie.Polynomial((0.0, 0.0, -1.0, 0.0, 1.0))    # two lowest points
    >>> try:
    ...     sie.solve(sie.Scene(profile=wavy, modulus=1.0, normal_load=0.01)).edges
    ... except sie.ContactError as error:
    ...     print(type(error).__name__, error.reached)
    LoadError {'load': 0.0}
    """

    def __init__(self, message: str, **reached: Any) -> None:
        super().__init__(message)
        self.reached = reached

    def __reduce__(self) -> tuple[Any, ...]:
        # The default would lose `reached` on the way through a process pool.
        return (_rebuilt, (type(self), self.args[0], self.reached))


class LoadError(ContactError):
    """The profile cannot carry the load or the moment in one contact."""


class InequalityError(ContactError):
    """One contact would need tension inside it (p < 0) or overlap outside it (gap < 0)."""


class ResolutionError(ContactError):
    """A function does not settle to the tolerance: noise, a singularity or an undeclared break."""


def _rebuilt(kind: type[ContactError], message: str, reached: dict[str, Any]) -> ContactError:
    return kind(message, **reached)
