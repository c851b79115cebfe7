"""Surroundings: what bodies move in and lie on, and the part of a Model that adds it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..surfaces.with_surfaces import WithSurfaces
from .fluids import Fluid
from .grounds import Ground, Relief, height_of, upward
from .gusts import Gusts
from .velocity_field import VelocityField
from .waves import Waves


class Surroundings(WithSurfaces):
    """Fluids and grounds of one model."""

    gravity: FloatArray

    def __init__(self) -> None:
        super().__init__()
        self.fluids: list[Fluid] = []
        self.grounds: list[Ground] = []

    def add_fluid(
        self,
        name: str,
        density: float,
        velocity: Any = (0.0, 0.0, 0.0),
        above: float | None = None,
        below: float | None = None,
        on: Any = None,
        waves: Any = None,
        gusts: Any = None,
    ) -> Fluid:
        """Add a fluid everywhere, or between two heights, in which bodies have buoyancy, drag and added mass.

        Beams need a section with ``diameter`` and ``drag``; ``added_mass`` counts where it is given. Point
        masses and rigid bodies take part with the ``volume``, ``drag_area`` and ``added_mass`` they have.

        Parameters
        ----------
        name : str
            Unique over the model.
        density : float, kg/m^3
        velocity : (3,) m/s, function of time, profile, formulas or function of t, x, y, z
            A profile is ``{"z": heights, "velocity": (n, 3)}``; formulas are three of t, x, y, z. A Python
            function of t, x, y, z returns three numbers; it is compiled by numba if it can be, else called
            once a step.
        above, below : float, m
            Heights z between which the fluid is; default everywhere. Above one with waves it follows them.
        on : sequence of bodies or names, optional
            Bodies on which it acts; default all.
        waves : Waves or dict, optional
            On its surface at ``below``: :class:`ancf.Waves`, or the table of one. Gravity must point down.
        gusts : Gusts or dict, optional
            Turbulence that is added to its velocity: :class:`ancf.Gusts`, or the table of one.

        """
        where = self._where("add_fluid", name if isinstance(name, str) else None)
        item = Fluid(
            self._names.of_item(name, "fluid", where),
            checks.positive(density, f"{where}.density"),
            VelocityField(velocity, f"{where}.velocity"),
            None if above is None else checks.number(above, f"{where}.above"),
            None if below is None else checks.number(below, f"{where}.below"),
            self._acted_on(on, f"{where}.on"),
            None if waves is None else self._waves(waves, below, f"{where}.waves"),
            None if gusts is None else Gusts(gusts, f"{where}.gusts"),
        )
        low, high = item.heights
        if not low < high:
            raise ModelError(f"{where}.above", f"is {low:g} m, must be below {high:g} m")
        for other in self.fluids:
            _refuse_both(where, item, other)
        self._names.take(item.name, "fluid")
        self.fluids.append(item)
        return item

    def add_ground(
        self,
        name: str,
        height: Any,
        stiffness: float,
        damping: float = 0.0,
        friction: float = 0.0,
        stick: float | None = None,
        normal: Any = None,
        on: Any = None,
    ) -> Ground:
        """Add a ground on which beams and cables lie, with friction that sticks.

        Their sections need a ``diameter``. It presses against the axis, not against the surface.

        Parameters
        ----------
        name : str
            Unique over the model.
        height : float, m, or table
            z of the plane, at x = y = 0 if it slopes; or ``{"x": (nx,), "y": (ny,), "z": (nx, ny)}``.
        stiffness : float, Pa/m
            Force per length, diameter and depth.
        damping : float, Pa s/m
            Force per length, diameter and rate of depth; it never pulls.
        friction : float
            Coulomb's coefficient.
        stick : float, Pa/m
            Stiffness against sliding, before it slips, per length and diameter; default `stiffness`.
        normal : (3,)
            Of a plane that slopes, any length; default up.
        on : sequence of bodies or names, optional
            Beams and cables that lie on it; default all.

        """
        where = self._where("add_ground", name if isinstance(name, str) else None)
        item = Ground(
            self._names.of_item(name, "ground", where),
            height_of(height, f"{where}.height"),
            checks.positive(stiffness, f"{where}.stiffness"),
            checks.non_negative(damping, f"{where}.damping"),
            checks.non_negative(friction, f"{where}.friction"),
            None if stick is None else checks.positive(stick, f"{where}.stick"),
            upward(normal, f"{where}.normal"),
            self._acted_on(on, f"{where}.on"),
        )
        if isinstance(item.height, Relief) and item.normal is not None:
            raise ModelError(f"{where}.normal", "has no effect with a table of heights", "leave it out")
        self._names.take(item.name, "ground")
        self.grounds.append(item)
        return item

    def _waves(self, given: Any, below: Any, where: str) -> Waves:
        waves = Waves(given, where)
        if below is None:
            raise ModelError(where, "need a surface", "give the fluid below=, its mean height")
        if not (self.gravity[2] < 0.0 and not np.any(self.gravity[:2])):
            what = f"need gravity along -z, which is {self.gravity.tolist()}"
            raise ModelError(where, what, "give Model(gravity=(0, 0, -9.81))")
        waves.refuse_breaking(where, -float(self.gravity[2]))
        return waves

    def _acted_on(self, given: Any, where: str) -> tuple[str, ...] | None:
        if given is None:
            return None
        if isinstance(given, str) or not isinstance(given, list | tuple) or not given:
            raise ModelError(where, f"must be a list of bodies or their names, is {checks.shown(given)}")
        return tuple(self._body(item, f"{where}[{k}]").name for k, item in enumerate(given))


def _refuse_both(where: str, one: Fluid, other: Fluid) -> None:
    """Raise ModelError where two fluids are in one place, for the same bodies."""
    if not one.meets(other):
        return
    low = max(one.heights[0], other.heights[0])
    high = min(one.heights[1], other.heights[1])
    if low < high:
        place = (
            "everywhere" if math.isinf(low) and math.isinf(high) else f"between z = {low:g} and {high:g} m"
        )
        what = f'"{one.name}" and "{other.name}" are both {place}'
        raise ModelError(where, what, "give above= and below=, or on= with different bodies")
