"""The same cantilever with and without damping, compared."""

import ancf
from ancf.viz import style


def run(bending_damping):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.1, rhoA=0.05, bending_damping=bending_damping)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=6, section=section)
    model.clamp(beam.start)
    return ancf.simulate(model, t_end=3.0, step=2e-3)


with style.new_figure(120, 70) as figure:
    axes = figure.subplots()
    for k, damping in enumerate((0.0, 0.005)):
        result = run(damping)
        label = f"bending_damping = {damping} N m² s"
        axes.plot(result.t, result.position("beam.end")[:, 2], label=label, **style.line(k))
    axes.set(xlabel="time [s]", ylabel="height of the tip [m]")
    style.legend_above(figure, axes)
    figure.savefig("two_results.png")
