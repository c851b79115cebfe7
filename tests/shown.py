"""What one does with a model and its result: print, save, load, plot, view, export."""

import csv
import json
from pathlib import Path

import h5py
import matplotlib.pyplot as plt
import numpy as np

import ancf
from ancf.viz.export import write_csv, write_vtk
from ancf.viz.view import view_page
from viewed import data_of


def shown(model, folder, **settings):
    """Simulate a model into a file, load it, and do all of it; what each of them has.

    Parameters
    ----------
    model : ancf.Model
    folder : path
        An empty one.
    **settings
        For ``ancf.simulate``; default two steps of 1 ms.

    Returns
    -------
    dict
        Of "printed" (model and result), "described", "settings", "legend", "markers", "traces", "parts",
        "columns",
        "sensors"; a name of what is drawn or written goes with its kind.
    """
    folder = Path(folder)
    ran = ancf.simulate(model, **{"t_end": 2e-3, "step": 1e-3, "file": folder / "run.h5"} | settings)
    run = ancf.load(folder / "run.h5")
    assert np.array_equal(run.q[:], ran.q[:])
    assert np.isfinite(run.q[:]).all()
    assert run.model.to_dict() == model.to_dict()
    copy = folder / "copy.h5"
    run.save(copy)
    assert np.array_equal(ancf.load(copy).q[:], run.q[:])
    found = {"printed": [str(model), str(run)], "described": json.loads(json.dumps(model.to_dict()))}
    found["settings"] = run.provenance["settings"]
    found["sensors"] = run.sensors.names if "sensors" in settings else []
    figure = run.plot_shape(times=2).figure
    figure.savefig(folder / "shape.png")
    assert plt.imread(folder / "shape.png")[..., :3].std() > 0.01  # something is drawn
    found["legend"] = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    plt.close(figure)
    scene = data_of(view_page(run))["scene"]
    found["markers"] = {name: group["kind"] for group in scene["markers"] for name in group["names"]}
    found["drawn"] = sorted(set(_names(scene)))
    found["traces"] = {thread["name"]: thread["element"] for thread in scene["threads"]}
    with h5py.File(write_vtk(run, folder / "run.vtkhdf")) as file:
        assert np.isfinite(file["VTKHDF/Points"][:]).all()
        kinds, names = (json.loads(file["ancf"].attrs[key]) for key in ("kinds", "parts"))
        numbers = (file[f"VTKHDF/PointData/{key}"][:] for key in ("part", "kind"))
        found["parts"] = sorted({(names[p], kinds[k]) for p, k in zip(*numbers, strict=True)})
    found["parts"] = [list(pair) for pair in found["parts"]]
    found["columns"] = []
    for path in write_csv(run, folder / "tables"):
        with path.open(encoding="utf-8", newline="") as file:
            head, *rows = csv.reader(file)
        numbers = [[float(cell) if cell else np.inf for cell in row] for row in rows]
        table = dict(zip(head, np.array(numbers).T, strict=True))
        for name, column in table.items():
            force = table.get(name.replace(" gap [m]", " force [N]")) if name.endswith(" gap [m]") else None
            far = np.isposinf(column) if force is not None else np.zeros(len(column), bool)
            assert np.isfinite(column[~far]).all(), (path.name, name)
            assert force is None or np.all(force[far] == 0.0)  # an empty cell where no cable is near
        found["columns"] += head
    return found


def _names(plain):
    """All names in the plain data of a page."""
    if isinstance(plain, dict):
        yield from [plain["name"]] if isinstance(plain.get("name"), str) else plain.get("names", [])
    for part in plain.values() if isinstance(plain, dict) else plain if isinstance(plain, list) else ():
        yield from _names(part)
