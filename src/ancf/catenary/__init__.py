"""Overhead lines: description, form finding, pantographs that run along them, statistics and reports."""

from __future__ import annotations

from ..model.keywords import guard
from .acceptance import acceptance, time_above
from .arm_loads import ArmLoad, arm_loads
from .auxiliary import Auxiliary, LongDroppers
from .catalogue import line_file, line_names, read_line
from .clamp_strain import ClampStrain, clamp_strains
from .conditions import Conditions
from .cycles import Cycles, FatigueLine, rainflow
from .derivatives import slopes
from .elasticity import Elasticity, elasticity
from .fittings import DropperErrors, Droppers, Load, SteadyArm, Tensioner
from .form import Form
from .galloping import Galloping, galloping
from .gradient import gradient
from .identify import Identified, dynamic_stiffness, identify_pantograph
from .irregular import dropper_errors, height_errors
from .kept import Kept, read_run
from .line import Line
from .measuring import Measured, MeasuringHead, measure
from .measuring_file import read_measuring_head
from .mesh import Mesh
from .opened import Overhead, assemble
from .pantograph import Pantograph, find_pantograph, pantographs, read_pantograph
from .quantity import Quantity
from .references import Reference, reference_case, reference_names, rows
from .report import write_report
from .rest import form
from .route import Route
from .route_form import RouteForm
from .run import run
from .run_data import Recording, Run
from .sheets import tell
from .signals import Butterworth
from .span import DropperRule, Span
from .statistics import Statistics, statistics
from .steps import LineStepper, stepper
from .stitch import StitchWire
from .touching import Touching
from .travelling import add_pantograph
from .underside import random_underside, read_underside
from .validate import reference_run, write_validation
from .verify import Verified, verify
from .wire import Rayleigh, Wire
from .wires import WireType, wire, wires
from .write import write_run

__all__ = [
    "ArmLoad",
    "Auxiliary",
    "Butterworth",
    "ClampStrain",
    "Conditions",
    "Cycles",
    "DropperErrors",
    "DropperRule",
    "Droppers",
    "Elasticity",
    "FatigueLine",
    "Form",
    "Galloping",
    "Identified",
    "Kept",
    "Line",
    "LineStepper",
    "Load",
    "LongDroppers",
    "Measured",
    "MeasuringHead",
    "Mesh",
    "Overhead",
    "Pantograph",
    "Quantity",
    "Rayleigh",
    "Recording",
    "Reference",
    "Route",
    "RouteForm",
    "Run",
    "Span",
    "Statistics",
    "SteadyArm",
    "StitchWire",
    "Tensioner",
    "Touching",
    "Verified",
    "Wire",
    "WireType",
    "acceptance",
    "add_pantograph",
    "arm_loads",
    "assemble",
    "clamp_strains",
    "dropper_errors",
    "dynamic_stiffness",
    "elasticity",
    "find_pantograph",
    "form",
    "galloping",
    "gradient",
    "height_errors",
    "identify_pantograph",
    "line_file",
    "line_names",
    "measure",
    "pantographs",
    "rainflow",
    "random_underside",
    "read_line",
    "read_measuring_head",
    "read_pantograph",
    "read_run",
    "read_underside",
    "reference_case",
    "reference_names",
    "reference_run",
    "rows",
    "run",
    "slopes",
    "statistics",
    "stepper",
    "time_above",
    "verify",
    "wire",
    "wires",
    "write_report",
    "write_run",
    "write_validation",
]

tell()
# what a controller calls in each step is called directly
guard(globals(), (name for name in __all__ if name not in ("LineStepper", "Touching")))
