"""Measuring pantographs as files, and what they measured as tables."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from pydantic import Field, ValidationError

from ...errors import ModelError
from ...model import checks
from ...model.file import parameters, read_toml
from ...model.file.fields import Entry, NonNegative, Parameters, Positive
from ...model.file.kinds import HEAD, refuse
from ...model.file.messages import beside, combined, of_validation
from .measuring import Measured, MeasuringHead
from .write import write_columns


class MeasuringEntry(Entry):
    """A measuring pantograph: sensors below the strip, and an accelerometer on it."""

    parameters: Parameters = Field(default_factory=dict)
    mass: Positive | None = Field(None, description="What moves above the force sensors [kg].")
    corrected_mass: NonNegative | None = Field(
        None, description="By which the force is corrected for inertia, 0 for none [kg]."
    )
    force_band: Positive | None = Field(None, description="Up to where the force sensors follow [Hz].")
    acceleration_band: Positive | None = Field(
        None, description="Up to where the accelerometer follows [Hz]."
    )
    force_noise: NonNegative = Field(0.0, description="Standard deviation of each sample [N].")
    acceleration_noise: NonNegative = Field(0.0, description="Standard deviation of each sample [m/s^2].")
    rate: Positive | None = Field(None, description="Samples per second, default those of the run [Hz].")
    delay: NonNegative = Field(0.0, description="By which the accelerometer is late [s].")
    seed: int = Field(0, ge=0, description="Of the noise.")


def read_measuring_head(path: str | Path) -> MeasuringHead:
    """A measuring pantograph from a file: TOML with the keys of :class:`MeasuringHead`.

    Raises
    ------
    ModelError
        The file cannot be read, or something in it is wrong.

    """
    path = checks.path(path, "read_measuring_head.path")
    data = read_toml(path, "file of a measuring pantograph")
    refuse(path, data, HEAD)
    try:
        parameters.refuse_keys(data, MeasuringEntry.model_fields)
        with parameters.given(data, {}):
            entry = MeasuringEntry.model_validate(data)
    except ValidationError as error:
        problems = of_validation(error, lambda parts: MeasuringEntry)
        raise beside(combined(problems, str(path)), str(path)) from None
    try:
        return MeasuringHead(**entry.given("parameters"))
    except ModelError as error:
        raise ModelError(
            f"{path}: {error.where.removeprefix('measuring.')}", error.what, error.hint
        ) from None


def write_measured(measured: Measured, path: Path) -> Path:
    """Write the measured and the true force, both below 20 Hz, over time and track position, as CSV."""
    columns = {
        "t_s": measured.t,
        "position_m": measured.position,
        "measured_20hz_N": measured.force,
        "true_20hz_N": measured.true,
    }
    return write_columns(path, columns)


def compared(measured: Measured) -> list[tuple[str, float, float]]:
    """Name, true and measured value of what is read off a force in the window, N."""
    true, force = measured.true[measured.window], measured.force[measured.window]
    read: tuple[tuple[str, Any], ...] = (
        ("mean force Fm", np.mean),
        ("standard deviation 0-20 Hz", np.std),
        ("maximum", np.max),
        ("minimum", np.min),
    )
    return [(name, float(of(true)), float(of(force))) for name, of in read]
