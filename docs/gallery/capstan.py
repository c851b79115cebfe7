"""Tension of a rope around a bollard while it is pulled, beside Euler's exponential."""

import numpy as np

import ancf
from ancf.model.file import read_study
from ancf.viz import style

study = read_study("examples/capstan.toml")
state = ancf.equilibrium(study.model)
rope, contact = study.model.beams["rope"], study.model.connections[0]
line = state.contact_line(contact)
x = line.x[line.normal > 0.0]
force = np.array([float(state.tension(rope.at(s))) for s in x])

with style.new_figure(110, 75) as figure:
    axes = figure.subplots(1, 1)
    axes.plot(x, force, ".", color=style.BLUE, label="rope")
    euler = force[-1] * np.exp(0.3 * (x - x[-1]) / 0.21)
    axes.plot(x, euler, "--", color=style.ORANGE, label="exp(0.3 angle)")
    axes.set(xlabel="place on the rope [m]", ylabel="tension [N]", yscale="log")
    style.legend_above(figure, axes)
    figure.savefig("capstan.png")
