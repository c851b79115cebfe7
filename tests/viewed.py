"""What the tests of the page look at: two small runs, and the data of a page."""

import base64
import json
import re

import numpy as np

import ancf

TITLE = "Größe <1> & </script>"
STRIP = ancf.Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500.0)


def cantilever(folder):
    """A cantilever that falls, from its file."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81), title=TITLE)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=STRIP)
    model.clamp(beam.start)
    return ancf.simulate(model, t_end=0.2, step=1e-3, file=folder / "results.h5")


def bead():
    """A bead slides down a line between two points; a spring holds it from above."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    rope = ancf.Section(EA=1e4, EI=0.01, rhoA=0.1)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(4, 0, 0.5), elements=6, length=4.1, section=rope)
    model.pin(wire.start)
    model.pin(wire.end)
    mass = model.add_point_mass("bead", at=(2, 0, 0.25), mass=0.5)
    joint = model.slide(mass, along=wire, name="ring")
    spring = model.add_spring(mass, (2.0, 0.0, 1.0), stiffness=5.0, length=0.8, slack=True, name="string")
    return ancf.simulate(model, t_end=0.2, step=2e-3, sensors=[wire.at(2.0), spring, joint])


def data_of(text):
    """What the page's scripts read."""
    return json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', text, re.S)[1])


def array_of(data, plain):
    """An array of the page as float64, with as many rows as the page has kept."""
    raw = base64.b64decode(data["numbers"])
    size = int(np.prod(plain["shape"]))
    if plain["kind"] == "f4":
        values = np.frombuffer(raw, "<f4", size, plain["at"]).astype(float)
    else:
        shares = np.frombuffer(raw, "<u2", size, plain["at"])
        values = plain["low"] + (plain["high"] - plain["low"]) / 65535 * shares
    return values.reshape(plain["shape"])
