"""From a model file to a functional mock-up unit (FMU) for co-simulation, FMI 2.0 or 3.0."""

from __future__ import annotations

import importlib
import json
import logging
import re
import shutil
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import tomli_w

from ..errors import ModelError
from ..files import writing
from ..model.file import read_study, read_toml
from .motion import MODEL, OUTPUTS, begun, settings_of
from .outputs import Output, outputs_of

#: Library that builds a unit, by version.
LIBRARIES = {"2.0": "pythonfmu", "3.0": "pythonfmu3"}
EXTRA = "pip install 'ancf[fmu]'"
#: What a unit can do beside taking steps, by version.
ABILITIES = {
    "2.0": {"canGetAndSetFMUstate": True, "canSerializeFMUstate": True},
    "3.0": {"canGetAndSetFMUState": True, "canSerializeFMUState": True},
}

_SCRIPT = '''"""{title}: a model of ancf for co-simulation by FMI {version}.

The machine that imports it needs Python and the package ancf.
"""

from pathlib import Path

from {library} import {words}
from {library}.enums import Fmi{n}Status

from ancf.cosimulation.described import described
from ancf.cosimulation.motion import MODEL, Kept, Motion
from ancf.errors import ModelError, SolveError


class {name}(Fmi{n}Slave):
    """{title}"""

    def __init__(self, **given):
        super().__init__(**given)
        self.description = {title!r}
        # of this instance: Python keeps the script of the first one, whose folder may be gone
        folders = [Path(given.get("resources") or "."), Path(__file__).parent]
        own = next((folder for folder in folders if (folder / MODEL).is_file()), folders[-1])
        self.motion = motion = Motion(own)
{independent}        for name in motion.inputs:
            variable = {number}(
                name,
                description=motion.said(name),
                causality=Fmi{n}Causality.input,
                variability=Fmi{n}Variability.continuous,
                getter=lambda name=name: motion.inputs[name],
                setter=lambda value, name=name: motion.give(name, float(value)),
            )
            self.register_variable(variable)
        for output in motion.outputs:
            variable = {number}(
                output.name,
                description=output.said,
                causality=Fmi{n}Causality.output,
                variability=Fmi{n}Variability.continuous,
                getter=lambda output=output: motion.value(output),
            )
            self.register_variable(variable)

    def to_xml(self, *options):
        return described(super().to_xml(*options), self.motion)

    def setup_experiment(self, start_time, *rest):
        self.motion.place(start_time)

    def exit_initialization_mode(self):
        self.motion.begin()

    def do_step(self, current_time, step_size):
        try:
            self.motion.advance(current_time, step_size)
        except (ModelError, SolveError) as error:
            self.log(str(error), Fmi{n}Status.error)
            return {failed}
        return {done}

    def _get_fmu_state(self):
        return self.motion.state()

    def _set_fmu_state(self, state):
        self.motion.restore(state)

    @staticmethod
    def _fmu_state_to_bytes(state):
        return state.to_bytes()

    @staticmethod
    def _fmu_state_from_bytes(state):
        return Kept.from_bytes(state)
'''
_WORDS = {
    "2.0": {
        "n": 2,
        "words": "Fmi2Causality, Fmi2Slave, Fmi2Variability, Real",
        "number": "Real",
        "independent": "",
        "done": "True",
        "failed": "False",
    },
    "3.0": {
        "n": 3,
        "words": "Float64, Fmi3Causality, Fmi3Slave, Fmi3StepResult, Fmi3Variability",
        "number": "Float64",
        "independent": (
            '        self.time = 0.0\n        self.register_variable(Float64("time", description="time", '
            "causality=Fmi3Causality.independent, variability=Fmi3Variability.continuous))\n"
        ),
        "done": "Fmi3StepResult(status=Fmi3Status.ok)",
        "failed": "Fmi3StepResult(status=Fmi3Status.error)",
    },
}


@dataclass(frozen=True)
class Unit:
    """What was written."""

    inputs: list[str]
    outputs: list[Output]


def export_fmu(path: Path, output: Path, version: str = "3.0") -> Unit:
    """Write a unit whose inputs are the model's and whose outputs are the sensors of its simulation.

    Parameters
    ----------
    path : Path
        Model file with a simulation of fixed steps.
    output : Path
        File to write, ending in ``.fmu``.
    version : str
        Of FMI, "2.0" or "3.0".

    Returns
    -------
    Unit

    Raises
    ------
    ModelError
        The model file is wrong, has no simulation or no sensors; the library that builds units is not
        installed; the file cannot be written.
    SolveError
        The start is an equilibrium, which was not found.
    """
    builder = _builder(version)
    if output.suffix.lower() != ".fmu":
        raise ModelError(f"-o {output}", "must end in .fmu", f"give {output.with_suffix('.fmu')}")
    study = read_study(path)
    settings = settings_of(study)
    if not settings.sensors:
        hint = 'add sensors = ["line.end"] to the table [simulation]'
        raise ModelError(f"{path}: simulation.sensors", "is empty: the unit would give nothing", hint)
    first = {name: item.value for name, item in study.model.inputs.items()}
    outputs = outputs_of(begun(study, first, settings.sensors))
    _refuse_clashes(path, outputs, first)
    name = _class_name(output.stem)
    title = re.sub(r'["\\\n]', " ", study.title or name)
    with tempfile.TemporaryDirectory(prefix="ancf_fmu_") as folder:
        files = Path(folder, MODEL), Path(folder, OUTPUTS)
        files[0].write_text(tomli_w.dumps(read_toml(path, "model file")), "utf-8")
        files[1].write_text(json.dumps([asdict(o) for o in outputs], indent=1), "utf-8")
        script = Path(folder, f"{name.lower()}_slave.py")
        words = {"title": title, "version": version, "library": LIBRARIES[version], "name": name}
        script.write_text(_SCRIPT.format(**words, **_WORDS[version]), "utf-8")
        made = _build(builder, script, Path(folder, "made"), files, ABILITIES[version])
        with writing(output):
            shutil.move(made, output)
    return Unit(list(first), outputs)


def _builder(version: str) -> Any:
    """The builder of a library that is installed when it is needed."""
    if version not in LIBRARIES:
        raise ModelError("version", f"is {version!r}, there are: {', '.join(LIBRARIES)}")
    try:
        return importlib.import_module(f"{LIBRARIES[version]}.builder").FmuBuilder
    except ImportError:
        raise ModelError("export-fmu", f"needs {LIBRARIES[version]}, which is not installed", EXTRA) from None


def _build(
    builder: Any, script: Path, folder: Path, files: tuple[Path, ...], abilities: dict[str, bool]
) -> Path:
    """Let the library write the unit; it imports the script from a folder on the path."""
    folder.mkdir()
    before, level = list(sys.path), logging.root.manager.disable
    sys.path.insert(0, str(script.parent))
    logging.disable(logging.INFO)
    try:
        return Path(builder.build_FMU(script, dest=folder, project_files=set(files), **abilities))
    finally:
        logging.disable(level)
        sys.path[:] = before
        sys.modules.pop(script.stem, None)


def _class_name(stem: str) -> str:
    name = re.sub(r"\W", "_", stem, flags=re.ASCII).strip("_") or "model"
    return (name if name[0].isalpha() else f"model_{name}").capitalize()


def _refuse_clashes(path: Path, outputs: list[Output], inputs: dict[str, float]) -> None:
    names = ["time", *inputs, *(output.name for output in outputs)]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        what = f'"{twice[0]}" would be the name of two variables'
        raise ModelError(f"{path}: simulation.sensors", what, "rename one of them")
