"""The load of docs/howto/write_a_load.md: a file and a record in a copy of the package."""

import numpy as np
import pytest
from scipy.optimize import brentq

from additions import Addition
from places import HOWTO

PAGE = (HOWTO / "write_a_load.md").read_text(encoding="utf-8")
#: What the page adds: a file, and an import and the record in the registry.
KERNELS, REGISTRY = "loads/attraction.py", "model/kinds.py"
IMPORT = "from .loads.laws import Parameter, law\n"
LIST = "LOADS: list[Kind] = [\n"
RECORD = PAGE.split(LIST)[1].split("    ...\n]")[0]
BEHIND = "from .kind import CONTACT, JOINT, SLIDE, SPRING, SURFACE_CONTACT, Kind, Look, Push\n"

#: Attraction S/d^2 of a unit mass that starts at the apsis A, from the centre, with the speed W.
S, A, W = 4.0, (1.0, 0.0, 0.0), (0.0, 1.8, 0.6)
METHODS = {
    "trapezoidal": "ancf.Trapezoidal()",
    "generalised": "ancf.GeneralizedAlpha(0.8)",
    "radau": "ancf.Radau(adaptive=False)",
    "explicit": "ancf.Explicit()",
}
FALL, DRAG, MASS, G = 2.0, 0.3, 2.0, 9.81
SPRING = {"stiffness": 40.0, "length": 1.0}

COMPILED = f"""
import json
import numpy as np
import ancf
from ancf.model.file import parse_study, schema
from shown import shown

CENTRE = np.array((0.3, -0.2, 0.1))

def orbit(strength={S}, drag=0.0):
    model = ancf.Model(title="orbit")
    point = model.add_point_mass("point", at=CENTRE + {A}, mass=1.0)
    point.set_motion(velocity={W})
    model.add_attraction(point, strength, centre=CENTRE, drag=drag, name="sun")
    return model

def steps(model, method, t_end, counts):
    runs = [ancf.simulate(model, t_end=t_end, step=t_end / n, output_step=t_end / 10, integrator=method)
            for n in counts]
    return [(r.position("point").tolist(), r.velocity("point").tolist()) for r in runs]

made = orbit()
found = {{"shown": str(made), "described": made.to_dict()["loads"][0]}}
found["dir"] = "add_attraction" in dir(made)
study = {{"bodies": [{{"type": "point_mass", "name": "point", "at": [1.0, 0.0, 0.0], "mass": 1.0}}],
         "loads": [{{"type": "attraction", "point": "point", "strength": "2*t", "drag": 0.5}}]}}
item = parse_study(study).model.loads[0]
found["file"] = [type(item).__name__, float(item.strength(3.0)[0]), item.drag, item.centre.tolist()]
found["refused"] = []
for wrong in ({{"drag": -1.0}}, {{"strength": "2*x"}}, {{"centre": [1.0, 2.0]}}):
    try:
        parse_study(study | {{"loads": [study["loads"][0] | wrong]}})
    except ancf.ModelError as error:
        found["refused"].append(str(error))
try:
    orbit(strength=None)
except ancf.ModelError as error:
    found["refused"].append(str(error))
found["schema"] = sorted(schema()["$defs"]["AttractionEntry"]["properties"])
for name, method in {{{", ".join(f'"{k}": {v}' for k, v in METHODS.items())}}}.items():
    found[name] = {{"orbit": steps(orbit(), method, 4.0, (1000, 2000))}}
    model = ancf.Model(gravity=(0, 0, -{G}))
    point = model.add_point_mass("point", at=(0, 0, 0), mass={MASS})
    model.add_attraction(point, 0.0, centre=(0, 0, 50), drag={DRAG})
    found[name]["fall"] = steps(model, method, {FALL}, (40, 80))
    model = orbit("3 + cos(2*t)", 0.1)
    model.add_spring("point", CENTRE, damping=0.7, stiffness=2.0, length=0.8)
    run = ancf.simulate(model, t_end=1.0, step=1e-3, integrator=method)
    energy = run.energy
    found[name]["booked"] = [float(energy.dissipated[-1]), float(energy.supplied[-1])]
    d, v = run.position("point") - CENTRE, run.velocity("point")
    size, speed = np.linalg.norm(d, axis=1), np.linalg.norm(v, axis=1)
    growth = np.sum(d * v, axis=1) / size
    supplied = -(3 + np.cos(2 * run.t)) * growth / size**2 - 0.1 * speed**3
    found[name]["quadrature"] = [float(np.trapezoid(p, run.t)) for p in (0.7 * growth**2, supplied)]
model = ancf.Model()
point = model.add_point_mass("point", at=(1, 0, 0), mass=1.0)
model.hold(point, position="yz")
model.add_spring(point, (0, 0, 0), stiffness={SPRING["stiffness"]}, length={SPRING["length"]})
model.add_attraction(point, {S}, centre=(3, 0, 0), drag={DRAG})
state = ancf.equilibrium(model, load_steps=3)
found["rest"] = state.position("point").tolist()
found["omega"] = ancf.modes(model, about=state, count=1).frequencies.tolist()
found["done"] = shown(orbit(), ".", t_end=0.1, step=1e-3, sensors=["point"])
print(json.dumps(found))
"""

