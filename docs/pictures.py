"""Make the pictures in docs/_static: overview.png of the README, the knot, figures for the theory pages.

Run from the repository root: python docs/pictures.py
"""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

import ancf
from ancf.model.file import read_study
from ancf.paper import reproduce
from ancf.viz import style

STATIC = Path(__file__).parent / "_static"
FIGURES = ("fig1", "fig2")
SIZE = (244.0, 84.0)  # mm


def nodes(result: ancf.Result | ancf.State, beam: str, length: float, count: int = 41) -> np.ndarray:
    """Positions of points along a beam, shape (count, n_t, 3) or (count, 3)."""
    return np.array([result.position(f"{beam}.at({x})") for x in np.linspace(0, length, count)])


def cantilever(axes: Axes) -> None:
    """Shapes of the falling cantilever of the paper's example 7.1."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=16, section=section)
    model.clamp(beam.start)
    result = ancf.simulate(model, t_end=0.4, step=2.5e-4, output_step=0.05)
    shapes = nodes(result, "beam", 1.0)
    for k in range(len(result.t)):
        shade = 0.25 + 0.75 * k / (len(result.t) - 1)
        axes.plot(shapes[:, k, 0], shapes[:, k, 2], color=style.BLUE, alpha=shade)
    axes.set(title="falling cantilever, every 0.05 s", xlabel="x [m]", ylabel="z [m]", xlim=(-0.03, 1.05))
    axes.set_aspect("equal", adjustable="datalim")


def pendulum(axes: Axes) -> None:
    """Path of the tip of the soft three-dimensional pendulum of example 7.2."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=40.0, EI=8.333e-5, rhoA=0.008)
    beam = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=16, section=section)
    model.pin(beam.start)
    beam.set_motion(angular_velocity=(0, 0, 4))
    result = ancf.simulate(model, t_end=2.0, step=2e-4, output_step=2e-3)
    tip = result.position(beam.end)
    axes.plot(*tip.T, color=style.LIGHT, lw=1)
    shapes = nodes(result, "rope", 1.0)
    for k in range(0, len(result.t), 125):
        axes.plot(*shapes[:, k].T, color=style.BLUE)
    axes.set(title="soft 3D pendulum, path of the tip", xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    axes.view_init(22, -60)
    axes.set(xticks=(-1, 0, 1), yticks=(-0.5, 0.5), zticks=(-0.6, -0.3, 0))
    axes.set_box_aspect((1.0, 1.0, 0.6), zoom=0.86)


def hanging(axes: Axes) -> None:
    """Slack cables: start shapes and equilibria."""
    for number, length in enumerate((10.1, 10.5, 12.0)):
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e6, EI=1.0, rhoA=1.0)
        model.add_beam("c", start=(0, 0, 0), end=(10, 0, 1), elements=40, section=section, length=length)
        model.pin("c.start")
        model.pin("c.end")
        state = ancf.equilibrium(model)
        shape = nodes(state, "c", length)
        label = f"{length:g} m, {state.tension('c.start'):.0f} N"
        axes.plot(shape[:, 0], shape[:, 2], label=label, **style.line(number))
    axes.plot([0, 10], [0, 1], color=style.LIGHT, lw=1, label="start")
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, 1.0), fontsize="small")
    axes.set_ylim(-2.7, 3.2)
    axes.set(title="slack cables: length, tension at the left end", xlabel="x [m]", ylabel="z [m]")


def figures() -> None:
    """Copy figures of the paper."""
    with tempfile.TemporaryDirectory() as folder:
        reproduce(FIGURES, folder)
        for name in FIGURES:
            shutil.copy(Path(folder) / f"{name}.png", STATIC)


def overview() -> None:
    """Draw the three panels."""
    with style.new_figure(*SIZE) as figure:
        grid = figure.add_gridspec(1, 3, width_ratios=(1, 1.25, 1.2))
        figure.get_layout_engine().set(w_pad=0.15)
        cantilever(figure.add_subplot(grid[0]))
        pendulum(figure.add_subplot(grid[1], projection="3d"))
        hanging(figure.add_subplot(grid[2]))
        (STATIC / "overview.png").write_bytes(style.png(figure, dpi=160))


