"""The derivatives of a solution, as its methods."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from sie.profiles.base import Profile

if TYPE_CHECKING:  # imported where a derivative is asked for
    from sie.sensitivity.derivative import Derivative
    from sie.sensitivity.gradient import Uncertainty


class DerivativeAnswers:
    """What a solution answers about a small change of its scene."""

    def derivative(self, name: str | Profile) -> Derivative:
        """The derivative of every answer by one number of the scene, exact to rounding.

        Parameters
        ----------
        name : str or Profile
            A number that the scene gives: "normal_load" or "half_width", "tilt" or "moment",
            "friction", "tangential_load", "bulk_stress", "modulus", "poisson"; "young" and
            "poisson" of bodies of one material, else "body.young", "indenter.poisson" and their
            like; "profile." and a parameter, such as "profile.radius", "profile.coefficients[2]",
            "profile.pieces[1][0]", "profile.heights[40]" or "profile.profiles[1].rise". A profile
            g is the direction h + t g, at t = 0.

        Returns
        -------
        Derivative
            With the names of a solution: `.half_width`, `.edges`, `.tilt`, `.pressure(x)`,
            `.shear(x)`, `.stick`, `.stress(x, y)` and others.

        Raises
        ------
        ValueError
            For a name that is no number of the scene; the message lists those that are.
        ContactError
            For dissimilar bodies with friction, and where derivatives are one-sided: an edge at a
            corner, a patch that is born, two that merge, slip that begins.

        Examples
        --------
        >>> import sie
        >>> scene = sie.Scene(profile=sie.RoundedFlat(1.0, 1.0), modulus=1.0, normal_load=1.0)
        >>> round(sie.solve(scene).derivative("profile.radius").half_width, 10)
        0.5240149793
        """
        from sie.sensitivity.derivative import Derivative

        return Derivative(self, name)

    def gradient(self, quantity: str) -> dict[str, Any]:
        """The derivatives of one quantity by every number of the scene.

        Parameters
        ----------
        quantity : str
            "half_width", "centre", "left_edge", "right_edge", "contact_length", "normal_load",
            "moment", "tilt", "peak_pressure", "peak_tension", or "elastic_limit" (the load P/k).

        Returns
        -------
        dict
            Numbers by the names of `derivative`. Those of all heights of a trace are one array,
            "profile.heights": in one patch without smoothing at the cost of a solve (3 to 7 for
            the peak pressure; peaks of the stress take one for each height). A number by which the
            quantity has no derivative is left out.

        Raises
        ------
        ValueError, ContactError
            For another quantity, or one without a derivative by any number.

        Examples
        --------
        >>> import sie
        >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0)
        >>> round(sie.solve(scene).gradient("peak_pressure")["profile.radius"], 6)
        -0.282095
        """
        from sie.sensitivity.gradient import gradient

        return gradient(self, quantity)

    def uncertainty(self, deviations: Mapping[str, float]) -> Uncertainty:
        """The standard deviations of the answers, to first order in those of the scene's numbers.

        Parameters
        ----------
        deviations : mapping of str to float
            Standard deviations of independent numbers, by the names of `derivative`;
            "profile.heights" is the noise of all heights of a trace.

        Returns
        -------
        Uncertainty
            `.of(quantity)` and `.shares(quantity)`.

        Examples
        --------
        >>> import sie
        >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0)
        >>> spread = sie.solve(scene).uncertainty({"normal_load": 0.1})
        >>> round(spread.of("half_width"), 6)
        0.056419
        """
        from sie.sensitivity.gradient import Uncertainty

        return Uncertainty(self, deviations)
