"""Results as tables and arrays of other libraries: pandas, xarray, Parquet."""

import sys

import numpy as np
import pytest

import ancf
from ancf.viz.export import write_csv, write_parquet
from ancf.viz.export.tables import sensor_columns

pandas = pytest.importorskip("pandas")
xarray = pytest.importorskip("xarray")
pytest.importorskip("pyarrow")


def swinging():
    model = ancf.Model(gravity=(0, 0, -9.81), title="A bob on a rope")
    section = ancf.Section(EA=1e4, EI=0.1, rhoA=0.5)
    rope = model.add_beam("rope", start=(0, 0, 0), end=(1.2, 0, 0), elements=3, section=section)
    bob = model.add_point_mass("bob", at=(0.7, 0, 0), mass=0.4)
    model.pin(rope.start)
    model.connect(rope.at(0.7), bob, name="hook")
    model.add_spring(rope.end, (1.2, 0, 1.0), stiffness=20.0, name="tie")
    return model


@pytest.fixture(scope="module")
def run():
    sensors = ["rope.end", "bob", "tie", "hook"]
    return ancf.simulate(swinging(), t_end=0.2, step=1e-3, output_step=0.01, sensors=sensors)


def touching():
    """A few steps of a rope on a floor under a strip, beside a ball that hangs from a torsion spring."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.1, rhoA=0.5, diameter=0.02)
    rope = model.add_beam("rope", start=(0, 0, 0.01), end=(1, 0, 0.01), elements=3, section=section)
    drawn = model.pin(rope.start)
    plane = model.add_surface("plane", ancf.Plane())
    model.add_surface_contact(rope, plane, stiffness=1e5, damping=10.0, friction=0.3, name="floor")
    head = model.add_point_mass("head", at=(0.4, 0, 0.0), mass=0.1)
    model.hold(head, position="xyz")
    model.add_contact(head, along=rope, stiffness=1e3, name="strip")
    body = model.add_rigid_body("body", at=(0, 2, 0.099), mass=1.0, inertia=(0.01, 0.01, 0.01))
    skin = model.add_surface("skin", ancf.Sphere(radius=0.1), on=body)
    model.add_body_contact(skin, plane, stiffness=1e4, damping=10.0, friction=0.3, name="ball")
    model.add_torsion_spring(body, (0, 2, 0.099), axis=(1, 0, 0), stiffness=1.0, name="twist")
    items = ["rope.end", "body", "floor", "strip", "ball", "twist", drawn]
    return ancf.simulate(model, t_end=0.01, step=1e-3, sensors=items)


@pytest.mark.parametrize("element", ["cable", "original", "nonlocking"])
@pytest.mark.parametrize("elements", [2, 4])
def test_clamps_have_their_moments(element, elements, tmp_path):
    """In every table of sensors, and of a result that is asked for them; a pin has none."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section.rectangle(width=0.02, height=0.02, E=1e8, rho=1000.0, nu=0.3)
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section, element=element
    )
    clamp = model.clamp(beam.start)
    pin = model.pin(model.add_point_mass("mass", at=(0, 1, 0), mass=1.0))
    run = ancf.simulate(model, t_end=0.05, step=1e-3, output_step=0.01, sensors=[clamp, pin])
    for known in (run, run.sensors):
        frame, arrays = known.to_pandas(clamp, pin), known.to_xarray(clamp, pin)
        heads = [f"{clamp.name} reaction {c} [N]" for c in "xyz"]
        heads += [f"{clamp.name} moment {c} [N m]" for c in "xyz"]
        assert [*frame.columns] == heads + [f"{pin.name} reaction {c} [N]" for c in "xyz"]
        moment = known.reaction_moment(clamp)
        assert np.array_equal(frame[heads[3:]].to_numpy(), moment)
        assert abs(moment[:, 1]).max() > 0.1
        assert np.array_equal(arrays[f"{clamp.name} moment y"], moment[:, 1])
        assert arrays[f"{clamp.name} moment y"].attrs["units"] == "N m"
    assert [*run.sensors.to_pandas().columns] == [name for name, _ in sensor_columns(run.sensors)][1:]


