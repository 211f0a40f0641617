"""The public names that a contact under its normal load does not need.

`import sie` does not import them; the first use of one of them imports this module.
"""

from .cauchy.equation import CauchyEquation
from .certificate.trace_noise import TraceReport
from .inverse.wanted_pressure import profile_for_pressure
from .many.solve_many import Many, solve_many
from .paths.dissimilar_cycle import steady_cycle
from .paths.history import History, follow
from .paths.steady_state import SteadyCycle
from .planning import Plan, plan
from .sensitivity.derivative import Derivative, StressDerivative
from .sensitivity.gradient import Uncertainty
from .stress.fatigue import CriticalPlane
from .stress.fretting import Cycle
from .stress.half_plane import Stress
from .stress.yield_limit import Peak, YieldPoint
from .sweeps.smoothing_search import least_smoothing
from .sweeps.sweep import Interrupted, sweep
from .sweeps.work import QUANTITIES

__all__ = [
    "QUANTITIES",
    "CauchyEquation",
    "CriticalPlane",
    "Cycle",
    "Derivative",
    "History",
    "Interrupted",
    "Many",
    "Peak",
    "Plan",
    "SteadyCycle",
    "Stress",
    "StressDerivative",
    "TraceReport",
    "Uncertainty",
    "YieldPoint",
    "follow",
    "least_smoothing",
    "plan",
    "profile_for_pressure",
    "solve_many",
    "steady_cycle",
    "sweep",
]
