"""Meshes as surfaces: signed distance, files, ropes on them beside the smooth shapes, what is refused."""

import struct

import numpy as np
import pytest

import ancf
from ancf.contact.mesh import distances


def prism(sides, radius=0.2, length=0.4):
    """A cylinder about y with so many sides, as large as the smooth one on average."""
    a = 2 * np.pi * np.arange(sides) / sides
    r = radius * np.sqrt(2 * np.pi / sides / np.sin(2 * np.pi / sides))  # the same area of the section
    x, z, half = r * np.cos(a), r * np.sin(a), np.full(sides, length / 2)
    points = np.concatenate(
        [
            np.stack([x, -half, z], axis=1),
            np.stack([x, half, z], axis=1),
            [[0, -length / 2, 0], [0, length / 2, 0]],
        ]
    )
    k, m = np.arange(sides), (np.arange(sides) + 1) % sides
    low, high = np.full(sides, 2 * sides), np.full(sides, 2 * sides + 1)
    rows = [(k, k + sides, m), (m, k + sides, m + sides), (low, k, m), (high, m + sides, k + sides)]
    return points, np.concatenate([np.stack(row, axis=1) for row in rows])


def ball(times, radius=0.3):
    """An icosahedron whose triangles are parted in four so often, on a sphere."""
    g = (1 + np.sqrt(5)) / 2
    points = np.array([[0, s, t * g] for s in (-1, 1) for t in (-1, 1)], dtype=float)
    points = np.concatenate([np.roll(points, k, axis=1) for k in range(3)])
    from scipy.spatial import ConvexHull

    for part in range(times + 1):
        points /= np.linalg.norm(points, axis=1, keepdims=True)
        hull = ConvexHull(points)
        rows = hull.simplices.copy()
        a, b, c = (points[rows[:, k]] for k in range(3))
        inward = np.sum(np.cross(b - a, c - a) * a, axis=1) < 0
        rows[inward] = rows[inward][:, ::-1]
        if part == times:
            return radius * points, rows
        ways = np.concatenate([rows[:, [0, 1]], rows[:, [1, 2]], rows[:, [2, 0]]])
        ends = np.unique(np.sort(ways, axis=1), axis=0)
        points = np.concatenate([points, points[ends].mean(axis=1)])


def brute(points, rows, places):
    """Distances of places from the triangles by many points of them."""
    u = np.linspace(0, 1, 25)
    weights = np.array([(1 - a - b, a, b) for a in u for b in u if a + b <= 1 + 1e-9])
    dots = np.einsum("wk,tkc->twc", weights, points[rows]).reshape(-1, 3)
    from scipy.spatial import cKDTree

    return cKDTree(dots).query(places)[0]


class TestDistance:
    def test_against_many_points_of_the_triangles(self):
        points, rows = ball(1)
        points = points * (1.0, 0.6, 1.4) + (0.05, -0.02, 0.01)
        places = np.random.default_rng(1).uniform(-0.6, 0.6, (400, 3))
        shift = np.array([0.1, 0.0, 0.0])
        found = distances(ancf.Mesh(points=points, triangles=rows, at=shift), places + shift)
        assert np.abs(found) == pytest.approx(brute(points, rows, places), abs=2e-3)
        assert (found < 0).sum() > 10
        assert (found > 0).sum() > 10

    def test_signs_beside_a_notch(self):
        """An L from above: in its corner and outside of its edges."""
        outline = np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], dtype=float)
        points = np.concatenate([np.c_[outline, np.zeros(6)], np.c_[outline, np.ones(6)]])
        cap = np.array([[0, 1, 3], [1, 2, 3], [0, 3, 5], [3, 4, 5]])
        k = np.arange(6)
        m = (k + 1) % 6
        rows = np.concatenate([cap[:, ::-1], cap + 6, np.c_[k, m, k + 6], np.c_[m, m + 6, k + 6]])
        places = np.array([[1.1, 1.1], [0.9, 0.9], [2.3, 1.4], [1.5, 1.5], [0.5, 0.5]])
        places = np.c_[places, [0.5, 0.5, 0.5, 0.5, 1.2]]
        found = distances(ancf.Mesh(points=points, triangles=rows), places)
        assert found == pytest.approx([0.1, -np.hypot(0.1, 0.1), 0.5, 0.5, 0.2])

    @pytest.mark.parametrize("seed", range(4))
    def test_signs_around_sharp_edges(self, seed):
        """Flat tetrahedra: outside is what is beyond one of the four planes, also at sharp edges."""
        from scipy.spatial import ConvexHull

        rng = np.random.default_rng(seed)
        points = rng.uniform(-1, 1, (4, 3)) * (1.0, 1.0, 0.05)
        rows = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
        if np.dot(np.cross(points[1] - points[0], points[2] - points[0]), points[3] - points[0]) < 0:
            rows = rows[:, ::-1]
        places = rng.uniform(-1.5, 1.5, (600, 3)) * (1.0, 1.0, 0.3)
        planes = ConvexHull(points).equations
        beyond = (places @ planes[:, :3].T + planes[:, 3]).max(axis=1)
        clear = np.abs(beyond) > 1e-6
        found = distances(ancf.Mesh(points=points, triangles=rows), places)
        np.testing.assert_array_equal(found[clear] > 0, beyond[clear] > 0)

    def test_a_sphere_comes_nearer_with_the_square_of_the_edges(self):
        places = np.random.default_rng(2).uniform(-0.5, 0.5, (300, 3))
        wanted = np.linalg.norm(places, axis=1) - 0.3
        off = [np.abs(distances(ancf.Mesh(None, *ball(n)), places) - wanted).max() for n in (1, 2, 3)]
        assert 3.0 < off[0] / off[1] < 5.0
        assert 3.0 < off[1] / off[2] < 5.0


