"""What stands beside the wires of a line: conductor rails and pantographs of bodies, beside formulas."""

from __future__ import annotations

import numpy as np

import ancf

from ... import catenary
from ...arrays import FloatArray
from ...model.bodies.rigid import RigidBody
from ...model.surfaces.contact import Contact
from ..check import Check

G = 9.81  # m/s^2
LENGTH, SPANS = 10.0, 15  # m
RAIL = catenary.Wire(EA=1.5e8, EI=2.3e5, mass=6.9, tension=0.0, expansion=2.3e-5, rail=True)
#: A load in the middle of a span of an endless beam on rigid supports lifts it by this, times F L^3/EI.
ENDLESS = 1.0 / 192.0 + 1.0 / (64.0 * (1.0 + np.sqrt(3.0)))
#: A level rod that carries the head of a pantograph: kg, m.
ROD, REACH = 45.0, 2.2
HEAD, SPRING, DAMPER, FORCE, CONTACT = 7.2, 4200.0, 10.0, 120.0, 50e3
SPEED, START = 40.0, 12.0  # m/s, m


def checks(short: bool = False) -> list[Check]:
    """Rails at rest, a lever's frequencies; the short form runs no lever along a line."""
    return [*_rail(), *_frequencies(), *([] if short else [*_arms(), *_runs()])]


def rail() -> catenary.Line:
    """A conductor rail on level supports, free along itself at both ends."""
    return catenary.Line(
        spans=(catenary.Span(length=LENGTH, droppers=()),) * SPANS,
        contact_wire=RAIL,
        steady_arm=catenary.SteadyArm(vertical=1e9),
        anchors="tension",
    )