#: With kernels as plain Python: a point of each kind of body, without supports, so that there are no shadows.
INTERPRETED = """
import json
import numpy as np
import ancf
from ancf.system.core import assemble, residual
from ancf.system.system import System
from ancf.linalg.sparse import to_sparse

model = ancf.Model()
thin = ancf.Section(EA=1e3, EI=1.0, rhoA=0.5, damping=0.2)
thick = ancf.Section.rectangle(0.02, 0.03, E=1e7, nu=0.3, rho=1e3)
wire = model.add_beam("wire", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=thin)
beam = model.add_beam("beam", start=(0, 1, 0), end=(1, 1, 0), elements=1, section=thick, element="nonlocking")
hub = model.add_rigid_body("hub", at=(2, 0, 0), mass=1.0, inertia=(0.1, 0.1, 0.1))
bob = model.add_point_mass("bob", at=(2, 1, 0), mass=1.0)
for k, point in enumerate((wire.at(0.3), wire.end, beam.at(0.4, 0.01, -0.01), hub.at(0.1, 0.2, 0.3), bob)):
    model.add_attraction(point, f"{k + 1}*cos(t)", centre=(0.1, 0.2, 3.0), drag=0.5 + k)
system = System(model)
core, rng = system.core, np.random.default_rng(1)
q, v = system.initial_state(0.2)
v[:] = rng.uniform(-1, 1, len(v))
mine, still = (system.parts["attraction"],), np.zeros(system.size)

def force(q, v):
    r = np.zeros(system.size)
    residual(mine, core.ws, q, v, still, still, r)
    return r

worst = []
for damping, stiffness in ((1.0, 0.0), (0.0, 1.0)):
    assemble(mine, core.ws, q, v, core.A, 0.0, damping, stiffness)
    matrix = to_sparse(core.A, system.places).toarray()
    shake = rng.uniform(-1, 1, system.size)
    shake[system.n:] = 0.0
    d = 1e-5 * shake
    ahead = force(q + stiffness * d, v + damping * d) - force(q - stiffness * d, v - damping * d)
    product = matrix @ shake[: system.n]
    worst.append(float(np.abs(ahead[: system.n] / 2e-5 - product).max() / np.abs(product).max()))
work = -force(q, v) @ v
power = 0.0
state = ancf.State(system, 0.2, q, v)
for load in model.loads:
    d, w = state.position(load.point) - (0.1, 0.2, 3.0), state.velocity(load.point)
    s = float(load.strength(0.2)[0])
    power += -s * d @ w / np.linalg.norm(d) ** 3 - load.drag * np.linalg.norm(w) ** 3
print(json.dumps({"tangent": worst, "work": float(work), "power": float(power)}))
"""


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the package with the file and the record of the page; nothing else is touched."""
    lines = {REGISTRY: {BEHIND: IMPORT, LIST: RECORD}}
    return Addition(tmp_path_factory.mktemp("load"), {"attraction.py": KERNELS}, lines)


@pytest.fixture(scope="module")
def added(copy):
    return copy.found(COMPILED)


def test_touches_two_files(copy):
    assert copy.touched() == [KERNELS, REGISTRY]
    assert "{literalinclude} attraction.py" in PAGE
    assert all(f"`{name}`" in PAGE for name in copy.touched())
    assert IMPORT in PAGE


def test_is_a_method_printed_and_described(added):
    assert added["dir"]
    assert "1 attraction" in added["shown"]
    assert "strength = 4 N m^2, centre = (0.3, -0.2, 0.1) m, drag = 0 N s^2/m^2" in added["shown"]
    described = {"type": "attraction", "name": "sun", "point": "point", "strength": S}
    assert added["described"] == described | {"centre": [0.3, -0.2, 0.1], "drag": 0.0}


def test_is_in_files_and_refused_there(added):
    assert added["file"] == ["Attraction", 6.0, 0.5, [0.0, 0.0, 0.0]]
    assert added["schema"] == sorted(["type", "point", "strength", "centre", "drag", "name"])
    places = ["loads[0].drag", "loads[0].strength", "loads[0].centre", 'add_attraction("sun").strength']
    assert [text.split(": ")[0] for text in added["refused"]] == places
    assert "must be given" in added["refused"][-1]


def kepler(t):
    """Place in the plane of the orbit, from the equation of Kepler, of a start at an apsis."""
    speed, r = np.linalg.norm(W), np.linalg.norm(A)
    a = 1.0 / (2.0 / r - speed**2 / S)
    e = 1.0 - r / a  # > 0: the start is the pericentre
    n = np.sqrt(S / abs(a) ** 3)
    E = np.array([brentq(lambda x, m=m: x - e * np.sin(x) - m, m - 1.5, m + 1.5, xtol=1e-15) for m in n * t])
    x, y = a * (np.cos(E) - e), a * np.sqrt(1 - e * e) * np.sin(E)
    across = np.asarray(W) / speed
    return x[:, None] * np.sign(r) * np.asarray(A) / r + y[:, None] * across


@pytest.mark.parametrize("name", METHODS)
class TestMotion:
    def test_is_an_ellipse(self, added, name):
        """Against Kepler's equation; the order of the method is seen in two steps."""
        exact = kepler(np.linspace(0.0, 4.0, 11))
        gaps = [np.abs(np.array(x) - (0.3, -0.2, 0.1) - exact).max() for x, _ in added[name]["orbit"]]
        if name == "radau":
            assert gaps[1] < 1e-9
        else:
            assert gaps[0] / gaps[1] == pytest.approx(4.0, rel=0.05)
            assert gaps[1] < 1e-3

    def test_keeps_energy_and_angular_momentum(self, added, name):
        x, v = (np.array(part) for part in added[name]["orbit"][1])
        d = x - (0.3, -0.2, 0.1)
        energy = 0.5 * np.sum(v * v, axis=1) - S / np.linalg.norm(d, axis=1)
        moment = np.cross(d, v)
        assert np.ptp(energy) < 1e-4
        assert np.ptp(moment, axis=0) == pytest.approx(0.0, abs=1e-5)
        assert moment[0] == pytest.approx(np.cross(A, W), abs=1e-12)

    def test_falls_to_the_terminal_velocity(self, added, name):
        final = np.sqrt(MASS * G / DRAG)
        exact = -final * np.tanh(G * np.linspace(0.0, FALL, 11) / final)
        gaps = [np.abs(np.array(v)[:, 2] - exact).max() for _, v in added[name]["fall"]]
        if name == "radau":
            assert gaps[1] < 1e-7
        else:
            assert gaps[0] / gaps[1] == pytest.approx(4.0, rel=0.1)
            assert gaps[1] < 2e-3 * final

    def test_each_force_is_booked_once(self, added, name):
        """Attraction and drag are supplied, the damper's work is dissipated, against quadratures of both."""
        assert added[name]["booked"] == pytest.approx(added[name]["quadrature"], abs=2e-5)
        assert min(map(abs, added[name]["quadrature"])) > 0.01


