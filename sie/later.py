"""The public names that a contact under its normal load does not need.

`import sie` does not import them; the first use of one of them imports this module.
"""

from .cauchy.equation import CauchyEquation
from .certificate.trace_noise import TraceReport
from .cracks.edge_crack import EdgeCrack
from .cracks.edge_intensity import EdgeIntensity
from .cracks.stress_intensity import StressIntensity
from .inverse.wanted_pressure import profile_for_pressure
from .many.solve_many import Many, solve_many
from .paths.dissimilar_cycle import steady_cycle
from .paths.history import History, follow
from .paths.rolling import Rolling, rolling
from .paths.steady_state import SteadyCycle
from .planning import Plan, plan
from .sensitivity.derivative import Derivative, StressDerivative
from .sensitivity.gradient import Uncertainty
from .stress.fatigue import CriticalPlane
from .stress.fretting import Cycle
from .stress.half_plane import Stress
from .stress.yield_limit import Peak, YieldPoint
from .sweeps.sweep import Interrupted, sweep
from .sweeps.work import QUANTITIES
from .wear.limit import WearLimit, wear_limit
from .wear.modes import WearModes, wear_modes

__all__ = [
    "QUANTITIES",
    "CauchyEquation",
    "CriticalPlane",
    "Cycle",
    "Derivative",
    "EdgeCrack",
    "EdgeIntensity",
    "History",
    "Interrupted",
    "Many",
    "Peak",
    "Plan",
    "Rolling",
    "SteadyCycle",
    "Stress",
    "StressDerivative",
    "StressIntensity",
    "TraceReport",
    "Uncertainty",
    "WearLimit",
    "WearModes",
    "YieldPoint",
    "follow",
    "plan",
    "profile_for_pressure",
    "rolling",
    "solve_many",
    "steady_cycle",
    "sweep",
    "wear_limit",
    "wear_modes",
]