class TestFile:
    @staticmethod
    def binary(corners):
        rows = b"".join(struct.pack("<12fH", 0, 0, 0, *row.ravel(), 0) for row in corners)
        return b"made by a test".ljust(80) + struct.pack("<I", len(corners)) + rows

    @staticmethod
    def text(corners):
        facets = "".join(
            "facet normal 0 0 0\n outer loop\n"
            + "".join(f"  vertex {x:.9e} {y:.9e} {z:.9e}\n" for x, y, z in row)
            + " endloop\nendfacet\n"
            for row in corners
        )
        return f"solid thing\n{facets}endsolid thing\n".encode()

    @classmethod
    def loud(cls, corners):
        """In capitals, as old programs write, after a name of the words of a file."""
        return b"SOLID FACET VERTEX 1 2" + cls.text(corners).upper().removeprefix(b"SOLID THING")

    @classmethod
    def returns(cls, corners):
        return cls.text(corners).replace(b"\n", b"\r\n")

    @classmethod
    def one_line(cls, corners):
        return cls.text(corners).replace(b"\n", b" ")

    @classmethod
    def solid(cls, corners):
        """Binary, with the word that text begins with."""
        return b"solid" + cls.binary(corners)[5:]

    @pytest.mark.parametrize("write", ["binary", "text", "loud", "returns", "one_line", "solid"])
    def test_stl(self, write, tmp_path):
        points, rows = prism(12)
        path = tmp_path / "drum.stl"
        path.write_bytes(getattr(self, write)(1e3 * points[rows]))
        mesh = ancf.Mesh(path, scale=1e-3)
        assert (mesh.points.shape, mesh.triangles.shape) == ((26, 3), (48, 3))
        places = np.random.default_rng(3).uniform(-0.4, 0.4, (50, 3))
        assert distances(mesh, places) == pytest.approx(
            distances(ancf.Mesh(points=points, triangles=rows), places), abs=1e-7
        )

    @pytest.mark.parametrize("write", ["binary", "text"])
    @pytest.mark.parametrize("thin", [1e-2, 1e-4, 1e-6])
    def test_corners_of_a_plate_stay_apart(self, write, thin, tmp_path):
        """However thin it is beside its size: single numbers have seven digits."""
        points, rows = ball(0)
        points = points * (1.0, 1.0, thin)
        path = tmp_path / "plate.stl"
        path.write_bytes(getattr(self, write)(points[rows]))
        mesh = ancf.Mesh(path)
        assert (mesh.points.shape, mesh.triangles.shape) == ((12, 3), (20, 3))
        assert mesh.narrowest == pytest.approx(np.ptp(points[:, 2]), rel=1e-6)

    def test_triangles_that_look_inwards_are_turned(self):
        points, rows = prism(12)
        place = np.array([[0.0, 0.0, 0.5]])
        assert distances(ancf.Mesh(points=points, triangles=rows[:, ::-1]), place)[0] > 0

    def test_kept_in_descriptions(self, tmp_path):
        points, rows = prism(6)
        model = ancf.Model()
        model.add_surface("thing", ancf.Mesh(points=points, triangles=rows, scale=0.5))
        again = ancf.Model.from_dict(model.to_dict()).surfaces[0].shape
        assert np.array_equal(again.points, 0.5 * points)


