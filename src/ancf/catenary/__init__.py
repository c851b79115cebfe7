"""Overhead lines: description, form finding, pantographs that run along them, statistics and reports."""

from __future__ import annotations

from ..model.keywords import guard
from .answers.acceptance import acceptance, time_above
from .answers.clamp_strain import ClampStrain, clamp_strains
from .answers.cycles import Cycles, FatigueLine, rainflow
from .answers.kept import Kept, read_run
from .answers.measuring import Measured, MeasuringHead, measure
from .answers.measuring_file import read_measuring_head
from .answers.quantity import Quantity
from .answers.references import Reference, reference_case, reference_names, rows
from .answers.run_data import Recording, Run
from .answers.sheets import tell
from .answers.signals import Butterworth
from .answers.statistics import Statistics, statistics
from .answers.write import write_run
from .derivatives import slopes
from .elasticity import Elasticity, elasticity
from .forms.arm_loads import ArmLoad, arm_loads
from .forms.form import Form
from .forms.irregular import dropper_errors, height_errors
from .forms.mesh import Mesh
from .forms.route_form import RouteForm
from .gradient import gradient
from .lines.auxiliary import Auxiliary, LongDroppers
from .lines.catalogue import line_file, line_names, read_line
from .lines.conditions import Conditions
from .lines.fittings import DropperErrors, Droppers, Load, SteadyArm, Tensioner
from .lines.galloping import Galloping, galloping
from .lines.line import Line
from .lines.route import Route
from .lines.span import DropperRule, Span
from .lines.stitch import StitchWire
from .lines.wire import Rayleigh, Wire
from .lines.wires import WireType, wire, wires
from .opened import Overhead, assemble
from .report import write_report
from .rest import form
from .run import run
from .steps import LineStepper, stepper
from .touching import Touching
from .travelling import add_pantograph
from .underside import random_underside, read_underside
from .validate import reference_run, write_validation
from .vehicles.identify import Identified, dynamic_stiffness, identify_pantograph
from .vehicles.pantograph import Pantograph, find_pantograph, pantographs, read_pantograph
from .verify import Verified, verify

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
