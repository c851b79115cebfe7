"""Every public call names an argument that it has not, the near one, and what it accepts."""

import inspect
import pickle
import traceback
from importlib import import_module
from pathlib import Path

import pytest

import ancf
from ancf import catenary
from ancf.model import keywords
from ancf.model.kinds import all_kinds

PACKAGE = Path(ancf.__file__).parent
MODULES = ("ancf", "ancf.model", "ancf.results", "ancf.catenary")
#: Called in each step, and so without the way round; what Python says of them is as clear.
DIRECT = {"Stepper", "LineStepper", "Touching", "Sensors", "Energy", "Stats", "Progress", "TimeFunction"}


def offered():
    """All public functions, constructors and methods, each once, with their names."""
    found = {}
    for module in map(import_module, MODULES):
        for name in sorted(set(module.__all__) - DIRECT):
            value = getattr(module, name)
            if inspect.isclass(value) and not issubclass(value, BaseException):
                for method in dir(value):
                    if method == "__init__" or not method.startswith("_"):
                        called = getattr(value, method)
                        if inspect.isroutine(called) and called.__module__.startswith("ancf"):
                            found[f"{name}.{method}"] = called
            elif inspect.isfunction(value):
                found[f"{module.__name__}.{name}"] = value
    return found


CALLS = offered()


def names_of(called):
    """What can be given by keyword; None: anything can, or it is for "with"."""
    parameters = inspect.signature(called).parameters.values()
    inner = inspect.unwrap(called)
    if any(p.kind is p.VAR_KEYWORD for p in parameters) or inspect.isgeneratorfunction(inner):
        return None
    return [p.name for p in parameters if p.kind is not p.VAR_POSITIONAL and p.name not in ("self", "cls")]


KEYWORDS = {name: names for name, called in CALLS.items() if (names := names_of(called))}


def typos(name):
    """Two letters exchanged, one lost, one twice, at every place of the name; the first letter stays."""
    for k in range(1, len(name) - 1):
        yield name[:k] + name[k + 1] + name[k] + name[k + 2 :]
        yield name[:k] + name[k + 1 :]
        yield name[:k] + name[k] + name[k:]


def test_there_are_many():
    assert len(KEYWORDS) > 150
    assert sum(map(len, KEYWORDS.values())) > 500
    assert {"Section.__init__", "Section.circle", "Model.add_beam", "ancf.simulate", "Span.__init__"} <= set(
        KEYWORDS
    )


@pytest.mark.parametrize("name", KEYWORDS)
def test_typing_errors_are_named(name):
    """Nothing of the call is looked at before: what lacks is not said where a name is wrong."""
    known = KEYWORDS[name]
    me = (None,) if "self" in inspect.signature(CALLS[name]).parameters else ()
    for right in known:
        for wrong in (w for w in typos(right) if w not in known):
            with pytest.raises(ancf.ArgumentError) as caught:
                CALLS[name](*me, **{wrong: 1})
            assert f'unknown argument "{wrong}"' in caught.value.what
            assert all(f'"{other}"' in caught.value.what for other in known[:40])
            # of a name of three letters two do not say which it was
            if len(right) > 4:
                assert caught.value.hint.startswith("did you mean")
                assert caught.value.hint.split('"')[1] in known


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: ancf.Section(EA=1.0), r'Section: wants "EI", "rhoA" \(accepted: "EA", '),
        (lambda: ancf.Section(1.0, 2.0), "Section: 2 arguments by place, all go by keyword"),
        (lambda: ancf.Model().add_beam("a", "b", 3), "add_beam: 3 arguments by place, at most 1 go by place"),
        (lambda: ancf.Model().add_beam("a", name="b"), r'add_beam: wants "section"'),
        (lambda: ancf.Model().pin("a", point="b"), r'pin: "point" given twice'),
        (
            lambda: ancf.Section.circle(diameter=1.0, E=1e9, rho=1.0, daming=1),
            "Section.circle: .*mean .damping",
        ),
        (lambda: ancf.simulate(ancf.Model(), t_end=1.0, stpe=1), "simulate: .*mean .step"),
        (lambda: catenary.run(catenary.Line, sped=1), "run: .*mean .speed"),
    ],
)
def test_what_is_said(call, said):
    with pytest.raises(ancf.ArgumentError, match=said) as caught:
        call()
    assert isinstance(caught.value, TypeError)
    assert isinstance(caught.value, ancf.ModelError)
    assert caught.value.__context__ is None
    inside = [
        f for f in traceback.extract_tb(caught.value.__traceback__) if PACKAGE in Path(f.filename).parents
    ]
    assert len(inside) == 1


