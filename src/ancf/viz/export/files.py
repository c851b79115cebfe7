"""Files that are complete or absent, and one error for those that cannot be written."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...errors import ModelError


@contextmanager
def drafted(path: Path) -> Iterator[Path]:
    """Place to write to; it becomes the file when all went well, and is gone otherwise."""
    draft = path.with_name(path.name + ".part")
    try:
        yield draft
        draft.replace(path)
    except BaseException:
        draft.unlink(missing_ok=True)
        raise


@contextmanager
def writing(path: Path, folder: Path) -> Iterator[None]:
    """Make a folder; within this context the system's errors become a ModelError about `path`.

    Raises
    ------
    ModelError
        The folder cannot be made, or something cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        yield
    except (FileExistsError, NotADirectoryError):
        raise ModelError(
            str(path), "cannot be written: its folder is a file", "choose another place"
        ) from None
    except OSError as error:
        reason = error.strerror or error
        raise ModelError(str(path), f"cannot be written: {reason}", "choose another place") from None
