"""Eight numbers as one value in kernels, and vectors of space made of them.

``Lanes`` are eight numbers, one for each element of a chunk; a ``Triple`` is a vector of space whose three
components are lanes.  In kernels ``+``, ``-``, ``*``, ``/`` work lane by lane, a number standing for eight
equal ones, so that formulas read as for one element:

    p = cd * d + c1 * t1 + c2 * t2
    eps = 0.5 * (dot(p, p) - 1.0)

LLVM keeps them in the registers that the machine has: one of AVX-512, two of AVX2, four of SSE2.  In Python
the same functions and operators work on arrays, (8,) and (3, 8): kernels run uncompiled as they are written.
There is no ``+=``, which would change such an array where another name may hold it.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.typing.templates import AbstractTemplate, infer, infer_global
from numba.extending import lower_builtin, register_model

LANES = 8

DOUBLE, INT = ir.DoubleType(), ir.IntType(32)
VECTOR = ir.VectorType(DOUBLE, LANES)
TRIPLE = ir.ArrayType(VECTOR, 3)


class LanesType(types.Type):
    """Type in kernels of eight numbers."""


class TripleType(types.Type):
    """Type in kernels of a vector of space of eight elements."""


@register_model(LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, VECTOR)


@register_model(TripleType)
class _TripleModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, TRIPLE)


lanes, triple = LanesType("Lanes"), TripleType("Triple")


def parts_of(context: Any, builder: Any, kind: Any, value: Any) -> list[Any]:
    """The LLVM vectors of a value: three of a Triple, one of Lanes or of a number."""
    if kind is triple:
        return [builder.extract_value(value, k) for k in range(3)]
    if kind is lanes:
        return [value]
    return [_equal(builder, context.cast(builder, value, kind, types.float64))]


def _equal(builder: Any, number: Any) -> Any:
    none = ir.Constant(VECTOR, ir.Undefined)
    first = builder.insert_element(none, number, INT(0))
    return builder.shuffle_vector(first, none, ir.Constant(ir.VectorType(INT, LANES), [0] * LANES))


def whole(builder: Any, parts: list[Any]) -> Any:
    """Lanes of one part, a Triple of three."""
    if len(parts) == 1:
        return parts[0]
    value = ir.Constant(TRIPLE, ir.Undefined)
    for k, part in enumerate(parts):
        value = builder.insert_value(value, part, k)
    return value


def in_kernels(plain: Callable[..., Any], kinds: Callable[..., Any]) -> Callable[[Any], Any]:
    """Give a function of Python a form in kernels.

    Parameters
    ----------
    plain : function
        What it does uncompiled.
    kinds : function
        ``kinds(*types)``: type of the result; None or TypeError where it takes no arguments of these types.
    """

    @infer_global(plain)
    class Typed(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:
            try:
                result = None if kws else kinds(*args)
            except TypeError:
                return None
            return None if result is None else result(*args)

    def with_code(generate: Any) -> Any:
        lower_builtin(plain, types.VarArg(types.Any))(generate)
        return generate

    return with_code


# --- operators


def _operator(function: Any, name: str, allowed: Callable[[bool, bool], bool]) -> None:
    """Make an operator work part by part where ``allowed(a, b)``, of whether its sides are triples."""
    ours = (lanes, triple)

    @infer_global(function)
    class Typed(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:
            a, b = args
            fits = all(x in ours or isinstance(x, types.Number) for x in args)
            if not fits or not (a in ours or b in ours) or not allowed(a is triple, b is triple):
                return None
            return (triple if triple in args else lanes)(a, b)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        a, b = (parts_of(context, builder, *given) for given in zip(signature.args, arguments, strict=True))
        n = max(len(a), len(b))
        one = getattr(builder, name)
        return whole(builder, [one(x, y) for x, y in zip(a * (n // len(a)), b * (n // len(b)), strict=True)])

    for a in (LanesType, TripleType, types.Number):
        for b in (LanesType, TripleType, types.Number):
            if (a, b) != (types.Number, types.Number):
                lower_builtin(function, a, b)(generate)


_operator(operator.add, "fadd", lambda a, b: a == b)
_operator(operator.sub, "fsub", lambda a, b: a == b)
_operator(operator.mul, "fmul", lambda a, b: not (a and b))
_operator(operator.truediv, "fdiv", lambda a, b: not b)


@infer_global(operator.neg)
class _Negative(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        return args[0](*args) if args[0] in (lanes, triple) else None


@lower_builtin(operator.neg, LanesType)
@lower_builtin(operator.neg, TripleType)
def _negative(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return whole(
        builder, [builder.fneg(x) for x in parts_of(context, builder, signature.args[0], arguments[0])]
    )


@infer
class _Component(AbstractTemplate):
    key = "static_getitem"

    def generic(self, args: Any, kws: Any) -> Any:
        return lanes(*args) if args[0] is triple and args[1] in (0, 1, 2) else None


@infer_global(operator.getitem)
class _Number(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        return types.float64(*args) if args[0] is lanes and isinstance(args[1], types.Integer) else None


@lower_builtin("static_getitem", TripleType, types.Any)
def _component(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return builder.extract_value(arguments[0], int(arguments[1]))


@lower_builtin(operator.getitem, LanesType, types.Integer)
def _number(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return builder.extract_element(arguments[0], arguments[1])


# --- values from numbers


def every(number: Any) -> Any:
    """Lanes that all have this number."""
    return np.full(LANES, float(number))


def vector(x: Any, y: Any, z: Any) -> Any:
    """The Triple of three Lanes."""
    return np.stack([x, y, z])


def zero() -> Any:
    """The Triple of zeros."""
    return np.zeros((3, LANES))


@in_kernels(every, lambda number: lanes if isinstance(number, types.Number) else None)
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return parts_of(context, builder, signature.args[0], arguments[0])[0]


@in_kernels(vector, lambda x, y, z: triple if x is y is z is lanes else None)
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return whole(builder, list(arguments))


@in_kernels(zero, lambda: triple)
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return ir.Constant(TRIPLE, None)


# --- functions of lanes


def replaced(x: Any, place: Any, number: Any) -> Any:
    """The numbers of x, but this one at a place."""
    return np.where(np.arange(LANES) == place, number, x)


def sqrt(x: Any) -> Any:
    """Square root."""
    return np.sqrt(x)


def absolute(x: Any) -> Any:
    """Without the sign."""
    return np.abs(x)


def greatest(x: Any, least: Any) -> Any:
    """The numbers of x, but ``least``, a number or eight, where they are less or not a number."""
    return np.fmax(x, least)


def total(x: Any) -> Any:
    """Sum of the eight numbers."""
    return np.sum(x)


def _called(plain: Any, name: str) -> None:
    """A function of lanes that is one of LLVM."""

    @in_kernels(plain, lambda x: lanes if x is lanes else None)
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind = ir.FunctionType(VECTOR, [VECTOR])
        function = cgutils.get_or_insert_function(builder.module, kind, f"llvm.{name}.v{LANES}f64")
        return builder.call(function, arguments)


_called(sqrt, "sqrt")
_called(absolute, "fabs")


@in_kernels(
    greatest,
    lambda x, least: lanes if x is lanes and (least is lanes or isinstance(least, types.Number)) else None,
)
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    x, least = (
        parts_of(context, builder, *given)[0] for given in zip(signature.args, arguments, strict=True)
    )
    return builder.select(builder.fcmp_ordered(">", x, least), x, least)


@in_kernels(
    replaced,
    lambda x, place, number: (
        lanes if x is lanes and isinstance(place, types.Integer) and number is types.float64 else None
    ),
)
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    x, place, number = arguments
    return builder.insert_element(x, number, place)


@in_kernels(total, lambda x: types.float64 if x is lanes else None)
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    found = [builder.extract_element(arguments[0], INT(m)) for m in range(LANES)]
    while len(found) > 1:  # in pairs: the same order on every machine
        found = [builder.fadd(found[k], found[k + 1]) for k in range(0, len(found), 2)]
    return found[0]
