"""Results for other programs: VTKHDF read back by VTK's own reader, CSV tables, ``ancf export``."""

import csv
import json
from pathlib import Path

import h5py
import numpy as np
import openpyxl
import pytest
import pyvista
from vtkmodules.vtkIOHDF import vtkHDFReader

import ancf
from ancf.cli.export import split_points
from ancf.viz.export import write_csv, write_vtk, write_xlsx
from ancf.viz.export.csv_files import default_points
from ancf.viz.export.parts import part_kinds
from ancf.viz.export.polydata import write_scene
from ancf.viz.export.workbook import described
from ancf.viz.scene import Scene, Strip, Triad

ROPE = ancf.Section(EA=2e3, EI=0.05, rhoA=0.3)
POINTS = ["wire.at(0.7)", "bob"]


def yard():
    """A bob on a rope that can go slack, tossed up, and a bead that slides along the wire."""
    model = ancf.Model(gravity=(0, 0, -9.81), title="Yard")
    wire = model.add_beam("wire", start=(0, 0, 1), end=(2, 0, 1.1), elements=4, section=ROPE)
    model.add_beam("tail", start=(2, 0, 1.1), end=(2, 1, 1.0), elements=2, section=ROPE)
    model.pin(wire.start)
    model.pin(wire.end)
    model.pin("tail.start")
    bob = model.add_point_mass("bob", at=(0.5, 0, 0.5), mass=0.2)
    bob.set_motion(velocity=(0, 0, 2.0))
    model.add_spring(wire.at(0.5), bob, stiffness=500.0, damping=0.5, length=0.5, slack=True, name="rope")
    bead = model.add_point_mass("bead", at=wire.initial_position(1.2), mass=0.1)
    model.slide(bead, along=wire, s=1.2, name="slider")
    return model


def rope():
    """A taut cable."""
    model = ancf.Model()
    wire = model.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0), elements=4, section=ROPE, length=1.99)
    model.pin(wire.start)
    model.pin(wire.end)
    return model


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A loaded result with sensors."""
    path = tmp_path_factory.mktemp("run") / "results.h5"
    given = {"t_end": 0.6, "step": 2e-3, "output_step": 0.01, "sensors": ["bob", "rope", "slider"]}
    ancf.simulate(yard(), file=path, **given)
    return ancf.load(path), path


class Read:
    """A VTKHDF file as VTK reads it."""

    def __init__(self, path):
        self.reader = vtkHDFReader()
        self.reader.SetFileName(str(path))
        self.reader.UpdateInformation()
        self.count = self.reader.GetNumberOfSteps()
        with h5py.File(path) as file:
            self.notes = {key: json.loads(value) for key, value in file["ancf"].attrs.items()}

    def step(self, k):
        """Time and mesh of one step."""
        self.reader.SetStep(k)
        self.reader.Update()
        return self.reader.GetTimeValue(), pyvista.wrap(self.reader.GetOutput()).copy()

    def meshes(self):
        return [self.step(k)[1] for k in range(self.count)]

    def of(self, mesh, part, kind):
        """Numbers of the points of one thing."""
        numbers = self.notes["parts"].index(part), self.notes["kinds"].index(kind)
        return np.flatnonzero((mesh["part"] == numbers[0]) & (mesh["kind"] == numbers[1]))


@pytest.fixture(scope="module")
def read(run, tmp_path_factory):
    """The run as a VTKHDF file."""
    return Read(write_vtk(run[0], tmp_path_factory.mktemp("vtk") / "run.vtkhdf"))


def by_middles(result, beam, x):
    """Tension at x between the middles of a cable's elements, where it does not waver, (n_t,)."""
    middles = 0.5 * (beam.node_x[:-1] + beam.node_x[1:])
    each = np.array([result.tension(beam.at(place)) for place in middles])
    return np.array([np.interp(x, middles, forces) for forces in each.T])


