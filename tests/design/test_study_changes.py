"""What a study rests on, files, modules, values: if one of them changes, its folder is refused."""

import importlib
import json
import os
import sqlite3
import sys
import textwrap

import numpy as np
import pytest

import ancf
from ancf.design import study as studies
from ancf.design.file import read_study_file
from ancf.design.fingerprints import fingerprint
from ancf.design.study import identity
from commands import MODEL, SIMULATION
from overhead_lines import TOML

TABLE = "t,F\n0,0\n0.01,1\n0.02,1\n"
SUPPORTS = "position,height\n0,0\n32,0\n64,0.02\n96,0\n128,0\n"
UNIT = "masses = [15.0]\nstiffness = [50.0]\ndamping = [90.0]\nstatic_force = 120.0\n"
TETRAHEDRON = """solid one
facet normal 0 0 0
outer loop
vertex 0 0 0
vertex 0 1 0
vertex 1 0 0
endloop
endfacet
facet normal 0 0 0
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 0 1
endloop
endfacet
facet normal 0 0 0
outer loop
vertex 0 0 0
vertex 0 0 1
vertex 0 1 0
endloop
endfacet
facet normal 0 0 0
outer loop
vertex 1 0 0
vertex 0 1 0
vertex 0 0 1
endloop
endfacet
endsolid one
"""
LOAD = '[[loads]]\ntype = "force"\npoint = "beam.end"\nforce = [0, 0, { csv = "F.csv", column = "F" }]\n'
OF_MODEL = """
model = "m.toml"
[[parameters]]
path = "sections.strip.E"
values = [1e8, 1.1e8]
[sampling]
method = "grid"
[[outputs]]
name = "tip"
formula = "last(position(beam.end)[2])"
"""
OF_LINE = """
line = "line.toml"
[[parameters]]
path = "contact_wire.tension"
values = [20e3]
[sampling]
method = "grid"
[[outputs]]
name = "y"
formula = "max(dropper_length)"
"""


def of_model(folder):
    short = SIMULATION.replace("0.4", "0.02")
    (folder / "m.toml").write_text(MODEL + LOAD + short, encoding="utf-8")
    (folder / "F.csv").write_text(TABLE, encoding="utf-8")
    (folder / "s.toml").write_text(OF_MODEL, encoding="utf-8")


def of_line(folder, run=""):
    head = TOML.partition("[[spans]]")[0].replace("stagger = 0.2", 'anchors = "tension"\nstagger = 0.2')
    rule = 'supports = "sup.csv"\ndropper_rule = {first = 3.0, pitch_max = 7.0}\n'
    (folder / "line.toml").write_text(rule + head, encoding="utf-8")
    (folder / "sup.csv").write_text(SUPPORTS, encoding="utf-8")
    (folder / "p.toml").write_text(UNIT, encoding="utf-8")
    text = OF_LINE.replace("[[parameters]]", f"{run}[[parameters]]", 1)
    (folder / "s.toml").write_text(text, encoding="utf-8")


def of_run(folder):
    settings = '[run]\nspeed = 120\nstep = 4e-3\npantograph = "p.toml"\nmesh = [4.0, 8.0]\n'
    of_line(folder, settings)


def reader(a):
    from ancf.model.file import read_study

    return {"y": a * read_study("m.toml").simulation.t_end}


def mesher(a):
    ancf.Mesh(file="one.stl")
    return {"y": a}


def of_file(function):
    def made(folder):
        of_model(folder)
        (folder / "one.stl").write_text(TETRAHEDRON, encoding="utf-8")
        return function, ancf.sample({"a": [1.0, 2.0]}, method="grid")

    return made


#: What makes a study in a folder, the file that changes, and how: each kind of file that something reads.
KINDS = {
    "table of a force": (of_model, "F.csv", ("0.01,1", "0.01,2")),
    "model": (of_model, "m.toml", ("gravity = [0, 0, -9.81]", "gravity = [0, 0, -9.8]")),
    "line": (of_line, "line.toml", ("pitch_max = 7.0", "pitch_max = 8.0")),
    "table of supports": (of_line, "sup.csv", ("64,0.02", "64,0.03")),
    "pantograph": (of_run, "p.toml", ("static_force = 120.0", "static_force = 110.0")),
    "model that a function reads": (of_file(reader), "m.toml", ("t_end = 0.02", "t_end = 0.03")),
    "table of a model that a function reads": (of_file(reader), "F.csv", ("0.01,1", "0.01,3")),
    "mesh that a function reads": (of_file(mesher), "one.stl", ("vertex 0 0 1", "vertex 0 0 2")),
}


