"""What a unit's description lacks as the libraries write it: units, how it may be stepped, who made it."""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement

from .._version import __version__
from .motion import Motion, settings_of
from .units import base_unit


def described(root: Element, motion: Motion) -> Element:
    """Complete the root of a ``modelDescription.xml``, of FMI 2.0 or 3.0.

    The title of the model as its name; units of all variables, with those of SI they are of; steps by which a
    master may go on; the time span of the model file; unknowns of the initial state.
    """
    older = root.get("fmiVersion", "").startswith("2")
    if title := " ".join(motion.study.title.split()):
        root.set("modelName", title)
    root.set("generationTool", f"ancf {__version__} ({root.get('generationTool')})")
    _steps(root, motion, older)
    units = {output.name: output.unit for output in motion.outputs}
    units |= {name: motion.study.model.inputs[name].unit for name in motion.inputs} | {"time": "s"}
    used = set()
    for variable in root.findall("ModelVariables/*"):
        if unit := units[variable.attrib["name"]]:
            (variable[0] if older else variable).set("unit", unit)
            used.add(unit)
    _define(root, sorted(used))
    if older:
        initial = SubElement(_found(root, "ModelStructure"), "InitialUnknowns")
        for unknown in root.iterfind("ModelStructure/Outputs/Unknown"):
            SubElement(initial, "Unknown", unknown.attrib)
    return root


def _steps(root: Element, motion: Motion, older: bool) -> None:
    """Steps of a master are multiples of the model's, and may change."""
    settings = settings_of(motion.study)
    stepped = _found(root, "CoSimulation")
    stepped.set("canHandleVariableCommunicationStepSize", "true")
    if not older:
        stepped.set("fixedInternalStepSize", repr(settings.step))
    span = {
        "startTime": "0.0",
        "stopTime": repr(settings.t_end),
        "stepSize": repr(settings.output_step or settings.step),
    }
    root.insert(list(root).index(_found(root, "ModelVariables")), Element("DefaultExperiment", span))


def _define(root: Element, units: list[str]) -> None:
    definitions = Element("UnitDefinitions")
    for name in units:
        unit = SubElement(definitions, "Unit", name=name)
        if (known := base_unit(name)) is not None:
            factor = {} if known.factor == 1.0 else {"factor": repr(known.factor)}
            SubElement(unit, "BaseUnit", factor | {key: str(value) for key, value in known.exponents.items()})
    if len(definitions):
        root.insert(list(root).index(_found(root, "CoSimulation")) + 1, definitions)


def _found(root: Element, name: str) -> Element:
    found = root.find(name)
    assert found is not None
    return found
