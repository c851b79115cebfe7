"""A model with one item of a kind, made from what is registered of the kind alone."""

import itertools
from typing import Literal, get_args, get_origin

from ancf.errors import ModelError
from ancf.model.file import fields, parse_study

SECTION = {"shape": "circle", "diameter": 0.02, "E": 1e7, "rho": 1e3, "nu": 0.3}
#: All bodies have a point at (1, 0, 0), so that any two can be joined there, and points elsewhere.
STAGE = {
    "title": "one of a kind",
    "gravity": [0.0, 0.0, -9.81],
    "bodies": [
        {"name": "wire", "section": SECTION, "start": [0.0, 0, 0], "end": [2.0, 0, 0], "elements": 2},
        {
            "name": "rod",
            "element": "nonlocking",
            "section": SECTION,
            "start": [1.0, 0, 0],
            "end": [1.0, 1.0, 0],
            "elements": 1,
        },
        {"type": "rigid_body", "name": "hub", "at": [1, 0, -0.3], "mass": 1.0, "inertia": [0.1, 0.1, 0.1]},
        {"type": "rigid_body", "name": "arm", "at": [1, 0, 0.5], "mass": 1.0, "inertia": [0.1, 0.2, 0.2]},
        {"type": "point_mass", "name": "bob", "at": [1.0, 0, 0], "mass": 0.2},
    ],
    "surfaces": [{"name": "floor", "shape": "plane", "at": [0, 0, -2]}],
}
POINTS = ["hub.at(0, 0, 0.3)", "arm.at(0, 0, -0.5)", "rod.start", "wire.at(1)", "bob", "rod.end", "wire.end"]
BODIES = ["wire", "hub", "rod", "floor"]
#: By the type of a field of a table; directions of one item are normal to each other.
VALUES = {
    fields.Positive: 1.5,
    fields.NonNegative: 1.5,
    fields.ScalarFunction: "1.5 + sin(t)",
    fields.VectorFunction: [0.1, "0.1*sin(t)", 0.0],
    fields.ForceFunction: [0.1, "0.1*sin(t)", "-0.1*vz"],
    fields.Pair: [0.25, 0.75],
    float: 0.5,
    int: 1,
    bool: True,
    str: "x",
}
AXES = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]


def _type_of(entry, key):
    """Type of a field as it is written, without "or None"."""
    given = entry.__annotations__.get(key, entry.model_fields[key].annotation)
    if isinstance(given, str):
        given = eval(given, vars(fields) | {"Literal": Literal})
    kinds = [kind for kind in get_args(given) if kind is not type(None)]
    return kinds[0] if type(None) in get_args(given) else given


def table_of(kind, ends, optional=()):
    """A table of a model file: the ends, what must be given, and some of what may be given."""
    entry, axes = kind.entry(), iter(AXES)
    keys = kind.keys or kind.ends
    table = {"type": kind.word, "name": f"the {kind.word}"} | dict(zip(keys, ends, strict=True))
    for key, field in entry.model_fields.items():
        if key in table or not (field.is_required() or key in optional):
            continue
        wanted = _type_of(entry, key)
        if wanted is fields.Vector:
            table[key] = next(axes)
        elif get_origin(wanted) is Literal:
            table[key] = get_args(wanted)[0]
        else:
            table[key] = VALUES[wanted]
    return table


def study_with(group, kind):
    """The stage with one item of a kind: at the first ends, with as little as possible, that are accepted."""
    entry = kind.entry()
    keys = kind.keys or kind.ends
    places = [BODIES if _type_of(entry, key) is str else POINTS for key in keys]
    spare = [key for key, field in entry.model_fields.items() if not field.is_required() and key != "name"]
    refused = []
    for optional in [(), *((key,) for key in spare)]:
        for ends in itertools.product(*places):
            study = STAGE | {group: [table_of(kind, ends, optional)]}
            try:
                parse_study(study)
            except (ModelError, KeyError) as error:
                refused.append(str(error))
            else:
                return study
    raise AssertionError(f"{kind.word}: no item is accepted: {refused[:3]} ...")
