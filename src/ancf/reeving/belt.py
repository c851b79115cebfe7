"""A flat belt on two pulleys that drives one with the other, beside creep theory.

The drive is that of Pechstein and Gerstmayr (Multibody Syst. Dyn. 30 (2013) 343) as Ntarladima, Pieber and
Gerstmayr have it (Nonlinear Dyn. 111 (2023), doi 10.1007/s11071-023-08973-y), with the numbers of Exudyn's
example of a belt drive and without weight, which creep theory does not know.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..analysis import equilibrium, simulate
from ..arrays import FloatArray
from ..model.bodies.reeving import Reeving
from ..model.integrators import GeneralizedAlpha
from ..model.model import Model
from ..model.sections.section import Section
from ..model.surfaces.shapes import Cylinder
from ..results import Result

#: Radius of the belt's axis on the pulleys, half of its thickness, distance of the centres, m.
RADIUS, HALF, APART = 0.1, 5e-5, 0.1 * math.pi
#: Stiffnesses, N and N m^2, and mass, kg/m, per length of the tensioned belt at rest; its strain there.
EA, EI, RHO_A, STRAIN = 8000.0, 4e-3 / 3.0, 0.8288, 0.05
FRICTION, SPEED = 0.5, 12.0
INERTIA, BRAKE, LOAD = 0.25, 2.0, 25.0
#: The peer takes steps of 12.5 us.
STEP, PEER_STEP, END, ELEMENTS = 2.5e-4, 12.5e-6, 2.45, 120


@dataclass(frozen=True)
class Creep:
    """What creep theory says of a belt drive in steady motion.

    Parameters
    ----------
    tight, slack : float, N
        Belt forces.
    driven : float, rad/s
        Speed of the driven pulley.
    torque : float, N m
    slip, stick : float, rad
        Arcs, the same on both pulleys.
    """

    tight: float
    slack: float
    driven: float
    torque: float
    slip: float
    stick: float


def creep_theory(natural: float) -> Creep:
    """Reynolds' creep with Euler's friction, exact in the stretch and with the belt's inertia.

    With its mass flow G and v = c lambda, the force P = T - G v is what a pulley feels and friction alone
    changes: P' = mu P in the slip arc. Where it runs onto a pulley it sticks, v = omega R. What closes the
    equations is its natural length, m.
    """
    from scipy.integrate import quad
    from scipy.optimize import fsolve

    EA_0, rho_0 = EA * (1.0 - STRAIN), RHO_A / (1.0 - STRAIN)

    def found(x: FloatArray) -> tuple[float, float, float, float, float]:
        tight, slack, flow = x
        inertia = rho_0 * flow * flow

        def stretch(P: float) -> float:
            return float((1.0 + P / EA_0) / (1.0 - inertia / EA_0))

        arc = math.log(tight / slack) / FRICTION
        slips = quad(lambda a: RADIUS / stretch(slack * math.exp(FRICTION * a)), 0.0, arc)[0]
        rest = APART + (math.pi - arc) * RADIUS
        length = rest / stretch(tight) + rest / stretch(slack) + 2.0 * slips
        return stretch(tight), stretch(slack), arc, length, inertia

    def residual(x: FloatArray) -> list[float]:
        first, second, _, length, _ = found(x)
        driven = x[2] * second / RADIUS
        return [
            x[2] * first - SPEED * RADIUS,
            (x[0] - x[1]) * RADIUS - (BRAKE * driven + LOAD),
            1e4 * (length - natural),
        ]

    x = fsolve(residual, [1.6 * EA * STRAIN, 0.4 * EA * STRAIN, SPEED * RADIUS], xtol=1e-12)
    first, second, arc, _, inertia = found(x)
    return Creep(
        tight=float(x[0] + inertia * first),
        slack=float(x[1] + inertia * second),
        driven=float(x[2] * second / RADIUS),
        torque=float((x[0] - x[1]) * RADIUS),
        slip=arc,
        stick=math.pi - arc,
    )


def drive(elements: int = ELEMENTS, bending: float = EI) -> Model:
    """The driving pulley turns as told, the driven one against a brake and a load that comes on at 1 s."""
    model = Model()
    section = Section(
        EA=EA * (1.0 - STRAIN),
        EI=bending,
        rhoA=RHO_A / (1.0 - STRAIN),
        diameter=2.0 * HALF,
        axial_damping=1.0,
    )
    path = Reeving([((0, 0, 0), RADIUS), ((APART, 0, 0), RADIUS)], axis=(0, -1, 0))
    model.add_beam(
        "belt",
        path=path,
        closed=True,
        elements=elements,
        section=section,
        length=path.length * (1.0 - STRAIN),
        natural_shape="straight",
    )
    for name, x in (("driving", 0.0), ("driven", APART)):
        wheel = model.add_rigid_body(name, at=(x, 0, 0), mass=50.0, inertia=(INERTIA, INERTIA, INERTIA))
        rim = model.add_surface(f"rim {name}", Cylinder(radius=RADIUS - HALF, axis=(0, 1, 0)), on=wheel)
        model.add_surface_contact(
            "belt", rim, stiffness=3.2e8, damping=6400.0, friction=FRICTION, stick=4e9, name=f"on {name}"
        )
    ramp = "min(max(t - 0.05, 0), 0.55)"
    model.clamp(
        "driving",
        rotation=f"{SPEED}*(0.5*{ramp}**2/0.55 + max(t - 0.6, 0))",
        rotation_rate=f"{SPEED}*{ramp}/0.55",
        rotation_acceleration=f"{SPEED}/0.55*(step(t - 0.05) - step(t - 0.6))",
        axis=(0, -1, 0),
    )
    model.hinge("driven", (APART, 0, 0), axis=(0, 1, 0))
    drag = BRAKE / (2.0 * RADIUS**2)
    for z in (RADIUS, -RADIUS):  # a brake: two opposite forces against the motion of the rim
        force = [f"-{drag}*vx", f"-{drag}*vy", f"-{drag}*vz"]
        model.add_force(wheel.at(0, 0, z), force)
    model.add_moment("driven", (0, f"{LOAD}*ramp(t, 1, 1.5)", 0))
    return model


def motion(elements: int = ELEMENTS, step: float = STEP, end: float = END, bending: float = EI) -> Result:
    """The drive from its equilibrium at rest to a steady motion."""
    model = drive(elements, bending)
    start = equilibrium(model, of=["belt"])
    return simulate(
        model,
        t_end=end,
        step=step,
        output_step=0.01,
        start=start,
        sensors=["on driving", "on driven"],
        integrator=GeneralizedAlpha(rho_inf=0.6),
    )


def run(
    elements: int = ELEMENTS, step: float = STEP, end: float = END, bending: float = EI
) -> dict[str, float]:
    """The drive in steady motion at the end of a simulation.

    Returns
    -------
    dict
        As :class:`Creep` has them, what :func:`on_pulley` finds of each pulley, with its name behind, and
        theory's numbers, with ``theory`` before.
    """
    result = motion(elements, step, end, bending)
    belt, last = result.model.beams["belt"], result.state(-1)
    driven = float(-result.angular_velocity("driven")[-20:, 1].mean())
    x = belt.length * (np.arange(elements) + 0.5) / elements
    place = np.array([last.position(belt.at(s)) for s in x])
    tension = np.array([float(last.tension(belt.at(s))) for s in x])
    inside = (place[:, 0] > 0.3 * APART) & (place[:, 0] < 0.7 * APART)
    found = {
        "tight": float(tension[inside & (place[:, 2] > 0.0)].mean()),
        "slack": float(tension[inside & (place[:, 2] < 0.0)].mean()),
        "driven": driven,
        "torque": BRAKE * driven + LOAD,
    }
    for name, centre, side in (("driving", 0.0, -1.0), ("driven", APART, 1.0)):
        arcs = on_pulley(last, belt, name, centre, side)
        found |= {f"{key} {name}": value for key, value in arcs.items()}
    theory = creep_theory(belt.length)
    return found | {f"theory {key}": float(value) for key, value in vars(theory).items()}


def on_pulley(state: Any, belt: Any, name: str, centre: float, side: float) -> dict[str, float]:
    """Arcs of a pulley, rad, and the torque of its friction, N m.

    Sticking ends where the line through the logarithm of the pressure in the slip arc, whose slope is the
    friction there, meets the pressure of the stick arc.
    """
    line = state.contact_line(f"on {name}")
    places = [belt.at(s) for s in line.x]
    arm = np.array([state.position(p) for p in places]) - (centre, 0.0, 0.0)
    on = line.normal > 0.0
    angle = np.arctan2(arm[:, 2] * side, arm[:, 0] * side)[on]  # from where the belt runs on to where off
    length = belt.length / belt.elements * 0.5 * np.tile(np.polynomial.legendre.leggauss(5)[1], belt.elements)
    torque = float(np.sum(length[:, None] * np.cross(arm, line.friction), axis=0)[1])
    stretch = np.array(
        [float(np.linalg.norm(state.slope(p))) for p in places]
    )  # forces are per natural length
    slips, level = line.slips[on], np.log((line.normal / stretch)[on])
    middle = np.abs(angle) < 0.5 * math.pi - 0.1
    slope, at_zero = np.polyfit(angle[slips & middle], level[slips & middle], 1)
    sticks = float(np.median(level[~slips & middle]))
    ends = (sticks - at_zero) / slope
    return {
        "slip": 0.5 * math.pi - ends,
        "stick": ends + 0.5 * math.pi,
        "torque": abs(torque),
    }
