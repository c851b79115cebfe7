"""Where the unknowns of a model stand in the state vectors of a results file."""

from __future__ import annotations

from typing import Any

from ..arrays import IntArray
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import Body
from ..system.system import System


def write_layout(file: Any, system: System) -> None:
    """Write the groups ``bodies`` and ``joints`` of an HDF5 file."""
    group = file.create_group("bodies", track_order=True)
    for name, body in system.model.bodies.items():
        group[f"{name}/slots"] = system.slots[name]
        if isinstance(body, Beam):
            group[f"{name}/node_x"] = body.node_x
    joints = file.create_group("joints")
    for k, (name, unknowns) in enumerate(system.joints.items()):
        joint = joints.create_dataset(f"{k:06d}", data=unknowns)  # a name may hold any character, such as /
        joint.attrs["name"] = name


def read_slots(file: Any, bodies: dict[str, Body]) -> dict[str, IntArray]:
    """First unknowns of the nodes' vectors by body."""
    return {name: file[f"bodies/{name}/slots"][()] for name in bodies}


def read_joints(file: Any) -> dict[str, IntArray]:
    """Unknowns by joint."""
    return {str(data.attrs["name"]): data[()] for data in file["joints"].values()}
