"""Generated model files and line files: each is read into something finite, or refused with a place.

The cases are changes of valid files: a value replaced, scaled, left out, doubled, moved.  They are always the
same ones; 1,000 of all kinds in a normal run, 20,000 with --slow.
"""

import copy
import tomllib
import warnings
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ancf
from ancf.catenary.lines.file import parse_line, read_file
from ancf.cli.check import check_file
from ancf.cli.notes import check_equilibrium, notes
from ancf.model.file import parse_study, read_study
from ancf.system.system import System
from fuzzing import cases, changed, finite, refused_or_fine
from places import EXAMPLES

#: Every kind of body, support, load and connection, small.
FACE = """
title = "Everything"
gravity = [0, 0, -9.81]

[sections.rope]
EA = 4e4
EI = 2.0
rhoA = 0.7
damping = 0.1

[sections.bar]
shape = "rectangle"
width = 0.03
height = 0.02
E = 6e8
rho = 1000
nu = 0.3

[[bodies]]
name = "beam"
start = [0, 0, 0]
end = [2, 0, 0]
elements = 3
length = 2.02
section = "rope"
motion = { velocity = [0, 0, 0.1], angular_velocity = [0, 0, 0.2], about = [0, 0, 0] }

[[bodies]]
name = "arc"
path = [[0, 1, 0], [0.5, 1.3, 0], [1, 1.4, 0.2], [1.5, 1.2, 0.2]]
nodes = [0, 0.5, 1.1, 1.5]
length = 1.5
section = "rope"
strain = "paper"
natural_shape = "straight"

[[bodies]]
name = "bar"
start = [0, 0, 1]
end = [1, 0, 1]
elements = 2
element = "nonlocking"
section = "bar"

[[bodies]]
type = "rigid_body"
name = "hub"
at = [2.2, 0, 0]
mass = 1.5
inertia = [0.3, 0.4, 0.5]

[[bodies]]
type = "point_mass"
name = "tip"
at = [1.0, 0, 1]
mass = 0.3
motion = { velocity = [0, 0, 0] }

[[supports]]
type = "pin"
point = "beam.start"
displacement = [0, 0, "0.01*sin(t)"]

[[supports]]
type = "clamp"
point = "bar.start"
rotation = "0.1*t"
axis = [0, 1, 0]

[[supports]]
type = "hold"
point = "arc.start"
position = "xz"
slope = "y"

[[supports]]
type = "pin"
point = "arc.end"

[[loads]]
type = "force"
point = "beam.at(1)"
force = [1, 0, "where(t < 1, t, 1)"]

[[loads]]
type = "moment"
point = "bar.end"
moment = [0.1, 0, 0]

[[loads]]
type = "distributed"
body = "arc"
load = [0, 0, -2]
between = [0.2, 1.0]

[[connections]]
type = "fixation"
point = "beam.end"
to = "hub"

[[connections]]
type = "hinge"
a = "hub.at(0.2, 0, 0)"
b = [2.4, 0, 0]
axis = [0, 1, 0]

[[connections]]
type = "spherical"
name = "ball"
a = "tip"
b = "bar.end"

[[connections]]
type = "spring"
name = "dropper"
a = "beam.at(1)"
b = "tip"
stiffness = 100
damping = 1
slack = true

[simulation]
t_end = 1
step = 0.01
output_step = 0.1
start = "equilibrium"
outputs = ["beam.at(1)"]
sensors = ["tip", "dropper"]
integrator = { type = "generalized_alpha", rho_inf = 0.8 }

[equilibrium]
load_steps = 2
"""
SLIDES = """
[[bodies]]
name = "beam"
start = [0, 0, 0]
end = [2, 0, 0.1]
elements = 3
section = { EA = 4e4, EI = 2.0, rhoA = 0.7 }

[[bodies]]
type = "point_mass"
name = "bead"
at = [1.0, 0, 0.05]
mass = 0.3

[[bodies]]
type = "point_mass"
name = "head"
at = [1.5, 0, 0.075]
mass = 0.3

[[supports]]
type = "pin"
point = "beam.start"

[[supports]]
type = "pin"
point = "beam.end"

[[connections]]
type = "slide"
point = "bead"
along = "beam"
mass = 0.1
friction = 0.2
unilateral = [0, 0, 1]
at_end = "clamp"

[[connections]]
type = "contact"
point = "head"
along = "beam"
stiffness = 1000
strip = [0, 1, 0]
normal = [0, 0, 1]
"""
MODELS = [tomllib.loads(FACE), tomllib.loads(SLIDES)]
#: Elements and nodes beyond which a case is read but not compiled.
MOST = 3000


