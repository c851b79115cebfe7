"""Overhead lines: description, form finding, pantographs that run along them, statistics and reports."""

from __future__ import annotations

from .catalogue import line_file, line_names, read_line
from .elasticity import Elasticity, elasticity
from .fittings import Droppers, SteadyArm
from .form import Form, form
from .line import Line
from .mesh import Mesh
from .opened import Overhead, assemble
from .pantograph import Pantograph, find_pantograph, pantographs, read_pantograph
from .quantity import Quantity
from .references import Reference, reference_case, reference_names, rows
from .run import run
from .run_data import Recording, Run
from .signals import Butterworth
from .span import Span
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
    "Droppers",
    "Elasticity",
    "Form",
    "Line",
    "Mesh",
    "Overhead",
    "Pantograph",
    "Quantity",
    "Rayleigh",
    "Recording",
    "Reference",
    "Run",
    "Span",
    "Statistics",
    "SteadyArm",
    "StitchWire",
    "Verified",
    "Wire",
    "WireType",
    "add_pantograph",
    "assemble",
    "elasticity",
    "find_pantograph",
    "form",
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
    "statistics",
    "verify",
    "wire",
    "wires",
    "write_run",
    "write_validation",
]
