"""A result as things to draw at some times; viewer, movies and exports share it. Needs no extra."""

from ...arrays import FloatArray
from .arrows import strokes
from .compose import chosen_times, make_scene
from .parts import QUANTITIES, Arrow, Comb, Link, Marker, Net, Scene, Strip, Thread, Triad, looks

__all__ = [
    "QUANTITIES",
    "Arrow",
    "Comb",
    "FloatArray",
    "Link",
    "Marker",
    "Net",
    "Scene",
    "Strip",
    "Thread",
    "Triad",
    "chosen_times",
    "looks",
    "make_scene",
    "strokes",
]