class TestPandas:
    def test_everything(self, run):
        frame = run.to_pandas()
        assert frame.index.name == "t [s]"
        assert np.array_equal(frame.index, run.t)
        assert frame.attrs["title"] == "A bob on a rope"
        middle = "rope.at(0.6)"
        for point in ("rope.start", middle, "rope.end", "bob"):
            for k, c in enumerate("xyz"):
                assert np.array_equal(frame[f"{point} position {c} [m]"], run.position(point)[:, k])
                assert np.array_equal(frame[f"{point} velocity {c} [m/s]"], run.velocity(point)[:, k])
        assert np.array_equal(frame[f"{middle} tension [N]"], run.tension(middle))
        assert np.array_equal(frame[f"{middle} curvature [1/m]"], run.curvature(middle))
        assert np.array_equal(frame["tie force [N]"], run.spring_force("tie"))
        assert np.array_equal(frame["tie length [m]"], run.spring_length("tie"))
        assert np.array_equal(frame["hook force z [N]"], run.multiplier("hook")[:, 2])
        assert np.array_equal(frame["supplied [J]"], run.energy.supplied)
        assert len(frame.columns) == 3 * 8 + 6 + 2 + 3 + 8
        units = frame.attrs["units"]
        assert units.keys() == set(frame.columns)
        assert (units["tie force [N]"], units[f"{middle} curvature [1/m]"]) == ("N", "1/m")

    @pytest.mark.parametrize("by", ["name", "object"])
    def test_what_is_asked_for_in_its_order(self, run, by):
        model = run.model
        items = ["tie", "bob", "hook"]
        if by == "object":
            springs = {item.name: item for item in model.connections}
            items = [springs["tie"], model.masses["bob"], springs["hook"]]
        frame = run.to_pandas(items)
        assert list(frame.columns[:3]) == ["tie force [N]", "tie length [m]", "bob position x [m]"]
        assert frame.columns[-1] == "hook force z [N]"
        assert run.to_pandas("bob").equals(run.to_pandas(["bob"]))
        assert run.to_pandas("bob", "energy").equals(run.to_pandas(["bob", "energy"]))

    def test_sensors_at_every_step(self, run):
        frame = run.sensors.to_pandas()
        assert len(frame) == 201
        assert np.array_equal(frame["bob position z [m]"], run.sensors.position("bob")[:, 2])
        assert np.array_equal(frame["rope.end tension [N]"], run.sensors.tension("rope.end"))
        assert not any("kinetic" in name for name in frame.columns)

    def test_has_all_that_the_tables_of_sensors_have(self):
        """Of every kind of connection, friction of what rubs and the place of a strip included."""
        recorded = touching().sensors
        table = dict(sensor_columns(recorded))
        table.pop("t [s]")
        frame = recorded.to_pandas()
        assert set(frame.columns) == set(table)
        assert {"floor friction [N]", "floor slipping [-]", "ball friction [N]", "strip s [m]"} <= set(table)
        for name, values in table.items():
            assert np.array_equal(frame[name], values, equal_nan=True), name

    def test_of_a_file(self, run, tmp_path):
        file = tmp_path / "run.h5"
        ancf.simulate(swinging(), t_end=0.2, step=1e-3, output_step=0.01, file=file)
        loaded = ancf.load(file).to_pandas()
        pandas.testing.assert_frame_equal(loaded, run.to_pandas(), rtol=1e-12, atol=1e-12)


class TestXarray:
    def test_dimensions_units_and_values(self, run):
        data = run.to_xarray()
        assert data.position.dims == data.velocity.dims == ("t", "point", "axis")
        assert data.tension.dims == ("t", "point")
        assert data.position.attrs["units"] == "m"
        assert data.t.attrs["units"] == "s"
        assert np.array_equal(data.position.sel(point="bob", axis="z"), run.position("bob")[:, 2])
        assert np.array_equal(data.tension.sel(point="rope.end"), run.tension("rope.end"))
        assert np.all(np.isnan(data.tension.sel(point="bob")))
        assert np.array_equal(data.spring_force.sel(spring="tie"), run.spring_force("tie"))
        assert np.array_equal(data["kinetic"], run.energy.kinetic)
        assert data["hook force x"].attrs["units"] == "N"
        assert float(data.tension.sel(t=0.1, point="rope.end")) == run.tension("rope.end")[10]

    def test_of_sensors_and_of_a_part(self, run):
        assert run.sensors.to_xarray().sizes == {"t": 201, "point": 2, "axis": 3, "spring": 1}
        assert set(run.to_xarray(["energy"])) == {
            "kinetic",
            "strain",
            "potential",
            "total",
            "dissipated",
            "supplied",
            "balance",
            "drift",
        }
        assert set(run.to_xarray("tie")) == {"spring_force", "spring_length"}


class TestParquet:
    @pytest.mark.parametrize("points", [None, ["bob", "rope.at(0.3)"]])
    def test_same_tables_as_csv(self, run, tmp_path, points):
        written = write_parquet(run, tmp_path / "a", points)
        beside = write_csv(run, tmp_path / "b", points)
        assert [f.stem for f in written] == [f.stem for f in beside]
        for one, other in zip(written, beside, strict=True):
            pandas.testing.assert_frame_equal(pandas.read_parquet(one), pandas.read_csv(other), rtol=1e-14)

    def test_wrong_point_writes_nothing(self, run, tmp_path):
        with pytest.raises(ancf.ModelError, match="bib"):
            write_parquet(run, tmp_path / "a", ["bib"])
        with pytest.raises(ancf.ModelError, match=r"write_parquet.points\[0\]"):
            write_parquet(run, tmp_path / "a", [3])
        assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("items", [["rope.ends"], "nix", [3], [None], [("tie",)]])
@pytest.mark.parametrize("method", ["to_pandas", "to_xarray"])
def test_what_there_is_not(run, items, method):
    for known in (run, run.sensors):
        with pytest.raises(ancf.ModelError) as caught:
            getattr(known, method)(items)
        assert caught.value.where == f"{method}[0]"


def test_what_was_not_recorded(run):
    for items in (["rope.start"], ["energy"]):
        with pytest.raises(ancf.ModelError):
            run.sensors.to_pandas(items)


@pytest.mark.parametrize(("library", "method"), [("pandas", "to_pandas"), ("xarray", "to_xarray")])
def test_without_the_library_it_says_what_to_install(run, monkeypatch, library, method):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(ancf.ModelError, match=rf"needs {library}.*pip install 'ancf\[data\]'"):
        getattr(run, method)()


def test_parquet_without_its_library(run, monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(ancf.ModelError, match="needs pyarrow"):
        write_parquet(run, tmp_path)