def test_type_errors_from_inside_stay():
    """What a call raises while it works is no matter of its arguments."""

    def deep(depth):
        return deep(depth - 1) if depth else len(1, 2)

    for depth in (0, 1, 5):
        with pytest.raises(TypeError, match=r"len\(\) takes exactly one argument") as caught:
            keywords.called_as(deep, "deep")(depth)
        assert not isinstance(caught.value, ancf.ArgumentError)


def test_functions_and_classes_go_to_other_processes():
    for value in (ancf.simulate, ancf.Section, catenary.run, catenary.form, ancf.Model, ancf.study):
        assert pickle.loads(pickle.dumps(value)) is value
    assert list(inspect.signature(ancf.simulate).parameters)[:3] == ["model", "t_end", "step"]
    assert ancf.simulate.__doc__.startswith("Simulate a model")


@pytest.mark.parametrize("frequency", [1.0, 3.0])
def test_warnings_name_the_line_that_called(frequency, recwarn):
    """Not one of the package."""
    model = ancf.Model()
    rope = model.add_beam(
        "rope", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ancf.Section(EA=1e4, EI=0.1, rhoA=0.1)
    )
    model.pin(rope.start, displacement=[0, 0, f"abs(sin({frequency}*(t - 0.02)))"])
    ancf.simulate(model, t_end=0.03, step=1e-3)
    found = [item for item in recwarn if "its rate jumps" in str(item.message)]
    assert [Path(item.filename).name for item in found] == [Path(__file__).name]


def test_methods_that_kinds_bring():
    """Those that a model finds by its kinds, and those that several classes share, by their own names."""
    model = ancf.Model()
    brought = {kind.method for kind in all_kinds() if kind.add is not None}
    assert {"add_follower_force", "add_pressure"} <= brought
    for name in brought:
        called = model.__getattr__(name)
        if names_of(called) is not None:
            with pytest.raises(ancf.ArgumentError, match=f'^{name}: unknown argument "stiffnes"'):
                called(stiffnes=1)
    with pytest.raises(ancf.ArgumentError, match=r'^plot: unknown argument "quantiy".*mean "quantity"'):
        ancf.Result.plot(None, quantiy="speed")
    with pytest.raises(AttributeError) as caught:
        ancf.simulat  # noqa: B018
    # with these the interpreter names the near one
    assert (caught.value.name, caught.value.obj) == ("simulat", ancf)


def described(name):
    """Kinds and units of the arguments that a call wants, as its docstring has them."""
    lines = (inspect.getdoc(CALLS[name]) or "").splitlines()
    heads = [line.split(" : ") for line in lines if " : " in line and not line.startswith(" ")]
    kinds = {argument: kind for names, kind in heads for argument in names.split(", ")}
    parameters = inspect.signature(CALLS[name]).parameters.values()
    wanted = [p.name for p in parameters if p.default is p.empty and p.name in KEYWORDS[name]]
    return {argument: kinds[argument] for argument in wanted if argument in kinds}


#: Of a winch it is said in words of its own.
DESCRIBED = {name: kinds for name in KEYWORDS if (kinds := described(name)) and name != "Model.winch"}


def test_many_are_described():
    assert len(DESCRIBED) > 60
    assert DESCRIBED["Model.hinge"]["b"] == "Point, RigidBody or (3,) m"


@pytest.mark.parametrize("name", DESCRIBED)
def test_what_lacks_is_described(name):
    """A call without arguments says of each that it wants what it is, with the unit."""
    me = (None,) if "self" in inspect.signature(CALLS[name]).parameters else ()
    with pytest.raises(ancf.ArgumentError) as caught:
        CALLS[name](*me)
    assert all(kind in caught.value.hint for kind in DESCRIBED[name].values())
