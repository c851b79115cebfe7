"""Static elasticity of a contact wire along a span: soft in the middle, stiff at the supports."""

from dataclasses import replace

from ancf import catenary
from ancf.viz import style

line = catenary.read_line("en50318-2002")
short = replace(line, spans=line.spans[:3], system_height=1.2, stagger=0.0)
found = catenary.elasticity(short, points=25, mesh=catenary.Mesh(contact=2.0, messenger=5.0))
with style.new_figure(130, 65) as figure:
    axes = figure.subplots()
    for k, force in enumerate(found.force):
        axes.plot(found.x, 1e3 * found.lift[k] / force, label=f"{force:g} N", **style.line(k))
    axes.set(xlabel="track position [m]", ylabel="lift per force [mm/N]", ylim=(0, None))
    style.legend_above(figure, axes)
    figure.savefig("elasticity.png")
