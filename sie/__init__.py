"""Plane elastic contact as Cauchy singular integral equations.

One notation for the whole package, its messages and its plots:

    x, y        along the surface; depth into the half-plane, y >= 0
    h(x), H     gap between the undeformed indenter and the flat surface; its slope h'
    [x1, x2]    the contact; m its centre, r its half-width; w(x) = sqrt((x - x1)(x2 - x))
    p(x), q(x)  contact pressure, >= 0; shear traction, q > 0 pushes the half-plane in +x
    P, Q, M     ∫p dx, ∫q dx, ∫p x dx (about x = 0), per unit length
    E*, β       1/E* = (1-ν1²)/E1 + (1-ν2²)/E2; Dundurs' second constant
    F(z)        1/π ∫ p(t)/(z - t) dt, the Cauchy potential: Fp of the pressure, Fq of the shear
    σ_xx, J2    stress, tension positive: σ_yy = -p, σ_xy = -q on the surface; second invariant
                of its deviator
    k           yield stress in shear

    f, κ        Coulomb's coefficient of friction; q over p of a layer of the contact, |κ| <= f
    [c1, c2]    the stick zone; ρ its half-width; p̂ the corrective pressure there, q = ± f (p - p̂)
    g(x), σ, τ  relative slip of the indenter along +x; bulk stress, E*/2 times its strain

    (1)   E*/2 h'(x) = 1/π PV∫ p(ξ)/(x - ξ) dξ - β q(x)          in contact
    (12)  E*/2 g'(x) = 1/π PV∫ q(ξ)/(x - ξ) dξ - τ               at β = 0; g = 0 in stick zones

Units are free: any consistent set works, and nothing depends on scale.

>>> import sie
>>> punch = sie.RoundedFlat(half_flat=1.0, radius=50.0)
>>> steel = sie.Elastic(young=210e3, poisson=0.3)
>>> solution = sie.solve(sie.Scene(profile=punch, body=steel, normal_load=500.0))
>>> round(float(solution.pressure(0.0)), 3)
131.935
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .errors import ContactError, InequalityError, LoadError, ResolutionError
from .problem.load_path import Path
from .problem.material import RIGID, Elastic
from .problem.scene import Scene
from .profiles.base import Profile
from .profiles.from_function import FromFunction
from .profiles.polynomials import Piecewise, Polynomial
from .profiles.row import Periodic, Row
from .profiles.sampled import Sampled
from .profiles.shapes import Flat, Parabola, Power, RoundedFlat, Wedge
from .traction.base import Density
from .traction.combination import ZERO, scaled, superposed

if TYPE_CHECKING:
    from .later import *  # noqa: F403
    from .solution import Solution, solve

__version__ = "0.3.0.dev0"

__all__ = [
    "QUANTITIES",
    "RIGID",
    "ZERO",
    "CauchyEquation",
    "ContactError",
    "CriticalPlane",
    "Cycle",
    "Density",
    "Derivative",
    "EdgeCrack",
    "EdgeIntensity",
    "Elastic",
    "Flat",
    "FromFunction",
    "History",
    "InequalityError",
    "Interrupted",
    "LoadError",
    "Many",
    "Parabola",
    "Path",
    "Peak",
    "Periodic",
    "Piecewise",
    "Plan",
    "Polynomial",
    "Power",
    "Profile",
    "ResolutionError",
    "Rolling",
    "RoundedFlat",
    "Row",
    "Sampled",
    "Scene",
    "Solution",
    "SteadyCycle",
    "Stress",
    "StressDerivative",
    "StressIntensity",
    "TraceReport",
    "Uncertainty",
    "WearLimit",
    "WearModes",
    "Wedge",
    "YieldPoint",
    "follow",
    "plan",
    "profile_for_pressure",
    "rolling",
    "scaled",
    "solve",
    "solve_many",
    "steady_cycle",
    "superposed",
    "sweep",
    "wear_limit",
    "wear_modes",
]


PARTS = {
    "adapters": "sie.sensitivity.adapters",
    "charts": "sie.sweeps.charts",
    "teaching": "sie.live.teaching",
    "plots": "sie.plots",
}


def __getattr__(name: str) -> Any:
    """What a scene does not need, imported when it is asked for.

    Of the public modules `sie.plots` needs Matplotlib.
    """
    if name in PARTS:
        return import_module(PARTS[name])
    if name in ("Solution", "solve"):
        from . import solution

        return getattr(solution, name)
    if name in __all__:
        from . import later

        return getattr(later, name)
    raise AttributeError(f"module 'sie' has no attribute {name!r}")
