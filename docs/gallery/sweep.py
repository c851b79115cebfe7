"""Fifty values of a stiffness: a frequency of a hanging cable, as a table and as a plot."""

import numpy as np

import ancf
from ancf.viz import style


def lowest(EA):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=EA, EI=0.1, rhoA=1.0)
    cable = model.add_beam("cable", start=(0, 0, 0), end=(20, 0, 0), elements=8, length=20.2, section=section)
    model.pin(cable.start)
    model.pin(cable.end)
    state = ancf.equilibrium(model)
    return {"frequency": ancf.modes(model, about=state, count=3).frequencies_hz[1]}


values = ancf.Discrete(list(np.geomspace(1e3, 1e5, 50)))
table = ancf.study(lowest, ancf.sample({"EA": values}, method="grid"), workers=0)
table.to_csv("sweep.csv")
with style.new_figure(110, 70) as figure:
    axes = figure.subplots()
    axes.plot(table["EA"], table["frequency"], "o-", color=style.BLUE, markersize=3)
    axes.set(xlabel="EA [N]", ylabel="second frequency [Hz]", xscale="log")
    figure.savefig("sweep.png")
