"""ancf: flexible multibody dynamics of thin beams and cables, absolute nodal coordinate formulation."""

from __future__ import annotations

import sys
from importlib import import_module
from typing import TYPE_CHECKING, Any

from ._version import __version__
from .errors import ArgumentError, Interrupted, ModelError, SolveError

if TYPE_CHECKING:
    from .analysis import damped_modes, equilibrium, load, modes, simulate, stable_step
    from .control.stepper import Stepper, stepper
    from .cosimulation.unit import FmuController
    from .design.bridges.jax import jax_function
    from .design.bridges.torch import torch_function
    from .design.calibrate import calibrate
    from .design.distributions import Discrete, LogNormal, Normal, Triangular, Uniform
    from .design.fit import Fit
    from .design.gradient import gradient
    from .design.linear_model import LinearModel
    from .design.linearise import linearise
    from .design.minimise import Optimum, minimise
    from .design.sampling import sample
    from .design.study import study
    from .model import Gusts, Model, Section, Waves
    from .model.bodies.reeving import Reeving
    from .model.functions.series import Series
    from .model.integrators import Explicit, GeneralizedAlpha, Newton, Radau, Trapezoidal
    from .model.surfaces.mesh import Mesh
    from .model.surfaces.shapes import Capsule, Cylinder, Plane, Sheave, Sphere, Torus
    from .results import DampedModes, Modes, Result, State
    from .resumption import resume
    from .verification import Verification, verify

# all is imported on first use: describing a model needs no compiled part, the start of a command no model
_LATER = {
    "Model": "model",
    "Section": "model",
    "Waves": "model",
    "Gusts": "model",
    "Reeving": "model.bodies.reeving",
    "Series": "model.functions.series",
    "equilibrium": "analysis",
    "simulate": "analysis",
    "modes": "analysis",
    "damped_modes": "analysis",
    "stable_step": "analysis",
    "load": "analysis",
    "resume": "resumption",
    "stepper": "control.stepper",
    "Stepper": "control.stepper",
    "FmuController": "cosimulation.unit",
    "Result": "results",
    "State": "results",
    "Modes": "results",
    "DampedModes": "results",
    "Capsule": "model.surfaces.shapes",
    "Cylinder": "model.surfaces.shapes",
    "Mesh": "model.surfaces.mesh",
    "Plane": "model.surfaces.shapes",
    "Sheave": "model.surfaces.shapes",
    "Sphere": "model.surfaces.shapes",
    "Torus": "model.surfaces.shapes",
    "Trapezoidal": "model.integrators",
    "Explicit": "model.integrators",
    "GeneralizedAlpha": "model.integrators",
    "Radau": "model.integrators",
    "Newton": "model.integrators",
    "calibrate": "design.calibrate",
    "gradient": "design.gradient",
    "linearise": "design.linearise",
    "LinearModel": "design.linear_model",
    "jax_function": "design.bridges.jax",
    "torch_function": "design.bridges.torch",
    "minimise": "design.minimise",
    "Optimum": "design.minimise",
    "Fit": "design.fit",
    "sample": "design.sampling",
    "study": "design.study",
    **dict.fromkeys(("Uniform", "Normal", "LogNormal", "Triangular", "Discrete"), "design.distributions"),
    "Verification": "verification",
    "verify": "verification",
}

# what a controller calls in each step is called directly
_EACH_STEP = ("Stepper",)

__all__ = [
    "ArgumentError",
    "Capsule",
    "Cylinder",
    "DampedModes",
    "Discrete",
    "Explicit",
    "Fit",
    "FmuController",
    "GeneralizedAlpha",
    "Gusts",
    "Interrupted",
    "LinearModel",
    "LogNormal",
    "Mesh",
    "Model",
    "ModelError",
    "Modes",
    "Newton",
    "Normal",
    "Optimum",
    "Plane",
    "Radau",
    "Reeving",
    "Result",
    "Section",
    "Series",
    "Sheave",
    "SolveError",
    "Sphere",
    "State",
    "Stepper",
    "Torus",
    "Trapezoidal",
    "Triangular",
    "Uniform",
    "Verification",
    "Waves",
    "__version__",
    "calibrate",
    "damped_modes",
    "equilibrium",
    "gradient",
    "jax_function",
    "linearise",
    "load",
    "minimise",
    "modes",
    "resume",
    "sample",
    "simulate",
    "stable_step",
    "stepper",
    "study",
    "torch_function",
    "verify",
]


#: Packages that pages call by their names, such as ``ancf.catenary.run``.
_PACKAGES = ("catenary", "design", "model", "viz")


def __getattr__(name: str) -> Any:
    if name in _PACKAGES:
        return import_module(f".{name}", __name__)
    if name not in _LATER:
        hint = import_module(".model.model", __name__).offered(name)
        said = f"module 'ancf' has no attribute {name!r}" + (f": {hint}" if hint else "")
        raise AttributeError(said, name=name, obj=sys.modules[__name__])
    value = getattr(import_module(f".{_LATER[name]}", __name__), name)
    if name not in _EACH_STEP:
        value = import_module(".model.keywords", __name__).guarded(value)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
