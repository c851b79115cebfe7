"""The numerics of each kind of element that a model may have."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Any, Protocol, cast

from numpy.typing import ArrayLike

from ..arrays import FloatArray
from ..model.bodies.beam import Beam
from ..model.elements import KINDS
from . import winched_build


class Element(Protocol):
    """What the module of a kind of element offers; :data:`ancf.model.elements.KINDS` names it."""

    def build(self, beams: Sequence[Beam], slots: Sequence[Any]) -> Any:
        """Batch of all such elements.

        ``slots``: first unknown of each vector of each node of each beam, (nodes, vectors + internal).
        """

    def shape(
        self,
        element: str,
        xi: ArrayLike,
        length: float,
        y: float = 0.0,
        z: float = 0.0,
        derivative: int | str = 0,
    ) -> FloatArray:
        """Factors of the element's vectors in r at (y, z), or in "r_x", "r_xx" or a vector of the section.

        Shape (..., columns) for xi of shape (...): the vectors of the first node, of the second, the
        internal ones.
        """

    def initial_vectors(self, beam: Beam) -> FloatArray:
        """Vectors of the nodes and, in the row of its first node, of an element, (nodes, vectors, 3)."""


class Optional(Protocol):
    """What such a module may offer beyond that, see :func:`offered`."""

    #: Type of the batch that ``build`` returns.
    BATCH: type

    def slack(self, batch: Any, q: FloatArray) -> Any:
        """Of elements that hang slack: ``stiffest``, the largest EA, and ``set(factor, held)``.

        That lowers EA and takes away forces of the compression in the initial shape q.
        """

    def quadratic_strains(self, batch: Any) -> Any:
        """Of elements whose strains are quadratic in the unknowns: ``batch``, one whose stresses
        ``leave_out(change)`` makes linear in the last change of the state vector.
        """

    def renumbered(self, batch: Any, beam: Beam, slot: Any) -> Any:
        """The batch of a System with the constants of another beam in the place of one of its own.

        ``slot``: as for ``build``, of the System; None where the batch would be another one.
        """


ELEMENTS: dict[str, Element] = {
    name: cast(Element, import_module(f".{kind.module}", __package__)) for name, kind in KINDS.items()
}


def offered(batch: Any, name: str) -> Callable[..., Any] | None:
    """What the module of a batch offers under this name, see :class:`Optional`, or None."""
    modules = (*ELEMENTS.values(), winched_build)
    found = (m for m in modules if getattr(m, "BATCH", None) is type(batch))
    return getattr(next(found, None), name, None)


def offers(element: str, name: str) -> bool:
    """Whether a kind of element offers it."""
    return hasattr(ELEMENTS[element], name)