def _given(make, folder):
    """Function and samples of what lies in a folder."""
    if make in (of_model, of_line, of_run):
        file = read_study_file("s.toml")
        return file.case, file.samples
    return make.__closure__[0].cell_contents, ancf.sample({"a": [1.0, 2.0]}, method="grid")


@pytest.fixture
def never(monkeypatch):
    """No case is computed any more."""

    def stop():
        def refuse(*_):
            raise AssertionError("a case is computed")

        monkeypatch.setattr(studies, "outcome", refuse)

    return stop


@pytest.mark.parametrize("kind", KINDS)
class TestFiles:
    @pytest.fixture
    def study(self, kind, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        make = KINDS[kind][0]
        make(tmp_path)

        def run(folder="out"):
            table = ancf.study(*_given(make, tmp_path), folder=folder, workers=0, report=False)
            assert set(table["status"]) == {"ok"}, table["message"].tolist()
            return table

        return run

    def test_changed(self, kind, study, tmp_path, never):
        """Refused by its name; what there is stays. In another folder, or as it was, the study goes on."""
        _, name, (old, new) = KINDS[kind]
        study()
        before = (tmp_path / "out" / "table.csv").read_bytes()
        text = (tmp_path / name).read_text(encoding="utf-8")
        assert old in text
        (tmp_path / name).write_text(text.replace(old, new), encoding="utf-8")
        with pytest.raises(ancf.ModelError) as caught:
            study()
        assert caught.value.what == f'holds a study of another "{name}": the file has changed since'
        assert caught.value.hint == "choose another folder, or empty this one"
        assert (tmp_path / "out" / "table.csv").read_bytes() == before
        (tmp_path / name).write_text(text, encoding="utf-8")
        never()
        study()

    def test_unchanged(self, kind, study, tmp_path, never):
        """Also touched, written anew with the same text, or moved with the folder."""
        first = study()
        never()
        assert study().equals(first)
        file = tmp_path / KINDS[kind][1]
        os.utime(file, (1e9, 1e9))
        assert study().equals(first)
        file.write_bytes(file.read_bytes())
        assert study().equals(first)
        assert all(not os.path.isabs(path) for path in _about(tmp_path / "out")["read"])

    def test_of_an_earlier_version(self, kind, study, tmp_path, never):
        """A journal without fingerprints goes on, and has them then."""
        study()
        forget(tmp_path / "out")
        never()
        study()


@pytest.mark.parametrize("seed", range(4))
def test_what_a_file_says_has_no_order(tmp_path, seed):
    """Keys and tables may change places, comments come and go; a number that changes is another file."""
    lines = [f"k{k} = {k}.5" for k in range(6)]
    tables = [f"[t{k}]\nz = {k}\na = [1, 2]\n" for k in range(4)]
    before = tmp_path / "before.toml"
    before.write_text("\n".join([*lines, *tables]), encoding="utf-8")
    draw, now = np.random.default_rng(seed), tmp_path / "now.toml"
    shuffled = [*draw.permutation(lines), "# moved", *draw.permutation(tables)]
    now.write_text("\n".join(shuffled), encoding="utf-8-sig")
    assert fingerprint(now) == fingerprint(before) != ""
    for old, new in (("k3 = 3.5", "k3 = 3.25"), ("[1, 2]", "[2, 1]"), ("z = 2", "y = 2")):
        now.write_text("\n".join(shuffled).replace(old, new), encoding="utf-8")
        assert fingerprint(now) != fingerprint(before)


def _about(folder):
    return json.loads((folder / "study.json").read_text(encoding="utf-8"))


def forget(folder):
    """Make a journal such as earlier versions wrote."""
    with sqlite3.connect(folder / "journal.sqlite") as base:
        base.execute("DROP TABLE files")
        base.execute("DELETE FROM about WHERE key IN ('modules', 'values')")
    base.close()
    about = _about(folder)
    del about["read"]
    (folder / "study.json").write_text(json.dumps(about), encoding="utf-8")


def test_command(tmp_path, monkeypatch, call):
    """It does not tell what is there while a table beside the model has changed."""
    monkeypatch.chdir(tmp_path)
    of_model(tmp_path)
    command = ("study", "s.toml", "-o", "out", "-j", "0", "--no-report")
    assert call(*command).code == 0
    assert "case" not in call(*command).err
    (tmp_path / "F.csv").write_text(TABLE.replace("0.01,1", "0.01,5"), encoding="utf-8")
    ran = call(*command)
    assert ran.code == 2
    assert 'folder out: holds a study of another "F.csv": the file has changed since' in ran.said
    (tmp_path / "F.csv").write_text(TABLE, encoding="utf-8")
    assert call(*command).code == 0
    forget(tmp_path / "out")
    assert call(*command).code == 0


SCRIPT = """
import importlib
import os
import aa_helper
import aa_other
from aa_helper import twice
from aa_package.inner import thrice
import numpy as np
import ancf

COUNT = 3
FACTOR = 2.0
TABLE = {"k": 3.0}
TABLE["l"] = 4.0
PAIR = (1.0, "x")
SAMPLES = [1.0, 2.0]

def _unused(a):
    return a

def helped(a):
    return FACTOR * a

class Law:
    scale = 5.0
    def __init__(self, gain):
        self.gain = gain
    def __call__(self, a):
        return {"y": self.gain * self.scale * a}

def whole(a): return {"y": aa_helper.twice(a)}
def named(a): return {"y": twice(a)}
def packaged(a): return {"y": thrice(a)}
def inside(a):
    import aa_late
    return {"y": aa_late.four(a)}
def by_name(a): return {"y": importlib.import_module("aa_late").four(a)}
def other_part(a): return {"y": helped(a)}
def table(a): return {"y": TABLE["k"] * a}
def pair(a): return {"y": PAIR[0] * a}
def local(a):
    return {"y": sum(helped(x) for x in [a])}
def enclosing(k):
    def inner(a):
        return {"y": k * a}
    return inner
closed = enclosing(7.0)
lawful = Law(6.0)
method = Law(6.0).__call__

if __name__ == "__main__":
    COUNT = 7
"""
MODULES = {
    "aa_case.py": SCRIPT,
    "aa_helper.py": "from aa_deep import base\ndef twice(a): return 2 * base(a)\n",
    "aa_deep.py": "def base(a): return a\n",
    "aa_other.py": "def nothing(a): return a\n",
    "aa_late.py": "def four(a): return 4 * a\n",
    "aa_package/__init__.py": "",
    "aa_package/inner.py": "from . import constants\ndef thrice(a): return constants.THREE * a\n",
    "aa_package/constants.py": "THREE = 3\n",
}
#: Function, file, old, new, and how what changed is called.
OTHERS = [
    ("whole", "aa_helper.py", "2 *", "3 *", 'the module "aa_helper"'),
    ("named", "aa_helper.py", "2 *", "3 *", 'the module "aa_helper"'),
    ("whole", "aa_deep.py", "return a", "return -a", 'the module "aa_deep"'),
    ("named", "aa_deep.py", "return a", "return -a", 'the module "aa_deep"'),
    ("packaged", "aa_package/inner.py", "THREE * a", "THREE + a", 'the module "aa_package.inner"'),
    ("packaged", "aa_package/constants.py", "3", "4", 'the module "aa_package.constants"'),
    ("inside", "aa_late.py", "4 *", "5 *", 'the module "aa_late"'),
    ("by_name", "aa_late.py", "4 *", "5 *", 'the module "aa_late"'),
    ("other_part", "aa_case.py", "return FACTOR * a", "return FACTOR + a", 'the module "aa_case"'),
    ("local", "aa_case.py", "return FACTOR * a", "return FACTOR + a", 'the module "aa_case"'),
    ("other_part", "aa_case.py", "FACTOR = 2.0", "FACTOR = 3.0", "its FACTOR is 2.0, not 3.0"),
    ("table", "aa_case.py", '{"k": 3.0}', '{"k": 4.0}', 'the module "aa_case"'),
    ("table", "aa_case.py", 'TABLE["l"] = 4.0', 'TABLE["k"] = 4.0', 'the module "aa_case"'),
    ("pair", "aa_case.py", '(1.0, "x")', '(2.0, "x")', "its PAIR is (1.0, 'x'), not (2.0, 'x')"),
    ("closed", "aa_case.py", "enclosing(7.0)", "enclosing(8.0)", "its k is 7.0, not 8.0"),
    ("lawful", "aa_case.py", "lawful = Law(6.0)", "lawful = Law(7.0)", "its Law.gain is 6.0, not 7.0"),
    ("method", "aa_case.py", "method = Law(6.0)", "method = Law(7.0)", "its Law.gain is 6.0, not 7.0"),
    ("lawful", "aa_case.py", "scale = 5.0", "scale = 6.0", 'the module "aa_case"'),
    ("whole", "aa_case.py", "aa_helper.twice(a)", "-aa_helper.twice(a)", "the source of its function"),
]
#: What a function does not rest on.
UNRELATED = [
    ("aa_case.py", "COUNT = 3", "COUNT = 30"),
    ("aa_case.py", "COUNT = 7", "COUNT = 70"),
    ("aa_case.py", "SAMPLES = [1.0, 2.0]", "SAMPLES = [1.0, 2.0, 3.0]"),
    ("aa_case.py", "    return a\n\ndef helped", "    return -a\n\ndef helped"),
    ("aa_case.py", "import numpy as np\n", "import numpy as np\n# a remark\n\n"),
    ("aa_other.py", "return a", "return -a"),
]
FUNCTIONS = sorted({one[0] for one in OTHERS})


@pytest.fixture
def modules(tmp_path, monkeypatch):
    """Imports ``aa_case`` anew from a folder."""
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    monkeypatch.syspath_prepend(str(tmp_path))
    for name, text in MODULES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(textwrap.dedent(text), encoding="utf-8")

    def forgotten():
        for name in [name for name in sys.modules if name.startswith("aa_")]:
            del sys.modules[name]
        importlib.invalidate_caches()

    def load():
        forgotten()
        return importlib.import_module("aa_case")

    yield load
    forgotten()


def changed(tmp_path, file, old, new):
    text = (tmp_path / file).read_text(encoding="utf-8")
    assert old in text
    (tmp_path / file).write_text(text.replace(old, new), encoding="utf-8")


class TestModules:
    @pytest.mark.parametrize(("function", "file", "old", "new", "phrase"), OTHERS)
    def test_changed(self, modules, tmp_path, function, file, old, new, phrase):
        samples = ancf.sample({"a": [1.0, 2.0]}, method="grid")
        out = tmp_path / "out"
        ancf.study(getattr(modules(), function), samples, folder=out, workers=0, report=False)
        before = (out / "table.csv").read_bytes()
        changed(tmp_path, file, old, new)
        with pytest.raises(ancf.ModelError, match="choose another folder, or empty this one") as caught:
            ancf.study(getattr(modules(), function), samples, folder=out, workers=0, report=False)
        assert caught.value.what.startswith(f"holds another study: {phrase}")
        assert (out / "table.csv").read_bytes() == before

    @pytest.mark.parametrize("function", FUNCTIONS)
    def test_unchanged(self, modules, tmp_path, function, never):
        """Also in more samples, and in a journal of an earlier version."""
        out = tmp_path / "out"

        def run(values):
            samples = ancf.sample({"a": values}, method="grid")
            return ancf.study(getattr(modules(), function), samples, folder=out, workers=0, report=False)

        run([1.0, 2.0])
        run([1.0, 2.0, 3.0])
        never()
        run([1.0, 2.0, 3.0])
        forget(out)
        run([3.0, 2.0])

    @pytest.mark.parametrize(("file", "old", "new"), UNRELATED)
    def test_what_does_not_count(self, modules, tmp_path, file, old, new):
        before = {name: identity(getattr(modules(), name)) for name in FUNCTIONS}
        changed(tmp_path, file, old, new)
        assert {name: identity(getattr(modules(), name)) for name in FUNCTIONS} == before

    def test_installed_packages_do_not_count(self, modules):
        def case(a):
            import numpy as np
            import scipy.optimize

            return {"y": float(np.sum(a)) + len(scipy.optimize.__doc__) + len(json.dumps(a))}

        assert not [name for name in identity(case)["modules"] if name.partition(".")[0] != __name__]


def test_a_file_that_changes_while_the_study_runs(tmp_path, monkeypatch):
    """Cases of both are not mixed."""
    monkeypatch.chdir(tmp_path)
    of_model(tmp_path)

    def case(a):
        made = reader(a)
        changed(tmp_path, "m.toml", "t_end = 0.02", "t_end = 0.025")
        return made

    samples = ancf.sample({"a": [1.0, 2.0]}, method="grid")
    with pytest.raises(ancf.ModelError, match=r'of another "m\.toml": the file has changed'):
        ancf.study(case, samples, folder="out", workers=0, report=False)
