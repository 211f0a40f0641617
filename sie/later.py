"""The public names that the scene of a contact, and its solution, do not need.

`import sie` does not import them; the first use of one of them imports this module.
"""

from .cauchy.equation import CauchyEquation as CauchyEquation
from .certificate.trace_noise import TraceReport as TraceReport
from .cracks.edge_crack import EdgeCrack as EdgeCrack
from .cracks.edge_intensity import EdgeIntensity as EdgeIntensity
from .cracks.stress_intensity import StressIntensity as StressIntensity
from .inverse.wanted_pressure import profile_for_pressure as profile_for_pressure
from .many.solve_many import Many as Many
from .many.solve_many import solve_many as solve_many
from .paths.dissimilar_cycle import steady_cycle as steady_cycle
from .paths.history import History as History
from .paths.history import follow as follow
from .paths.rolling import Rolling as Rolling
from .paths.rolling import rolling as rolling
from .paths.steady_state import SteadyCycle as SteadyCycle
from .planning import Plan as Plan
from .planning import plan as plan
from .sensitivity.derivative import Derivative as Derivative
from .sensitivity.derivative import StressDerivative as StressDerivative
from .sensitivity.gradient import Uncertainty as Uncertainty
from .stress.fatigue import CriticalPlane as CriticalPlane
from .stress.fretting import Cycle as Cycle
from .stress.half_plane import Stress as Stress
from .stress.yield_limit import Peak as Peak
from .stress.yield_limit import YieldPoint as YieldPoint
from .sweeps.sweep import Interrupted as Interrupted
from .sweeps.sweep import sweep as sweep
from .sweeps.work import QUANTITIES as QUANTITIES
from .wear.limit import WearLimit as WearLimit
from .wear.limit import wear_limit as wear_limit
from .wear.modes import WearModes as WearModes
from .wear.modes import wear_modes as wear_modes
