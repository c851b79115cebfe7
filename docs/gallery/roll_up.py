"""A moment of 2 pi EI/L bends a straight strip into a closed circle."""

import numpy as np

import ancf
from ancf.viz import style

with style.new_figure(120, 75) as figure:
    axes = figure.subplots()
    for k, share in enumerate((0.25, 0.5, 0.75, 1.0)):
        model = ancf.Model()
        section = ancf.Section(EA=1e5, EI=1.0, rhoA=0.1)
        strip = model.add_beam("strip", start=(0, 0, 0), end=(1, 0, 0), elements=16, section=section)
        model.clamp(strip.start)
        model.add_moment(strip.end, (0, -2 * np.pi * share, 0))
        state = ancf.equilibrium(model, load_steps=10)
        shape = np.array([state.position(strip.at(x)) for x in np.linspace(0, 1, 100)])
        axes.plot(shape[:, 0], shape[:, 2], label=f"{share:g} of 2π EI/L", **style.line(k))
    axes.set(xlabel="x [m]", ylabel="z [m]", aspect="equal")
    style.legend_above(figure, axes)
    figure.savefig("roll_up.png")
