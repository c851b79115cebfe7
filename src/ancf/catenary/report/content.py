"""Content: what a report is made of, read by its figures and tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ...model import checks
from ..answers.measuring import Measured
from ..answers.passing import check_run
from ..answers.references import REFERENCE, Reference, filter_note, second_reading
from ..answers.statistics import Statistics, statistics
from ..elasticity import Elasticity

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..answers.quantity import Quantity
    from ..answers.run_data import Run


@dataclass(frozen=True)
class Content:
    """What a report is made of.

    Parameters
    ----------
    run : Run
    found : sequence of Statistics
        One for each pantograph.
    reference : Reference, optional
        The published ranges to compare with.
    elasticity : Elasticity, optional
        Static elasticity along one span.
    measured : sequence of Measured
        What a measuring pantograph would have shown, one for each pantograph; default nothing.
    drawn : dict
        Figures by name, each drawn and laid out once for all formats.

    """

    run: Run
    found: tuple[Statistics, ...]
    reference: Reference | None = None
    elasticity: Elasticity | None = None
    measured: tuple[Measured, ...] = ()
    drawn: dict[str, Figure] = field(default_factory=dict, compare=False, repr=False)

    @classmethod
    def of(
        cls,
        run: Run,
        reference: Reference | None = None,
        elasticity: Elasticity | None = None,
        measured: Sequence[Measured] = (),
    ) -> Content:
        """Content of a report on a run, with the statistics of all its pantographs.

        Raises
        ------
        ModelError
            One of them is of another kind.

        """
        check_run(run, "write_report")
        if reference is not None:
            checks.kind(reference, "write_report.reference", Reference, REFERENCE)
        if elasticity is not None:
            checks.kind(elasticity, "write_report.elasticity", Elasticity, "ancf.catenary.elasticity(line)")
        hint = "ancf.catenary.measure(run, k), one for each pantograph"
        for k, one in enumerate(checks.items(measured, "write_report.measured", hint)):
            checks.kind(one, f"write_report.measured[{k}]", Measured, hint)
        found = tuple(statistics(run, k) for k in range(len(run.recordings)))
        return cls(run, found, reference, elasticity, tuple(measured))

    @property
    def several(self) -> bool:
        """Whether there is more than one pantograph."""
        return len(self.found) > 1

    @property
    def speed_kmh(self) -> float:
        """Speed of the first pantograph in the window, km/h."""
        return self.found[0]["speed"].value

    def name(self, k: int) -> str:
        """Name of a pantograph, its number behind it when another one has the same name."""
        names = [found.pantograph for found in self.found]
        return names[k] if names.count(names[k]) == 1 else f"{names[k]} ({k + 1})"

    @property
    def names(self) -> list[str]:
        """Names of all pantographs."""
        return [self.name(k) for k in range(len(self.found))]

    def compared(self, k: int) -> list[Quantity]:
        """Quantities of the reference with their ranges; nothing without a reference."""
        return self.reference.compare(self.found[k], self.run.speed_kmh) if self.reference else []

    def filter_note(self, k: int) -> str:
        """Whether the verdicts depend on the order of the filter; nothing without a reference."""
        if self.reference is None:
            return ""
        return filter_note(self.compared(k), second_reading(self.run, self.reference, k))
