"""A case built and solved with Exudyn 1.13, through its public Python interface."""

from __future__ import annotations

import time
import warnings
from itertools import product
from typing import Any

warnings.filterwarnings("ignore", category=DeprecationWarning)

import exudyn  # noqa: E402

import overhead  # noqa: E402
import peer_overhead  # noqa: E402
from cases import Beams, Case, Overhead, Sliding  # noqa: E402
from peer_models import build  # noqa: E402

Options = dict[str, Any]
METHODS = (exudyn.DynamicSolverType.TrapezoidalIndex2, exudyn.DynamicSolverType.GeneralizedAlpha)
GEOMETRIC_RANGE = 1e4  # of the last load step to the first
SOLVERS = {"dense": exudyn.LinearSolverType.EXUdense, "sparse": exudyn.LinearSolverType.EigenSparse}


def settings_to_try(case: Case) -> list[Options]:
    """Settings of Exudyn that its documentation offers for speed, a grid; the first one has its defaults.

    The dense solver pays for a few elements only. Contractivity is where modified Newton renews its
    Jacobian; the default absolute tolerance of 1e-10 N is stricter than most models need.
    """
    if isinstance(case, Overhead):
        return for_overhead()
    if case.static:
        return for_statics()
    solvers = ["sparse", "dense"] if case.elements <= 10 else ["sparse"]
    patterns = [False, True]
    if isinstance(case, Sliding):
        choices = for_sliding()
    else:
        choices = for_cables(case.peer_tolerance, few=isinstance(case, Beams))
    return [
        {"solver": solver, "pattern": pattern, **choice}
        for solver in solvers
        for pattern in (patterns if solver == "sparse" else patterns[:1])
        for choice in choices
    ]


def newton(*values: float | None) -> Options:
    """Settings of Newton's method that are not Exudyn's defaults: tolerances, contractivity, iterations."""
    names = "absoluteTolerance", "relativeTolerance", "modifiedNewtonContractivity", "maxIterations"
    return {key: value for key, value in zip(names, values, strict=False) if value is not None}


def for_cables(least: float | None, few: bool) -> list[Options]:
    """``least``: absolute tolerance, N, below which it does not get through; ``few``: a coarser grid."""
    absolute = [None, 1e-8, 1e-7, 1e-6, 1e-5] if least is None else [least, 10.0 * least]
    absolute = absolute[::2] if few else absolute
    grid = product(absolute, (None, 1e-7, 1e-6), (None, 0.2, 0.1, 0.05))
    return [{"newton": newton(*values)} for values in grid]


def for_sliding() -> list[Options]:
    """Its sliding joint is there for index 3 only, hence for the generalised-alpha method.

    With a spectral radius of 1, the trapezoidal rule, the larger models do not get to the end.
    """
    grid = product((None, 1e-7, 1e-5, 1e-4, 1e-3), (None, 1e-6, 1e-4), (None, 0.2, 0.1))
    choices = [newton(*values) for values in grid]
    return [{"rho": rho, "newton": choice} for rho in (0.9, 0.6) for choice in choices]


def for_overhead() -> list[Options]:
    """The generalised-alpha method again; the default tolerance, 1e-10 N, is out of reach here."""
    grid: list[tuple[float | None, ...]] = [
        (1e-4,),
        (1e-4, None, 0.2),
        (1e-4, 1e-6),
        (1e-2,),
        (1e-2, 1e-5),
        (1e-2, 1e-5, 0.9, 20),
        (1e-2, 1e-5, None, 20),
    ]
    return [
        {"solver": "sparse", "pattern": pattern, "rho": 0.6, "newton": newton(*values)}
        for pattern in (False, True)
        for values in grid
    ]


def for_statics() -> list[Options]:
    """Load steps up to the twenty that the carrier of 7.4 needs, tolerances, plain and modified Newton.

    A cable between hinges has no stiffness against its weight at first: steps that grow geometrically.
    """
    grid = product((1, 3, 10, 20), (None, 1e-6), (None, 1e-7), (False, True), (False, True))
    return [
        {"solver": "sparse", "load_steps": steps, "geometric": steps > 1 and geometric, "modified": modified,
         "newton": newton(absolute, relative)}
        for steps, absolute, relative, modified, geometric in grid
        if steps > 1 or not geometric
    ]  # fmt: skip


def version() -> str:
    return str(exudyn.__version__)


def solve(case: Case, options: Options) -> dict[str, Any]:
    """Build and solve; CPU seconds of ``SolveDynamic`` alone and of everything."""
    start = time.process_time()
    sensors: dict[str, int] = {}
    if isinstance(case, Overhead):
        system, tip, sensors = peer_overhead.build(case)
    else:
        system, tip = build(case)
    settings = simulation_settings(case, options)
    before = time.process_time()
    if case.static:
        done = system.SolveStatic(settings)
    else:
        done = system.SolveDynamic(settings, solverType=METHODS["rho" in options])
    after = time.process_time()
    if done is False:
        raise RuntimeError("Exudyn did not get to the end")
    counters = system.sys["staticSolver" if case.static else "dynamicSolver"].it
    records = {key: system.GetSensorStoredData(number) for key, number in sensors.items()}
    return {
        **force_of(records),
        "cpu": after - before,
        "cpu_whole": after - start,
        "steps": 1 if case.static else counters.currentStepIndex - 1,
        "newton_iterations": counters.newtonStepsCount,
        "jacobians": counters.newtonJacobiCount,
        "tip": [float(x) for x in system.GetNodeOutput(tip, exudyn.OutputVariableType.Position)],
    }


def force_of(records: dict[str, Any]) -> dict[str, Any]:
    """Contact force between 20 and 220 m of the overhead line; nothing for the other cases."""
    if not records:
        return {}
    x, force = records["head"][:, 1], -records["force"][:, 3]
    return {"force": overhead.summary(force[(x > 20.0) & (x < 220.0)])}


def simulation_settings(case: Case, options: Options) -> Any:
    """One thread, modified Newton, nothing printed or written."""
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.active = isinstance(case, Overhead)
    settings.solution.sensors.writePeriod = 5e-3
    settings.linearSolver.solverType = SOLVERS[options.get("solver", "sparse")]
    settings.linearSolver.reuseAnalyzedPattern = options.get("pattern", False)
    settings.parallel.numberOfThreads = 1
    if case.static:
        load_steps(settings.staticSolver, options)
        return settings
    integration = settings.timeIntegration
    integration.endTime = case.t_end
    integration.numberOfSteps = case.steps
    integration.verboseMode = 0
    integration.adaptiveStep = case.once  # else a step that fails ends the run instead of being cut silently
    integration.newton.useModifiedNewton = True
    integration.generalizedAlpha.spectralRadius = options.get("rho", 1.0)
    for key, value in options.get("newton", {}).items():
        setattr(integration.newton, key, value)
    return settings


def load_steps(static: Any, options: Options) -> None:
    """How the load grows, and Newton's method for it; a step that fails is cut as it is by default."""
    static.verboseMode = 0
    static.numberOfLoadSteps = options["load_steps"]
    static.loadStepGeometric = options["geometric"]
    static.loadStepGeometricRange = GEOMETRIC_RANGE
    static.newton.useModifiedNewton = options["modified"]
    for key, value in options["newton"].items():
        setattr(static.newton, key, value)
