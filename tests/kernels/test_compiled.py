"""The decorators of kernels: what Python may call, and what is left out where there is nothing to do."""

from collections import namedtuple

import numba
import numpy as np
import pytest

from ancf.choices import optional, where_dimensions
from ancf.compiled import formula, inline_kernel, kernel
from ancf.kernel_cache import announce_compilation

Batch = namedtuple("Batch", "factor")


@inline_kernel
def twice(x):
    return 2.0 * x


@formula
def thrice(x):
    return 3.0 * x


@kernel
def six_times(x):
    return twice(thrice(x))


def _scaled(batches, x):
    return batches[0].factor * x


scaled = optional(_scaled, -1.0)


@kernel
def scaled_by(batches, x):
    return scaled(batches, x)


class TestParts:
    @pytest.mark.parametrize("part", [twice, thrice])
    def test_python_cannot_call_them(self, part):
        """Whether they are compiled already or not: without the check the process would end."""
        assert part.py_func(2.0) in (4.0, 6.0)
        for _ in range(2):
            with pytest.raises(TypeError, match=f"{part.py_func.__name__} is a part of kernels"):
                part(2.0)
            assert six_times(2.0) == 12.0

    def test_other_types(self):
        assert six_times(2) == 12.0


class TestOptional:
    def test_of_a_tuple(self):
        assert scaled_by((Batch(4.0),), 2.0) == 8.0

    def test_of_none(self):
        assert scaled_by((), 2.0) == -1.0

    def test_not_from_python(self):
        with pytest.raises(TypeError, match="only in compiled code"):
            scaled((), 2.0)


entry = where_dimensions(2, lambda table, row: 2.0 * table[row, 0], -1.0)


@kernel
def entry_of(table, row):
    return entry(table, row)


class TestWhereDimensions:
    """An array with fewer dimensions stands for none: nothing is compiled that would index it by two."""

    def test_of_a_table(self):
        assert entry_of(np.array([[1.0, 5.0], [3.0, 7.0]]), 1) == 6.0

    def test_of_none(self):
        assert entry_of(np.zeros(0), 1) == -1.0

    def test_from_python(self):
        assert [entry(table, 0) for table in (np.array([[4.0]]), np.zeros(0))] == [8.0, -1.0]


def test_compiling_is_announced_once():
    """Before the first kernel, whatever follows."""
    said = []
    announce_compilation(lambda: said.append("compiling"))
    for function in (lambda x: x + 1.0, lambda x: x - 1.0):
        assert said in ([], ["compiling"])
        numba.njit(function)(2.0)
        assert said == ["compiling"]
