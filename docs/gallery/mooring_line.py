"""A chain on the seabed: its shape and the tension at its upper end, which drifts away."""

import numpy as np

import ancf
from ancf.viz import style

with style.new_figure(150, 60) as figure:
    axes = figure.subplots()
    for k, x in enumerate((90.0, 105.0, 115.0)):
        model = ancf.Model(gravity=(0, 0, -9.81))
        chain = ancf.Section(EA=5e7, EI=10.0, rhoA=60.0, diameter=0.1, drag=(1.6, 0.1), added_mass=(1.0, 0.0))
        line = model.add_beam(
            "line", start=(0, 0, -50), end=(x, 0, 0), elements=24, length=130.0, section=chain
        )
        model.add_fluid("sea", density=1025.0, below=0.0)
        model.add_ground("seabed", height=-50.0, stiffness=1e5)
        model.pin(line.start)
        model.pin(line.end)
        state = ancf.equilibrium(model)
        shape = np.array([state.position(line.at(s)) for s in np.linspace(0, 130, 120)])
        label = f"{state.tension(line.end) / 1e3:.0f} kN"
        axes.plot(shape[:, 0], shape[:, 2], label=label, **style.line(k))
    axes.axhline(-50, color=style.LIGHT, linewidth=4, zorder=0)
    axes.set(xlabel="x [m]", ylabel="z [m]", aspect="equal", ylim=(-53, 3))
    style.legend_above(figure, axes)
    figure.savefig("mooring_line.png")
