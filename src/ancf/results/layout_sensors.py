"""Sensors of a results file: what was listed, and room for what is recorded."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from ..model.bodies.rigid import Body
from ..model.points import Point
from ..system.sensors import Listing

#: Rows and columns of a chunk: few columns, so that one sensor is read without the others.
ROWS, COLUMNS = 512, 24
#: Data sets by name; the time is written last, so that each of its rows is complete.
DATA = ("q", "v", "measured", "time")


def write_listing(file: Any, listing: Listing) -> None:
    """Write the group ``sensors`` with empty data sets; none without sensors."""
    if not listing:
        return
    group = file.create_group("sensors")
    points = [{"body": p.body.name, "label": p.label, "place": (p.x, p.y, p.z)} for p in listing.points]
    # springs stand among the columns as well: versions that knew contacts alone refuse the file
    columns = {name: places.tolist() for name, places in (listing.columns | listing.springs).items()}
    held = {name: places.tolist() for name, places in listing.held.items()}
    listed = {"points": points, "connections": listing.connections, "columns": columns, "held": held}
    listed["springs"] = [*listing.springs]
    listed["turned"] = {name: places.tolist() for name, places in listing.turned.items()}
    group.attrs["listed"] = json.dumps(listed)
    group["index"], group["entries"] = listing.index, listing.entries
    group["moved"], group["pushed"] = listing.moved, listing.pushed
    for name, width in zip(DATA, (len(listing.index),) * 2 + (listing.width, None), strict=True):
        tail = () if width is None else (width,)
        chunk = () if width is None else (max(1, min(width, COLUMNS)),)
        most = () if width is None else (width or None,)
        group.create_dataset(name, (0, *tail), "f8", maxshape=(None, *most), chunks=(ROWS, *chunk))


def read_listing(group: Any, bodies: dict[str, Body]) -> Listing:
    """What the group ``sensors`` lists."""
    listed = json.loads(group.attrs["listed"])
    points = []
    for item in listed["points"]:
        x, y, z = item["place"]
        points.append(Point(bodies[item["body"]], x, item["label"], y, z))
    columns = {name: np.array(places, dtype=np.int64) for name, places in listed["columns"].items()}
    springs = {name: columns.pop(name) for name in listed.get("springs", [])}
    connections = tuple(listed["connections"])
    held = {name: np.array(places, dtype=np.int64) for name, places in listed.get("held", {}).items()}
    turned = {
        name: np.array(rows, dtype=np.int64).reshape(-1, 2) for name, rows in listed.get("turned", {}).items()
    }
    moved, pushed = (group[key][:] if key in group else np.zeros(0, np.int64) for key in ("moved", "pushed"))
    index, entries = group["index"][:], group["entries"][:]
    where = index, entries, columns, moved, pushed, held, springs, turned
    return Listing(tuple(points), connections, *where)
