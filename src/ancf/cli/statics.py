"""An equilibrium as a results file with one state."""

from __future__ import annotations

from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..model.file import Study

if TYPE_CHECKING:
    from .. import Result, State


def store(study: Study, state: State, path: Path) -> Result:
    """Write a state to a results file.

    Raises
    ------
    ModelError
        The file cannot be written.

    """
    from ..results.result import load
    from ..results.store import FileStore

    file = FileStore(path, state.system, _header(study))
    file.append(np.array([state.t]), state.q[None], state.v[None], np.zeros((1, 2)))
    file.update(state.stats, "complete")
    file.close()
    return load(path, state.system)


def _header(study: Study) -> dict[str, Any]:
    from ..results.provenance import versions

    return {
        "title": study.title,
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "model": study.model.to_dict(),
        "settings": {"equilibrium": None if study.equilibrium is None else asdict(study.equilibrium)},
        "versions": versions(),
    }
