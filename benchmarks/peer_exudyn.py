"""A case built and solved with Exudyn 1.13, through its public Python interface."""

from __future__ import annotations

import time
import warnings
from itertools import pairwise
from typing import Any

from cases import GRAVITY, Case

warnings.filterwarnings("ignore", category=DeprecationWarning)

import exudyn  # noqa: E402
from exudyn.itemInterface import (  # noqa: E402
    LoadMassProportional,
    MarkerBodyMass,
    MarkerNodeCoordinate,
    NodePointGround,
    NodePointSlope1,
    ObjectANCFCable,
    ObjectConnectorCoordinate,
)

Options = dict[str, Any]
SOLVERS = {"dense": exudyn.LinearSolverType.EXUdense, "sparse": exudyn.LinearSolverType.EigenSparse}


def settings_to_try(case: Case) -> list[Options]:
    """Settings of Exudyn that its documentation offers for speed; the first one has its defaults.

    The dense solver pays for a few elements only. Contractivity is where modified Newton renews its
    Jacobian; the default absolute tolerance of 1e-10 N is stricter than most models need.
    """
    if case.peer_tolerance is not None:
        return [{"solver": "sparse", "newton": {"absoluteTolerance": case.peer_tolerance}}]
    newton: list[Options] = [
        {},
        {"modifiedNewtonContractivity": 0.2},
        {"absoluteTolerance": 1e-6},
        {"absoluteTolerance": 1e-6, "relativeTolerance": 1e-6},
        {"absoluteTolerance": 1e-6, "modifiedNewtonContractivity": 0.2},
    ]
    solvers = ["sparse", "dense"] if case.elements <= 10 else ["sparse"]
    return [{"solver": solver, "newton": choice} for solver in solvers for choice in newton]


def version() -> str:
    return str(exudyn.__version__)


def solve(case: Case, options: Options) -> dict[str, Any]:
    """Build and solve; CPU seconds of ``SolveDynamic`` alone and of everything."""
    start = time.process_time()
    system, tip = build(case)
    settings = simulation_settings(case, options)
    before = time.process_time()
    done = system.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.TrapezoidalIndex2)
    after = time.process_time()
    if done is False:
        raise RuntimeError("Exudyn did not reach the end time")
    counters = system.sys["dynamicSolver"].it
    return {
        "cpu": after - before,
        "cpu_whole": after - start,
        "steps": counters.currentStepIndex - 1,
        "newton_iterations": counters.newtonStepsCount,
        "jacobians": counters.newtonJacobiCount,
        "tip": [float(x) for x in system.GetNodeOutput(tip, exudyn.OutputVariableType.Position)],
    }


def build(case: Case) -> tuple[Any, int]:
    """System ready to solve and the number of the tip's node."""
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    system.variables["container"] = container  # the system lives as long as its container
    nodes = [add_node(system, case, i) for i in range(case.elements + 1)]
    for first, second in pairwise(nodes):
        add_element(system, case, first, second)
    hold(system, nodes[0], 6 if case.clamped else 3)
    system.Assemble()
    return system, nodes[-1]


def add_node(system: Any, case: Case, i: int) -> int:
    x = case.length * i / case.elements
    node = NodePointSlope1(
        referenceCoordinates=[x, 0, 0, 1, 0, 0],
        initialVelocities=[0, case.omega * x, 0, 0, case.omega, 0],
    )
    return int(system.AddNode(node))


def add_element(system: Any, case: Case, first: int, second: int) -> None:
    element = system.AddObject(
        ObjectANCFCable(
            nodeNumbers=[first, second],
            length=case.length / case.elements,
            massPerLength=case.rhoA,
            axialStiffness=case.EA,
            bendingStiffness=case.EI,
        )
    )
    body = system.AddMarker(MarkerBodyMass(bodyNumber=element))
    system.AddLoad(LoadMassProportional(markerNumber=body, loadVector=[0, 0, -GRAVITY]))


def hold(system: Any, node: int, count: int) -> None:
    """Fix the first coordinates of a node."""
    ground = system.AddNode(NodePointGround(referenceCoordinates=[0, 0, 0]))
    fixed = system.AddMarker(MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    for c in range(count):
        own = system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=c))
        system.AddObject(ObjectConnectorCoordinate(markerNumbers=[fixed, own]))


def simulation_settings(case: Case, options: Options) -> Any:
    """Trapezoidal rule, one thread, modified Newton, nothing printed or written."""
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.active = False
    settings.linearSolver.solverType = SOLVERS[options.get("solver", "sparse")]
    settings.parallel.numberOfThreads = 1
    integration = settings.timeIntegration
    integration.endTime = case.t_end
    integration.numberOfSteps = case.steps
    integration.verboseMode = 0
    integration.adaptiveStep = False  # a step that fails ends the run instead of being cut silently
    integration.newton.useModifiedNewton = True
    for key, value in options.get("newton", {}).items():
        setattr(integration.newton, key, value)
    return settings
