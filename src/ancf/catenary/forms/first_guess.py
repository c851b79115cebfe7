"""Where form finding starts: the wires of a line as strings without bending stiffness."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ..lines.cant import plumb_above
from ..lines.line import Line
from ..lines.wire import Wire
from .along_track import curve_pull, lumped_pull
from .clamps import missing_give
from .hang import Hung, masses
from .mesh import Mesh, Nodes, stitch_ends
from .shape import WireShape, started
from .strings import lumped, string_loads, string_shape

STEEPEST = 0.5  # slope of a contact wire


def first_guess(line: Line, mesh: Mesh) -> Hung:
    """All wires as strings under their tensions.

    Raises
    ------
    ModelError
        A wire would hang too steep, the mesh is too large, or the numbers are beyond what can be computed.

    """
    try:
        with np.errstate(all="ignore"):
            begun = _first_guess(line, mesh)
    except (ValueError, np.linalg.LinAlgError) as error:
        if isinstance(error, ModelError):
            raise
        raise _beyond() from None
    every = (begun.contact, begun.messenger, begun.auxiliary, *begun.stitches)
    shapes = [s for s in every if s is not None]
    if not all(np.all(np.isfinite(shape.position)) for shape in shapes) or not np.all(
        np.isfinite(begun.lift)
    ):
        raise _beyond()
    return begun


def _beyond() -> ModelError:
    what = "cannot be hung: numbers of its wires are too large or too small to compute with"
    return ModelError("line", what, "see whether tensions, masses and heights are as meant; in N, kg/m, m")


def _first_guess(line: Line, mesh: Mesh) -> Hung:
    contact, load = _contact(line, mesh)
    load = load + line.droppers.clamp_contact * line.gravity
    down = load + line.droppers.clamp_messenger * line.gravity
    auxiliary, long_load = _auxiliary(line, mesh, down)
    if line.auxiliary is not None:
        down = long_load + line.auxiliary.droppers.clamp_messenger * line.gravity
    stitches, ends = _stitches(line, mesh, down)
    messenger = None if line.messenger_wire is None else _messenger(line, mesh, down, ends)
    count = line.supports.size
    placed = []
    for k, shape in enumerate(stitches):
        assert messenger is not None
        height = np.interp(shape.nodes.x, messenger.nodes.x, messenger.position[:, 2])
        side = np.interp(shape.nodes.x, messenger.nodes.x, messenger.position[:, 1])
        z = shape.position[:, 2] + np.interp(shape.nodes.x, shape.nodes.x[[0, -1]], height[[0, -1]])
        placed.append(started(shape.wire, shape.nodes, side, z))
        ends[k, :, 0] = shape.wire.tension * np.array([-1.0, 1.0])
    return Hung(
        line=line,
        contact=contact,
        messenger=messenger,
        stitches=tuple(placed),
        lift=load,
        arm=np.zeros((count, 3)),
        support=np.zeros(count),
        side=np.zeros(count),
        ends=ends,
        give=_give(line, contact, messenger if auxiliary is None else auxiliary, placed),
        auxiliary=auxiliary,
        long_lift=long_load,
        long_give=_long_give(auxiliary, messenger),
        auxiliary_side=np.zeros(count),
    )


def _long_give(auxiliary: WireShape | None, messenger: WireShape | None) -> FloatArray:
    """What auxiliary and messenger lack at the clamps between them (2, m), m/N.

    Where a dropper hangs below another one, what it pulls down the other one pulls up: little of both is left
    to bend the auxiliary, which then lacks nothing for either.
    """
    if auxiliary is None or messenger is None:
        return np.zeros((2, 0))
    low = missing_give(auxiliary.wire, auxiliary.nodes, auxiliary.nodes.stitch)
    low[np.isin(auxiliary.nodes.stitch, auxiliary.nodes.dropper)] = 0.0
    high = missing_give(messenger.wire, messenger.nodes, messenger.nodes.dropper, messenger.hinges)
    return np.stack([low, high])


def _auxiliary(line: Line, mesh: Mesh, down: FloatArray) -> tuple[WireShape | None, FloatArray]:
    """The auxiliary under its droppers, held at its height, and what holds it there, N."""
    if line.auxiliary is None:
        return None, np.zeros(0)
    wire, nodes = line.auxiliary.wire, mesh.nodes(line, "auxiliary")
    held = np.full(nodes.x.size, np.nan)
    marks = np.unique(np.concatenate([nodes.stitch, nodes.support[[0, -1]]]))
    held[marks] = line.height_at(nodes.x[marks]) + line.auxiliary.height
    load = lumped(nodes.x, wire.mass * line.gravity)
    load[nodes.load] -= masses(line, "auxiliary")
    np.subtract.at(load, nodes.dropper, down)
    z = string_shape(nodes.x, held, load, wire.tension)
    force = string_loads(nodes.x, z, wire.tension, 0.0) - load
    y = _sideways(line, nodes, plumb_above(line, line.auxiliary.height), wire, "auxiliary")
    lift = force[nodes.stitch] + line.auxiliary.droppers.clamp_contact * line.gravity
    return started(wire, nodes, y, z), lift


def _give(
    line: Line, contact: WireShape, messenger: WireShape | None, stitches: list[WireShape]
) -> FloatArray:
    """What the wires lack at both clamps of each dropper (2, n), m/N."""
    give = np.zeros((2, line.dropper_x.size))
    give[0] = missing_give(contact.wire, contact.nodes, contact.nodes.dropper)
    if messenger is None:
        return give
    give[1] = missing_give(messenger.wire, messenger.nodes, messenger.nodes.dropper, messenger.hinges)
    if line.auxiliary is not None:
        give[1, np.isin(messenger.nodes.dropper, messenger.nodes.stitch)] = 0.0  # see _long_give
    for k, shape in enumerate(stitches):
        own = line.dropper_stitch == k + 1
        give[1, own] = missing_give(shape.wire, shape.nodes, shape.nodes.dropper)
    return give


def _contact(line: Line, mesh: Mesh) -> tuple[WireShape, FloatArray]:
    """The contact wire through its heights, and the forces that it needs at the droppers, N."""
    wire, nodes = line.contact_wire, mesh.nodes(line, "contact")
    held = np.full(nodes.x.size, np.nan)
    held[nodes.dropper] = line.dropper_height
    level = nodes.support if line.contact_support == "held" else nodes.support[[0, -1]]
    held[level] = line.height_at(nodes.x[level])
    weight = wire.mass * line.gravity
    load = lumped(nodes.x, weight)
    load[nodes.load] -= masses(line, "contact")
    marks = np.flatnonzero(~np.isnan(held))
    pull = wire.pull_for_sag(float(np.max(np.diff(nodes.x[marks]))))
    z = string_shape(nodes.x, held, load, pull)
    force = np.zeros(nodes.x.size)
    force[marks] = string_loads(nodes.x, z, pull, 0.0)[marks] - load[marks]
    steepest = float(np.max(np.abs(np.diff(z) / np.diff(nodes.x))))
    if not np.isfinite(steepest):
        raise _beyond()
    if steepest > STEEPEST:
        what = f"is too low: the wire would hang at a slope of {steepest:.2g} between the droppers"
        raise ModelError("line.contact_wire.tension", what, f"at most {STEEPEST:g}; units are N")
    y = _sideways(line, nodes, line.stagger, wire, "contact")
    return started(wire, nodes, y, z), force[nodes.dropper]


def _stitches(line: Line, mesh: Mesh, down: FloatArray) -> tuple[list[WireShape], FloatArray]:
    """Stitch wires between level ends, and the upward forces at their ends (stitches, 2, 3), N."""
    if line.stitch is None:
        return [], np.zeros((0, 2, 3))
    wire, shapes = line.stitch.wire, []
    ends = np.zeros((line.supports.size - 2, 2, 3))
    for k in range(1, line.supports.size - 1):
        nodes = mesh.stitch_nodes(line, k)
        load = lumped(nodes.x, wire.mass * line.gravity)
        load[nodes.dropper] -= down[line.dropper_stitch == k]
        held = np.full(nodes.x.size, np.nan)
        held[[0, -1]] = 0.0
        z = string_shape(nodes.x, held, load, wire.tension)
        share = (nodes.x - nodes.x[0]) / (nodes.x[-1] - nodes.x[0])
        ends[k - 1, :, 2] = -np.sum(load * (1.0 - share)), -np.sum(load * share)
        shapes.append(started(wire, nodes, np.zeros(nodes.x.size), z))
    return shapes, ends


def _messenger(line: Line, mesh: Mesh, down: FloatArray, ends: FloatArray) -> WireShape:
    """The messenger under its droppers and stitch wires, which take off part of its tension."""
    wire, nodes = line.messenger_wire, mesh.nodes(line, "messenger")
    assert wire is not None
    load = lumped(nodes.x, wire.mass * line.gravity)
    load[nodes.load] -= masses(line, "messenger")
    own = line.dropper_stitch < 0 if line.auxiliary is None else np.ones(line.long_x.size, dtype=bool)
    load[nodes.dropper[own]] -= down[own]
    np.subtract.at(load, nodes.stitch, ends[:, :, 2].ravel())
    middle = 0.5 * (nodes.x[1:] + nodes.x[:-1])
    tension = np.full(middle.size, wire.tension)
    for a, b in stitch_ends(line):
        assert line.stitch is not None
        tension[(a < middle) & (middle < b)] -= line.stitch.wire.tension
    held = np.full(nodes.x.size, np.nan)
    held[nodes.support] = np.array(line.system_height) + line.height
    z = string_shape(nodes.x, held, load, tension)
    y = _sideways(line, nodes, line.messenger_y, wire, "messenger")
    hinges = tuple(nodes.support[1:-1].tolist()) if line.messenger_clamp == "hinged" else ()
    return started(wire, nodes, y, z, hinges)


def _sideways(line: Line, nodes: Nodes, stagger: tuple[float, ...], wire: Wire, name: str) -> FloatArray:
    """From support to support, straight but for the pull of curves."""
    held = np.full(nodes.x.size, np.nan)
    held[nodes.support] = stagger
    level = np.zeros(nodes.x.size)
    pull = curve_pull(line, started(wire, nodes, level, level), name)
    along = wire.pull_for_sag(float(np.max(np.diff(nodes.x[nodes.support]))))
    return string_shape(nodes.x, held, lumped_pull(nodes.x, pull), along)
