"""A contact wire hung from a messenger wire by droppers that pull but do not push, lifted in the middle."""

import numpy as np

import ancf

SPAN = 50.0  # m
DROPPERS = (5.0, 15.0, 25.0, 35.0, 45.0)  # m
LENGTHS = (1.07, 0.896, 0.838, 0.896, 1.07)  # m, without force


def build(elements: int = 40) -> ancf.Model:
    EA, tension = 1e7, 1e4  # N
    natural = SPAN / (1 + tension / EA)  # shorter than the span: both wires are taut
    model = ancf.Model(gravity=(0.0, 0.0, -9.81), title="Messenger and contact wire")
    for name, height, mass in (("messenger", 1.2, 0.45), ("contact", 0.0, 0.89)):
        wire = model.add_beam(
            name,
            start=(0, 0, height),
            end=(SPAN, 0, height),
            length=natural,
            elements=elements,
            section=ancf.Section(EA=EA, EI=150.0, rhoA=mass, damping=0.03),
        )
        model.pin(wire.start)
        model.pin(wire.end)
    for x, length in zip(DROPPERS, LENGTHS, strict=True):
        ends = (f"messenger.at({x})", f"contact.at({x})")
        model.add_spring(*ends, stiffness=1e5, damping=8.0, length=length, slack=True, name=f"dropper {x}")
    model.add_force("contact.at(25.0)", (0, 0, "250*ramp(t, 0, 0.1)*(1 - ramp(t, 0.2, 0.3))"))  # N
    return model


def main(t_end: float = 3.0) -> None:
    model = build()
    state = ancf.equilibrium(model)
    result = ancf.simulate(
        model, t_end=t_end, step=1e-3, start=state, integrator=ancf.GeneralizedAlpha(rho_inf=0.8)
    )
    for x, length in zip(DROPPERS, LENGTHS, strict=True):
        between = result.position(f"messenger.at({x})") - result.position(f"contact.at({x})")
        force = np.maximum(1e5 * (np.linalg.norm(between, axis=1) - length), 0.0)
        slack = np.mean(force == 0.0)
        print(
            f"dropper at {x:4.1f} m: {force[0]:.1f} N at rest, {force.max():.1f} N at most, slack {slack:.0%}"
        )
    lift = result.position("contact.at(25.0)")[:, 2]
    print(f"contact wire at midspan: {lift[0]:.4f} m at rest, {lift.max():.4f} m at most")


if __name__ == "__main__":
    main()