class TestMovingMesh:
    def test_times(self, run, read):
        assert read.count == len(run[0].t) == 61
        assert [read.step(k)[0] for k in range(61)] == pytest.approx(run[0].t, abs=1e-15)

    def test_one_part_for_all_steps(self, read):
        """VTK 9.3, the first that knows time steps, reads cells that are written once only like this."""
        with h5py.File(read.reader.GetFileName()) as file:
            root = file["VTKHDF"]
            assert root.attrs["Type"] == b"PolyData"
            assert not root["Steps/PartOffsets"][:].any()
            assert not root["Steps/CellOffsets"][:].any()
            assert len(root["Lines/NumberOfCells"]) == 1
            assert (
                root["Steps/PointOffsets"][:].tolist() == (root["NumberOfPoints"][0] * np.arange(61)).tolist()
            )

    def test_constant_values_are_those_of_every_step(self, read):
        """They are written once: a reader that looked for them further on would find nothing, or others."""
        with h5py.File(read.reader.GetFileName()) as file:
            offsets = file["VTKHDF/Steps/PointDataOffsets"]
            assert {name for name in offsets if offsets[name][:].any()} >= {"tension", "displacement"}
            assert not any(offsets[name][:].any() for name in ("kind", "part", "s"))
        first, last = (read.step(k)[1] for k in (0, 60))
        for name in ("kind", "part", "s"):
            np.testing.assert_array_equal(first[name], last[name])

    @pytest.mark.parametrize("name", ["wire", "tail"])
    def test_centrelines(self, run, read, name):
        """Places and values at every point of a line, nodes among them, at several times."""
        result, meshes = run[0], read.meshes()
        beam = result.bodies[name]
        at = read.of(meshes[0], name, "cable")
        s = meshes[0]["s"][at]
        assert set(beam.node_x) <= set(s)
        assert np.all(np.diff(s) > 0)
        for i, x in zip(at[::7], s[::7], strict=True):
            point = beam.at(x)
            moved = np.array([mesh.points[i] for mesh in meshes])
            assert moved == pytest.approx(result.position(point), abs=1e-12)
            for quantity, wanted in (("tension", by_middles(result, beam, x)), ("curvature", None)):
                got = [mesh[quantity][i] for mesh in meshes]
                exact = 1e-12 if wanted is None else 1e-15 * ROPE.EA  # strains are differences
                wanted = getattr(result, quantity)(point) if wanted is None else wanted
                assert got == pytest.approx(wanted, rel=1e-12, abs=exact)
            speed = np.linalg.norm(result.velocity(point), axis=1)
            assert [mesh["speed"][i] for mesh in meshes] == pytest.approx(speed, rel=1e-12, abs=1e-12)
            shift = np.array([mesh["displacement"][i] for mesh in meshes])
            assert shift == pytest.approx(moved - moved[0], abs=1e-15)

    def test_cells(self, read):
        """A line for each cable and spring, a vertex for each mass, support and joint."""
        mesh = read.step(5)[1]
        lines = [mesh.get_cell(k) for k in range(mesh.n_cells) if mesh.get_cell(k).type.name.endswith("LINE")]
        ends = [list(line.point_ids) for line in lines]
        wanted = [read.of(mesh, *what) for what in (("wire", "cable"), ("tail", "cable"), ("rope", "spring"))]
        assert [list(w) for w in wanted] == ends
        kinds = [part_kinds()[mesh["kind"][k]] for k in mesh.verts.reshape(-1, 2)[:, 1]]
        assert sorted(kinds) == ["pin", "pin", "pin", "point mass", "point mass", "slide"]

    def test_spring(self, run, read):
        result, meshes = run[0], read.meshes()
        a, b = read.of(meshes[0], "rope", "spring")
        assert np.array([m.points[a] for m in meshes]) == pytest.approx(result.position("wire.at(0.5)"))
        assert np.array([m.points[b] for m in meshes]) == pytest.approx(result.position("bob"))
        force = result.spring_force("rope")
        slack = np.linalg.norm(result.position("bob") - result.position("wire.at(0.5)"), axis=1) < 0.5
        assert 5 < slack.sum() < 56  # both happen
        for end in (a, b):
            assert [m["force"][end] for m in meshes] == pytest.approx(force, rel=1e-12)
            assert np.all(np.array([m["slack"][end] for m in meshes])[slack] == 1.0)

    def test_markers(self, run, read):
        result, meshes = run[0], read.meshes()
        for name, kind, point in (
            ("bob", "point mass", "bob"),
            ("bead", "point mass", "bead"),
            ("slider", "slide", "bead"),
            ("pin at wire.end", "pin", "wire.end"),
        ):
            [at] = read.of(meshes[0], name, kind)
            assert np.array([m.points[at] for m in meshes]) == pytest.approx(
                result.position(point), abs=1e-12
            )

    def test_what_does_not_apply_is_nan(self, read):
        mesh = read.step(3)[1]
        line = np.isin(mesh["kind"], [part_kinds().index("cable")])
        spring = mesh["kind"] == part_kinds().index("spring")
        for name, there in (("tension", line), ("s", line), ("force", spring), ("slack", spring)):
            assert np.array_equal(np.isfinite(mesh[name]), there)
        assert np.all(np.isfinite(mesh.points))
        assert read.notes["units"]["tension"] == "N"
        assert read.notes["title"] == "Yard"

    def test_chosen_times(self, run, tmp_path):
        read = Read(write_vtk(run[0], tmp_path / "a.vtkhdf", frames=4))
        assert [read.step(k)[0] for k in range(4)] == pytest.approx([0.0, 0.2, 0.4, 0.6])
        read = Read(write_vtk(run[0], tmp_path / "a.vtkhdf", start=0.3, end=0.33))
        assert [read.step(k)[0] for k in range(read.count)] == pytest.approx([0.3, 0.31, 0.32, 0.33])

    def test_in_blocks(self, run, read, tmp_path, monkeypatch):
        """Written a few times at once it is the same file."""
        monkeypatch.setattr("ancf.viz.export.polydata.BLOCK", 1000)
        whole, other = (r.meshes() for r in (read, Read(write_vtk(run[0], tmp_path / "b.vtkhdf"))))
        for one, two in zip(whole, other, strict=True):
            assert np.array_equal(one.points, two.points)
            assert np.array_equal(one["displacement"], two["displacement"])
            assert np.array_equal(one["tension"], two["tension"], equal_nan=True)

    def test_number_of_points(self, run, tmp_path):
        """Never less than the nodes on a long history; as many as wanted."""
        mesh = Read(write_vtk(run[0], tmp_path / "a.vtkhdf", frames=2, points=6)).step(0)[1]
        assert np.sum(np.isfinite(mesh["s"])) == 8


