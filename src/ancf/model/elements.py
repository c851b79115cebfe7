"""The kinds of elements; a new one is its file in ``ancf.elements`` and a line here."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ElementKind:
    """What the description of a model has to know of an element.

    Parameters
    ----------
    module : str
        File in ``ancf.elements`` with its numerics, see :class:`ancf.elements.registry.Element`.
    strains : tuple of str
        Strain measures; the first one is the default.
    vectors : int
        Three-component unknowns of a node that neighbours share: r, r_x and, of a cross-section, r_y, r_z.
    internal : int
        Three-component unknowns of an element alone.
    """

    module: str
    strains: tuple[str, ...]
    vectors: int
    internal: int

    @property
    def has_section(self) -> bool:
        """Whether it has cross-sections, and so torques and points off the axis."""
        return self.vectors > 2


KINDS: dict[str, ElementKind] = {
    "cable": ElementKind("cable_build", ("material", "paper"), vectors=2, internal=0),
    "original": ElementKind("solid_build", ("green",), vectors=4, internal=0),
    "nonlocking": ElementKind("solid_build", ("green",), vectors=4, internal=2),
}
