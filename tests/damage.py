"""Generated damage of results files: what a file can suffer, and all that can be asked of one that opens."""

import json
import math
from unittest.mock import patch

import h5py
import numpy as np
from hypothesis import strategies as st

import ancf
from ancf import preparation
from ancf.model.integrators import Trapezoidal
from ancf.results.store import FileStore
from ancf.solvers.stepping import Stats
from ancf.system.sensors import listing
from ancf.system.system import System
from fuzzing import changed, finite, refused_or_fine

ROPE = {"EA": 4e4, "EI": 2.0, "rhoA": 0.7}


def everything():
    """A model with every kind of body and connection, and what its sensors record."""
    model = ancf.Model(gravity=(0, 0, -9.81), title="Everything")
    section = ancf.Section(**ROPE, axial_damping=0.1)
    bar = ancf.Section.rectangle(0.03, 0.02, E=6e8, rho=1e3, nu=0.3)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0), elements=2, section=section)
    model.add_beam(
        "arc", path=lambda u: (u, 1, u * u), elements=2, section=section, strain="paper"
    ).set_motion(velocity=(0, 0, 1))
    beam = model.add_beam(
        "bar", start=(0, 0, 1), end=(1, 0, 1), elements=1, section=bar, element="nonlocking"
    )
    hub = model.add_rigid_body("hub", at=(2, 0, 1), mass=1.5, inertia=(0.3, 0.4, 0.5))
    tip, head = (
        model.add_point_mass(name, at=(x, 0, 0), mass=0.3) for name, x in (("tip", 1), ("head", 1.5))
    )
    model.pin(wire.start)
    model.clamp(beam.start, rotation="0.1*t")
    model.hinge(beam.end, hub.at(-1, 0, 0), axis=(0, 1, 0), name="hinge")
    model.slide(tip, along=wire, name="slider")
    model.add_contact(head, wire, stiffness=1e3, name="touch")
    model.add_spring(wire.at(0.7), tip, stiffness=10.0, slack=True, name="dropper")
    model.add_spring(tip, (1, 0, 1), stiffness=10.0, damping=0.1, name="=rope")
    return model, [wire.at(0.7), head.point, "dropper", "slider", "touch"]


def write(path):
    """A results file of that model, with states that it might have had; no kernel is compiled for it."""

    def energies(system, q, v):
        return np.abs(q[:, :3]) + 1.0

    model, sensors = everything()
    with patch("ancf.system.system.set_scales"), patch("ancf.results.store.energies", energies):
        system = System(model)
        system.sensors = listing(system, [model.sensor(item, "sensors") for item in sensors], True)
        file = FileStore(path, system, preparation.header_of(system, Trapezoidal(), 0.0, 1.0, 0.1, 0.5))
        rng = np.random.default_rng(1)
        q, v = system.initial_state()
        t = np.linspace(0.0, 1.0, 11)
        states = q + 0.01 * rng.normal(size=(len(t), len(q)))
        rates = v + rng.normal(size=states.shape)
        index, measured = system.sensors.index, rng.uniform(0.1, 1.0, (len(t), system.sensors.width))
        file.record(t, np.concatenate([states[:, index], rates[:, index], measured], axis=1))
        file.append(t[::5], states[::5], rates[::5], np.outer(t[::5], [0.1, 0.2]))
        file.update(Stats(steps=10, newton_iterations=20, jacobians=2, cpu_seconds=0.1), "complete")
        file.close()
    shrink(path)


def shrink(path):
    """The same in chunks of its size: small, so that bytes that are changed mean something."""
    new = path.with_suffix(".new")
    with h5py.File(path, "r") as old, h5py.File(new, "w", libver="latest", track_order=True) as file:
        for key, value in old.attrs.items():
            file.attrs[key] = value
        for name, item in old.items():
            if isinstance(item, h5py.Dataset) and item.ndim:
                file.create_dataset(name, data=item[()], maxshape=(None, *item.shape[1:]), chunks=item.shape)
            elif name != "sensors":
                old.copy(item, file, name)
        group = file.create_group("sensors")
        group.attrs["listed"] = old["sensors"].attrs["listed"]
        for name, item in old["sensors"].items():
            group[name] = item[()]
    new.replace(path)


