"""The cases as models of Exudyn."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import exudyn
import numpy as np
from exudyn.itemInterface import (
    LoadMassProportional,
    MarkerBodyBeamShape,
    MarkerBodyMass,
    MarkerNodeCoordinate,
    MarkerNodePosition,
    NodeGenericData,
    NodePoint,
    NodePointGround,
    NodePointSlope1,
    NodePointSlope23,
    ObjectANCFBeam,
    ObjectANCFCable,
    ObjectConnectorCoordinate,
    ObjectConnectorSpringDamper,
    ObjectJointSliding,
    ObjectJointSpherical,
    ObjectMassPoint,
)

from cases import GRAVITY, Beams, Cable, Case, Hanging, Net, Sliding

Point = tuple[float, float, float]
SQUARE_TORSION = 0.1406  # J / side^4
WEIGHT = [0, 0, -GRAVITY]


def build(case: Case) -> tuple[Any, int]:
    """System ready to solve and the number of the tip's node."""
    if isinstance(case, Sliding):
        return sliding(case)
    if isinstance(case, Net):
        return net(case)
    if isinstance(case, Beams):
        return beams(case)
    assert isinstance(case, Cable)
    system = new_system()
    end = (case.length, 0.0, 0.0)
    nodes, _ = add_cable(system, case, (0.0, 0.0, 0.0), end, case.elements, omega=case.omega)
    hold(system, nodes[0], 6 if case.clamped else 3)
    hanging = isinstance(case, Hanging)
    if hanging and case.held:
        hold(system, nodes[-1], 3)
    system.Assemble()
    return system, nodes[case.count // 2 if hanging else -1]


def beams(case: Beams) -> tuple[Any, int]:
    """Its own beam with a cross-section: two nodes, linear, eighteen coordinates."""
    system = new_system()
    section = exudyn.BeamSection()
    section.massPerLength = case.rhoA
    second = case.side**4 / 12.0
    section.inertia = case.rho * np.diag([2.0 * second, second, second])
    shear, torsion = 0.5 * case.EA, 0.5 * SQUARE_TORSION * case.E * case.side**4  # without contraction
    factor = 5.0 / 6.0
    section.stiffnessMatrix = np.diag([case.EA, factor * shear, factor * shear, torsion, case.EI, case.EI])
    h = case.length / case.count
    axes = [0, 1, 0, 0, 0, 1]
    nodes = [
        int(system.AddNode(NodePointSlope23(referenceCoordinates=[i * h, 0, 0, *axes])))
        for i in range(case.count + 1)
    ]
    for pair in pairwise(nodes):
        beam = ObjectANCFBeam(nodeNumbers=list(pair), length=h, sectionData=section)
        add_weight(system, int(system.AddObject(beam)))
    hold(system, nodes[0], 9)
    system.Assemble()
    return system, nodes[-1]


def net(case: Net) -> tuple[Any, int]:
    """Cables side by side with springs; the last one is free at its end, which is the tip."""
    system = new_system()
    before: list[int] = []
    nodes: list[int] = []
    for k in range(case.cables):
        y = k * case.gap
        nodes, _ = add_cable(system, case, (0.0, y, 0.0), (case.length, y, 0.0), case.count)
        hold(system, nodes[0], 3)
        if k < case.cables - 1:
            hold(system, nodes[-1], 3)
        for pair in zip(before[1:-1], nodes[1:-1], strict=False):
            ends = [system.AddMarker(MarkerNodePosition(nodeNumber=node)) for node in pair]
            spring = ObjectConnectorSpringDamper(
                markerNumbers=ends, referenceLength=case.gap, stiffness=case.stiffness, damping=case.damping
            )
            system.AddObject(spring)
        before = nodes
    system.Assemble()
    return system, nodes[-1]


def new_system() -> Any:
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    system.variables["container"] = container  # the system lives as long as its container
    return system


def add_cable(
    system: Any,
    case: Case,
    start: Point,
    end: Point,
    count: int,
    omega: float = 0.0,
    shifts: list[Any] | None = None,
) -> tuple[list[int], list[int]]:
    """Nodes and elements of a straight cable under gravity.

    ``omega``: rotation about z through the start, rad/s; ``shifts``: initial displacements of the nodes.
    """
    line = [b - a for a, b in zip(start, end, strict=True)]
    length = sum(x * x for x in line) ** 0.5
    slope = [x / length for x in line]
    rate = [-omega * slope[1], omega * slope[0], 0.0]  # of the slope
    nodes = []
    for i in range(count + 1):
        place = [a + x * i / count for a, x in zip(start, line, strict=True)]
        velocity = [length * i / count * x for x in rate]
        node = NodePointSlope1(
            referenceCoordinates=place + slope,
            initialVelocities=velocity + rate,
            initialCoordinates=[0.0] * 6 if shifts is None else list(shifts[i]),
        )
        nodes.append(int(system.AddNode(node)))
    return nodes, [add_element(system, case, pair, length / count) for pair in pairwise(nodes)]


def add_element(system: Any, case: Case, nodes: tuple[int, int], length: float) -> int:
    cable = ObjectANCFCable(
        nodeNumbers=list(nodes),
        length=length,
        massPerLength=case.rhoA,
        axialStiffness=case.EA,
        bendingStiffness=case.EI,
    )
    element = int(system.AddObject(cable))
    add_weight(system, element)
    return element


def add_weight(system: Any, item: int) -> None:
    body = system.AddMarker(MarkerBodyMass(bodyNumber=item))
    system.AddLoad(LoadMassProportional(markerNumber=body, loadVector=WEIGHT))


def hold(system: Any, node: int, count: int) -> None:
    """Fix the first coordinates of a node."""
    ground = system.AddNode(NodePointGround(referenceCoordinates=[0, 0, 0]))
    fixed = system.AddMarker(MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    for c in range(count):
        own = system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=c))
        system.AddObject(ObjectConnectorCoordinate(markerNumbers=[fixed, own]))


