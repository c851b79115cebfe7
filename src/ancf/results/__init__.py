"""What a run computed: states, histories, energies, counters, and the file that holds them."""

from ..model.keywords import guard
from ..solvers.record import Progress, Stats
from .modes import DampedModes, Modes
from .result import Result
from .sensors import Sensors
from .state import Energy, State

__all__ = ["DampedModes", "Energy", "Modes", "Progress", "Result", "Sensors", "State", "Stats"]

# Sensors, which steppers have too, are asked in each step
guard(globals(), ("DampedModes", "Modes", "Result", "State"))
