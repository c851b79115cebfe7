"""Kind: the one record of a kind of support, load or connection, which everything that lists kinds reads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from .bodies.rigid import Body
from .functions.function import TimeFunction
from .points import Point

#: Under which noun results answer questions about a connection, see ancf.viz.pictures.questions.
SPRING, CONTACT, SLIDE, JOINT = "spring", "contact", "sliding joint", "joint"
SURFACE_CONTACT = "contact with a surface"
TORSION = "torsion spring"


@dataclass(frozen=True)
class Look:
    """How a kind is marked in pictures.

    Parameters
    ----------
    shape : str
        "circle", "square", "diamond", "up", "down", or "slider", which leaves what slides visible.
    fill : str
        "black", "grey", "light", "white" (an outline) or "orange".
    size : float
        Points.
    """

    shape: str
    fill: str
    size: float


@dataclass(frozen=True)
class Push:
    """What an arrow in pictures shows of a load.

    Parameters
    ----------
    field : str
        Of its items: a function of time, or of the state, with three components.
    unit : str
    turns : bool
        It turns things about an axis, and the arrow is round.
    frame : str
        "": global components; "axes": in those of the body; "normal": one number, normal to the tangent and
        the item's `axis`, per present length.
    """

    field: str
    unit: str
    turns: bool = False
    frame: str = ""


@dataclass(frozen=True)
class Kind:
    """What the package knows of a kind; see ``docs/howto/write_a_joint.md`` for a new one.

    Parameters
    ----------
    item : type
        Frozen dataclass of its items, the first field ``name``.
    word : str
        Its ``type`` in model files and in the description of a model.
    noun : str
        In tables and messages.
    method : str
        Of Model; adds one. For a kind from outside `add` is the method.
    entry : function
        Returns the class of its table in a model file; called when the first file is read, because
        pydantic is imported then.
    sheet : function
        What the last column of a model's table says of an item: what a support holds, a load's value, the
        numbers of a connection.
    ends : tuple of str
        Fields with its points, fixed positions or bodies; a picture marks it at the first one.
    keys : tuple of str
        The same in the method and in files; default as `ends`.
    between : function, optional
        What a table says of where it is; default its ends one after the other.
    asked : str
        SPRING, TORSION, CONTACT, SURFACE_CONTACT, SLIDE or JOINT: what results answer of it; "" for supports
        and loads.
    rows : str
        Module in ``ancf.connections`` with its ``rows``, of a joint made of rows.
    look : Look or None
        Marker in pictures; None: it has none, or a shape of its own.
    push : Push, optional
        Arrow in pictures.
    add : function, optional
        ``add(model, ...)``, what ``model.<method>(...)`` calls if Model itself has no such method.
    batch : str
        Module in ``ancf.loads`` with ``build(items, locate, value)``, of a load that depends on the state; of
        surroundings ``build(items, locate, value, model)``.
    on_state : function, optional
        ``on_state(item)``: whether an item depends on the state, where only some do.
    inputs : function, optional
        Functions of time of such an item, the same number for all; ``value``, (items, inputs, 3), has what
        they are now.
    """

    item: type
    word: str
    noun: str
    method: str
    entry: Callable[[], Any]
    sheet: Callable[[Any], str]
    ends: tuple[str, ...] = ("point",)
    keys: tuple[str, ...] = ()
    between: Callable[[Any], str] | None = None
    asked: str = ""
    rows: str = ""
    look: Look | None = None
    push: Push | None = None
    add: Callable[..., Any] | None = None
    batch: str = ""
    on_state: Callable[[Any], bool] | None = None
    inputs: Callable[[Any], list[TimeFunction]] | None = None

    def inputs_of(self, item: Any) -> list[TimeFunction]:
        """Functions of time that its kernels want."""
        return [] if self.inputs is None else self.inputs(item)

    def has_batch(self, item: Any) -> bool:
        """Whether a load depends on the state, so that `batch` takes it."""
        return bool(self.batch) and (self.on_state is None or self.on_state(item))

    @property
    def constrains(self) -> bool:
        """Whether it holds motions by multipliers (or shared unknowns)."""
        return self.asked in (JOINT, SLIDE)

    @property
    def last_key(self) -> str:
        """Key of its last end in the method and in files."""
        return (self.keys or self.ends)[-1]

    def ends_of(self, item: Any) -> list[Any]:
        """Its points, fixed positions (3,) in m, and bodies."""
        return [getattr(item, name) for name in self.ends]


def body_of(end: Any) -> Body | None:
    """The body of an end, of a surface the one that carries it; None: a fixed position."""
    body = end.body if isinstance(end, Point) else getattr(end, "on", end)
    return body if isinstance(body, Body) else None