class TestSolids:
    def test_surface_is_closed_and_has_the_volume(self, tmp_path):
        """0.2 m x 0.1 m x 3 m, faces outwards."""
        model = ancf.Model()
        section = ancf.Section.rectangle(width=0.2, height=0.1, E=1e6, rho=100.0, nu=0.3)
        given = {"elements": 2, "section": section, "element": "nonlocking"}
        bar = model.add_beam("bar", start=(0, 0, 0), end=(1, 2, 2), **given)
        model.clamp(bar.start)
        read = Read(write_vtk(ancf.equilibrium(model), tmp_path / "bar.vtkhdf"))
        _, mesh = read.step(0)
        assert read.count == 1
        surface = pyvista.PolyData(mesh.points, faces=mesh.faces).clean()
        assert surface.n_open_edges == 0
        triangles = surface.triangulate().faces.reshape(-1, 4)[:, 1:]
        a, b, c = np.moveaxis(surface.points[triangles], 1, 0)
        assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0 == pytest.approx(0.2 * 0.1 * 3.0, rel=1e-9)
        on = read.of(mesh, "bar", "surface")
        assert np.all(np.isfinite(mesh["tension"][on]))
        assert len(on) == 4 * len(read.of(mesh, "bar", "nonlocking"))

    def test_axes_of_a_rigid_body(self, tmp_path):
        """Columns of the rotation are the directions of the three lines, as long as they are to be drawn."""
        angle = np.array([0.0, 0.3])
        c, s, zero, one = np.cos(angle), np.sin(angle), 0 * angle, 0 * angle + 1
        axes = np.array([[c, -s, zero], [s, c, zero], [zero, zero, one]]).transpose(2, 0, 1)
        centre = np.array([[3.0, 0, 0], [3.0, 1, 0]])
        scene = Scene("", np.array([0.0, 1.0]), triads=[Triad("hub", centre, axes, 0.5)])
        mesh = Read(write_scene(scene, tmp_path / "hub.vtkhdf")).step(1)[1]
        assert mesh.points[0] == pytest.approx([3, 1, 0])
        tips = np.array([[np.cos(0.3), np.sin(0.3), 0], [-np.sin(0.3), np.cos(0.3), 0], [0, 0, 1]])
        assert mesh.points[1:] - mesh.points[0] == pytest.approx(0.5 * tips)
        assert mesh.lines.tolist() == [2, 0, 1, 2, 0, 2, 2, 0, 3]

    @pytest.mark.parametrize("force", [np.array([7.0, 0.0]), None])
    def test_strips(self, tmp_path, force):
        """The force of a strip is unknown when nothing recorded it."""
        ends = np.arange(12.0).reshape(2, 2, 3)
        scene = Scene("", np.array([0.0, 1.0]), strips=[Strip("touch", ends, force)])
        read = Read(write_scene(scene, tmp_path / "strip.vtkhdf"))
        for k in range(2):
            mesh = read.step(k)[1]
            assert mesh.points.tolist() == ends[k].tolist()
            assert ("force" in mesh.array_names) == (force is not None)
            if force is not None:
                assert mesh["force"].tolist() == [force[k], force[k]]

    def test_modes(self, tmp_path):
        """One period; the largest displacement is a tenth of the model's size."""
        model = rope()
        modes = ancf.modes(model, about=ancf.equilibrium(model), count=3)
        read = Read(write_vtk(modes, tmp_path / "mode.vtkhdf", mode=2))
        assert read.count == 60
        assert read.step(59)[0] == pytest.approx(1.0 / modes.frequencies_hz[2])
        largest = max(np.max(np.linalg.norm(mesh["displacement"], axis=1)) for mesh in read.meshes())
        assert largest == pytest.approx(0.2, rel=0.01)
        assert "tension" not in read.step(0)[1].array_names


