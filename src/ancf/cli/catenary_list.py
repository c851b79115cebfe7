"""``ancf catenary list``: lines, pantographs and wires of the catalogue."""

from __future__ import annotations

from .screen import console, table


def show_catalogue() -> None:
    """Print three tables; a name is what files and options take."""
    from .. import catenary

    lines = table("line", "spans", "length [m]", "wave speed [km/h]", "title")
    for name in catenary.line_names():
        line = catenary.read_line(name)
        size = str(len(line.spans)), f"{line.length:g}", f"{3.6 * line.wave_speed:.0f}"
        lines.add_row(name, *size, line.title)
    kinds = table("pantograph", "masses [kg]", "force at 250 km/h [N]", "title")
    for name, unit in catenary.pantographs().items():
        masses = " / ".join(f"{mass:g}" for mass in unit.masses)
        kinds.add_row(name, masses, f"{unit.force(250 / 3.6):.0f}", unit.title)
    wires = table("wire", "mass [kg/m]", "EA [MN]", "EI [N m^2]", "diameter [mm]", "source", "tag")
    for name, data in catenary.wires().items():
        numbers = f"{data.mass:.3f}", f"{1e-6 * data.EA:.2f}", f"{data.EI:.0f}", f"{1e3 * data.diameter:.1f}"
        wires.add_row(name, *numbers, data.source, data.tag)
    screen = console()
    for made in (lines, kinds, wires):
        screen.print(made)
    screen.print(
        "tags: V read in a public source, V2 in two, U not yet checked against a copy of the standard"
    )