def test_equilibrium_and_its_mode(added):
    """The spring's force is the attraction's; the frequency is that of both slopes."""
    k, length = SPRING["stiffness"], SPRING["length"]
    x = brentq(lambda x: k * (x - length) - S / (3.0 - x) ** 2, 1.0, 2.0, xtol=1e-15)
    assert added["rest"] == pytest.approx([x, 0.0, 0.0], abs=1e-10)
    assert added["omega"] == pytest.approx([np.sqrt(k - 2 * S / (3.0 - x) ** 3)], rel=1e-9)


def test_is_saved_drawn_exported_and_sampled(added):
    """In the plot, the page, the file of ParaView and the tables."""
    done = added["done"]
    assert "1 attraction" in done["printed"][0]
    assert "attraction" in done["legend"]
    assert done["markers"]["sun"] == "attraction"
    assert ["sun", "attraction"] in done["parts"]
    assert done["sensors"] == ["point"]
    assert "point position x [m]" in done["columns"]


def test_tangent_and_work_on_every_kind_of_body(copy):
    """A cable, off a beam's axis, rigid body and mass: against differences, and F . v of the points."""
    found = copy.found(INTERPRETED, interpreted=True)
    assert max(found["tangent"]) < 1e-8
    assert found["work"] == pytest.approx(found["power"], rel=1e-12)