def _rail() -> list[Check]:
    line, mesh = rail(), catenary.Mesh(contact=1.0)
    made, load = catenary.form(line, mesh), RAIL.mass * G
    x, _, z = made.contact.position.T
    sag = -float(np.interp(0.5 * SPANS * LENGTH, x, z))
    give = catenary.elasticity(line, (100.0,), points=2, mesh=mesh).lift[0, 1]
    found = [
        ("sag in the middle of a span", sag, load * LENGTH**4 / (384.0 * RAIL.EI), "m", "w L^4/(384 EI)"),
        ("load of a support", float(made.arm_force[SPANS // 2, 2]), load * LENGTH, "N", "w L"),
        (
            "uplift by 100 N in the middle of a span",
            float(give),
            100.0 * ENDLESS * LENGTH**3 / RAIL.EI,
            "m",
            "endless beam on rigid supports, theorem of three moments",
        ),
    ]
    return [
        Check(f"Overhead line, conductor rail: {name}", value, exact, 3e-3 * exact, unit, origin)
        for name, value, exact, unit, origin in found
    ]


def _arms() -> list[Check]:
    """A bar that is pulled stiffens the wire upwards by force over length, a strut softens it."""
    found, length, sides = [], 1.1, ("right", "left")
    free = _hung((catenary.SteadyArm(vertical=0.0),) * 6)
    for name, shift, push in (("that pulls", 0, False), ("that pushes", 1, True)):
        arms = tuple(
            catenary.SteadyArm(length=length, side=sides[(k + 1 + shift) % 2], push=push) for k in range(6)
        )
        made = _hung(arms)
        exact = (-1.0 if push else 1.0) * abs(float(made.arm_force[2, 1])) / length
        added = _upwards(made) - _upwards(free)
        whole = f"Overhead line, arm {name}: what it adds to the stiffness upwards"
        found.append(Check(whole, added, exact, 0.02 * abs(exact), "N/m", "force over length"))
        if not push:
            for part, value in (("left", made.arm_force[2, 1]), ("right", made.arm_force[1, 1])):
                pull = (1.0 if part == "left" else -1.0) * 4.0 * 0.2 * 20e3 / 32.0
                whole = f"Overhead line, arm at a stagger to the {part}: pull to the left"
                found.append(Check(whole, float(value), pull, 0.01 * abs(pull), "N", "4 T a/l"))
    return found


def _hung(arms: tuple[catenary.SteadyArm, ...]) -> catenary.Form:
    spans = (catenary.Span(length=32.0, droppers=tuple(32.0 * np.array([0.1, 0.3, 0.5, 0.7, 0.9]))),) * 5
    line = catenary.Line(
        spans=spans,
        contact_wire=catenary.Wire(EA=15e6, EI=1.0, mass=1.35, tension=20e3),
        messenger_wire=catenary.Wire(EA=11.6e6, EI=131.7, mass=1.07, tension=16e3),
        droppers=catenary.Droppers(stiffness=1e5),
        steady_arm=arms,
        system_height=1.2,
        stagger=0.2,
        contact_support="free",
    )
    return catenary.form(line, catenary.Mesh(contact=2.0, messenger=3.0, contact_support=0.1))


def _upwards(found: catenary.Form) -> float:
    """Stiffness of the contact wire at the third support, N/m."""
    overhead = catenary.assemble(found)
    point, rest = overhead.supports[2], ancf.equilibrium(overhead.model)
    overhead.model.add_force(point, (0.0, 0.0, 1.0))
    return 1.0 / float(ancf.equilibrium(overhead.model).position(point)[2] - rest.position(point)[2])


def _frequencies() -> list[Check]:
    """A rod on a bearing, the head on its tip, the stiffness of a contact above it: two masses."""
    model = ancf.Model()
    rod = _add_rod(model, np.array([REACH, 0.0, 0.0]), None)
    head = model.add_point_mass("head", at=(REACH, 0.0, 0.5), mass=HEAD)
    model.hold(head, position="xy")
    model.add_spring(rod.at(0.5 * REACH, 0.0, 0.0), head, stiffness=SPRING, length=0.5)
    model.add_spring(head, (REACH, 0.0, 20.5), stiffness=CONTACT, length=20.0)
    modes = ancf.modes(model, count=2)
    stiffness = np.array([[SPRING, -SPRING], [-SPRING, SPRING + CONTACT]])
    exact = np.sqrt(np.linalg.eigvals(stiffness / np.array([[ROD / 3.0], [HEAD]])).real)
    origin = "two masses, of which the lower one is a third of the rod"
    return [
        Check(f"Overhead line, pantograph as a lever: frequency {k + 1}", value, wanted, 1e-6, "Hz", origin)
        for k, (value, wanted) in enumerate(
            zip(modes.frequencies_hz[:2].tolist(), np.sort(exact) / (2.0 * np.pi), strict=True)
        )
    ]


def _runs() -> list[Check]:
    """The lever along a line beside the chain of masses that it is."""
    spans = (30.0, 36.0, 32.0, 38.0, 30.0)
    line = catenary.Line(
        spans=tuple(
            catenary.Span(length=a, droppers=tuple(a * np.array([0.1, 0.3, 0.5, 0.7, 0.9]))) for a in spans
        ),
        contact_wire=catenary.Wire(EA=15e6, EI=195.0, mass=1.35, tension=20e3),
        messenger_wire=catenary.Wire(EA=11.6e6, EI=131.7, mass=1.07, tension=16e3),
        droppers=catenary.Droppers(stiffness=1e5),
        steady_arm=catenary.SteadyArm(vertical=300.0),
        system_height=1.2,
        damping=catenary.Rayleigh(alpha=0.0125, beta=1e-4),
    )
    found = catenary.form(line, catenary.Mesh(contact=2.0, messenger=3.0))
    chain = catenary.Pantograph(
        masses=(ROD / 3.0, HEAD), stiffness=(0.0, SPRING), damping=(1e-6, DAMPER), static_force=FORCE
    )
    lever, other = catenary.assemble(found), catenary.assemble(found)
    deviation = float(np.std(_force(lever, _add_lever(lever))))
    wanted = float(np.std(_force(other, other.add_pantograph(chain, SPEED, start=START).meter)))
    name = "Overhead line, pantograph as a lever: standard deviation of its force along a line"
    return [Check(name, deviation, wanted, 2e-3 * wanted, "N", "the same run with a chain of two masses")]


def _force(overhead: catenary.Overhead, contact: Contact) -> FloatArray:
    result = ancf.simulate(
        overhead.model,
        t_end=2.0,
        step=1e-3,
        start=ancf.equilibrium(overhead.model),
        integrator=ancf.GeneralizedAlpha(0.9),
        sensors=[contact],
        energy=False,
    )
    return result.sensors.contact_force(contact)


def _add_lever(overhead: catenary.Overhead) -> Contact:
    """The rod under the line, its tip pushed up by the static force."""
    model, there = overhead.model, overhead.contact_at(START)
    push = model.add_force(there, (0.0, 0.0, FORCE))
    strip = float(ancf.equilibrium(model).position(there)[2]) + FORCE / CONTACT
    model.loads.remove(push)
    way = (f"{SPEED!r}*t", 0.0, 0.0)
    rod = _add_rod(model, np.array([START, 0.0, strip - 0.5]), way)
    head = model.add_point_mass("head", at=(START, 0.0, strip), mass=HEAD)
    model.hold(head, position="xy", displacement=way)
    for body in (rod, head):
        body.set_motion(velocity=(SPEED, 0.0, 0.0))
    end = rod.at(0.5 * REACH, 0.0, 0.0)
    model.add_spring(end, head, stiffness=SPRING, damping=DAMPER, length=0.5 + FORCE / SPRING)
    model.add_force(rod.at(0.0, 0.0, 0.0), (0.0, 0.0, ROD * G), name="balance")
    model.add_force(end, (0.0, 0.0, FORCE), name="lift")
    model.add_force(head, (0.0, 0.0, HEAD * G), name="balance of the head")
    touch: Contact = model.add_contact(head, overhead.contact_wire, stiffness=CONTACT, name="strip on wire")
    return touch


def _add_rod(model: ancf.Model, tip: FloatArray, way: tuple[str, float, float] | None) -> RigidBody:
    """A level rod behind its tip on two bearings, which stand still or go along the track."""
    inertia = ROD * REACH**2 / 12.0
    rod = model.add_rigid_body(
        "lever", at=tip - [0.5 * REACH, 0.0, 0.0], mass=ROD, inertia=(0.1, inertia, inertia)
    )
    for k, y in enumerate((-0.2, 0.2)):
        bearing = model.add_point_mass(f"bearing {k + 1}", at=tip - [REACH, -y, 0.0], mass=1.0)
        if way is None:
            model.pin(bearing)
        else:
            model.pin(bearing, displacement=way)
            bearing.set_motion(velocity=(SPEED, 0.0, 0.0))
        model.connect(bearing, rod.at(-0.5 * REACH, y, 0.0))
    return rod
