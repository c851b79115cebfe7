"""Contact force of a pantograph at 250 km/h on the reference line of EN 50318:2002."""

from dataclasses import replace

from ancf import catenary
from ancf.viz import style

line = catenary.read_line("en50318-2002")
line = replace(line, spans=line.spans[:5], system_height=1.2, stagger=0.0)
run = catenary.run(
    line,
    speed=250 / 3.6,
    pantograph="en50318-2002",
    window=(120.0, 240.0),
    step=2e-3,
    mesh=catenary.Mesh(contact=2.0, messenger=5.0),
)
found = catenary.statistics(run)
place = run.recordings[0].position[found.window]
with style.new_figure(150, 65) as figure:
    axes = figure.subplots()
    axes.plot(place, run.recordings[0].force[found.window], color=style.LIGHT, label="unfiltered")
    axes.plot(place, found.force[found.window], color=style.BLUE, label="below 20 Hz")
    axes.set(xlabel="track position [m]", ylabel="contact force [N]", ylim=(0, None))
    style.legend_above(figure, axes)
    figure.savefig("overhead_force.png")
