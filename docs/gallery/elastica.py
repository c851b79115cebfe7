"""A column beyond its buckling load, beside the elastica (elliptic integrals)."""

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipk

import ancf
from ancf.viz import style

critical = np.pi**2 / 4  # of a cantilever, EI = L = 1
ratios, sway = (1.02, 1.05, 1.1, 1.2, 1.4, 1.7, 2.0), []
for ratio in ratios:
    model = ancf.Model()
    section = ancf.Section(EA=1e6, EI=1.0, rhoA=1.0)
    column = model.add_beam("column", start=(0, 0, 0), end=(0, 0, 1), elements=8, section=section)
    model.clamp(column.start)
    model.add_force(column.end, (1e-3, 0, -ratio * critical))
    sway.append(ancf.equilibrium(model, load_steps=4).position(column.end)[0])
loads = np.linspace(1.001, 2.0, 100)
m = [brentq(lambda m, p=p: ellipk(m) - np.pi / 2 * np.sqrt(p), 0, 0.99) for p in loads]

with style.new_figure(110, 75) as figure:
    axes = figure.subplots()
    axes.plot(loads, 2 * np.sqrt(m) / (np.pi / 2 * np.sqrt(loads)), label="elastica", **style.line(0))
    axes.plot(ratios, np.abs(sway), "o", color=style.ORANGE, label="8 cable elements")
    axes.set(xlabel="load / buckling load", ylabel="sway of the tip / length")
    style.legend_above(figure, axes)
    figure.savefig("elastica.png")