def look_at(study):
    """What ``ancf check`` and ``ancf info`` say of a study that was read; all of it must be finite."""
    model = study.model
    assert str(model)
    assert repr(model)
    finite(model.size, model.gravity)
    for beam in model.beams.values():
        finite(beam.length, beam.stretch, beam.node_x, beam.node_position, beam.node_tangent, beam.node_y)
        assert beam.length > 0
        assert np.all(np.diff(beam.node_x) > 0)
        finite(beam.section.EA, beam.section.rhoA, beam.section.EI_y, beam.section.EI_z)
    if sum(b.elements for b in model.beams.values()) > MOST or not model.bodies:
        return
    # the scales of joints would take compiled kernels of each combination of bodies
    with warnings.catch_warnings(), patch("ancf.system.system.set_scales"):
        warnings.simplefilter("ignore")
        system = System(model)
        q, v = system.initial_state()
        check_equilibrium(study, system)
        for note in notes(study, system):
            assert note.strip()
    finite(q, v, system.core.loads.gravity, system.core.weight)


@pytest.mark.parametrize("which", range(len(MODELS)))
def test_valid_files_are_valid(which):
    look_at(parse_study(copy.deepcopy(MODELS[which])))


@cases(0.25)
@given(data=st.one_of([changed(m) for m in MODELS]))
def test_model_files(data):
    with refused_or_fine():
        look_at(parse_study(data))


@st.composite
def spoiled(draw, text):
    """A text with some characters replaced, taken out or put in, or cut off."""
    for _ in range(draw(st.integers(1, 3))):
        at = draw(st.integers(0, len(text)))
        new = draw(
            st.sampled_from(
                ['"', "[", "]", "=", "\n", "#", "1", "-", "e9", ".", "\x00", "é", "[[a]]", "{", "'"]
            )
        )
        text = text[:at] + new + text[at + draw(st.integers(0, 3)) :]
    return text[: draw(st.integers(0, len(text)))] if draw(st.booleans()) else text


@cases(0.07)
@given(text=st.one_of([spoiled(FACE), spoiled(SLIDES)]))
def test_texts_of_model_files(tmp_path_factory, text):
    """As the command reads them, from a file with any bytes."""
    path = tmp_path_factory.getbasetemp() / "spoiled.toml"
    path.write_bytes(text.encode("utf-8"))
    with refused_or_fine():
        read_study(path)


LINE = tomllib.loads((EXAMPLES / "line.toml").read_text(encoding="utf-8"))
LINE["stitch"] = {"EA": 4e6, "EI": 10.0, "mass": 0.3, "tension": 2e3, "reach": 8.0}
LINE["spans"] = LINE["spans"][:2]


@cases(0.13)
@given(data=changed(LINE))
def test_line_files(data):
    with refused_or_fine():
        line = parse_line(data)
        finite(line.length, line.supports, line.dropper_x, line.dropper_height, line.wave_speed)
        finite(line.stagger, line.messenger_y, line.system_height)
        assert np.all(np.diff(line.supports) > 0)
        assert np.all(np.diff(line.dropper_x) > 0)
        assert len(line.dropper_x) == len(line.dropper_stitch) == len(line.dropper_span)


def test_one_span_has_no_stitch_wire():
    """They hang at supports inside a line; of a line without any each dropper hangs on the messenger."""
    line = parse_line({**copy.deepcopy(LINE), "spans": LINE["spans"][:1]})
    assert len(line.dropper_x) > 2
    assert np.all(line.dropper_stitch == -1)


@cases(0.02)
@given(text=spoiled((EXAMPLES / "line.toml").read_text(encoding="utf-8")))
def test_texts_of_line_files(tmp_path_factory, text):
    path = tmp_path_factory.getbasetemp() / "spoiled_line.toml"
    path.write_bytes(text.encode("utf-8"))
    with refused_or_fine():
        read_file(path)


@cases(0.01)
@given(data=st.binary(max_size=200))
def test_any_bytes(tmp_path_factory, data):
    """What is no text at all is refused as such."""
    path = tmp_path_factory.getbasetemp() / "bytes.toml"
    path.write_bytes(data)
    with refused_or_fine():
        check_file(path)
    with refused_or_fine():
        read_file(path)


def test_an_empty_model_is_refused_by_the_check(tmp_path):
    path = tmp_path / "empty.toml"
    path.write_text("", encoding="utf-8")
    with pytest.raises(ancf.ModelError, match="bodies: is missing"):
        check_file(path)