class TestWrongVtk:
    def test_suffix(self, run):
        with pytest.raises(ancf.ModelError, match="suffix that ParaView does not know") as caught:
            write_vtk(run[0], run[1])
        assert ".vtkhdf" in caught.value.hint
        assert ancf.load(run[1]).status == "complete"

    @pytest.mark.parametrize("given", [{"frames": 0}, {"frames": 1.5}, {"points": 1}, {"start": 7.0}])
    def test_numbers(self, run, tmp_path, given):
        with pytest.raises(ancf.ModelError):
            write_vtk(run[0], tmp_path / "a.vtkhdf", **given)
        assert not list(tmp_path.iterdir())

    def test_no_result(self, tmp_path):
        with pytest.raises(ancf.ModelError, match="must be a Result, a State or Modes"):
            write_vtk("results.h5", tmp_path / "a.vtkhdf")

    def test_folder_is_a_file(self, run, tmp_path):
        (tmp_path / "a").write_text("x")
        with pytest.raises(ancf.ModelError, match="a file stands in the way"):
            write_vtk(run[0], tmp_path / "a" / "b.vtkhdf")

    def test_place_is_a_folder(self, run, tmp_path):
        """Nothing half-written stays."""
        (tmp_path / "a.vtkhdf" / "full").mkdir(parents=True)
        with pytest.raises(ancf.ModelError, match="cannot be written"):
            write_vtk(run[0], tmp_path / "a.vtkhdf")
        assert [path.name for path in tmp_path.iterdir()] == ["a.vtkhdf"]


