"""The schedule of the droppers between messenger and auxiliary: what they are cut and hung by."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..lines.conditions import expansion
from .form import Form
from .route_form import AnyForm
from .schedule import LONG_COLUMNS, LongRow, texts, write_rows


def long_rows(found: AnyForm) -> list[LongRow]:
    """Rows in the order along each tension length, spans counted over all; none without an auxiliary."""
    rows: list[LongRow] = []
    spans = 0
    forms, starts = ((found,), (0.0,)) if isinstance(found, Form) else (found.forms, found.line.starts)
    for form, start in zip(forms, starts, strict=True):
        rows += _of_part(form, float(start), spans)
        spans += len(form.line.spans)
    return rows


def _of_part(form: Form, start: float, before: int) -> list[LongRow]:
    line, made = form.line, form.long_droppers
    if line.auxiliary is None or made is None:
        return []
    cut = made.natural / (1.0 + expansion(line) * form.warmer)
    load = made.force - 0.5 * line.auxiliary.droppers.mass * made.length * line.gravity
    span = np.searchsorted(line.supports, line.long_x, side="right") - 1
    return [
        LongRow(
            span=before + int(span[j]) + 1,
            dropper=j - int(np.argmax(span == span[j])) + 1,
            position=float(x - line.supports[span[j]]),
            track=start + float(x),
            length=1e3 * float(made.length[j]),
            natural=1e3 * float(cut[j]),
            load=float(load[j]),
        )
        for j, x in enumerate(line.long_x)
    ]


def save_long_schedule(found: AnyForm, path: Path) -> Path:
    """Write the rows as CSV; ModelError if the file cannot be written."""
    return write_rows([texts(row) for row in long_rows(found)], LONG_COLUMNS, path)