def sliding(case: Sliding) -> tuple[Any, int]:
    """Both beams, the mass with a spherical joint at the tip, and the sliding joint."""
    system = new_system()
    shifts = sag(case)
    carrier, elements = add_cable(system, case, case.start, case.joint, case.carrier, shifts=shifts)
    beam, _ = add_cable(system, case, case.joint, case.tip, case.slider)
    hold(system, carrier[0], 3)
    hold(system, carrier[-1], 3)
    mass = system.AddNode(NodePoint(referenceCoordinates=list(case.tip)))
    add_weight(system, system.AddObject(ObjectMassPoint(mass=case.mass, nodeNumber=mass)))
    ends = [system.AddMarker(MarkerNodePosition(nodeNumber=node)) for node in (mass, beam[-1])]
    system.AddObject(ObjectJointSpherical(markerNumbers=ends))
    add_sliding_joint(system, case, beam[0], elements)
    system.Assemble()
    return system, beam[-1]


def add_sliding_joint(system: Any, case: Sliding, node: int, elements: list[int]) -> None:
    """The node slides along these elements, at first at the end of the last one."""
    length = sum((b - a) ** 2 for a, b in zip(case.start, case.joint, strict=True)) ** 0.5
    one = length / case.carrier
    last = len(elements) - 1
    data = NodeGenericData(initialCoordinates=[last, length], numberOfDataCoordinates=2)
    memory = system.AddNode(data)
    point = system.AddMarker(MarkerNodePosition(nodeNumber=node))
    along = [system.AddMarker(MarkerBodyBeamShape(bodyNumber=element)) for element in elements]
    system.AddObject(
        ObjectJointSliding(
            markerNumbers=[point, along[-1]],
            slidingMarkerNumbers=along,
            slidingMarkerOffsets=[i * one for i in range(len(along))],
            nodeNumber=memory,
            constrainRotations=[0, 0, 0],
        )
    )


def sag(case: Sliding) -> list[Any]:
    """Displacements of the carrier's nodes in its equilibrium."""
    system = new_system()
    nodes, _ = add_cable(system, case, case.start, case.joint, case.carrier)
    hold(system, nodes[0], 3)
    hold(system, nodes[-1], 3)
    system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.active = False
    static = settings.staticSolver
    static.verboseMode = 0
    static.numberOfLoadSteps = 20
    static.loadStepGeometric = True  # a straight cable has no stiffness against its weight
    static.loadStepGeometricRange = 1e4
    static.adaptiveStep = False
    static.newton.relativeTolerance = 1e-8
    static.newton.absoluteTolerance = 1e-9
    if system.SolveStatic(settings) is False:
        raise RuntimeError("Exudyn found no equilibrium")
    return [system.GetNodeOutput(node, exudyn.OutputVariableType.Coordinates) for node in nodes]
