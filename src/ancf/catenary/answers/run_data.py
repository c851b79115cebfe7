"""What a finished run is: one recording per pantograph, the line's answer, and how it was computed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ..told import Told

if TYPE_CHECKING:
    from ... import Result
    from ..forms.route_form import AnyForm
    from ..vehicles.pantograph import Pantograph


@dataclass(frozen=True)
class Recording:
    """What one pantograph did, at every step of the run.

    Parameters
    ----------
    name : str
        Name of the pantograph in tables and figures.
    position : (n,) float
        Track position of the strip, m.
    force : (n,) float
        Contact force, unfiltered, N; 0 while contact is lost.
    height : (n,) float
        Height of the contact wire at the contact point, as z of the line, m: on a gradient it climbs.
    stagger : (n,) float
        Sideways position of the contact point, m.
    strip : (n,) float
        Height of the strip, m.
    by_wire : (n, wires) float, optional
        The force on each contact wire, of which `force` is the sum; default one wire that takes all.
    by_strip : (n, strips) float, optional
        The force on each strip, the first ahead; default one strip.

    Raises
    ------
    ModelError
        Histories of different lengths, or a value that is not finite.

    """

    name: str
    position: FloatArray
    force: FloatArray
    height: FloatArray
    stagger: FloatArray
    strip: FloatArray
    by_wire: FloatArray | None = None
    by_strip: FloatArray | None = None

    def __post_init__(self) -> None:
        where = f'recording "{self.name}"'
        count = (np.size(self.position),)
        for key in ("position", "force", "height", "stagger", "strip"):
            _check(getattr(self, key), count, f"{where}.{key}")
        for key in ("by_wire", "by_strip"):
            shares = getattr(self, key)
            if shares is not None:
                _check(shares, (*count, shares.shape[-1]), f"{where}.{key}")

    def force_on(self, wire: int) -> FloatArray:
        """Force (n,) on one of the contact wires, N."""
        if self.by_wire is None:
            return self.force if wire == 0 else np.zeros_like(self.force)
        part: FloatArray = self.by_wire[:, wire]
        return part


@dataclass(frozen=True)
class RunSlopes:
    """Derivatives of the records of a run by one parameter, per m.

    Attributes
    ----------
    force : tuple of (n,)
        Contact force of each pantograph, N/m.
    uplift : (n, supports)
        m/m, without the height at rest.

    """

    force: tuple[FloatArray, ...]
    uplift: FloatArray


@dataclass(frozen=True)
class Run(Told):
    """A finished run of pantographs along a line.

    Parameters
    ----------
    form : Form
        The line at rest.
    pantographs : list of Pantograph
        In the order of `recordings`; the first one runs ahead.
    speed : float
        m/s; of a profile the mean over the whole run, see ``passing.speeds_in_window``.
    t : (n,) float
        Times, s.
    recordings : list of Recording
        One for each pantograph.
    uplift : (n, n_supports) float
        Height of the contact wire at each support above its place at rest, m; of twin wires
        that of the higher one.
    dropper_force : (n, n_droppers) float
        Tension of each dropper, N.
    window : (float, float)
        Track interval that is evaluated, m.
    cpu_seconds, simulated_seconds, real_time_factor : float
        CPU time, that of a trial run included, simulated time and their ratio (simulated over CPU).
    settings : mapping
        How it was computed: step, mesh, contact, integrator and so on.
    result : Result, optional
        States of the whole line, to plot and to animate, and what was recorded.
    slopes : dict of str to RunSlopes
        Derivatives of the records by parameter, where they were asked for.
    broken_droppers : tuple of str
        Span and number from 1, "8-3", of the droppers that the line did not have; their force is 0.

    Raises
    ------
    ModelError
        Arrays that do not fit together, a value that is not finite, an empty window.

    """

    form: AnyForm
    pantographs: list[Pantograph]
    speed: float
    t: FloatArray
    recordings: list[Recording]
    uplift: FloatArray
    dropper_force: FloatArray
    window: tuple[float, float]
    cpu_seconds: float
    simulated_seconds: float
    real_time_factor: float
    settings: Mapping[str, Any]
    result: Result | None = None
    slopes: Mapping[str, RunSlopes] = field(default_factory=dict, repr=False)
    broken_droppers: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        count, line = np.size(self.t), self.form.line
        _check(self.t, (count,), "run.t")
        _check(self.uplift, (count, len(line.supports)), "run.uplift")
        _check(self.dropper_force, (count, len(line.dropper_x)), "run.dropper_force")
        for k, recording in enumerate(self.recordings):
            _check(recording.position, (count,), f"run.recordings[{k}].position")
        if not self.recordings or len(self.recordings) != len(self.pantographs):
            what = f"{len(self.recordings)} recordings of {len(self.pantographs)} pantographs"
            raise ModelError("run.recordings", what)
        if not self.window[0] < self.window[1]:
            raise ModelError("run.window", f"is empty: {self.window[0]:g} m to {self.window[1]:g} m")

    def __repr__(self) -> str:
        return self.in_a_line()

    @property
    def speed_kmh(self) -> float:
        """Speed in km/h."""
        return 3.6 * self.speed


def _check(array: FloatArray, shape: tuple[int, ...], where: str) -> None:
    if np.shape(array) != shape:
        raise ModelError(where, f"must have the shape {shape}, has {np.shape(array)}")
    if not np.all(np.isfinite(array)):
        raise ModelError(where, "holds a value that is not finite")
