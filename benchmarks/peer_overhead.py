"""Case 7.5 as a model of Exudyn: two wires, droppers that go slack, a pantograph on the sliding joint.

Natural lengths of wires and droppers are those of our form finding. The equilibrium under the pantograph's
force is Exudyn's own.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise
from typing import Any

import exudyn
import numpy as np
from exudyn.itemInterface import (
    LoadCoordinate,
    LoadForceVector,
    MarkerBodyBeamShape,
    MarkerBodyPosition,
    MarkerNodeCoordinate,
    MarkerNodePosition,
    Node1D,
    NodeGenericData,
    NodePoint,
    NodePointGround,
    NodePointSlope1,
    ObjectANCFCable,
    ObjectConnectorCartesianSpringDamper,
    ObjectConnectorCoordinate,
    ObjectConnectorCoordinateSpringDamper,
    ObjectConnectorSpringDamper,
    ObjectGround,
    ObjectJointSliding,
    ObjectMass1D,
    ObjectMassPoint,
    SensorNode,
    SensorObject,
)
from exudyn.utilities import CreateSymbolicUserFunction

import overhead
from cases import Overhead
from peer_models import add_weight, new_system

STATIC_STEPS = 20
#: Node of the contact wire under which the pantograph starts.
FIRST = 2


@dataclass
class Wires:
    """Both wires and the droppers in a system.

    ``contact``, ``carrier``: numbers of nodes; ``elements``: of the contact wire; ``droppers``: connectors.
    """

    system: Any
    contact: list[int] = field(default_factory=list)
    carrier: list[int] = field(default_factory=list)
    elements: list[int] = field(default_factory=list)
    droppers: list[Any] = field(default_factory=list)


@cache
def form(case: Overhead) -> Any:
    return overhead.form(case)


def build(case: Overhead) -> tuple[Any, int, dict[str, int]]:
    """System ready to solve, the number of the head's node, and sensors of contact force and head."""
    shifts = rest(case)
    system = new_system()
    wires = add_wires(case, system, shifts)
    let_go_slack(system, wires.droppers)
    head = add_pantograph(case, wires, shifts[FIRST])
    joint = add_joint(case, wires, head)
    kinds, quiet = exudyn.OutputVariableType, {"writeToFile": False, "storeInternal": True}
    sensors = {
        "force": system.AddSensor(SensorObject(objectNumber=joint, outputVariableType=kinds.Force, **quiet)),
        "head": system.AddSensor(SensorNode(nodeNumber=head, outputVariableType=kinds.Position, **quiet)),
    }
    system.Assemble()
    return system, head, sensors


def add_wires(case: Overhead, system: Any, shifts: Any = None, damped: bool = True) -> Wires:
    """Wires, supports and droppers; ``shifts``: initial displacements of all nodes."""
    shape, wires = form(case), Wires(system)
    count = shape.contact.arc.size
    upper, lower = (None, None) if shifts is None else (shifts[count:], shifts[:count])
    ground = system.AddMarker(MarkerBodyPosition(bodyNumber=system.AddObject(ObjectGround())))
    brake = ground if damped else None
    wires.contact, wires.elements = add_wire(case, system, shape.contact, case.rhoA, lower, brake)
    wires.carrier, _ = add_wire(case, system, shape.messenger, case.carrier_rhoA, upper, brake)
    for nodes, where, inner in (
        (wires.contact, shape.contact.nodes.support, (1,)),
        (wires.carrier, shape.messenger.nodes.support, (1, 2)),
    ):
        for i in where:
            end = i in (0, len(nodes) - 1)
            fix(system, nodes[i], (0, 1, 2) if end else inner)
    add_droppers(case, wires)
    return wires


def add_wire(
    case: Overhead, system: Any, shape: Any, rhoA: float, shifts: Any, brake: int | None
) -> tuple[list[int], list[int]]:
    """Nodes and elements of a wire; its viscous damping is lumped to the nodes."""
    slopes = np.gradient(shape.position, shape.arc, axis=0)
    nodes = []
    for i, (place, slope) in enumerate(zip(shape.position, slopes, strict=True)):
        start = {} if shifts is None else {"initialCoordinates": list(shifts[i])}
        nodes.append(int(system.AddNode(NodePointSlope1(referenceCoordinates=[*place, *slope], **start))))
    elements = []
    for pair, length in zip(pairwise(nodes), np.diff(shape.arc), strict=True):
        cable = ObjectANCFCable(
            nodeNumbers=list(pair),
            length=float(length),
            massPerLength=rhoA,
            axialStiffness=case.EA,
            bendingStiffness=case.EI,
        )
        elements.append(int(system.AddObject(cable)))
        add_weight(system, elements[-1])
    if brake is not None:
        share = case.damping * np.gradient(shape.arc)
        for node, damping in zip(nodes, share.tolist(), strict=True):
            ends = [brake, system.AddMarker(MarkerNodePosition(nodeNumber=node))]
            damper = ObjectConnectorCartesianSpringDamper(
                markerNumbers=ends, stiffness=[0.0] * 3, damping=[damping] * 3
            )
            system.AddObject(damper)
    return nodes, elements


