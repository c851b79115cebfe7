"""Total energy of a chain that falls: the trapezoidal rule keeps it, numerical damping takes it out."""

import ancf
from ancf.viz import style

with style.new_figure(120, 75) as figure:
    axes = figure.subplots()
    methods = (ancf.Trapezoidal(), ancf.GeneralizedAlpha(rho_inf=0.8), ancf.GeneralizedAlpha(rho_inf=0.3))
    for k, method in enumerate(methods):
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e3, EI=1e-3, rhoA=0.1)
        chain = model.add_beam("chain", start=(0, 0, 0), end=(1, 0, 0), elements=10, section=section)
        model.pin(chain.start)
        result = ancf.simulate(model, t_end=1.5, step=1e-3, integrator=method)
        label = f"{type(method).__name__}({getattr(method, 'rho_inf', '')})"
        axes.plot(result.t, result.energy.total - result.energy.total[0], label=label, **style.line(k))
    axes.set(xlabel="time [s]", ylabel="change of the energy [J]")
    style.legend_above(figure, axes)
    figure.savefig("energy_of_methods.png")
