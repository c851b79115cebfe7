"""Bodies of a results file: what is needed to read fields from its states, without the model."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..model.beam import Beam
from ..model.bodies import Body, PointMass, RigidBody
from ..model.section import DAMPINGS, Circle, Rectangle, Section
from ..system.system import System
from .layout_springs import write_springs

IntArray = NDArray[np.int64]

_WORDS = ("element", "strain", "natural_shape", "poisson")
_NODES = ("node_x", "node_position", "node_tangent", "node_y")
_RIGID = ("inertia", "axes", "angular_velocity", "about")
_MATERIAL = ("E", "rho", "nu", "J", "shear_factors")
_MOMENTS = ("A", "I_y", "I_z", "I_yyyy", "I_zzzz", "I_yyzz")


def write_layout(file: Any, system: System) -> None:
    """Write the groups ``bodies``, ``joints`` and ``springs`` of an HDF5 file."""
    group = file.create_group("bodies", track_order=True)
    for name, beam in system.model.bodies.items():
        body = group.create_group(name)
        if not isinstance(beam, Beam):
            _write_mass(body, beam, system.slots[name])
            continue
        body.attrs["length"], body.attrs["stretch"] = beam.length, beam.stretch
        body.attrs["gauss"] = beam.gauss
        for key in _WORDS:
            body.attrs[key] = getattr(beam, key)
        _write_section(body.attrs, beam)
        body["slots"] = system.slots[name]
        for key in _NODES:
            body[key] = getattr(beam, key)
        body.attrs["motion"] = np.concatenate([beam.velocity, beam.angular_velocity, beam.about])

    joints = file.create_group("joints")
    for k, (name, unknowns) in enumerate(system.joints.items()):
        joint = joints.create_dataset(f"{k:06d}", data=unknowns)  # a name may hold any character, such as /
        joint.attrs["name"], joint.attrs["slides"] = name, name in system.numbering.arcs
    write_springs(file, system.model)


def read_joints(file: Any) -> tuple[dict[str, IntArray], dict[str, int]]:
    """Unknowns by joint, and those of s by sliding joint; early files have none, or names for numbers."""
    joints, arcs = {}, {}
    for key, data in file.get("joints", {}).items():
        name = str(data.attrs.get("name", key))
        joints[name] = data[:]
        if data.attrs["slides"]:
            arcs[name] = int(joints[name][-1])
    return joints, arcs


def _write_mass(group: Any, body: PointMass | RigidBody, slots: IntArray) -> None:
    for key in ("mass", "position", "velocity"):
        group.attrs[key] = getattr(body, key)
    if isinstance(body, RigidBody):
        for key in _RIGID:
            group.attrs[key] = getattr(body, key)
    group["slots"] = slots


def _read_mass(name: str, a: Any) -> PointMass | RigidBody:
    given = {"name": name, "mass": float(a["mass"]), "position": a["position"], "velocity": a["velocity"]}
    if "inertia" not in a:
        return PointMass(**given)
    return RigidBody(**given, **{key: a[key] for key in _RIGID})


def read_layout(group: Any) -> tuple[dict[str, Body], dict[str, IntArray]]:
    """Bodies and slots from the group ``bodies``."""
    bodies: dict[str, Body] = {}
    slots = {}
    for name, body in group.items():
        a = body.attrs
        slots[name] = body["slots"][:]
        if "mass" in a:
            bodies[name] = _read_mass(name, a)
            continue
        motion = a["motion"].reshape(3, 3)
        given: dict[str, Any] = {key: str(a[key]) for key in _WORDS}
        given |= {key: _nodes(body, key) for key in _NODES}
        bodies[name] = Beam(
            name=name,
            section=_read_section(a),
            gauss=(int(a["gauss"][0]), int(a["gauss"][1])),
            length=float(a["length"]),
            stretch=float(a["stretch"]),
            velocity=motion[0],
            angular_velocity=motion[1],
            about=motion[2],
            **given,
        )
    return bodies, slots


def _nodes(body: Any, key: str) -> Any:
    """Array of the nodes; files from before version 0.2 have no node_y, which a cable does not need."""
    return body[key][:] if key in body else np.zeros_like(body["node_tangent"][:])


def _write_section(attrs: Any, beam: Beam) -> None:
    """Stiffnesses of a cable; material and shape, or moments, of a beam with a section."""
    section = beam.section
    keys = [*DAMPINGS]
    keys += [*_MATERIAL, *_MOMENTS] if beam.has_section else ["EA", "EI", "rhoA"]
    for key in keys:
        attrs[key] = getattr(section, key)
    if isinstance(section.shape, Rectangle):
        attrs["shape"] = (section.shape.width, section.shape.height)
    elif isinstance(section.shape, Circle):
        attrs["shape"] = (section.shape.diameter,)


def _read_section(attrs: Any) -> Section:
    def numbers(*keys: str) -> dict[str, Any]:
        return {key: float(attrs[key]) for key in keys}

    dampings = numbers(*(key for key in DAMPINGS if key in attrs))  # older files have fewer
    if "EA" in attrs:
        return Section(**numbers("EA", "EI", "rhoA"), **dampings)
    given = {**numbers("E", "rho", "nu", "J"), **dampings}
    given["shear_factors"] = tuple(attrs["shear_factors"].tolist())
    shape = attrs["shape"].tolist() if "shape" in attrs else []
    if len(shape) == 2:
        return Section.rectangle(*shape, **given)
    if len(shape) == 1:
        return Section.circle(*shape, **given)
    return Section.from_moments(**numbers(*_MOMENTS), **given)
