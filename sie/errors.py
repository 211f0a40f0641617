"""Refusals of questions that have no answer.

A bad question (a negative radius, a load of nan) is a `ValueError`, raised where the value is
built. A good question without an answer (a load that no single contact can carry) is a
`ContactError`, raised by the stage that finds this out. Messages are sentences: what, how much,
what to do.
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
    >>> hollow = sie.Polynomial((0.0, 0.0, -1.0))    # rises nowhere
    >>> try:
    ...     sie.solve(sie.Scene(profile=hollow, modulus=1.0, normal_load=0.01)).edges
    ... except sie.ContactError as error:
    ...     print(type(error).__name__, error.reached)
    LoadError {'falls': 'left'}
    """

    def __init__(self, message: str, **reached: Any) -> None:
        super().__init__(message)
        self.reached = reached


class LoadError(ContactError):
    """The profile cannot carry the load or the moment in one contact.

    Notes
    -----
    `reached["load"]` is the largest load that it carries, where that is known; `reached["falls"]`
    is the side to which the profile has no lowest point.

    Examples
    --------
    >>> import sie
    >>> sie.solve(sie.Scene(profile=sie.Wedge(0.1), modulus=1.0, normal_load=1.0, tilt=0.2)).edges
    Traceback (most recent call last):
    sie.errors.LoadError: the profile falls without bound to the left: no lowest point, ...
    """


class InequalityError(ContactError):
    """One patch of dissimilar bodies that slide would need tension (p < 0) or overlap (gap < 0).

    Notes
    -----
    `reached` has the edges, and the intervals of the violation as `tension` or `overlap`.

    Examples
    --------
    >>> import sie
    >>> wells = sie.Polynomial((0.0, 0.0, -0.25, 0.0, 0.25))
    >>> sliding = {"dundurs": 0.2, "friction": 0.3, "sliding": 1}
    >>> try:
    ...     sie.solve(sie.Scene(profile=wells, modulus=1.0, normal_load=0.19, **sliding)).edges
    ... except sie.InequalityError as error:
    ...     print(len(error.reached["tension"]))
    1
    """


class ResolutionError(ContactError):
    """A function does not settle to the tolerance: noise, a singularity or an undeclared break.

    Notes
    -----
    `reached["x"]` is near the place where the function still changes.

    Examples
    --------
    >>> import sie
    >>> noisy = sie.FromFunction("x + 1e-3*sin(1e9*x)")
    >>> sie.solve(sie.Scene(profile=noisy, modulus=1.0, normal_load=1.0)).edges
    Traceback (most recent call last):
    sie.errors.ResolutionError: the slope does not settle: ...
    """
