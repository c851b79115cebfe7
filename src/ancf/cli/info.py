"""``ancf info``: what is in a file."""

from __future__ import annotations

from pathlib import Path

from ..errors import ModelError
from ..files import no_results, results_at

SIGNATURE = b"\x89HDF\r\n\x1a\n"


def show_info(path: Path) -> None:
    """Tell a results file by its first bytes, a line file by its tables, and describe it."""
    path = results_at(path)
    if is_hdf5(path):
        from .info_result import show_result

        show_result(path)
    elif path.suffix.lower() in (".h5", ".hdf5"):
        raise ModelError(str(path), "is not a results file: no HDF5")
    else:
        _show_description(path)


def _show_description(path: Path) -> None:
    """A line file or a model file, by the tables that it has."""
    from ..model.file import read_toml
    from ..model.file.kinds import LINE, MODEL, kind_of

    data = read_toml(path, "model file")
    kind = kind_of(data)
    if kind == LINE:
        from .info_line import show_line

        show_line(path, data)
    elif kind in ("", MODEL):
        from .info_model import show_model

        show_model(path)
    else:
        from .other_files import described
        from .screen import console

        console().print(described(path, kind), soft_wrap=True)


def is_hdf5(path: Path) -> bool:
    """Whether a file begins as HDF5 does; ModelError if it cannot be read."""
    try:
        with path.open("rb") as file:
            return file.read(len(SIGNATURE)) == SIGNATURE
    except FileNotFoundError:
        raise ModelError(str(path), "no such file") from None
    except IsADirectoryError:
        raise no_results(path) from None
    except (OSError, ValueError) as error:
        raise ModelError(str(path), f"cannot be read: {error}") from None
