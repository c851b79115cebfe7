"""Garbage is collected later while a model is made, and as before afterwards."""

import gc

import pytest

import ancf
from ancf.garbage import later, without


def test_it_is_collected_again():
    assert gc.isenabled()
    with later():
        assert not gc.isenabled()
        with later():
            assert not gc.isenabled()
        assert not gc.isenabled()
    assert gc.isenabled()


def test_also_after_an_error():
    @without
    def fails():
        assert not gc.isenabled()
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        fails()
    assert gc.isenabled()
    with pytest.raises(ancf.ModelError):
        ancf.simulate(ancf.Model(), t_end=1.0, step=-1.0)
    assert gc.isenabled()


def test_who_has_switched_it_off_keeps_that():
    gc.disable()
    try:
        with later():
            assert not gc.isenabled()
        assert not gc.isenabled()
    finally:
        gc.enable()


def test_a_function_stays_what_it_is():
    @without
    def add(a, b=1):
        """Sum."""
        return a + b

    assert (add(1), add(1, b=2), add.__doc__) == (2, 3, "Sum.")