#: Values of attributes and data sets; text that HDF5 cannot hold is left out.
JSON = st.one_of(
    st.sampled_from(
        [None, True, 0, -1, 3, 0.5, 1e308, "", "a", "contact", "wire.start", "wire.at(9)", "bar", [], {}]
    ),
    st.sampled_from(
        [[0, 0, 0], [0, 0, 1], ["t", 0, 0], [[0, 0, 0]], {"t": [0]}, math.nan, math.inf, "\x1b[2J"]
    ),
)
VALUES = [
    0,
    -1,
    1,
    2,
    0.5,
    1e300,
    -1e-300,
    10**9,
    2**62,
    np.nan,
    np.inf,
    -np.inf,
    True,
    "",
    "a",
    "cable",
    "wire",
]
VALUES += ["nonlocking", "paper", "wire.end", "{", "[1]", "\x1b[2J", b"x\xff", h5py.Empty("f8"), np.zeros(0)]
VALUES += [
    np.zeros(3),
    np.ones(3),
    np.full(3, np.nan),
    np.zeros((2, 3)),
    np.ones((3, 3)),
    np.zeros((2, 2, 2)),
]
VALUES += [
    np.arange(4),
    np.arange(10**4),
    np.array([b"a", b"b"]),
    np.array([1j, 2.0]),
    np.zeros(3, dtype="f4"),
]
VALUES += [np.zeros((3, 1), dtype="i8"), np.zeros(2, dtype=[("a", "f8")]), np.zeros((3, 0))]
SHARE = st.floats(0.0, 1.0, exclude_max=True)


def damage(path, draw):
    """Make one or two changes to a file; whether its states may have become others."""
    kinds = (
        ["bytes"] * 2
        + ["attribute"] * 4
        + ["header"] * 5
        + ["listed"] * 2
        + ["data"] * 6
        + ["group", "elsewhere"]
    )
    states = False
    for _ in range(draw(st.integers(1, 2))):
        kind = draw(st.sampled_from(kinds))
        if kind == "bytes":
            _bytes(path, draw)
            return True  # what has become of it is not to be opened for writing
        with h5py.File(path, "r+", libver="latest") as file:
            states |= bool(CHANGES[kind](file, draw))
    return states


def _bytes(path, draw):
    """Bytes that are changed, put in or cut off."""
    data = bytearray(path.read_bytes())
    for _ in range(draw(st.integers(1, 4))):
        at = int(draw(SHARE) * len(data))
        how = draw(st.sampled_from(["turn", "turn", "turn", "zeros", "cut", "put", "end"]))
        if how == "turn":
            data[at] ^= 1 << draw(st.integers(0, 7))
        elif how == "zeros":
            data[at : at + 64] = bytes(len(data[at : at + 64]))
        elif how == "cut":
            del data[at : at + draw(st.integers(1, 100))]
        elif how == "put":
            data[at:at] = draw(st.binary(min_size=1, max_size=20))
        elif at > 100:
            del data[at:]
    path.write_bytes(data)


def _all(file, kind=h5py.HLObject):
    """Names of all groups and data sets."""
    found = ["/"]
    file.visit(found.append)
    return [name for name in sorted(found) if isinstance(file[name], kind)]


def _attribute(file, draw):
    name = draw(st.sampled_from([n for n in _all(file) if len(file[n].attrs)]))
    attrs = file[name].attrs
    key = draw(st.sampled_from(sorted(attrs)))
    how, old = draw(st.sampled_from(["value", "value", "missing", "scale"])), attrs[key]
    if how == "missing":
        del attrs[key]
    elif how == "scale" and isinstance(old, float | np.ndarray) and np.asarray(old).dtype.kind in "if":
        attrs[key] = old * draw(st.sampled_from([-1.0, 0.0, 1e-30, 1e30, np.nan, 0.5]))
    else:
        attrs[key] = draw(st.sampled_from(VALUES))


def _json(attrs, key, draw):
    try:
        plain = json.loads(attrs[key])
    except (ValueError, TypeError, KeyError):
        return
    if isinstance(plain, dict | list):
        attrs[key] = json.dumps(draw(changed(plain, values=JSON)))


def _header(file, draw):
    _json(file.attrs, "header", draw)


def _listed(file, draw):
    if isinstance(file.get("sensors"), h5py.Group):
        _json(file["sensors"].attrs, "listed", draw)


def _data(file, draw):
    name = draw(st.sampled_from(_all(file, h5py.Dataset) or ["/"]))
    if name == "/":
        return False
    old, attrs = file[name][()], dict(file[name].attrs)
    how = draw(st.sampled_from(["value", "missing", "scale", "entry", "shape", "kind", "other", "group"]))
    del file[name]
    if how == "group":
        file.create_group(name)
    if how in ("missing", "group"):
        return False
    new = np.asarray(old)
    number = st.sampled_from([-1, 0, 1e-300, 1e300, np.nan, np.inf, 1 + 1e-9, 3])
    if how == "value":
        new = draw(st.sampled_from(VALUES))
    elif how == "scale" and new.dtype.kind in "if":
        with np.errstate(all="ignore"):
            new = new * draw(number)
    elif how == "entry" and new.size and new.dtype.kind in "if":
        new = new.astype(float)
        new.flat[int(draw(SHARE) * new.size)] = draw(number)
        with np.errstate(all="ignore"):  # too large for a whole number
            new = new if draw(st.booleans()) or not np.all(np.isfinite(new)) else new.astype(old.dtype)
    elif how == "shape":
        shapes = (
            [new.T, new[..., :0], new[:-1], new[..., None], new.ravel(), new[::-1]]
            if new.ndim
            else [new[None]]
        )
        shapes += [np.concatenate([new, new]), np.repeat(new, 2, axis=-1)] if new.ndim else []
        new = draw(st.sampled_from(shapes))
    elif how == "kind":
        with np.errstate(all="ignore"):
            new = new.astype(draw(st.sampled_from(["f4", "i4", "c16", "S3", "?", "u1"])))
    elif how == "other":
        other = draw(st.sampled_from(_all(file, h5py.Dataset) or ["/"]))
        new = file[other][()] if other != "/" else new
    file[name] = new
    for key, value in attrs.items():
        file[name].attrs[key] = value
    return name.rpartition("/")[2] in ("q", "v", "measured", "energy", "work", "time")


