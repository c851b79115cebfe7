"""Axes of models that are upright along other directions than z."""

import numpy as np

UP = {"z": (0.0, 0.0, 1.0), "x": (1.0, 0.0, 0.0), "skew": (0.6, 0.0, -0.8)}


def axes(up):
    """Three unit vectors, the last one upwards."""
    third = np.array(UP[up])
    first = np.cross((0.0, 1.0, 0.0), third)
    return np.array([first, np.cross(third, first), third])
