"""Overhead lines: description, form finding, pantographs that run along them, statistics and reports."""

from __future__ import annotations

from .catalogue import line_file, line_names, read_line
from .conditions import Conditions
from .derivatives import slopes
from .elasticity import Elasticity, elasticity
from .fittings import Droppers, Load, SteadyArm, Tensioner
from .form import Form
from .irregular import dropper_errors, height_errors
from .line import Line
from .mesh import Mesh
from .opened import Overhead, assemble
from .pantograph import Pantograph, find_pantograph, pantographs, read_pantograph
from .quantity import Quantity
from .references import Reference, reference_case, reference_names, rows
from .rest import form
from .route import Route
from .route_form import RouteForm
from .run import run
from .run_data import Recording, Run
from .signals import Butterworth
from .span import DropperRule, Span
from .statistics import Statistics, statistics
from .stitch import StitchWire
from .travelling import add_pantograph
from .validate import reference_run, write_validation
from .verify import Verified, verify
from .wire import Rayleigh, Wire
from .wires import WireType, wire, wires
from .write import write_run

__all__ = [
    "Butterworth",
    "Conditions",
    "DropperRule",
    "Droppers",
    "Elasticity",
    "Form",
    "Line",
    "Load",
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
    "Verified",
    "Wire",
    "WireType",
    "add_pantograph",
    "assemble",
    "dropper_errors",
    "elasticity",
    "find_pantograph",
    "form",
    "height_errors",
    "line_file",
    "line_names",
    "pantographs",
    "read_line",
    "read_pantograph",
    "reference_case",
    "reference_names",
    "reference_run",
    "rows",
    "run",
    "slopes",
    "statistics",
    "verify",
    "wire",
    "wires",
    "write_run",
    "write_validation",
]
