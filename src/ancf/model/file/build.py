"""From the checked tables of a model file to a Model; all problems are collected."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

from ...errors import ModelError
from ..bodies.reeving import Reeving
from ..bodies.rigid import Body
from ..integrators import integrator_of
from ..kinds import GROUPS, SURROUNDINGS
from ..model import Model
from ..names import unknown
from ..rebuild import add_item, add_surrounding
from ..sections.section import Section
from ..settings import EquilibriumSettings, SimulationSettings
from .entries import (
    AnyBody,
    BeamEntry,
    CircleEntry,
    EquilibriumEntry,
    FileEntry,
    InputEntry,
    MomentsEntry,
    RectangleEntry,
    ReevingEntry,
    SectionEntry,
    SimulationEntry,
)
from .messages import place

T = TypeVar("T")
Shaped = SectionEntry | RectangleEntry | CircleEntry | MomentsEntry

MAKERS: dict[type[Shaped], Callable[..., Section]] = {
    SectionEntry: Section,
    RectangleEntry: Section.rectangle,
    CircleEntry: Section.circle,
    MomentsEntry: Section.from_moments,
}


class Builder:
    """Builds the model of one file and keeps the problems found on the way."""

    def __init__(self, entry: FileEntry) -> None:
        self.entry = entry
        self.model = Model(entry.gravity, entry.title)
        self.problems: list[ModelError] = []
        self._sections: dict[str, Section] = {}

    def build(self) -> Model:
        """Return the model, complete when `problems` is empty."""
        for name, section in self.entry.sections.items():
            made = self._collected(_section, section, place(("sections", name)))
            if made is not None:
                self._sections[name] = made
        if not self.problems:
            for i, body in enumerate(self.entry.bodies):
                self._collected(self._add_body, body, f"bodies[{i}]")
        if not self.problems:
            for i, item in enumerate(self.entry.inputs):
                self._collected(self._add_input, item, f"inputs[{i}]")
        if not self.problems:
            self._add_items()
        return self.model

    def simulation(self) -> SimulationSettings | None:
        """Return the settings of a simulation, or None."""
        given = self.entry.simulation
        return None if given is None else self._collected(self._simulation, given)

    def equilibrium(self) -> EquilibriumSettings | None:
        """Return the settings of an equilibrium, or None."""
        given = self.entry.equilibrium
        return None if given is None else self._collected(self._equilibrium, given)

    def _simulation(self, given: SimulationEntry) -> SimulationSettings:
        settings = _simulation(given)
        for i, body in enumerate(settings.equilibrium_of or ()):
            self._check(self.model.body, body, f"simulation.equilibrium_of[{i}]")
        for i, label in enumerate(settings.outputs):
            self._check(self.model.point, label, f"simulation.outputs[{i}]")
        for i, name in enumerate(settings.sensors):
            self._check(self.model.sensor, name, f"simulation.sensors[{i}]")
        return settings

    def _equilibrium(self, given: EquilibriumEntry) -> EquilibriumSettings:
        simulation = self.entry.simulation
        if simulation is not None and simulation.start != "equilibrium":
            what = f'is not used: the simulation starts from "{simulation.start}"'
            raise ModelError("equilibrium", what, 'give simulation.start = "equilibrium"')
        return EquilibriumSettings(**given.given())

    def _check(self, find: Callable[[str], object], name: str, where: str) -> None:
        with _renamed(lambda _: where):
            find(name)

    def _add_body(self, entry: AnyBody, where: str) -> None:
        given = entry.given("name", "section", "motion")
        if isinstance(entry, BeamEntry):
            given["section"] = self._section_of(entry, f"{where}.section")
            if entry.reeving is not None:
                given["path"] = _reeving(given, entry.reeving, where)
        add: dict[str, Callable[..., Body]] = {
            "beam": self.model.add_beam,
            "point_mass": self.model.add_point_mass,
            "rigid_body": self.model.add_rigid_body,
        }
        with self.model.located(where):
            body = add[entry.type](entry.name, **given)
        if entry.motion is not None:
            _set_motion(body.set_motion, entry.motion.given(), f"{where}.motion")

    def _add_input(self, entry: InputEntry, where: str) -> None:
        with self.model.located(where):
            self.model.add_input(**entry.given())

    def _section_of(self, body: BeamEntry, where: str) -> Section:
        if not isinstance(body.section, str):
            return _section(body.section, where)
        if body.section not in self._sections:
            raise unknown(where, "section", body.section, self._sections)
        return self._sections[body.section]

    def _add_items(self) -> None:
        model, entry = self.model, self.entry
        for key in SURROUNDINGS:
            for i, item in enumerate(getattr(entry, key)):
                self._collected(add_surrounding, model, key, i, item.given())
        for key in GROUPS:
            for i, item in enumerate(getattr(entry, key)):
                self._collected(add_item, model, key, i, item.type, item.given())

    def _collected(self, work: Callable[..., T], *given: Any) -> T | None:
        try:
            return work(*given)
        except ModelError as error:
            self.problems.append(error)
            return None


@contextmanager
def _renamed(rename: Callable[[str], str]) -> Iterator[None]:
    """Turn the place of an error into one of the file."""
    try:
        yield
    except ModelError as error:
        raise ModelError(rename(error.where), error.what, error.hint) from None


def _section(given: Shaped, where: str) -> Section:
    values = given.given("shape")
    with _renamed(lambda old: where + old.removeprefix("Section")):
        return MAKERS[type(given)](**values)


def _reeving(given: dict[str, Any], entry: ReevingEntry, where: str) -> Reeving:
    del given["reeving"]
    if "path" in given:
        raise ModelError(f"{where}.reeving", "give either path or reeving, not both")
    values = entry.given("wheels")
    with _renamed(lambda old: f"{where}.reeving" + old.removeprefix("Reeving")):
        return Reeving([wheel.given() for wheel in entry.wheels], **values)


def _set_motion(set_motion: Callable[..., None], given: dict[str, Any], where: str) -> None:
    with _renamed(lambda old: where + old.rpartition(")")[2]):
        set_motion(**given)


def _simulation(given: SimulationEntry) -> SimulationSettings:
    values = given.given("integrator", "equilibrium_of", "outputs", "sensors")
    of = given.equilibrium_of
    return SimulationSettings(
        integrator=integrator_of(given.integrator),
        equilibrium_of=None if of is None else tuple(of),
        outputs=tuple(given.outputs),
        sensors=tuple(given.sensors),
        **values,
    )
