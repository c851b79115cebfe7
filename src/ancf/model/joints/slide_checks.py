"""Checks of sliding joints: what ``Model.slide`` was given, and the place where it starts."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..bodies import nearest
from ..bodies.beam import NODE_TOLERANCE, Beam
from ..bodies.rigid import Body, RigidBody, kind
from ..functions.function import TimeFunction
from ..points import Point, initial_position
from .basic import AT_END, Slide, line_length

OFF = 1e-6  # of the size of the model: distance of the point from the line that is taken for rounding
ROUNDING = 1e-12  # of the length of the line
PERPENDICULAR = 1e-6  # cosine or sine below which directions are perpendicular or the same

Line = tuple[FloatArray, FloatArray]
Carrier = Beam | RigidBody


def make_slide(
    where: str,
    name: str,
    point: Point | FloatArray,
    carrier: Body,
    size: float,
    *,
    line: Any,
    offset: Any,
    s: Any,
    tolerance: Any,
    force: Any,
    motion: Any,
    release: Any,
    unilateral: Any,
    at_end: Any,
    **numbers: Any,
) -> Slide:
    """Check what ``Model.slide`` was given; `size` is the size of the model in m."""
    on = _carrier(point, carrier, where)
    ends = _line(line, on, f"{where}.line")
    place = _offset(offset, on, f"{where}.offset")
    values = _numbers(numbers, where)
    drives = _drives(force, motion, values, where)
    allowed = OFF * size if tolerance is None else checks.non_negative(tolerance, f"{where}.tolerance")
    start = _start(where, point, _Track(on, ends, place), s, drives["motion"], allowed)
    directions = _directions(release, unilateral, _Track(on, ends, place).tangent(start), where)
    return Slide(
        name=name,
        point=point,
        carrier=on,
        line=ends,
        offset=place,
        s=start,
        tolerance=allowed,
        mass=values["mass"],
        friction=values["friction"],
        friction_velocity=values["friction_velocity"],
        viscous=values["viscous"],
        force=drives["force"],
        motion=drives["motion"],
        release=directions["release"],
        unilateral=directions["unilateral"],
        at_end=checks.choice(at_end, f"{where}.at_end", AT_END),
    )


class _Track:
    """The line on which the point slides, in the initial shape."""

    def __init__(self, carrier: Carrier, line: Line | None, offset: tuple[float, float]) -> None:
        self.carrier, self.offset = carrier, offset
        self.ends = None if line is None else [carrier.initial_position(*end) for end in line]
        self.length = carrier.length if isinstance(carrier, Beam) else line_length(line)

    def position(self, s: float) -> FloatArray:
        """Position (3,) at s."""
        if self.ends is None:
            return self.carrier.initial_position(s, *self.offset)
        return self.ends[0] + s / self.length * (self.ends[1] - self.ends[0])

    def tangent(self, s: float) -> FloatArray:
        """Unit tangent (3,) at s, of a beam that of its centreline."""
        if isinstance(self.carrier, Beam):
            return self.carrier.initial_tangent(s)
        assert self.ends is not None
        unit: FloatArray = (self.ends[1] - self.ends[0]) / self.length
        return unit

    def nearest(self, position: FloatArray) -> tuple[float, float]:
        """Arc length s of the nearest place and its distance."""
        if isinstance(self.carrier, Beam):
            return nearest.along_beam(self.carrier, self.offset, position)
        assert self.ends is not None
        return nearest.along_line(self.ends[0], self.ends[1], position)


def _carrier(point: Point | FloatArray, carrier: Body, where: str) -> Carrier:
    if not isinstance(carrier, Beam | RigidBody):
        what = f'"{carrier.name}" is a {kind(carrier)}, must be a beam, a cable or a rigid body'
        raise ModelError(f"{where}.along", what)
    if isinstance(carrier, Beam) and carrier.closed:
        what = f'"{carrier.name}" is closed: nothing slides along a beam without ends'
        raise ModelError(f"{where}.along", what, "a beam with ends, or a contact with a ring")
    if isinstance(point, Point) and point.body is carrier:
        what = f'"{carrier.name}" is the body of {point} itself, it cannot slide along it'
        raise ModelError(f"{where}.along", what)
    return carrier


def _line(given: Any, carrier: Carrier, where: str) -> Line | None:
    if isinstance(carrier, Beam):
        if given is not None:
            what = f'is for rigid bodies, "{carrier.name}" is a {kind(carrier)}: the point slides along it'
            raise ModelError(where, what, "leave it out")
        return None
    if given is None:
        what = f'is missing: the rigid body "{carrier.name}" needs the start and end of the line, body axes'
        raise ModelError(where, what, "such as line=((0, 0, 0), (1, 0, 0))")
    ends = checks.array(given, where, (2, 3))
    start, end = (checks.place(place, f"{where}[{i}]") for i, place in enumerate(ends))
    if line_length((start, end)) <= 1e-12 * float(max(np.max(np.abs(start)), np.max(np.abs(end)))):
        raise ModelError(where, f"has no length: it starts and ends at {start.tolist()}")
    return start, end


def _offset(given: Any, carrier: Carrier, where: str) -> tuple[float, float]:
    y, z = (checks.array(given, where, (2,)) + 0.0).tolist()
    if (y or z) and isinstance(carrier, RigidBody):
        raise ModelError(where, f'is for beams, "{carrier.name}" is a rigid body', "move its line")
    if isinstance(carrier, Beam):
        try:
            carrier.at(0.0, y, z)
        except ModelError as error:
            raise ModelError(where, error.what, error.hint) from None
    return y, z


def _drives(force: Any, motion: Any, values: dict[str, float], where: str) -> dict[str, TimeFunction | None]:
    """Drive force and prescribed motion, of which a joint has one at most."""
    acting = [key for key in ("mass", "friction", "viscous") if values[key]]
    if motion is not None:
        for key in (["force"] if force is not None else []) + acting:
            what = "has no effect with motion, which prescribes s"
            raise ModelError(f"{where}.{key}", what, "give one of them")
    given = {"force": (force, "N"), "motion": (motion, "m")}
    return {k: None if f is None else TimeFunction(f, 1, f"{where}.{k}", u) for k, (f, u) in given.items()}


def _numbers(given: dict[str, Any], where: str) -> dict[str, float]:
    clean = {}
    for key, value in given.items():
        check = checks.positive if key == "friction_velocity" else checks.non_negative
        clean[key] = check(value, f"{where}.{key}")
    return clean


def _start(
    where: str,
    point: Point | FloatArray,
    track: _Track,
    s: Any,
    motion: TimeFunction | None,
    tolerance: float,
) -> float:
    """Arc length at the start, where the line is as near to the point as it must be."""
    position = initial_position(point)
    found, distance = track.nearest(position)
    key, start = "point", found
    if s is not None:
        key, start = "s", checks.number(s, f"{where}.s")
    if motion is not None and not (motion.missing and s is not None):
        begins = float(motion(0.0)[0])
        if s is not None and abs(start - begins) > NODE_TOLERANCE * track.length:
            raise ModelError(f"{where}.s", f"is {start:.9g} m, but motion starts from {begins:.9g} m")
        key, start = "motion", begins
    start = _inside(start, track.length, f"{where}.{key}")
    gap = distance if key == "point" else math.dist(track.position(start), position)
    if not gap <= tolerance + ROUNDING * track.length:
        _raise_off(f"{where}.{key}", point, track, start, gap, (found, distance))
    return start


def _inside(s: float, length: float, where: str) -> float:
    slack = NODE_TOLERANCE * length
    if not -slack <= s <= length + slack:
        raise ModelError(where, f"s = {s:g} m is off the line, 0 <= s <= {length:g} m")
    return min(max(s, 0.0), length)


def _raise_off(
    where: str, point: Point | FloatArray, track: _Track, s: float, gap: float, near: tuple[float, float]
) -> None:
    who = str(point) if isinstance(point, Point) else f"the ring at {point.tolist()}"
    line = f'the line of "{track.carrier.name}"'
    if s == near[0]:
        what = f"{who} is {gap:.6g} m off {line}, the nearest place is s = {s:.9g} m"
    else:
        what = f"{who} is {gap:.6g} m off {line} at s = {s:.9g} m"
        rest = near[1] if near[1] > ROUNDING * track.length else 0.0
        what += f", the nearest place is s = {near[0]:.9g} m, {rest:.6g} m off"
    raise ModelError(where, what, "give a tolerance if it comes there in the equilibrium")


def _directions(
    release: Any, unilateral: Any, tangent: FloatArray, where: str
) -> dict[str, FloatArray | None]:
    clean: dict[str, FloatArray | None] = {"release": None, "unilateral": None}
    for key, given in (("release", release), ("unilateral", unilateral)):
        if given is None:
            continue
        unit = checks.direction(given, f"{where}.{key}")
        if float(np.linalg.norm(np.cross(unit, tangent))) <= PERPENDICULAR:
            what = f"{unit.tolist()} is along the line, where the joint has no force"
            raise ModelError(f"{where}.{key}", what, "give a direction across it")
        clean[key] = unit
    one, two = clean.values()
    if one is not None and two is not None and abs(float(one @ two)) > PERPENDICULAR:
        what = f"must be perpendicular to release, their cosine is {float(one @ two):.3g}"
        raise ModelError(f"{where}.unilateral", what)
    return clean
