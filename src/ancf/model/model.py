"""Model: everything the user describes, checked when it is added; no numerics."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from ..arrays import FloatArray
from ..errors import ModelError
from . import checks, describe, other_words, rebuild
from .bodies import auto_elements
from .bodies.beam import Beam
from .bodies.layout import make_beam
from .functions.function import check_inputs
from .joints.connecting import PointLike
from .keywords import called_as
from .kinds import GROUPS, SURROUNDINGS, all_kinds, kind_of
from .loads import followers
from .loads.load import DistributedLoad, Force, Load, Moment, make_distributed, make_moment
from .loads.state_function import force_function
from .overview import of_model
from .points import initial_position
from .sections.section import Section
from .supports.support import Support
from .supports.supporting import Supporting
from .tables import Readable, Sheet

LoadT = TypeVar("LoadT", bound=Load)


def _hint(name: str) -> str:
    """What does what a name says that a Model does not have."""
    methods = {kind.method for kind in (*all_kinds(), *SURROUNDINGS.values())} | MAKING
    return other_words.method_of(name, methods) or other_words.hint_of(name, other_words.OF_MODEL)


def offered(name: str) -> str:
    """What does what a name says that the package does not have."""
    hint = other_words.hint_of(name, other_words.OF_PACKAGE)
    return hint or (f"model.{own}" if (own := _hint(name)) else "")


#: Methods that make bodies and inputs.
MAKING = {"add_beam", "add_point_mass", "add_rigid_body", "add_input"}

#: What one of the parts of a model is called.
ONE = {"bodies": "body", "supports": "support", "loads": "load", "connections": "connection"}


class Model(Supporting, Readable):
    """Bodies, supports, loads and connections in a field of gravity.

    Points are given as ``beam.start``, ``beam.end``, ``beam.at(x)``, on a beam with a cross-section also
    ``beam.at(x, y, z)``, on a rigid body ``hub.centre`` and ``hub.at(x, y, z)``, or as that text; a point
    mass, or a rigid body for its centre of mass, stands for its point, as an object or by its name.
    Values that may depend on time are constants, functions of t in s, or formulas such as
    ``"10*sin(2*pi*t)"``. Every method that adds something takes a unique ``name`` and returns the new
    item; each raises ModelError, with the place, when something given is wrong. ``print(model)`` shows it
    all in tables.

    Parameters
    ----------
    gravity : (3,) m/s^2
    title : str

    Attributes
    ----------
    bodies : dict of str to Beam, PointMass or RigidBody
    beams, masses, rigid_bodies : dict
        The bodies of one kind.
    supports, loads, connections, fluids, grounds, surfaces : list
    inputs : dict of str to Input
    """

    def __init__(self, gravity: Any = (0.0, 0.0, 0.0), title: str = "") -> None:
        super().__init__()
        if isinstance(gravity, int | float):
            what = f"must be a list of three numbers, is {checks.shown(gravity)}"
            raise ModelError(
                "Model.gravity", what, f"(0, 0, {checks.shown(-abs(gravity))}) where z points upwards"
            )
        self.gravity: FloatArray = checks.vector(gravity, "Model.gravity")
        self.title = checks.text(title, "Model.title")
        self.supports: list[Support] = []
        self.loads: list[Load] = []

    def __repr__(self) -> str:
        counts = ("bodies", "supports", "loads", "connections")
        found = {key: len(getattr(self, key)) for key in counts}
        inside = ", ".join(f"{n} {ONE[key] if n == 1 else key}" for key, n in found.items())
        return f"Model({self.title!r}, {inside})" if self.title else f"Model({inside})"

    if not TYPE_CHECKING:  # a misspelled method is an error

        def __getattr__(self, name: str) -> Any:
            """The method of a kind that is not written in this class, see :class:`ancf.model.kind.Kind`."""
            for kind in all_kinds():
                if kind.method == name and kind.add is not None:
                    return partial(called_as(kind.add, name), self)
            said = f"Model has no attribute {name!r}"
            hint = _hint(name)
            raise AttributeError(f"{said}: {hint}" if hint else said, name=name, obj=self)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *(kind.method for kind in all_kinds())})

    def _sheet(self) -> Sheet:
        return of_model(self)

    def add_beam(
        self,
        name: str,
        *,
        section: Section,
        start: Any = None,
        end: Any = None,
        path: Any = None,
        elements: int | Literal["auto"] | None = None,
        nodes: Any = None,
        element: str = "cable",
        strain: str | None = None,
        poisson: str = "centreline",
        length: float | None = None,
        natural_shape: Any = "path",
        gauss: tuple[int, int] = (5, 3),
        y_axis: Any = None,
        closed: bool = False,
    ) -> Beam:
        """Add a beam or cable.

        Parameters
        ----------
        name : str
            Unique over the model.
        section : Section
            Stiffnesses, mass and damping per length; of a material for the two beams.
        start, end : (3,) m
            Ends of a straight beam.
        path : (m, 3) m, callable or Reeving
            Instead of start and end: 3 or more points of a spline, or a function of u from 0 to 1.
        elements : int or "auto"
            Number of elements of equal length. "auto" takes as many as keep the estimated error of every
            position below 1e-4 of the length: of a path, or of a cable as it hangs between its ends.
        nodes : (n+1,) m
            Instead of elements: increasing reference arc lengths from 0 to the length.
        element : "cable", "original" or "nonlocking"
            The paper's cable (12 unknowns), or its beams with a cross-section (24 and 30 unknowns).
        strain : "material" or "paper"
            Strain measures of the cable, default "material". The beams have one, "green".
        poisson : "centreline" or "full"
            Poisson effect of the beams: coupled on the centreline only, which does not lock and takes
            the section's J and shear factors, or in the whole volume, the paper's. A cable ignores it.
        length : float, m
            Natural length; default the arc length of the initial shape.
        natural_shape : "path", "straight", or as path
            Whether the initial shape is free of bending, or a straight beam was bent into it, or one with
            the bends of another curve: it is scaled to the natural length, and `y_axis` holds for it too.
        gauss : (int, int)
            Gauss points of a cable's axial and bending integrals, or of a beam along its axis and in
            each direction of the section, where 3 are exact.
        y_axis : (3,)
            Direction near which the local y axis lies at the start; default horizontal, along
            e_z x tangent, or e_y for a vertical start. Along a path the axes do not turn about the
            tangent.
        closed : bool
            Join the end to the start, as of a belt; a `length` below the path's gives pre-tension.

        """
        where = self._where("add_beam", name if isinstance(name, str) else None)
        if elements == "auto":
            shape = {"start": start, "end": end, "path": path, "length": length, "closed": closed}
            elements = auto_elements.count(where, section, self.gravity, element=element, **shape)
        beam = make_beam(
            where,
            self._names.of_body(name, where),
            start=start,
            end=end,
            path=path,
            elements=elements,
            nodes=nodes,
            section=section,
            element=element,
            strain=strain,
            poisson=poisson,
            length=length,
            natural_shape=natural_shape,
            gauss=gauss,
            y_axis=y_axis,
            closed=closed,
        )
        return self._add_body(beam)

    def add_force(self, point: PointLike, force: Any, name: str | None = None) -> Force:
        """Add a force (3,) in N at a point, in fixed directions.

        Parameters
        ----------
        point : Point, PointMass or RigidBody
        force : (3,) N, function of time or law of the state
            A law is a function of t, r and v, place (3,) in m and velocity (3,) in m/s of the point, such as
            ``lambda t, r, v: -20.0 * v``, called once a step if numba cannot compile it; or numbers and
            formulas of t, x, y, z, vx, vy, vz. Its work is supplied energy; in equilibria v is zero.
        name : str
            Default "force at beam.end".

        """
        where, label, clean = self.named_point("add_force", "force", point, name)
        given = force_function(force, f"{where}.force", initial_position(clean), lambda: self.size, "N")
        return self.add_load(Force(label, clean, given))

    def add_moment(self, point: PointLike, moment: Any, name: str | None = None) -> Moment:
        """Add a moment (3,) in N m at a point, in fixed directions.

        On a cable it acts on the slope r_x and must not be a torque; on a beam it acts on the section;
        on a rigid body its place does not matter.
        """
        where, label, clean = self.named_point("add_moment", "moment", point, name)
        return self.add_load(make_moment(where, label, clean, moment))

    def add_distributed_load(
        self, body: Beam | str, load: Any, between: Any = None, name: str | None = None
    ) -> DistributedLoad:
        """Add a load (3,) in N per m of reference length on a body, or on its part between=(x0, x1) in m.

        As a force it may be a law of the state, of t and each point's r and v: ``lambda t, r, v: -0.5 * v``.
        """
        where = self._where("add_distributed_load", name, body)
        clean = self._body(body, f"{where}.body")
        label = self._names.of_item(name, f"load on {clean.name}", where)
        return self.add_load(make_distributed(where, label, clean, load, between, self.size))

    def add_follower_force(self, point: PointLike, force: Any, *, name: str | None = None) -> Any:
        """Add a force (3,) in N that turns with a cable's tangent, a beam's section or a rigid body.

        Its parts are those in the axes of the body: along the tangent or the section's normal, then along
        the section's y and z; a cable has a tangent alone.
        """
        return followers.add_follower_force(self, point, force, name=name)

    def add_pressure(
        self, body: Beam | str, pressure: Any, axis: Any, name: str | None = None
    ) -> followers.Pressure:
        """Add a pressure in N per m of present length on a beam or cable, which turns with it.

        It acts in the direction tangent x `axis` (3,), normal to both.
        """
        return followers.add_pressure(self, body, pressure, axis, name)

    def add_load(self, item: LoadT) -> LoadT:
        """Add a checked load; every method that makes one ends here."""
        check_inputs(item, self.inputs)
        self._names.take(item.name, "load")
        self.loads.append(item)
        return item

    def to_dict(self) -> dict[str, Any]:
        """Plain description, ready for JSON, of which :meth:`from_dict` makes the model again.

        Python functions stand there as ``<function name>``.
        """
        plain: dict[str, Any] = {"title": self.title, "gravity": self.gravity.tolist()}
        if self.inputs:
            plain["inputs"] = [item.described() for item in self.inputs.values()]
        plain["bodies"] = [describe.body(body) for body in self.bodies.values()]
        for key in GROUPS:
            plain[key] = [describe.other(item, kind_of(item)) for item in getattr(self, key)]
        for key in SURROUNDINGS:
            plain[key] = [describe.fields_of(item) for item in getattr(self, key)]
        return plain

    @classmethod
    def from_dict(cls, plain: dict[str, Any]) -> Model:
        """The model that :meth:`to_dict` described, to the last bit, also after JSON.

        Python functions cannot be described: what had one is there and says so when its value is asked
        for, which a computation does. Beams that were not straight cannot be refined.

        Raises
        ------
        ModelError
            It is no description of a model; ``where`` is ``bodies[2].mass`` and so on.

        """
        table = rebuild.Table(plain, "model")
        model = cls(table.take("gravity"), table.take("title"))
        for body, where in rebuild.bodies(table):
            model._names.of_body(body.name, where)
            model._add_body(body)
        for given in table.tables("inputs"):
            with model.located(given.where):
                said = {key: given.given[key] for key in ("unit", "description") if key in given.given}
                model.add_input(given.take("name"), given.take("value"), **said)
        rebuild.items(model, table)
        return model

    def missing_functions(self) -> list[tuple[str, str]]:
        """Items that had a Python function, and its name, where a description could not keep it."""
        keys = *GROUPS, *SURROUNDINGS
        return [pair for key in keys for item in getattr(self, key) for pair in rebuild.missing(item)]
