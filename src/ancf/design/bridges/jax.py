"""``ancf.jax_function``: a number of a run for JAX, with its derivatives."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ...model.model import Model
from ...results.state import State
from ..extras import extra
from .face import Vector

WHERE = "jax_function"


def jax_function(
    model: Model | Callable[..., Model],
    objective: str,
    parameters: Sequence[str],
    *,
    t_end: float,
    step: float,
    begin: Callable[..., State] | None = None,
    integrator: Any = None,
) -> Callable[[Any], Any]:
    """A number of a simulation as a function for JAX, which differentiates it by :func:`ancf.gradient`.

    ``jax.grad``, ``jax.value_and_grad``, ``jax.jacrev``, ``jax.jit`` and ``jax.vmap`` take it; a chain of
    other functions before and behind it as well. It calls back from JAX: inside, the run has double precision
    whatever JAX has. Second derivatives and ``jax.jvp`` it does not have.

    Parameters
    ----------
    model : Model or callable
        With the parameters as names of its numbers, see ``sensitivities`` of :func:`ancf.simulate`; or
        ``build(**parameters)`` returns the model.
    objective : str
        As of :func:`ancf.gradient`.
    parameters : sequence of str
        What the entries of the argument are.
    t_end, step, integrator
        As of :func:`ancf.simulate`.
    begin : function, optional
        ``begin(model, sensitivities=...)`` is the state from which the run starts, such as
        ``ancf.equilibrium``; default the initial shape.

    Returns
    -------
    callable
        ``f(x)`` of an array (n,) of the parameters, in their units; an array () of the type of x.

    Raises
    ------
    ModelError
        JAX is not installed (extra ``jax``), or what is given is wrong. What is wrong in a run JAX raises as
        an error of its own, which quotes the message; on an accelerator where the number is read.
    """
    jax, np = extra("jax", "jax"), extra("jax.numpy", "jax")
    settings = {"t_end": t_end, "step": step, "integrator": integrator}
    vector = Vector(model, objective, parameters, settings, begin, WHERE)

    def floating(x: Any) -> Any:
        given = np.asarray(x)
        vector.check(given.shape)
        return given if np.issubdtype(given.dtype, np.floating) else given.astype(float)

    @jax.custom_vjp  # type: ignore[untyped-decorator]
    def number(x: Any) -> Any:
        made = jax.ShapeDtypeStruct((), x.dtype)
        return jax.pure_callback(lambda y: vector.value(y).astype(x.dtype), made, x, vmap_method="sequential")

    def forwards(x: Any) -> tuple[Any, Any]:
        def both(y: Any) -> tuple[Any, Any]:
            value, slope = vector.with_slope(y)
            return value.astype(x.dtype), slope.astype(x.dtype)

        made = jax.ShapeDtypeStruct((), x.dtype), jax.ShapeDtypeStruct(x.shape, x.dtype)
        value, slope = jax.pure_callback(both, made, x, vmap_method="sequential")
        return value, slope

    def backwards(slope: Any, by: Any) -> tuple[Any]:
        return (by * slope,)

    number.defvjp(forwards, backwards)
    return lambda x: number(floating(x))
