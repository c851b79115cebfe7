"""What the user describes: Model, Section, bodies, points, supports, loads, connections; no numerics."""

from .beam import Beam
from .bodies import PointMass, RigidBody
from .connections import Spring
from .contact import Contact
from .functions import TimeFunction
from .guides import Cylindrical, Planar, Prismatic
from .gusts import Gusts
from .joints import Fixation, Revolute, Slide, Spherical
from .keywords import guard
from .loads import DistributedLoad, Force, Moment
from .model import Model
from .points import Point
from .rigid_joints import Guide, Universal, Weld
from .section import Circle, Rectangle, Section
from .supports import Clamp, Hold, Pin
from .torsion import TorsionSpring
from .waves import Waves

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
