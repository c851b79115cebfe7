"""Error of a clamped beam's tip over the number of elements: order four."""

import numpy as np

import ancf
from ancf.viz import style


def tip(elements):
    model = ancf.Model()
    section = ancf.Section(EA=1e4, EI=1.0, rhoA=1.0)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section)
    model.clamp(beam.start)
    model.add_force(beam.end, (0, 0, -3.0))
    return ancf.equilibrium(model).position(beam.end)


counts = np.array([2, 4, 8, 16])
exact = tip(64)
errors = np.array([np.linalg.norm(tip(n) - exact) for n in counts])
with style.new_figure(100, 75) as figure:
    axes = figure.subplots()
    axes.loglog(counts, errors, "o-", color=style.BLUE, label="tip")
    axes.loglog(counts, errors[0] * (counts[0] / counts) ** 4.0, "--", color=style.LIGHT, label="order 4")
    axes.set(xlabel="elements", ylabel="error of the tip [m]")
    style.legend_above(figure, axes)
    figure.savefig("convergence.png")
