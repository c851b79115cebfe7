"""``ancf.torch_function``: a number of a run for PyTorch, with its derivatives."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ...model.model import Model
from ...results.state import State
from ..extras import extra
from .face import Vector

WHERE = "torch_function"


def torch_function(
    model: Model | Callable[..., Model],
    objective: str,
    parameters: Sequence[str],
    *,
    t_end: float,
    step: float,
    begin: Callable[..., State] | None = None,
    integrator: Any = None,
) -> Callable[[Any], Any]:
    """A number of a simulation as a function for PyTorch, which differentiates it by :func:`ancf.gradient`.

    A tensor that requires gradients takes one run with derivatives, any other a plain run; ``backward`` takes
    none. The run has double precision; a tensor of single precision gets its numbers rounded. Second
    derivatives it does not have.

    Parameters
    ----------
    model, objective, parameters, t_end, step, begin, integrator
        As of :func:`ancf.jax_function`.

    Returns
    -------
    callable
        ``f(x)`` of a tensor (n,) of the parameters, in their units; a tensor () of the type of x.

    Raises
    ------
    ModelError
        PyTorch is not installed (extra ``torch``), or what is given is wrong.
    SolveError
        A run fails.
    """
    torch: Any = extra("torch", "torch")
    settings = {"t_end": t_end, "step": step, "integrator": integrator}
    vector = Vector(model, objective, parameters, settings, begin, WHERE)

    class Number(torch.autograd.Function):  # type: ignore[misc]
        """The number, with what its derivatives are."""

        @staticmethod
        def forward(ctx: Any, x: Any) -> Any:
            given = x.detach().cpu().double().numpy()
            if not ctx.needs_input_grad[0]:
                return x.new_tensor(float(vector.value(given)))
            value, slope = vector.with_slope(given)
            ctx.save_for_backward(x.new_tensor(slope))
            return x.new_tensor(float(value))

        @staticmethod
        @torch.autograd.function.once_differentiable  # type: ignore[untyped-decorator]
        def backward(ctx: Any, by: Any) -> Any:
            return by * ctx.saved_tensors[0]

    def number(x: Any) -> Any:
        given = torch.as_tensor(x)
        vector.check(tuple(given.shape))
        return Number.apply(given if given.is_floating_point() else given.double())

    return number
