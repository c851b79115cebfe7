"""Excerpt: a part of a line as a line of its own."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...errors import ModelError
from ...model import checks


def excerpt(line: Any, first: int, count: int) -> Any:
    """Of a Line the `count` spans from span `first` on, anchored at their own ends.

    Droppers are off as they are in the line. Springs that pull the ends are stiffer by as much as it is
    shorter, so that heat changes the tension alike.

    Raises
    ------
    ModelError
        The line has not these spans.

    """
    spans = len(line.spans)
    first = checks.integer(first, "excerpt.first", 0, spans - 1)
    count = checks.integer(count, "excerpt.count", 1, spans)
    if first + count > spans:
        what = f"is {count}, from span {first} on the line has {spans - first} of its {spans} spans"
        raise ModelError("excerpt.count", what, "spans are counted from 0")
    supports = slice(first, first + count + 1)
    keys = ["system_height", "stagger"]
    keys += [key for key in ("height", "cant") if isinstance(getattr(line, key), tuple)]
    keys += ["messenger_stagger"] if line.messenger_stagger is not None else []
    keys += ["steady_arm"] if isinstance(line.steady_arm, tuple) else []
    keys += ["rows"] if line.rows else []
    cut: dict[str, Any] = {key: getattr(line, key)[supports] for key in keys}
    if line.dropper_lengths is not None:
        own = (line.dropper_span >= first) & (line.dropper_span < first + count)
        cut["dropper_lengths"] = tuple(np.array(line.dropper_lengths)[own].tolist())
    if line.dropper_errors is not None:
        before = line.dropper_errors.before + int(np.sum(line.dropper_span < first))
        cut["dropper_errors"] = replace(line.dropper_errors, before=before)
    start, end = line.supports[first], line.supports[first + count]
    if line.tensioner.stiffness is not None:
        stiffness = line.tensioner.stiffness * line.length / float(end - start)
        cut["tensioner"] = replace(line.tensioner, stiffness=stiffness)
    inside = [load for load in line.loads if start < load.position < end]
    cut["loads"] = tuple(replace(load, position=load.position - float(start)) for load in inside)
    return replace(line, spans=line.spans[first : first + count], **cut)
