"""What the tests of models share: sections, a curve, and how wrong input is refused."""

import numpy as np
import pytest

from ancf import ModelError, Section


def cable_section():
    return Section(EA=1e4, EI=1.0, rhoA=0.5)


def flat():
    return Section.rectangle(width=0.04, height=0.02, E=1e8, rho=500.0, nu=0.3)


def helix(angle):
    return np.stack([np.cos(angle), np.sin(angle), 0.5 * angle], axis=-1)


def refused(where, phrase, function, *args, **kwargs):
    with pytest.raises(ModelError) as caught:
        function(*args, **kwargs)
    assert caught.value.where == where
    assert phrase in str(caught.value)
    return caught.value
