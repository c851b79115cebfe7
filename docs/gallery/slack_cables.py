"""Equilibria of cables that are longer than the way between their ends."""

import numpy as np

import ancf
from ancf.viz import style

with style.new_figure(120, 75) as figure:
    axes = figure.subplots()
    for k, length in enumerate((10.1, 10.5, 12.0)):
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e6, EI=1.0, rhoA=1.0)
        cable = model.add_beam(
            "cable", start=(0, 0, 0), end=(10, 0, 1), elements=20, section=section, length=length
        )
        model.pin(cable.start)
        model.pin(cable.end)
        state = ancf.equilibrium(model)
        shape = np.array([state.position(cable.at(x)) for x in np.linspace(0, length, 80)])
        label = f"{length} m: {state.tension(cable.start):.0f} N"
        axes.plot(shape[:, 0], shape[:, 2], label=label, **style.line(k))
    axes.set(xlabel="x [m]", ylabel="z [m]", aspect="equal")
    style.legend_above(figure, axes)
    figure.savefig("slack_cables.png")
