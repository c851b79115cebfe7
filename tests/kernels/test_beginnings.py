"""Formulas that take what records of several kinds begin with."""

from typing import NamedTuple

import numba
import numpy as np
import pytest

from ancf.contact.press import PressBatch
from ancf.contact.rub import RubBatch
from ancf.contact.touching import Touching
from ancf.records import beginning, recorded


@recorded
class Common(NamedTuple):
    """What two of the three begin with."""

    weights: np.ndarray
    items: tuple
    factor: float


@recorded
class Short(NamedTuple):
    weights: np.ndarray
    items: tuple
    factor: float
    more: np.ndarray


@recorded
class Long(NamedTuple):
    weights: np.ndarray
    items: tuple
    factor: float
    places: np.ndarray
    count: int


@recorded
class Other(NamedTuple):
    """The same names in another order."""

    factor: float
    weights: np.ndarray
    items: tuple


@beginning(Common)
def nested(record, k):
    return record.factor * record.weights[k] + record.items[1]


@beginning(Common)
def total(record, first):
    s = 0.0
    for k in range(first, record.weights.shape[0]):
        s += nested(record, k)
    return s


@numba.njit  # without a cache, which would give it without what it calls
def of_short(record, first):
    return total(record, first) + record.more[0]


@numba.njit  # without a cache, which would give it without what it calls
def of_long(record, first):
    return total(record, first) + record.places[1] + record.count


@numba.njit  # without a cache, which would give it without what it calls
def of_other(record, first):
    return total(record, first)


def wanted(weights, factor, first):
    return float(factor * weights[first:].sum() + 7.0 * len(weights[first:]))


@pytest.fixture(params=range(4))
def given(request):
    rng = np.random.default_rng(request.param)
    return rng.standard_normal(2 + 3 * request.param), (3, 7.0), float(rng.standard_normal())


@pytest.mark.parametrize("first", [0, 1])
def test_each_reads_its_own(given, first):
    weights, items, factor = given
    value = wanted(weights, factor, first)
    short = Short(*given, np.array([11.0]))
    assert of_short(short, first) == pytest.approx(value + 11.0, abs=1e-12)
    long = Long(*given, np.arange(3.0), 5)
    assert of_long(long, first) == pytest.approx(value + 6.0, abs=1e-12)
    other = Other(factor, weights, items)
    assert of_other(other, first) == pytest.approx(value, abs=1e-12)


def kinds(part):
    return {signature[0].batch.instance_class.__name__ for signature in part.overloads}


@pytest.mark.skipif(not hasattr(of_short, "overloads"), reason="kernels are interpreted")
def test_one_serves_all_that_begin_so():
    given = np.ones(2), (3, 7.0), 1.0
    of_short(Short(*given, np.ones(1)), 0)
    of_long(Long(*given, np.ones(2), 5), 0)
    assert kinds(total) == kinds(nested) == {"Common"} | ({"Other"} & kinds(total))
    of_other(Other(given[2], *given[:2]), 0)
    assert kinds(total) == kinds(nested) == {"Common", "Other"}
    of_short(Short(np.ones(4)[::2], *given[1:], np.ones(1)), 0)  # an array of another type
    assert len(total.overloads) == 3


@pytest.mark.parametrize("kind", [PressBatch, RubBatch])
def test_batches_begin_as_they_say(kind):
    assert kind._fields[: len(Touching._fields)] == Touching._fields
