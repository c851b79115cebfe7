"""Forms in which the constraints enter a time step, one file each."""

from .base import Formulation
from .ggl import GGL
from .index1 import Index1
from .index2 import Index2
from .index3 import Index3

#: The formulations by the name that an integrator and a model file use.
FORMULATIONS: dict[str, type[Formulation]] = {f.name: f for f in (Index1, Index2, GGL, Index3)}

__all__ = ["FORMULATIONS", "GGL", "Formulation", "Index1", "Index2", "Index3"]