def _group(file, draw):
    name = draw(st.sampled_from([n for n in _all(file, h5py.Group) if n != "/"] or ["/"]))
    how = draw(st.sampled_from(["missing", "empty", "rename", "into itself", "twice", "data"]))
    if name == "/":
        return
    if how == "into itself":
        inner = f"{name}/{draw(st.sampled_from(['a', 'slots', '000009']))}"
        if inner in file:
            del file[inner]
        file[inner] = file[name]
    elif how == "twice":
        if f"{name}_2" not in file:
            file.copy(name, f"{name}_2")
    elif how == "rename":
        other = name[:-1] + draw(st.sampled_from(["x", "\u00e4", "\x1b[2J", "a" * 1000]))
        if other not in file:
            file.move(name, other)
    else:
        del file[name]
        if how == "empty":
            file.create_group(name)
        elif how == "data":
            file[name] = draw(st.sampled_from(VALUES))


def _elsewhere(file, draw):
    """Links to other places, and data that are kept in other files."""
    name = draw(st.sampled_from([n for n in _all(file) if n != "/"]))
    how = draw(st.sampled_from(["soft", "external", "hard", "storage", "virtual"]))
    other = draw(st.sampled_from(_all(file)))
    target, data = file[other], file[name]
    shape = data.shape if isinstance(data, h5py.Dataset) else (3,)
    del file[name]
    if how == "soft":
        file[name] = h5py.SoftLink(other)
    elif how == "external":
        file[name] = h5py.ExternalLink(draw(st.sampled_from(["/etc/passwd", "other.h5", ""])) or "x", "/q")
    elif how == "hard":
        file[name] = target
    elif how == "storage":
        file.create_dataset(name, shape or (1,), "f8", external=[("/etc/passwd", 0, h5py.h5f.UNLIMITED)])
    else:
        layout = h5py.VirtualLayout(shape or (1,), "f8")
        layout[...] = h5py.VirtualSource("/etc/passwd", "q", shape or (1,))
        file.create_virtual_dataset(name, layout)
    return True


CHANGES = {
    "attribute": _attribute,
    "header": _header,
    "listed": _listed,
    "data": _data,
    "group": _group,
    "elsewhere": _elsewhere,
}


def ask(result, states):
    """All questions to a result; numbers are asked for where the states are those that were written."""

    def answered(question, *arguments):
        with refused_or_fine():
            answer = question(*arguments)
            if not states:
                finite(answer)
            return answer

    assert result.status in ("running", "complete", "failed", "interrupted")
    for show in (repr, str):
        with refused_or_fine():
            text = show(result)
            assert states or "nan" not in text, text
    with refused_or_fine():
        assert all(note.strip() for note in result.notes)
    for source in (result, _sensors(result)):
        if source is None:
            continue
        assert np.all(np.isfinite(source.t))
        assert np.all(np.diff(source.t) > 0)
        for name, body in result.bodies.items():
            points = (
                [body.start, body.end, body.at(0.3 * body.length)] if hasattr(body, "elements") else [body]
            )
            for point in (*points, name):
                for quantity in ("position", "velocity"):
                    answered(getattr(source, quantity), point)
            for quantity in INSIDE:
                answered(getattr(source, quantity), points[-1])
        for spring in result.springs:
            answered(source.spring_force, spring)
            answered(source.spring_length, spring)
        for joint in result.joints:
            answered(source.multiplier, joint)
        for joint in (*result.arcs, *source._contacts()):
            for quantity in ("arc_length", "arc_rate", "contact_force", "contact_gap", "contact_offset"):
                answered(getattr(source, quantity), joint)
    with refused_or_fine():
        for part in ("kinetic", "strain", "potential", "dissipated", "supplied", "balance", "drift"):
            assert getattr(result.energy, part).shape == result.t.shape


INSIDE = ("slope", "strain", "tension", "curvature", "bending_moment", "torque", "twist", "section_rotation")


def _sensors(result):
    with refused_or_fine():
        return result.sensors
    return None