def fix(system: Any, node: int, coordinates: tuple[int, ...]) -> None:
    """Keep some coordinates of a node."""
    ground = system.AddNode(NodePointGround(referenceCoordinates=[0, 0, 0]))
    still = system.AddMarker(MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    for c in coordinates:
        own = system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=c))
        system.AddObject(ObjectConnectorCoordinate(markerNumbers=[still, own]))


def add_droppers(case: Overhead, wires: Wires) -> None:
    shape, system = form(case), wires.system
    for j, (low, high) in enumerate(
        zip(shape.contact.nodes.dropper, shape.messenger.nodes.dropper, strict=True)
    ):
        ends = [MarkerNodePosition(nodeNumber=n) for n in (wires.contact[low], wires.carrier[high])]
        spring = ObjectConnectorSpringDamper(
            markerNumbers=[system.AddMarker(end) for end in ends],
            referenceLength=float(shape.dropper_natural[j]),
            stiffness=float(shape.spring_stiffness[j]),
            damping=float(shape.spring_damping[j]),
        )
        wires.droppers.append(system.AddObject(spring))


def keep(system: Any, function: Any, name: str, item: Any) -> None:
    """Give an object a function that Exudyn turns into C++, and keep it alive."""
    made = CreateSymbolicUserFunction(system, function, name, item)
    system.variables.setdefault("functions", []).append(made)
    system.SetObjectParameter(item, name, made)


def let_go_slack(system: Any, droppers: list[Any]) -> None:
    """Droppers pull only."""
    choose = exudyn.symbolic.IfThenElse

    def pull(mbs, t, itemNumber, deltaL, deltaL_t, stiffness, damping, force):  # type: ignore[no-untyped-def]
        return choose(deltaL > 0, stiffness * deltaL + damping * deltaL_t, 0 * deltaL)

    for item in droppers:
        keep(system, pull, "springForceUserFunction", item)


def add_pantograph(case: Overhead, wires: Wires, shift: Any) -> int:
    """Head and frame; number of the head's node. The lift acts on the frame."""
    system = wires.system
    x, _, z = form(case).contact.position[FIRST] + np.array(shift[:3])
    point = NodePoint(referenceCoordinates=[x, 0.0, z], initialVelocities=[case.speed, 0.0, 0.0])
    head, frame = system.AddNode(point), system.AddNode(Node1D(referenceCoordinates=[0.0]))
    system.AddObject(ObjectMassPoint(mass=case.masses[1], nodeNumber=head))
    system.AddObject(ObjectMass1D(mass=case.masses[0], nodeNumber=frame))
    fix(system, head, (1,))
    ground = system.AddNode(NodePointGround(referenceCoordinates=[0, 0, 0]))
    still, along, up, lift = (
        system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=c))
        for node, c in ((ground, 0), (head, 0), (head, 2), (frame, 0))
    )
    drive = system.AddObject(ObjectConnectorCoordinate(markerNumbers=[still, along]))
    speed = case.speed

    def travel(mbs, t, itemNumber, lOffset):  # type: ignore[no-untyped-def]
        return speed * t

    keep(system, travel, "offsetUserFunction", drive)
    for ends, k, offset in (([still, lift], 0, 0.0), ([lift, up], 1, case.force / case.stiffness[1])):
        spring = ObjectConnectorCoordinateSpringDamper(
            markerNumbers=ends, stiffness=case.stiffness[k], damping=case.dampers[k], offset=offset
        )
        system.AddObject(spring)
    system.AddLoad(LoadCoordinate(markerNumber=lift, load=case.force))
    return int(head)


def add_joint(case: Overhead, wires: Wires, head: int) -> int:
    """Sliding joint of the head on the contact wire, free across the track."""
    system, arc = wires.system, form(case).contact.arc
    data = NodeGenericData(initialCoordinates=[FIRST, float(arc[FIRST])], numberOfDataCoordinates=2)
    memory = system.AddNode(data)
    point = system.AddMarker(MarkerNodePosition(nodeNumber=head))
    along = [system.AddMarker(MarkerBodyBeamShape(bodyNumber=e)) for e in wires.elements]
    joint = ObjectJointSliding(
        markerNumbers=[point, along[FIRST]],
        slidingMarkerNumbers=along,
        slidingMarkerOffsets=arc[:-1].tolist(),
        nodeNumber=memory,
        constrainRotations=[0, 0, 0],
        constrainTranslations=[1, 0, 1],
    )
    return int(system.AddObject(joint))


def rest(case: Overhead) -> list[Any]:
    """Displacements of all nodes in the equilibrium with the pantograph's force on the wire."""
    system = new_system()
    wires = add_wires(case, system, damped=False)
    lifted = system.AddMarker(MarkerNodePosition(nodeNumber=wires.contact[FIRST]))
    system.AddLoad(LoadForceVector(markerNumber=lifted, loadVector=[0.0, 0.0, case.force]))
    system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.active = False
    settings.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
    static = settings.staticSolver
    static.verboseMode = 0
    static.numberOfLoadSteps = STATIC_STEPS
    static.newton.relativeTolerance = 1e-8
    static.newton.absoluteTolerance = 1e-4
    if system.SolveStatic(settings) is False:
        raise RuntimeError("Exudyn found no equilibrium")
    coordinates = exudyn.OutputVariableType.Coordinates
    return [system.GetNodeOutput(node, coordinates) for node in wires.contact + wires.carrier]