def table(path):
    """Columns of a CSV file by name."""
    with Path(path).open(newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    return dict(zip(head, np.array(rows, dtype=float).T, strict=True))


@pytest.fixture(scope="module")
def tables(run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("csv") / "new" / "folder"
    files = write_csv(run[0], folder, points=POINTS)
    assert [f.stem for f in files] == ["sensors", "points", "springs", "joints", "energies"]
    return {file.stem: table(file) for file in files}


class TestTables:
    def test_points(self, run, tables):
        """To the last bit."""
        result, found = run[0], tables["points"]
        assert np.array_equal(found["t [s]"], result.t)
        for point in POINTS:
            for k, c in enumerate("xyz"):
                assert np.array_equal(found[f"{point} position {c} [m]"], result.position(point)[:, k])
                assert np.array_equal(found[f"{point} velocity {c} [m/s]"], result.velocity(point)[:, k])
        assert np.array_equal(found["wire.at(0.7) tension [N]"], result.tension("wire.at(0.7)"))
        assert np.array_equal(found["wire.at(0.7) curvature [1/m]"], result.curvature("wire.at(0.7)"))
        assert len(found) == 1 + 6 + 2 + 6  # a mass has no tension

    def test_sensors_at_every_step(self, run, tables):
        sensors, found = run[0].sensors, tables["sensors"]
        assert len(found["t [s]"]) == 301
        assert np.array_equal(found["bob position z [m]"], sensors.position("bob")[:, 2])
        assert np.array_equal(found["rope force [N]"], sensors.spring_force("rope"))
        assert np.array_equal(found["slider s [m]"], sensors.arc_length("slider"))

    def test_springs_joints_energies(self, run, tables):
        result = run[0]
        assert list(tables["springs"]) == ["t [s]", "rope force [N]"]
        assert np.array_equal(tables["springs"]["rope force [N]"], result.spring_force("rope"))
        assert np.array_equal(tables["joints"]["slider s [m]"], result.arc_length("slider"))
        assert np.array_equal(tables["joints"]["slider force z [N]"], result.multiplier("slider")[:, 2])
        energy = tables["energies"]
        assert np.array_equal(energy["kinetic [J]"], result.energy.kinetic)
        total = energy["kinetic [J]"] + energy["strain [J]"] + energy["potential [J]"]
        assert energy["total [J]"] == pytest.approx(total, rel=1e-14)
        balance = total + energy["dissipated [J]"] - energy["supplied [J]"]
        assert energy["balance [J]"] == pytest.approx(balance, rel=1e-14)
        assert np.array_equal(energy["drift [J]"], result.energy.drift)

    def test_moments_of_a_joint(self, tmp_path):
        """Behind its force, along global axes."""
        model = ancf.Model(gravity=(0, 0, -9.81))
        hub = model.add_rigid_body("hub", at=(1, 0.2, 0), mass=1.0, inertia=(0.01, 0.02, 0.03))
        hinge = model.hinge(hub.at(-1, -0.2, 0), (0, 0, 0), axis=(0, 1, 0), name="hinge")
        result = ancf.simulate(model, t_end=0.02, step=0.01)
        (path,) = (f for f in write_csv(result, tmp_path) if f.stem == "joints")
        found, values = table(path), np.hstack([result.multiplier(hinge)[:, :3], result.joint_moment(hinge)])
        names = [f"hinge {what} {c} [{u}]" for what, u in (("force", "N"), ("moment", "N m")) for c in "xyz"]
        assert list(found) == ["t [s]", *names, "hinge angle [rad]"]
        np.testing.assert_array_equal(found["hinge angle [rad]"], result.joint_angle(hinge))
        for k, name in enumerate(names):
            assert np.array_equal(found[name], values[:, k])
        assert np.all(values[-1, [3, 5]] != 0.0)  # it turns freely about y

    def test_moments_of_clamps(self, tmp_path):
        """Of what a clamp holds, not of a pin; at every step."""
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e4, EI=1.0, rhoA=0.2)
        one = model.add_beam("one", start=(0, 0, 0), end=(1, 0, 0), elements=3, section=section)
        two = model.add_beam("two", start=(0, 1, 0), end=(2, 1, 0), elements=3, section=section)
        model.clamp(one.start, name="wall")
        model.pin(two.start, name="peg")
        result = ancf.simulate(model, t_end=0.02, step=1e-3, sensors=["wall", "peg"], output_step=0.01)
        write_csv(result, tmp_path)
        found = table(tmp_path / "sensors.csv")
        told = np.transpose([found[f"wall moment {axis} [N m]"] for axis in "xyz"])
        assert np.array_equal(told, result.sensors.reaction_moment("wall"))
        assert np.abs(told[:, 1]).max() > 0.01
        assert not any("peg moment" in head for head in found)

    def test_without_sensors_and_energy(self, tmp_path):
        """Points that stand for the bodies; no table is empty."""
        result = ancf.simulate(rope(), t_end=0.002, step=1e-3, energy=False)
        files = write_csv(result, tmp_path)
        assert [f.name for f in files] == ["points.csv"]
        found = table(files[0])
        assert len(found) == 1 + 3 * 8
        assert found["wire.at(0.995) position x [m]"][0] == pytest.approx(1.0)

    def test_points_that_stand_for_bodies(self):
        model = yard()
        model.add_rigid_body("hub", at=(3, 0, 0), mass=2.0, inertia=(0.3, 0.4, 0.5))
        wanted = ["wire.start", "wire.at(1.00125)", "wire.end", "tail.start", "tail.at(0.502494)", "tail.end"]
        assert default_points(model) == [*wanted, "bob", "bead", "hub.centre"]

    def test_methods_of_a_result(self, run, tables, tmp_path):
        """Points as objects or by name; what is written is what ``ancf export`` writes."""
        result = run[0]
        point = result.model.bodies["wire"].at(0.7)
        files = result.to_csv(tmp_path / "tables", points=[point, result.model.bodies["bob"]])
        assert [path.stem for path in files] == list(tables)
        for path in files:
            found = table(path)
            assert list(found) == list(tables[path.stem])
            assert all(np.array_equal(found[head], tables[path.stem][head]) for head in found)
        book = openpyxl.load_workbook(result.to_excel(tmp_path / "run.xlsx", points="bob"))
        assert book.sheetnames == ["about", *tables]

    def test_wrong_point_writes_nothing(self, run, tmp_path):
        for wrong, what in (("wier.end", 'did you mean "wire"'), ("wire.at(7)", "outside the beam")):
            with pytest.raises(ancf.ModelError, match=what):
                write_csv(run[0], tmp_path / "a", points=[wrong])
        with pytest.raises(ancf.ModelError, match=r"points\[0\]"):
            write_csv(run[0], tmp_path / "a", points=[3])
        assert not list(tmp_path.iterdir())

    def test_points_of_a_command_line(self):
        assert split_points("a.end, b.at(0.5, 0, 0.01) ,c") == ["a.end", "b.at(0.5, 0, 0.01)", "c"]
        assert split_points(" , ") == []


@pytest.fixture
def call(call):
    return lambda *arguments: call("export", *arguments)


@pytest.fixture
def file(run, tmp_path):
    """The results file in the empty folder."""
    Path("out").mkdir(exist_ok=True)
    path = tmp_path / "out" / "results.h5"
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(run[1].read_bytes())
    return Path("out/results.h5")


class TestCommand:
    def test_vtk_beside_the_results(self, call, file):
        ran = call(file, "--to", "vtk")
        assert (ran.code, ran.out, ran.said) == (0, "written: out/results.vtkhdf\n", "")
        assert Read("out/results.vtkhdf").count == 61

    def test_vtk_elsewhere(self, call, file):
        assert call(file, "--to", "vtk", "-o", "new/a.vtkhdf", "--frames", 3, "-q").out == ""
        assert Read("new/a.vtkhdf").count == 3
        assert call(file, "--to", "vtk", "-o", "new", "--start", 0.1, "--end", 0.2).code == 0
        assert Read("new/results.vtkhdf").count == 11

    def test_the_end_of_the_name_says_what_is_written(self, call, file):
        assert call(file, "-o", "a.vtkhdf", "--frames", 3).out == "written: a.vtkhdf\n"
        assert Read("a.vtkhdf").count == 3
        assert call(file, "-o", "a.XLSX", "--points", "bob").out == "written: a.XLSX\n"
        assert openpyxl.load_workbook("a.XLSX").sheetnames[0] == "about"
        assert call(file, "-o", "a.gif", "--frames", 2).code == 0
        assert Path("a.gif").read_bytes()[:4] == b"GIF8"

    def test_csv(self, call, file):
        ran = call(file, "--to", "csv", "--points", "wire.at(0.7, 0, 0),bob", "-o", "tables")
        assert ran.code == 0
        assert "tables/sensors.csv" in ran.out
        assert "wire.at(0.7, 0, 0) tension [N]" in table("tables/points.csv")

    def test_workbook(self, call, file):
        """Read by a program for spreadsheets: the tables of CSV, number by number, and a sheet about them."""
        for word in ("excel", "xlsx"):
            assert call(file, "--to", word, "--points", "bob").out == "written: out/results.xlsx\n"
        call(file, "--to", "csv", "--points", "bob", "-o", "tables")
        book = openpyxl.load_workbook("out/results.xlsx")
        assert book.sheetnames == ["about", "sensors", "points", "springs", "joints", "energies"]
        said = {row[1]: row[2:] for row in book["about"].iter_rows(values_only=True) if row[0] == "points"}
        assert said["t"] == ("s", "time")
        assert said["bob position z"] == ("m", "global coordinate z of the point")
        for name in book.sheetnames[1:]:
            head, *rows = book[name].iter_rows(values_only=True)
            wanted = table(f"tables/{name}.csv")
            assert list(head) == list(wanted)
            np.testing.assert_allclose(np.array(rows, dtype=float).T, list(wanted.values()), rtol=1e-15)
            assert all(described(column)[2] for column in head)

    @pytest.mark.parametrize("element", ["cable", "original", "nonlocking"])
    def test_tension_of_sensors(self, element, tmp_path):
        """Of points of cables and beams, at every step, with unit and meaning; a mass has none."""
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section.circle(diameter=0.02, E=1e8, rho=1000.0, nu=0.3)
        rod = model.add_beam(
            "rod", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section, element=element
        )
        model.clamp(rod.start)
        model.add_point_mass("bob", at=(0, 0, -1), mass=1.0)
        points = ["rod.start", "rod.at(0.4)", "bob"] + ["rod.at(0.4, 0.005, 0)"] * rod.has_section
        result = ancf.simulate(model, t_end=0.01, step=1e-3, output_step=5e-3, sensors=points)
        write_csv(result, tmp_path)
        columns = table(tmp_path / "sensors.csv")
        assert [name for name in columns if "tension" in name] == [
            f"{point} tension [N]" for point in points if point != "bob"
        ]
        for point in points[:2]:
            assert np.array_equal(columns[f"{point} tension [N]"], result.sensors.tension(point))
            np.testing.assert_array_equal(columns[f"{point} tension [N]"][::5], result.tension(point))
        write_xlsx(result, tmp_path / "a.xlsx")
        about = openpyxl.load_workbook(tmp_path / "a.xlsx")["about"].iter_rows(values_only=True)
        said = {row[1]: row[2:] for row in about if row[0] == "sensors"}
        assert said["rod.start tension"] == ("N", "axial force, positive in tension")

    def test_workbook_has_no_formulas(self, tmp_path):
        """A title that a spreadsheet would take for one."""
        model = ancf.Model(title="=1+2")
        model.add_point_mass("m", at=(0, 0, 0), mass=1.0)
        write_xlsx(ancf.simulate(model, t_end=0.01, step=5e-3), tmp_path / "a.xlsx")
        book = openpyxl.load_workbook(tmp_path / "a.xlsx")
        cells = [cell for sheet in book for row in sheet.iter_rows() for cell in row]
        assert [cell for cell in cells if cell.data_type == "f"] == []

    def test_csv_without_sensors(self, call):
        result = ancf.simulate(yard(), t_end=0.01, step=2e-3)
        result.save("a.h5")
        ran = call("a.h5", "--to", "csv")
        assert "no sensors were recorded" in ran.said
        assert "wire.at(1.00125) tension [N]" in table("points.csv")
        assert not Path("sensors.csv").exists()

    def test_run_that_stopped(self, call, file):
        with h5py.File(file, "r+") as data:
            data["status"][()] = 2
        ran = call(file, "--to", "csv", "-o", "t")
        assert ran.code == 0
        assert "not complete (failed): exporting up to t = 0.6 s" in ran.said

    @pytest.mark.parametrize(
        ("arguments", "said"),
        [
            ((), '--to: is missing: one of "vtk", "csv"'),
            (("-o", "a.csv"), "csv fills a folder: --to csv -o a"),
            (("-o", "b/a.PARQUET"), "parquet fills a folder: --to parquet -o b/a"),
            (("-o", "a.pdf"), "or -o with a file that ends so"),
            (("--to", "vkt"), 'did you mean "vtk"?'),
            (
                ("--to", "csv", "--frames", 3),
                "--frames: means nothing with --to csv it belongs to vtk, mp4, gif",
            ),
            (("--to", "vtk", "--points", "bob"), "--points: means nothing with --to vtk it belongs to csv"),
            (("--to", "csv", "--points", " , "), "names no point"),
            (("--to", "csv", "--points", "bib"), "bib"),
            (("--to", "csv", "-o", "a.csv"), "give a folder"),
            (("--to", "vtk", "-o", "a.vtu"), "must end in .vtkhdf"),
            (("--to", "vtk", "-o", "out/results.h5"), "must end in .vtkhdf"),
            (("--to", "vtk", "-o", "out/results.h5/a.vtkhdf"), "a file stands in the way"),
            (("--to", "vtk", "--start", 9), "there are states from t = 0 to 0.6 s"),
            (("--to", "vtk", "--frames", 0), "must be between 1 and"),
        ],
    )
    def test_wrong_options(self, call, file, arguments, said):
        ran = call(file, *arguments)
        assert ran.code == 2
        assert said in ran.said
        assert [path.name for path in Path("out").iterdir()] == ["results.h5"]

    @pytest.mark.parametrize(
        ("name", "said"),
        [
            ("none.h5", "there is no such file"),
            (".", "is a folder without results.h5 name the file: empty.h5, other.h5"),
            ("model.toml", "is a model file, not a results file ancf run model.toml"),
            ("text.h5", "is not a results file of ancf"),
            ("other.h5", "is not a results file of ancf"),
            ("torn.h5", "is not a results file of ancf"),
            ("empty.h5", "holds no states yet"),
        ],
    )
    def test_wrong_file(self, call, file, name, said):
        for text in ("model.toml", "text.h5"):
            Path(text).write_text("title = 1", encoding="utf-8")
        for copy in ("empty.h5", "torn.h5"):
            Path(copy).write_bytes(file.read_bytes())
        with h5py.File("other.h5", "w") as data:
            data["x"] = 1
        with h5py.File("torn.h5", "r+") as data:
            del data["bodies"]
        with h5py.File("empty.h5", "r+") as data:
            data["time"].resize(0, axis=0)
        ran = call(name, "--to", "vtk")
        assert ran.code == 2
        assert said in ran.said

    def test_folder(self, call, file):
        """The folder of a run names its results file, and what is written stands beside that."""
        ran = call("out", "--to", "vtk")
        assert (ran.code, ran.out) == (0, "written: out/results.vtkhdf\n")

    def test_movie(self, call, file):
        pytest.importorskip("ancf.viz.pictures.movie")
        ran = call(file, "--to", "gif", "--frames", 4, "--fps", 5, "--color", "speed", "--view", "xz")
        assert ran.code == 0
        assert Path("out/results.gif").read_bytes()[:4] == b"GIF8"
