"""The house: imports run downwards only, the core needs no extra, ``import ancf`` is light."""

import ast
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest
from PIL import Image

import ancf
from commands import python
from pages import script
from places import DOCS

ROOT = Path(ancf.__file__).parent

#: From the bottom to the top; a layer imports from lower ones and from itself.
LAYERS = (
    {"errors", "_version", "kernel_cache", "arrays", "interrupts", "later", "reading"},
    {"files", "worker", "columns", "garbage"},
    {"parts", "addresses", "asked"},
    {"kept"},
    {"compiled"},
    {"choices"},
    {"vectors", "words"},
    {"records", "operations"},
    {"batches"},
    {"simd"},
    {"model"},
    {"elements", "bodies", "linalg"},
    {"connections", "loads"},
    {"contact"},
    {"system"},
    {"solvers"},
    {"results"},
    {"compilation"},
    {"preparation"},
    {"control"},
    {"sensitivity"},
    {"analysis"},
    {"resumption"},
    {"viz"},
    {"verification"},
    {"catenary"},
    {"validation"},
    {"mooring", "reeving"},
    {"cosimulation"},
    {"paper"},
    {"design"},
    {"cli"},
)
#: The one way up, for methods that draw: in functions and for types, never when the file is imported.
DRAWING = ("results/pictures.py", "viz")
LEVEL = {name: level for level, names in enumerate(LAYERS) for name in names}
#: Parts of the public face that others may import: ``import ancf`` above the analysis only.
FACE = LEVEL["analysis"] + 1


def modules():
    return sorted(p for p in ROOT.rglob("*.py") if p.parent != ROOT or p.stem not in ("__init__", "__main__"))


def part(path):
    """First name below ancf of a file."""
    return path.relative_to(ROOT).with_suffix("").parts[0]


@cache
def tree(path):
    return ast.parse(path.read_text(encoding="utf-8"))


