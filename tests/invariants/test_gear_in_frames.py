"""Random worlds with machinery: nothing depends on how a model is written down."""

import pytest

from helpers import some
from random_gear import Gear
from random_worlds import FRAMES, LATER, differences

SEEDS = [2, 4, 8, 9, 14, 15, 16, 17, 19, 20, 21, 23]


@pytest.mark.parametrize("seed", some(SEEDS))
def test_frames(seed):
    """Joints, strips, slides and springs: turned, mirrored, renumbered, in other units, at another time."""
    for frames, most in ((FRAMES, 1e-5), (LATER, 1e-9)):
        assert {key: off for key, off in differences(Gear, seed, frames).items() if not off < most} == {}
