"""Of which kind a TOML file is, by the keys that no other kind has, and which command reads it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...errors import ModelError

MODEL, LINE = "model", "line"
PANTOGRAPH, HEAD = "pantograph", "measuring pantograph"
STUDY, CALIBRATION, OPTIMISATION = "study", "calibration", "optimisation"
#: Keys that only files of overhead lines have.
OF_A_LINE = {"contact_wire", "messenger_wire", "spans", "steady_arm"}
#: And those of files of which nothing has the same: of pantographs, of measuring pantographs, of models.
OF_A_PANTOGRAPH = {"masses", "static_force", "aerodynamic", "strip_length", "strip_distance", "relaxed_at"}
OF_A_HEAD = {"mass", "corrected_mass", "rate", "delay", "seed"}
OF_A_HEAD |= {"force_band", "acceleration_band", "force_noise", "acceleration_noise"}
OF_A_STUDY = {"sampling", "outputs", "correlations"}
OF_A_CALIBRATION, OF_AN_OPTIMISATION = {"data", "deviations"}, {"objective", "constraints", "most"}
OF_A_MODEL = {"bodies", "inputs", "connections", "fluids", "grounds", "surfaces", "simulation", "equilibrium"}
#: How files of these kinds are called, and by which commands they are read.
READ_BY = {
    PANTOGRAPH: ("the file of a pantograph", "ancf catenary run LINE --speed 250 --pantograph FILE"),
    HEAD: ("the file of a measuring pantograph", "ancf catenary run LINE --speed 250 --measure FILE"),
    STUDY: ("a study file", "ancf study FILE"),
    CALIBRATION: ("a calibration file", "ancf calibrate FILE"),
    OPTIMISATION: ("an optimisation file", "ancf optimise FILE"),
    MODEL: ("a model file", "ancf run FILE"),
    LINE: (
        "the file of an overhead line",
        "ancf catenary run FILE --speed 250, ancf catenary form FILE, ancf check FILE",
    ),
}


def kind_of(data: Mapping[str, Any]) -> str:
    """The kind of the file with these tables; "" where no key tells it."""
    keys = set(data)
    for kind, own in (
        (LINE, OF_A_LINE),
        (MODEL, OF_A_MODEL),
        (PANTOGRAPH, OF_A_PANTOGRAPH),
        (HEAD, OF_A_HEAD),
    ):
        if own & keys:
            return kind
    if isinstance(data.get("parameters"), list) or OF_A_STUDY & keys:  # parameters of models are a table
        return _of_parameters(keys, data.get("parameters"))
    if isinstance(data.get("sections"), list):
        return LINE
    return MODEL if isinstance(data.get("sections"), dict) else ""


def _of_parameters(keys: set[str], parameters: Any) -> str:
    """Which of the kinds that have a list of parameters, by the keys of the file and of those."""
    each = parameters if isinstance(parameters, list) else []
    inside = {key for one in each if isinstance(one, dict) for key in one}
    if OF_AN_OPTIMISATION & keys or "droppers" in inside:
        return OPTIMISATION
    bounded = "low" in inside and not OF_A_STUDY & keys
    return CALIBRATION if OF_A_CALIBRATION & keys or bounded else STUDY


def refuse(path: str | Path, data: Mapping[str, Any], wanted: str) -> None:
    """Raise ModelError if the file is of another kind than the wanted one, with the command that reads it."""
    found = kind_of(data)
    if found and found != wanted:
        name, command = READ_BY[found]
        what = f"is {name}, not {READ_BY[wanted][0]}"
        raise ModelError(str(path), what, command.replace("FILE", str(path)))