class TestRope:
    @staticmethod
    def over(shape, friction=0.0, elements=40):
        """A rope over half of a drum, pulled at one end; its middle and the force that holds the other."""
        angle = np.linspace(0, np.pi, 80)
        arc = 0.21 * np.stack([np.cos(angle), 0 * angle, np.sin(angle)], axis=1)
        tail = np.linspace(0.1, 0.01, 10)[:, None] * (0, 0, -1.0)
        path = np.concatenate([arc[0] + tail, arc, arc[-1] + tail[::-1]])
        model = ancf.Model()
        section = ancf.Section(EA=1e5, EI=1e-2, rhoA=0.3, diameter=0.02)
        rope = model.add_beam("rope", path=path, elements=elements, section=section)
        drum = model.add_surface("drum", shape)
        model.add_contact(rope, drum, stiffness=1e6, friction=friction)
        held = model.pin(rope.start)
        model.add_force(rope.end, (0, 0, -200.0))
        state = ancf.equilibrium(model)
        at = [state.position(rope.at(x)) for x in np.linspace(0.15, rope.length - 0.15, 12)]
        return np.array(at), np.linalg.norm(state.reaction(held))

    def test_lies_as_on_the_cylinder(self):
        """The finer the mesh, the nearer; the force that friction leaves as well."""
        wanted, force = self.over(ancf.Cylinder(radius=0.2, axis=(0, 1, 0)), 0.2)
        found = [
            self.over(ancf.Mesh(points=points, triangles=rows), 0.2)
            for points, rows in (prism(24), prism(48), prism(96))
        ]
        off = [np.linalg.norm(at - wanted, axis=1).max() for at, _ in found]
        assert off[2] < 3e-4
        assert off[2] < 0.25 * off[0]
        assert max(abs(held - force) for _, held in found) < 1e-2 * force  # it turns by as much
        assert force == pytest.approx(200.0 * np.exp(-0.2 * np.pi), rel=1e-2)


@pytest.mark.parametrize("factors", [(1.0, 2.0, 3.0), (2.5, 0.4, 1.0), (5.0, 1.0, 0.2)])
def test_narrowest_is_the_least_extent(factors):
    """Of an icosahedron, whose corners are at (0, 1, g) times the radius over sqrt(1 + g^2) and so on."""
    points, rows = ball(0, radius=0.3)
    g = (1 + np.sqrt(5)) / 2
    wide = 0.6 * g / np.sqrt(1 + g**2)
    assert ancf.Mesh(points=factors * points, triangles=rows).narrowest == pytest.approx(wide * min(factors))


BAD = {
    "a hole": (lambda p, t: {"points": p, "triangles": t[1:]}, "is not closed: 3 edges"),
    "one turned": (
        lambda p, t: {"points": p, "triangles": np.concatenate([t[:1, ::-1], t[1:]])},
        "look inwards and others outwards",
    ),
    "no area": (lambda p, t: {"points": p, "triangles": np.concatenate([t, [[0, 1, 1]]])}, "has no area"),
    "too far": (lambda p, t: {"points": 1e12 * p, "triangles": t}, "distances from it are not known"),
    "no such point": (lambda p, t: {"points": p, "triangles": t + 1}, "names a point that is none"),
    "from behind": (
        lambda p, t: {"points": p, "triangles": np.where(t == len(p) - 1, -1, t)},
        "names a point that is none",
    ),
    "no triangles": (lambda p, t: {"points": p}, "triangles: is missing"),
    "nothing": (lambda p, t: {}, "give either file, or points"),
    "no file": (lambda p, t: {"file": "nowhere.stl"}, "cannot be read: No such file"),
    "scale": (lambda p, t: {"points": p, "triangles": t, "scale": 0}, "scale: must be > 0"),
}


class TestBad:
    @pytest.mark.parametrize("case", BAD)
    def test_one_message(self, case):
        given, match = BAD[case]
        with pytest.raises(ancf.ModelError, match=match):
            ancf.Mesh(**given(*prism(6)))

    @pytest.mark.parametrize("data", [b"", b"solid x\nendsolid x\n", b"vertex 1 2", b"\x00" * 200])
    def test_files(self, data, tmp_path):
        path = tmp_path / "bad.stl"
        path.write_bytes(data)
        with pytest.raises(ancf.ModelError, match=r"Mesh.file: .*bad.stl"):
            ancf.Mesh(path)

    @pytest.mark.parametrize("lost", [1, 50, 900])
    @pytest.mark.parametrize("head", [b"made by a test", b"solid"])
    def test_cut_off(self, head, lost, tmp_path):
        points, rows = prism(12)
        path = tmp_path / "bad.stl"
        path.write_bytes(head.ljust(80) + TestFile.binary(points[rows])[80:-lost])
        there = (2400 - lost) // 50
        with pytest.raises(ancf.ModelError, match=rf"cut off.*48 triangles are announced, .* for {there}$"):
            ancf.Mesh(path)

    def test_inside_a_rope_at_the_start(self):
        points, rows = prism(24)
        with pytest.raises(ancf.ModelError, match=r'"drum" is 0\.\d+ m inside "rope"'):
            TestRope.over(ancf.Mesh(points=points * 1.1, triangles=rows))
