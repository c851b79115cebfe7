"""The line of case 7.5 for both sides: its description, its form at rest, our run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import ancf
from ancf import catenary
from cases import GRAVITY

if TYPE_CHECKING:
    from cases import Overhead


def line(case: Overhead) -> catenary.Line:
    """Description of the line."""
    pitch = case.span / case.droppers
    span = catenary.Span(length=case.span, droppers=tuple((j + 0.5) * pitch for j in range(case.droppers)))
    wires = [
        catenary.Wire(EA=case.EA, EI=case.EI, mass=mass, tension=case.tension, damping=case.damping)
        for mass in (case.rhoA, case.carrier_rhoA)
    ]
    return catenary.Line(
        spans=(span,) * case.spans,
        contact_wire=wires[0],
        messenger_wire=wires[1],
        droppers=catenary.Droppers(EA=case.dropper_EA, damping=case.dropper_damping),
        steady_arm=catenary.SteadyArm(vertical=0.0),
        system_height=case.height,
        messenger_clamp="continuous",
        stagger=case.zigzag,
        messenger_stagger=0.0,
        contact_support="free",
        gravity=GRAVITY,
    )


def form(case: Overhead) -> catenary.Form:
    """The line at rest; both sides take lengths of wires and droppers from it."""
    length = case.spans * case.span
    more = 1.01  # than the length of an element, which has to be divided evenly
    mesh = catenary.Mesh(contact=more * length / case.contact, messenger=more * length / case.carrier)
    found = catenary.form(line(case), mesh)
    assert (found.contact.arc.size, found.messenger.arc.size) == (case.contact + 1, case.carrier + 1)
    return found


def pantograph(case: Overhead) -> catenary.Pantograph:
    """The pantograph."""
    return catenary.Pantograph(
        masses=case.masses, stiffness=case.stiffness, damping=case.dampers, static_force=case.force
    )


def run(case: Overhead, shape: catenary.Form, contact: str) -> catenary.Run:
    """A run of ours with a kind of contact."""
    end = case.start + case.speed * case.t_end
    return catenary.run(
        shape,
        speed=case.speed,
        pantograph=pantograph(case),
        start=case.start,
        window=(case.start + 1e-3, end),
        until=end,
        contact=contact,
        step=case.step,
        integrator=ancf.GeneralizedAlpha(
            case.rho, newton=ancf.Newton(tolerance=1e-9, corotate=contact == "joint")
        ),
    )


def summary(force: Any) -> dict[str, float]:
    """Mean, standard deviation and extremes of a force, N; empty when there is none."""
    if not len(force):
        return {}
    return {
        "mean": float(np.mean(force)),
        "deviation": float(np.std(force)),
        "least": float(np.min(force)),
        "largest": float(np.max(force)),
    }
