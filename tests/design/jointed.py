"""Mechanisms for the tests of gradients through joints."""

import ancf
from helpers import SOFT

NEWTON = ancf.Newton(tolerance=1e-14, modified=False)


def arms():
    """Two rigid bodies on hinges whose axes are not parallel; the first hangs from the ground."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    hub = model.add_rigid_body("hub", at=(0.5, 0, 0), mass=1.0, inertia=(0.01, 0.1, 0.1))
    arm = model.add_rigid_body("arm", at=(1.3, 0, 0), mass=0.7, inertia=(0.06, 0.1, 0.05))
    model.hinge(hub.at(-0.5, 0, 0), (0.0, 0.0, 0.0), axis=(0, 1, 0), name="hinge")
    model.hinge(hub.at(0.5, 0, 0), arm.at(-0.3, 0, 0), axis=(0, 1, 0.3), name="elbow")
    return model


def machine(stretch="free", damped=True, **sliding):
    """Damped cable - hub - arm in a loop, a mass that slides on the cable and one on the arm, local axes."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    damping = {"axial_damping": 2.0, "bending_damping": 0.01} if damped else {}
    section = ancf.Section(**SOFT, **damping)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0), elements=3, section=section)
    stay = model.add_beam("stay", start=(2, 0, 0), end=(2, 1, 0.5), elements=2, section=section)
    hub = model.add_rigid_body("hub", at=(2.2, 0, 0), mass=1.5, inertia=(0.3, 0.4, 0.5))
    arm = model.add_rigid_body("arm", at=(2.7, 0, 0), mass=0.8, inertia=(0.0, 0.2, 0.2))
    model.pin(wire.start, displacement=(0, 0, "0.02*(1 - cos(9*t))"), name="anchor")
    model.clamp(stay.end, stretch=stretch)
    model.clamp(wire.end, to=hub, name="clamp")
    model.connect(stay.start, hub.at(-0.2, 0, 0), name="ball")
    model.hinge(hub.at(0.3, 0, 0), arm.at(-0.2, 0, 0), axis=(0, 1, 1), name="hinge")
    tip = model.add_point_mass("tip", at=wire.initial_position(0.5), mass=0.3)
    model.slide(tip, along=wire, s=0.5, name="ring", **{"mass": 0.2, "viscous": 0.3} | sliding)
    bob = model.add_point_mass("bob", at=(2.9, 0, 0), mass=0.4)
    model.slide(bob, along=arm, line=((-0.1, 0, 0), (0.6, 0, 0)), name="bead")
    model.add_spring(bob, (2.9, 0.2, 0.5), stiffness=30.0, damping=0.5, length=0.4, name="coil")
    return model


def methods():
    """All formulations of the methods that have sensitivities, by name."""
    trapezoidal = ("index1", "index2", "ggl")
    found = {f"trapezoidal {f}": ancf.Trapezoidal(newton=NEWTON, formulation=f) for f in trapezoidal}
    for f in ("index1", "index2", "ggl", "index3"):
        found[f"generalized {f}"] = ancf.GeneralizedAlpha(rho_inf=0.8, newton=NEWTON, formulation=f)
    return found
