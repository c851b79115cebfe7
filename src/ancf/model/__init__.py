"""What the user describes: Model, Section, bodies, points, supports, loads, connections; no numerics."""

from ancf.model.beam import Beam
from ancf.model.bodies import PointMass, RigidBody
from ancf.model.connections import Spring
from ancf.model.contact import Contact
from ancf.model.functions import TimeFunction
from ancf.model.joints import Fixation, Revolute, Slide, Spherical
from ancf.model.loads import DistributedLoad, Force, Moment
from ancf.model.model import Model
from ancf.model.points import Point
from ancf.model.section import Circle, Rectangle, Section
from ancf.model.supports import Clamp, Hold, Pin

__all__ = [
    "Beam",
    "Circle",
    "Clamp",
    "Contact",
    "DistributedLoad",
    "Fixation",
    "Force",
    "Hold",
    "Model",
    "Moment",
    "Pin",
    "Point",
    "PointMass",
    "Rectangle",
    "Revolute",
    "RigidBody",
    "Section",
    "Slide",
    "Spherical",
    "Spring",
    "TimeFunction",
]
