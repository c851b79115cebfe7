"""Generated damage of results files: a file opens and answers, or is refused with its name and a reason.

The file has every kind of body and connection; bytes, attributes, data sets, groups and links are changed.
"""

import contextlib
import io
import json
import shutil
import warnings
from unittest.mock import patch

import h5py
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ancf
import damage
from ancf.cli.check import check_file
from ancf.cli.info import show_info
from ancf.viz.export import write_csv, write_vtk
from ancf.viz.view import view_page
from fuzzing import cases, parent_of, refused_or_fine


@pytest.fixture(scope="module")
def right(tmp_path_factory):
    path = tmp_path_factory.mktemp("right") / "right.h5"
    damage.write(path)
    return path


def written(path):
    """What the commands make of a file: words, tables, a mesh, a page."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        for command in (check_file, show_info):
            with refused_or_fine():
                command(path)
    assert "\x1b" not in said.getvalue()
    with refused_or_fine():
        write_csv(ancf.load(path), path.with_suffix(""))
    with refused_or_fine():
        write_vtk(ancf.load(path), path.with_suffix(".vtkhdf"))
    with refused_or_fine(), patch("ancf.viz.view.page.plotly_script", return_value=""):
        assert "</html>" in view_page(ancf.load(path))


def test_right_file(right):
    result = ancf.load(right)
    assert result.status == "complete"
    damage.ask(result, states=False)
    assert len(result.sensors.names) == 5
    written(right)


@pytest.mark.parametrize("name", ["", " ", "nobody"])
@pytest.mark.parametrize(
    "question",
    ["multiplier", "arc_length", "arc_rate", "contact_force", "contact_gap", "spring_force", "spring_length"],
)
@pytest.mark.parametrize("of", ["result", "state", "sensors"])
def test_a_name_that_is_not_there_has_a_place(right, of, question, name):
    """Also an empty one, as a damaged file may list it."""
    result = ancf.load(right)
    asked = {"result": result, "state": result.state(-1), "sensors": result.sensors}[of]
    with pytest.raises(ancf.ModelError) as error:
        getattr(asked, question)(name)
    assert error.value.where.strip()


@cases(0.16)
@given(data=st.data())
def test_results_files(right, data):
    path = right.with_name("damaged.h5")
    path.unlink(missing_ok=True)  # a result that is still open keeps the old file
    shutil.copyfile(right, path)
    by_command = data.draw(st.integers(0, 5)) == 0
    states = damage.damage(path, data.draw)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with refused_or_fine():
            damage.ask(ancf.load(path), states)
        if by_command:
            written(path)


def header(key, value):
    """Another value in the header; the key is a path of keys."""

    def change(file):
        plain = json.loads(file.attrs["header"])
        parent_of(plain, key)[key[-1]] = value
        file.attrs["header"] = json.dumps(plain)

    return change


def body(number, key, value):
    """Another value in the description of a body."""
    return header(("model", "bodies", number, key), value)


def listed(key, value):
    """Another value in what the sensors list."""

    def change(file):
        plain = json.loads(file["sensors"].attrs["listed"])
        parent_of(plain, key)[key[-1]] = value
        file["sensors"].attrs["listed"] = json.dumps(plain)

    return change


def unlisted(spring):
    """A spring of which nothing was recorded."""

    def change(file):
        plain = json.loads(file["sensors"].attrs["listed"])
        plain["springs"].remove(spring)
        del plain["columns"][spring]
        file["sensors"].attrs["listed"] = json.dumps(plain)

    return change


def attribute(name, key, value):
    return lambda file: file[name].attrs.__setitem__(key, value)


def data(name, of):
    """A data set that is made from the old one."""

    def change(file):
        attrs, new = dict(file[name].attrs), of(file[name][()])
        del file[name]
        file[name] = new
        file[name].attrs.update(attrs)

    return change


SLIDER = "joints/000002"
#: What was found once, and the place that its refusal names.
FOUND = {
    "slots of fewer vectors": (data("bodies/wire/slots", lambda x: x[:, :1]), "bodies/wire/slots has shape"),
    "slots of fewer nodes": (data("bodies/wire/slots", lambda x: x[:-1]), "bodies/wire/slots has shape"),
    "slots of a mass in a row": (data("bodies/tip/slots", np.ravel), "bodies/tip/slots has shape"),
    "slots of decimals": (
        data("bodies/wire/slots", lambda x: 1.0 * x),
        "must hold whole numbers",
    ),
    "slots at the end": (data("bodies/tip/slots", lambda x: 0 * x + 10**3), "lies outside the states"),
    "directions of two numbers": (
        body(1, "node_tangent", [[1.0, 0.0]] * 3),
        "node_tangent: has shape",
    ),
    "places that are no numbers": (body(1, "node_position", [[np.nan] * 3] * 3), r"bodies\[1\].*finite"),
    "tangents of no length": (body(1, "node_tangent", [[0.0] * 3] * 3), "must be unit vectors"),
    "another element": (body(0, "element", "{"), r"bodies\[0\].*element"),
    "another strain": (body(0, "strain", "green"), r"bodies\[0\].*strain"),
    "no length": (body(0, "length", 0.0), r"bodies\[0\].*length"),
    "endless stretch": (body(0, "stretch", 1e30), r"bodies\[0\].*stretch"),
    "points of integration": (body(0, "gauss", [0, 3]), r"bodies\[0\].*gauss"),
    "one number of two": (body(0, "gauss", 3), r"bodies\[0\].*gauss"),
    "negative mass": (body(3, "mass", -1.0), r"bodies\[3\].*mass"),
    "axes of no length": (body(3, "axes", [[0.0] * 3] * 3), r"bodies\[3\].*axes"),
    "negative inertia": (body(3, "inertia", [[-1.0, 0, 0], [0, 1, 0], [0, 0, 1]]), r"bodies\[3\].*inertia"),
    "sliding joint without s": (data(SLIDER, lambda x: x[:3]), 'joints "slider" has shape'),
    "joint of a table": (data(SLIDER, lambda x: x.reshape(2, 2)), "damaged"),
    "negative spring": (
        header(("model", "connections", 3, "stiffness"), -1.0),
        r"connections\[3\].*stiffness",
    ),
    "spring beside its body": (
        header(("model", "connections", 3, "a"), "wire.at(9)"),
        r"connections\[3\].a: x = 9 m is outside",
    ),
    "modes of two joints": (data("modes", lambda x: np.append(x, x)), "damaged"),
    "a mode that is none": (data("modes", lambda x: x + 3), "modes must each be 0, 1 or 2"),
    "a table of modes": (data("modes", lambda x: x[None]), "modes has 2 axes"),
    "a table of places": (data("places", lambda x: x[:, None]), "places has 2 axes"),
    "a mode that is no number": (data("modes", lambda x: np.nan * x), "modes must each be 0, 1 or 2"),
    "stored times": (data("time", lambda t: t[::-1]), "time does not ascend"),
    "counters": (data("stats", lambda x: np.nan * x), "damaged"),
    "label of a table": (listed(("points", 0, "label"), {"t": [0]}), "sensors: a point must be text"),
    "place of a text": (listed(("points", 0, "place"), ["a", 0, 0]), "must be a number"),
    "names of lists": (listed(("connections",), [["dropper"]]), "sensors.connections must be text"),
    "too few columns": (listed(("columns", "touch"), [0, 1, 2]), 'sensors "touch" has shape'),
    "columns elsewhere": (listed(("columns", "touch"), [0, 1, 2, 9]), 'sensors "touch" lies outside'),
    "too few columns of a spring": (listed(("columns", "dropper"), [0]), 'sensors "dropper" has shape'),
    "a spring's columns elsewhere": (
        listed(("columns", "dropper"), [0, 99]),
        'sensors "dropper" lies outside',
    ),
    "a spring that is a contact": (listed(("springs",), []), 'sensors "dropper" has shape'),
    "a spring of another name": (listed(("springs",), ["droper"]), "or damaged: .droper"),
    "a spring that is nowhere": (unlisted("dropper"), "is damaged: sensors lack dropper"),
    "index that goes back": (data("sensors/index", lambda x: x[::-1]), "sensors/index does not ascend"),
    "narrow samples": (data("sensors/q", lambda x: x[:, :-1]), "sensors has data of widths"),
    "sensors' times": (data("sensors/time", lambda t: 0 * t), "sensors/time does not ascend"),
    "end of a text": (header(("settings", "t_end"), "x"), "header.settings.t_end must be a number"),
    "sensors of numbers": (
        header(("settings", "sensors"), [3]),
        r"sensors\[0\] must be text",
    ),
    "sensors of a number": (header(("settings", "sensors"), 3), "header.settings.sensors must be a list"),
    "energy of a text": (
        header(("settings", "energy"), "no"),
        "settings.energy must be True",
    ),
    "model of a list": (header(("model",), []), "header.model must be a table"),
    "a kind that is none": (header(("model", "supports", 0, "type"), "x"), r"supports\[0\].*type"),
    "support nowhere": (
        header(("model", "supports", 0, "point"), None),
        r"supports\[0\].*point",
    ),
    "strip of no length": (header(("model", "connections", 2, "strip"), [0, 0, 0]), "strip: must not be the"),
    "title of a list": (header(("title",), []), "header.title must be text"),
}


class TestFound:
    @pytest.mark.parametrize("name", FOUND)
    def test_is_refused_with_its_place(self, right, tmp_path, name):
        path = tmp_path / "damaged.h5"
        shutil.copyfile(right, path)
        change, said = FOUND[name]
        with h5py.File(path, "r+", libver="latest") as file:
            change(file)
        with pytest.raises(ancf.ModelError, match=said) as caught:
            _ = ancf.load(path).sensors
        assert caught.value.where == str(path)

    def test_unknowns_of_a_joint_in_any_order(self, right, tmp_path):
        """Several blocks of a joint need not follow each other."""
        path, whole = tmp_path / "turned.h5", ancf.load(right)
        shutil.copyfile(right, path)
        turned = [4, 2, 0, 3, 1]
        with h5py.File(path, "r+", libver="latest") as file:
            key = next(k for k, v in file["joints"].items() if v.attrs["name"] == "hinge")
            data(f"joints/{key}", lambda x: x[turned])(file)
        assert np.array_equal(ancf.load(path).multiplier("hinge"), whole.multiplier("hinge")[:, turned])

    @pytest.mark.parametrize("version", [0, 2, "1.0"])
    def test_of_another_version(self, right, tmp_path, version):
        path = tmp_path / "later.h5"
        shutil.copyfile(right, path)
        with h5py.File(path, "r+", libver="latest") as file:
            file.attrs["format_version"] = version
        with pytest.raises(ancf.ModelError, match=f"is a results file of version {version}, this ancf reads"):
            ancf.load(path)
