"""``ancf info``: what is in a file."""

from __future__ import annotations

from pathlib import Path

from ..errors import ModelError
from ..files import exists

SIGNATURE = b"\x89HDF\r\n\x1a\n"


def show_info(path: Path) -> None:
    """Tell a results file by its first bytes, a line file by its tables, and describe it."""
    if is_hdf5(path):
        from .info_result import show_result

        show_result(path)
    elif path.suffix.lower() in (".h5", ".hdf5"):
        raise ModelError(str(path), "is not a results file: no HDF5")
    else:
        _show_description(path)


def _show_description(path: Path) -> None:
    """A line file or a model file, by the tables that it has."""
    from ..model.file import OF_A_LINE, read_toml
    from .info_line import show_line
    from .info_model import show_model

    data = read_toml(path, "model file")
    if OF_A_LINE & data.keys():
        show_line(path, data)
    else:
        show_model(path)


def is_hdf5(path: Path) -> bool:
    """Whether a file begins as HDF5 does; ModelError if it cannot be read."""
    try:
        with path.open("rb") as file:
            return file.read(len(SIGNATURE)) == SIGNATURE
    except FileNotFoundError:
        raise ModelError(str(path), "no such file") from None
    except IsADirectoryError:
        inside = path / "results.h5"
        hint = f"ancf info {inside}" if exists(inside) else ""
        raise ModelError(str(path), "is a folder", hint) from None
    except (OSError, ValueError) as error:
        raise ModelError(str(path), f"cannot be read: {error}") from None
