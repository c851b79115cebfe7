"""Numbers of runs as functions of JAX and PyTorch: their gradients are those of the package, and right."""

import numpy as np
import pytest

import ancf
from ancf.design import extras
from ancf.design.bridges.face import Vector
from ancf.model.vary import value_of, varied

EXACT = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-14, modified=False), formulation="index2")


def cantilever():
    """A cable that is pulled: it has an adjoint."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    model.clamp(beam.start)
    model.add_force(beam.end, (0.1, "0.5*sin(9*t)", 0.0), name="push")
    return model


def hinged(mass=1.0, z=0.1):
    """A rigid body on a hinge: it has joints, and the sensitivities of a run."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    hub = model.add_rigid_body("hub", at=(0.5, 0, 0), mass=mass, inertia=(0.01, 0.1, 0.1))
    model.hinge(hub.at(-0.5, 0, 0), (0.0, 0.0, 0.0), axis=(0, 1, 0), name="hinge")
    model.add_spring(hub.centre, (0.5, 0, 1 + z), stiffness=20.0, length=0.9, name="stay")
    return model


#: Model, number, parameters, where they are, settings.
CASES = {
    "adjoint": (
        cantilever(),
        "integral(norm(velocity(beam.end))**2)",
        ["beam.EI", "beam.rhoA", "push.force"],
        [0.4, 0.25, 1.3],
        {"t_end": 0.03, "step": 1e-3, "integrator": EXACT},
    ),
    "joints": (
        hinged,
        "last(position(hub.centre)[2])",
        ["mass", "z"],
        [1.2, 0.15],
        {"t_end": 0.1, "step": 2e-3, "integrator": EXACT},
    ),
}


def wanted(case):
    """Number and derivatives of the package itself."""
    model, text, names, x, settings = CASES[case]
    if callable(model):
        given = dict(zip(names, x, strict=True))
        made, parameters = (
            model(**given),
            {name: (given[name], lambda y, n=name: model(**given | {n: y})) for name in names},
        )
    else:
        made, parameters = model, names
        for name, value in zip(names, x, strict=True):
            made = varied(made, name, value)
            assert value_of(made, name) in (value, 1.0)  # a factor is 1 again
    value, slope = ancf.gradient(made, text, parameters, **settings)
    size = np.array([1.3 if name == "push.force" else 1.0 for name in names])
    return value, np.array(list(slope.values())) / size


def differences(function, x):
    """Central differences, extrapolated once."""
    slope = np.zeros(len(x))
    for k, value in enumerate(x):
        rough = []
        for e in (2e-3 * value, 1e-3 * value):
            both = [float(function(np.array(x) + s * e * np.eye(len(x))[k])) for s in (1, -1)]
            rough.append((both[0] - both[1]) / (2 * e))
        slope[k] = (4 * rough[1] - rough[0]) / 3
    return slope


@pytest.fixture
def jax():
    """JAX in double precision."""
    found = pytest.importorskip("jax", reason="extra jax")
    before = found.config.jax_enable_x64
    found.config.update("jax_enable_x64", True)
    yield found
    found.config.update("jax_enable_x64", before)


@pytest.mark.parametrize("case", CASES)
def test_jax(jax, case):
    model, text, names, x, settings = CASES[case]
    function = ancf.jax_function(model, text, names, **settings)
    value, slope = wanted(case)
    found = jax.value_and_grad(function)(jax.numpy.array(x))
    assert float(found[0]) == pytest.approx(value, rel=1e-13)
    assert np.asarray(found[1]) == pytest.approx(slope, rel=1e-10)
    assert np.asarray(found[1]) == pytest.approx(differences(function, x), rel=1e-6)

    def chained(u):
        return jax.numpy.exp(function(jax.numpy.array(x) * u[0] ** 2)) + u[0]

    u = jax.numpy.array([1.0])
    inner = float(np.exp(value) * 2 * slope @ np.array(x) + 1)
    assert float(jax.jit(jax.grad(chained))(u)[0]) == pytest.approx(inner, rel=1e-10)
    assert np.asarray(jax.vmap(function)(jax.numpy.array([x, x]))) == pytest.approx([value] * 2, rel=1e-13)


@pytest.mark.parametrize("case", CASES)
def test_torch(case):
    torch = pytest.importorskip("torch", reason="extra torch")
    model, text, names, x, settings = CASES[case]
    function = ancf.torch_function(model, text, names, **settings)
    value, slope = wanted(case)
    given = torch.tensor(x, dtype=torch.float64, requires_grad=True)
    found = function(given)
    found.backward()
    assert float(found.detach()) == pytest.approx(value, rel=1e-13)
    assert given.grad.numpy() == pytest.approx(slope, rel=1e-10)
    assert torch.autograd.gradcheck(function, given, eps=1e-5, atol=1e-8, rtol=1e-5)
    plain = function(torch.tensor(x, dtype=torch.float32))
    assert plain.dtype == torch.float32
    assert float(plain) == pytest.approx(value, rel=1e-5)


def test_bad_input(jax):
    settings = {"t_end": 0.01, "step": 1e-3}
    with pytest.raises(ancf.ModelError, match="different names"):
        ancf.jax_function(cantilever(), "last(t)", ["beam.EI", "beam.EI"], **settings)
    with pytest.raises(ancf.ModelError, match='has no number "EE"'):
        ancf.jax_function(cantilever(), "last(t)", ["beam.EE"], **settings)
    function = ancf.jax_function(cantilever(), "last(speed(beam.end))", ["beam.EI"], **settings)
    with pytest.raises(ancf.ModelError, match=r"shape \(1,\), have \(2,\)"):
        function(jax.numpy.ones(2))
    with pytest.raises(Exception, match=r"ModelError: beam\.EI"):  # an error of JAX that quotes it
        float(function(-jax.numpy.ones(1)))  # on an accelerator it comes where the number is read


@pytest.mark.parametrize("word", ["jax", "torch"])
def test_what_is_not_installed(monkeypatch, word):
    """One message that says what to install."""

    def missing(name):
        raise ImportError(name)

    monkeypatch.setattr(extras, "import_module", missing)
    with pytest.raises(ancf.ModelError, match=rf"{word} is not installed \(pip install 'ancf\[{word}\]'\)"):
        getattr(ancf, f"{word}_function")(cantilever(), "last(t)", ["beam.EI"], t_end=0.01, step=1e-3)


@pytest.mark.parametrize("case", CASES)
def test_what_bridges_hand_over(case):
    """Values and slopes are those of the model with these parameters, also by a factor that is not 1."""
    model, text, names, x, settings = CASES[case]
    vector = Vector(model, text, names, settings, None, "test")
    value, slope = vector.with_slope(x)
    assert value == vector.value(x) == pytest.approx(wanted(case)[0], rel=1e-13)
    assert slope == pytest.approx(differences(vector.value, x), rel=1e-6)