def rope(axes: Axes, shape: np.ndarray, diameter: float) -> None:
    """A rope as thick as it is, seen from above: what is higher hides what is below."""
    axes.set(aspect="equal", xlim=(-0.16, 0.30), ylim=(-0.085, 0.27), xlabel="x [m]", ylabel="y [m]")
    axes.figure.canvas.draw()
    wide = 72.0 / axes.figure.dpi * diameter * np.diff(axes.transData.transform([(0, 0), (1, 0)])[:, 0])[0]
    for k in np.argsort(shape[1:-2, 2]) + 1:
        piece = shape[k - 1 : k + 3]
        axes.plot(piece[1:-1, 0], piece[1:-1, 1], color="black", lw=wide, solid_capstyle="butt")
        axes.plot(piece[:, 0], piece[:, 1], color=style.BLUE, lw=0.8 * wide, solid_capstyle="butt")


def knot() -> None:
    """The knot of examples/knot.toml while it is pulled tight."""
    study = read_study(STATIC.parents[1] / "examples" / "knot.toml")
    given = study.simulation
    run = ancf.simulate(
        study.model, t_end=0.6, step=given.step, integrator=given.integrator, output_step=0.05
    )
    beam = study.model.beams["rope"]
    shapes = nodes(run, "rope", beam.length, 1200)
    with style.new_figure(244.0, 62.0) as figure:
        for axes, t in zip(figure.subplots(1, 4), (0.0, 0.25, 0.35, 0.6), strict=True):
            k = round(t / 0.05)
            rope(axes, shapes[:, k], beam.section.diameter)
            force = 20.0 * min(t / 0.3, 1.0)
            axes.set_title(f"{t:g} s, {force:.0f} N")
        (STATIC / "knot.png").write_bytes(style.png(figure, dpi=160))


def edge() -> None:
    """How the cable of examples/edge.toml slides off its table."""
    study = read_study(STATIC.parents[1] / "examples" / "edge.toml")
    run = ancf.simulate(study.model, t_end=0.8, step=study.simulation.step, output_step=0.2)
    shapes, a = nodes(run, "cable", study.model.beams["cable"].length, 400), np.linspace(0, 2 * np.pi, 90)
    with style.new_figure(110.0, 100.0) as figure:
        axes = figure.subplots()
        axes.fill([-0.9, 0, 0, -0.9], [0, 0, -0.9, -0.9], color=style.LIGHT)
        axes.fill(0.06 * np.cos(a), 0.06 * np.sin(a) - 0.06, color=style.LIGHT)
        for k in range(shapes.shape[1]):
            label = f"{run.t[k]:g} s"
            axes.plot(shapes[:, k, 0], shapes[:, k, 2], color=style.BLUE, alpha=0.3 + 0.17 * k, label=label)
        axes.set(aspect="equal", xlim=(-1.0, 0.45), ylim=(-1.1, 0.1), xlabel="x [m]", ylabel="z [m]")
        axes.legend(loc="lower right")
        (STATIC / "edge.png").write_bytes(style.png(figure, dpi=160))


def belt() -> None:
    """Belt force around examples/belt.toml in steady motion, and its stick and slip, beside creep theory."""
    from ancf.reeving.belt import FRICTION, creep_theory, motion

    result = motion()
    state, loop = result.state(-1), result.model.beams["belt"]
    theory = creep_theory(loop.length)
    with style.new_figure(165.0, 66.0) as figure:
        axes = figure.subplots(1, 2)
        for side, (name, centre, sign) in enumerate((("driving", 0.0, -1.0), ("driven", 0.314159, 1.0))):
            line = state.contact_line(f"on {name}")
            arm = np.array([state.position(loop.at(x)) for x in line.x]) - (centre, 0.0, 0.0)
            angle = np.degrees(np.arctan2(arm[:, 2] * sign, arm[:, 0] * sign))
            on = line.normal > 0.0
            force = np.array([float(state.tension(loop.at(x))) for x in line.x[on]])
            for mark, slips, color in (("sticks", False, style.BLUE), ("slips", True, style.ORANGE)):
                here = line.slips[on] == slips
                axes[side].plot(angle[on][here], force[here], ".", color=color, label=mark, markersize=3)
            first, last = (theory.tight, theory.slack) if side == 0 else (theory.slack, theory.tight)
            a = np.linspace(-90.0, 90.0, 181)
            way = np.maximum(np.radians(a + 90.0) - theory.stick, 0.0)
            grown = first * np.exp(np.sign(last - first) * FRICTION * way)
            axes[side].plot(a, grown, color="black", linewidth=0.7, label="creep theory")
            axes[side].set(
                title=f"{name} pulley", xlabel="angle from the line of centres [deg]", ylabel="belt force [N]"
            )
            axes[side].set_xticks(range(-90, 91, 45))
        axes[0].legend()
        (STATIC / "belt.png").write_bytes(style.png(figure, dpi=160))


if __name__ == "__main__":
    overview()
    knot()
    figures()
    belt()
    edge()
