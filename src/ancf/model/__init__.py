"""What the user describes: Model, Section, bodies, points, supports, loads, connections; no numerics."""

from .bodies.beam import Beam
from .bodies.rigid import PointMass, RigidBody
from .functions.function import TimeFunction
from .joints.basic import Fixation, Revolute, Slide, Spherical
from .joints.connections import Spring
from .joints.guides import Cylindrical, Planar, Prismatic
from .joints.rigid_joints import Guide, Universal, Weld
from .joints.torsion import TorsionSpring
from .keywords import guard
from .loads.load import DistributedLoad, Force, Moment
from .model import Model
from .points import Point
from .sections.section import Circle, Rectangle, Section
from .supports.support import Clamp, Hold, Pin
from .surfaces.contact import Contact
from .surroundings.gusts import Gusts
from .surroundings.waves import Waves

__all__ = [
    "Beam",
    "Circle",
    "Clamp",
    "Contact",
    "Cylindrical",
    "DistributedLoad",
    "Fixation",
    "Force",
    "Guide",
    "Gusts",
    "Hold",
    "Model",
    "Moment",
    "Pin",
    "Planar",
    "Point",
    "PointMass",
    "Prismatic",
    "Rectangle",
    "Revolute",
    "RigidBody",
    "Section",
    "Slide",
    "Spherical",
    "Spring",
    "TimeFunction",
    "TorsionSpring",
    "Universal",
    "Waves",
    "Weld",
]

# functions of time are called while a run goes on
guard(globals(), (name for name in __all__ if name != "TimeFunction"))