def imported(path):
    """Names below ancf that a file imports, "" for ancf itself, with the line; for types alone included."""
    package = ("ancf", *path.relative_to(ROOT).parts[:-1])
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            names = [alias.name.split(".") for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = list(package[: len(package) - node.level + 1]) if node.level else []
            base += node.module.split(".") if node.module else []
            names = [base] if len(base) > 1 else [[*base, alias.name] for alias in node.names]
        else:
            continue
        for name in names:
            if name[0] == "ancf":
                yield (name[1] if len(name) > 1 and name[1] in LEVEL else ""), node.lineno


def later(path):
    """Lines of a file that run only when something is called, or never: functions and names for types."""
    lines = set()
    for node in ast.walk(tree(path)):
        for_types = isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        if isinstance(node, ast.FunctionDef) or for_types:
            lines.update(range(node.lineno, node.end_lineno + 1))
    return lines


def allowed(path, name, line):
    """Whether an import is the one that may go up."""
    return (path.relative_to(ROOT).as_posix(), name) == DRAWING and line in later(path)


def violation(own, other):
    """Whether a file of one part must not import another part."""
    if other == "":
        return LEVEL[own] < FACE
    level, below = LEVEL[own], LEVEL[other]
    return own != other and below >= level


class TestImports:
    def test_run_downwards(self):
        assert {part(path) for path in modules()} <= LEVEL.keys(), "a part has no place in LAYERS"
        wrong = [
            f"{path.relative_to(ROOT)}, line {line} imports {name or 'ancf'}"
            for path in modules()
            for name, line in imported(path)
            if violation(part(path), name) and not allowed(path, name, line)
        ]
        assert not wrong, wrong

    def test_rule_can_fail(self, tmp_path):
        assert violation("model", "system")
        assert violation("elements", "connections")
        assert violation("solvers", "")
        assert not violation("cli", "")
        assert not violation("solvers", "system")
        assert violation("model", "elements")

    def test_only_methods_that_draw_go_up(self):
        """The exception is one file and one part, and ends where its functions end."""
        path = ROOT / DRAWING[0]
        upward = [(name, line) for name, line in imported(path) if violation("results", name)]
        assert {name for name, _ in upward} == {"viz"}
        assert all(allowed(path, name, line) for name, line in upward)
        assert not allowed(path, "viz", 1)
        assert not allowed(path, "paper", upward[0][1])
        assert not allowed(ROOT / "results" / "result.py", "viz", upward[0][1])

    def test_relative_imports_are_seen(self):
        seen = {name for name, _ in imported(ROOT / "solvers" / "runs.py")}
        assert {"model", "solvers", "system"} <= seen
        seen = {name for name, _ in imported(ROOT / "analysis.py")}
        assert {"errors", "model", "results", "solvers", "preparation"} <= seen


@pytest.fixture(scope="module")
def drawn():
    return script("architecture_pictures")


class TestPictures:
    """Those of docs/architecture.md show the floors that are tested here."""

    def test_floors(self, drawn):
        floors = [set(names.split()) for names, _ in reversed(drawn.FLOORS)]
        floors[0] |= set(drawn.UNSHOWN)
        assert floors == list(LAYERS)

    @pytest.mark.parametrize(
        ("name", "rows"), [("architecture_floors", "FLOORS"), ("architecture_step", "STEP")]
    )
    def test_are_drawn_from_what_the_script_has_now(self, drawn, name, rows):
        """The description of the file is written with it."""
        with Image.open(DOCS / "_static" / f"{name}.png") as picture:
            assert picture.text["Description"] == "; ".join(name for name, _ in getattr(drawn, rows))


class TestNames:
    def test_face(self):
        """Every public name is there and nothing else hides in the list."""
        for name in ancf.__all__:
            assert getattr(ancf, name) is not None
        wanted = {"Model", "Section", "simulate", "equilibrium", "modes", "load", "Trapezoidal"}
        wanted |= {"GeneralizedAlpha", "Newton", "Result", "State", "ModelError", "SolveError"}
        assert wanted <= set(ancf.__all__)
        assert ancf.__version__.count(".") == 2

    def test_unknown_name(self):
        with pytest.raises(AttributeError, match="has no attribute 'simulat'"):
            _ = ancf.simulat


#: A warning is an error.
STRICT = ("-W", "error")
BLOCKED = """
import sys

class Refuse:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in sys.argv[1].split(","):
            raise ImportError(f"{name} is not installed")

sys.meta_path.insert(0, Refuse())
"""

TINY = """
import ancf
model = ancf.Model(gravity=(0, 0, -9.81))
section = ancf.Section(EA=1e3, EI=0.1, rhoA=0.05)
beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
model.clamp(beam.start)
state = ancf.equilibrium(model)
result = ancf.simulate(model, t_end=0.01, step=1e-3, start=state)
ancf.modes(model, about=state, count=2)
import ancf.model.file
import ancf.cli
print("done", len(result.t))
"""


class TestExtras:
    EXTRAS = (
        "pandas,pyarrow,SALib,dask,distributed,cloudpickle,reportlab,docx,"
        "matplotlib,plotly,exudyn,sphinx,psutil,furo,pyvista,vtk,jax,pytest"
    )

    def test_core_runs_without_them(self):
        done = python(BLOCKED + TINY, self.EXTRAS, options=STRICT)
        assert done.code == 0, done.err
        assert done.out == "done 11\n"

    def test_the_block_blocks(self):
        done = python(BLOCKED + "import matplotlib", self.EXTRAS, options=STRICT)
        assert "matplotlib is not installed" in done.err

    def test_figures_say_what_is_missing(self):
        """The paper's figures need the extra ``plot`` and nothing else fails without it."""
        done = python(BLOCKED + "import ancf.paper, ancf.viz; print('imported')", self.EXTRAS, options=STRICT)
        assert done.code == 0, done.err


class TestStart:
    HEAVY = "numba,scipy,h5py,pydantic,matplotlib,rich,typer,plotly"

    def test_import_is_light(self):
        code = "import ancf, sys; print([m for m in sys.argv[1].split(',') if m in sys.modules])"
        done = python(code, self.HEAVY, options=STRICT)
        assert done.code == 0, done.err
        assert done.out == "[]\n"

    def test_describing_a_model_is_light(self):
        """Also all of the model but curved shapes, which need a spline."""
        code = (
            TINY.split("state =")[0]
            + "import sys; print([m for m in sys.argv[1].split(',') if m in sys.modules])"
        )
        done = python(code, self.HEAVY, options=STRICT)
        assert done.code == 0, done.err
        assert done.out == "[]\n"

    def test_a_short_run_is_light(self):
        """A cable that swings needs nothing of scipy, which takes as long to import as numba."""
        run = "ancf.simulate(model, t_end=2e-3, step=1e-3)"
        code = TINY.split("state =")[0] + f"\n{run}\nimport sys; print('scipy.sparse' in sys.modules)"
        done = python(code, options=STRICT)
        assert done.out == "False\n", done.err


def test_what_is_imported_later_is_there():
    """Each name of ancf.later is one of the module that it says."""
    from ancf import later

    for name in later.__all__:
        module, real = (cell.cell_contents for cell in getattr(later, name).__closure__)
        assert hasattr(import_module(module), real), name
        assert real == name


def graph():
    """Modules of ancf that each imports: in functions and for types as well."""
    paths = {".".join(_dotted(path)): path for path in ROOT.rglob("*.py")}
    return {name: {m for m, _ in _targets(path, paths)} - {name} for name, path in paths.items()}


def _dotted(path):
    parts = ("ancf", *path.relative_to(ROOT).with_suffix("").parts)
    return parts[:-1] if parts[-1] == "__init__" else parts


def _targets(path, paths):
    package = _dotted(path) if path.name == "__init__.py" else _dotted(path)[:-1]
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            found = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = ".".join([*package[: len(package) - node.level + 1]] if node.level else [])
            base = ".".join(part for part in (base, node.module) if part)
            found = [f"{base}.{alias.name}" for alias in node.names]
            found = [name if name in paths else base for name in found]
        else:
            continue
        yield from ((name, node.lineno) for name in found if name in paths)


def circles(edges):
    """Sets of modules each of which leads to all others of its set (Kosaraju)."""
    order, seen = [], set()

    def visit(node, follow, found):
        stack = [(node, iter(follow[node]))]
        seen.add(node)
        while stack:
            current, rest = stack[-1]
            following = next((other for other in rest if other not in seen), None)
            if following is None:
                stack.pop()
                found.append(current)
            else:
                seen.add(following)
                stack.append((following, iter(follow[following])))

    for node in edges:
        if node not in seen:
            visit(node, edges, order)
    back = {node: set() for node in edges}
    for node, others in edges.items():
        for other in others:
            back[other].add(node)
    seen.clear()
    sets = []
    for node in reversed(order):
        if node not in seen:
            sets.append([])
            visit(node, back, sets[-1])
    return [sorted(found) for found in sets if len(found) > 1]


class TestCircles:
    def test_the_only_one_is_of_methods_that_draw(self):
        """Of all imports, also those for types: without those of methods that draw there is no circle."""
        edges = graph()
        (only,) = circles(edges)
        assert {name.split(".")[1] for name in only} == {"results", "viz"}
        drawing = "ancf." + DRAWING[0].removesuffix(".py").replace("/", ".")
        upward = {name for name in edges[drawing] if name.split(".")[1] == DRAWING[1]}
        assert upward
        assert circles({**edges, drawing: edges[drawing] - upward}) == []

    def test_all_modules_are_looked_at(self):
        edges = graph()
        assert len(edges) == len(list(ROOT.rglob("*.py")))
        assert "ancf.results.pictures" in edges["ancf.results.result"]
        assert "ancf.viz.pictures.plot" in edges["ancf.results.pictures"]  # in a function
        assert "ancf.model.checks" in edges["ancf.model.model"]  # from ancf.model import checks

    def test_circles_are_found(self):
        edges = {"a": {"b"}, "b": {"c"}, "c": {"b", "d"}, "d": set(), "e": {"a", "f"}, "f": {"e"}}
        assert sorted(circles(edges)) == [["b", "c"], ["e", "f"]]
        assert circles({"a": {"b"}, "b": set()}) == []
