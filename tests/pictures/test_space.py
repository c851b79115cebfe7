"""Pictures in space: what is drawn fills its place, and no label runs into the colour bar."""

from itertools import product

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from mpl_toolkits.mplot3d.proj3d import proj_transform

import ancf

#: Ends of a rope, m: as a long line, a riser, a cube, flat on the ground, small.
ENDS = {
    "long": (300.0, 40.0, 25.0),
    "tall": (20.0, 25.0, -300.0),
    "cube": (1.0, 1.0, 1.0),
    "flat": (50.0, 50.0, 3.0),
    "small": (2e-3, 1e-3, 5e-4),
}


@pytest.mark.parametrize("end", ENDS.values(), ids=ENDS)
@pytest.mark.parametrize("color", ["tension", "plain"])
def test_fills_its_place(end, color):
    model = ancf.Model()
    section = ancf.Section(EA=1e4, EI=0.1, rhoA=0.1)
    rope = model.add_beam("rope", start=(0, 0, 0), end=end, elements=4, section=section)
    model.pin(rope.start)
    run = ancf.simulate(model, t_end=1e-3, step=1e-3)
    figure = run.plot_shape(2, color=color, plane="xyz").figure
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    axes, *bars = figure.axes
    corners = np.array(list(product(axes.get_xlim(), axes.get_ylim(), axes.get_zlim()))).T
    seen = np.column_stack(proj_transform(*corners, axes.get_proj())[:2])
    drawn = figure.transFigure.inverted().transform(axes.transData.transform(seen))
    low, high = drawn.min(axis=0), drawn.max(axis=0)
    width, height = high - low
    assert height > 0.55 or width > 0.5, "small in a large picture"
    assert low.min() > 0.0
    assert high.max() < 1.0
    for bar in bars:
        left = bar.get_window_extent().x0
        for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
            assert axis.get_tightbbox(canvas.get_renderer()).x1 < left
