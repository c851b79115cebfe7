"""What the tests with generated input share: odd values, changes of nested tables, what an answer may be."""

import copy
import math
import os
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

import ancf

#: Cases in all: of a normal run, and with --slow (conftest.py sets the variable).
SLOW = os.environ.get("ANCF_FUZZ") == "slow"
TOTAL = 20_000 if SLOW else 1_000


def cases(share: float) -> settings:
    """Settings for a share of all cases: always the same ones, and no clock decides."""
    return settings(
        max_examples=max(1, round(share * TOTAL)),
        derandomize=True,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )


NUMBERS = [0, -0.0, 1, -1, 2, 3, 0.5, -0.5, 1e-3, 1e3, 1e-9, 1e9, 1e-30, 1e30, 5e-324, 1e-160, 1e160, 1e308]
NO_NUMBERS = [math.nan, math.inf, -math.inf]
TEXTS = [
    "",
    " ",
    "a",
    "x",
    "xyz",
    "xx",
    "t",
    "1/t",
    "sqrt(-1 - t)",
    "1e400",
    "nan",
    "t +",
    "__import__('os')",
]
TEXTS += [
    "beam.start",
    "beam.at(1e9)",
    "beam.at(nan)",
    "beam.at(",
    "ä",
    "\u200b",
    "a\nb",
    "x" * 300,
    "../a",
    "0",
]
#: What TOML can hold.
PLAIN = [*NUMBERS, *NO_NUMBERS, *TEXTS, True, False, 10**400, [], {}, [0], [0, 0, 0], [1, 2, 3], [[0, 0, 0]]]
PLAIN += [
    [math.nan, 0, 0],
    [1e308, 1e308, 1e308],
    ["t", 0, "1/t"],
    [[0, 0, 0], [0, 0, 0]],
    {"t": [0], "value": [1]},
]
#: And what Python can give besides.
ODD = [*PLAIN, None, b"x", 1 + 2j, object(), int, range(3), {1}, np.float32(0.5), np.int64(3), np.nan]
ODD += [np.zeros(3), np.zeros((2, 3)), np.array([1, np.inf, 0]), np.array("a"), np.ones(3, dtype=complex)]
ODD += [
    lambda t: 0.0,
    lambda t: (0.0, 0.0, 0.0),
    lambda t: t[3],
    lambda: 1,
    lambda t: math.nan,
    lambda t: "a",
]

plain = st.one_of(st.sampled_from(PLAIN), st.floats(), st.integers(-10, 1000), st.text(max_size=8))
odd = st.one_of(st.sampled_from(ODD), st.floats(), st.integers(-10, 1000), st.text(max_size=8))


def places(data, at=()) -> Iterator[tuple]:
    """Paths of everything inside nested tables and lists."""
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in items:
        yield (*at, key)
        yield from places(value, (*at, key))


def parent_of(data, path):
    for key in path[:-1]:
        data = data[key]
    return data


@st.composite
def changed(draw, given, most=3, values=plain):
    """A copy of nested tables with up to three changes that keep its structure recognisable."""
    data = copy.deepcopy(given)
    for _ in range(draw(st.integers(1, most))):
        there = list(places(data))
        if not there:
            break
        path = there[draw(st.integers(0, len(there) - 1))]
        inside, key = parent_of(data, path), path[-1]
        what = draw(st.sampled_from(["value"] * 5 + ["scale"] * 3 + ["leave out", "copy", "rename", "twice"]))
        if what == "value":
            inside[key] = copy.deepcopy(draw(values))
        elif what == "scale" and isinstance(inside[key], int | float):
            inside[key] = inside[key] * draw(st.sampled_from([-1, 0, 1e-12, 1e-3, 0.3, 1.0001, 3, 1e3, 1e12]))
        elif what == "leave out":
            del inside[key]
        elif what == "copy":  # a value of somewhere else, of the right form or not
            other = there[draw(st.integers(0, len(there) - 1))]
            inside[key] = copy.deepcopy(parent_of(data, other)[other[-1]])
        elif what == "rename" and isinstance(inside, dict):
            inside[draw(st.sampled_from(["name", "type", "EA", "length", "nu", "X", ""]))] = inside.pop(key)
        elif what == "twice" and isinstance(inside, list):
            inside.append(copy.deepcopy(inside[key]))
    return data


@contextmanager
def refused_or_fine():
    """The body may refuse the input: one of the package's errors, with a place and a reason.

    What it gives is empty, and holds the error afterwards.
    """
    refusals = []
    try:
        yield refusals
    except (ancf.ModelError, ancf.SolveError) as error:
        refusals.append(error)
    for refusal in refusals:
        assert refusal.where.strip(), repr(refusal)
        assert refusal.what.strip(), repr(refusal)
        assert "Traceback" not in str(refusal)


def finite(*values) -> None:
    """All numbers are numbers."""
    for value in values:
        assert np.all(np.isfinite(np.asarray(value, dtype=float))), value
