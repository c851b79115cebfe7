"""Kernels that kernels call by their address.

What few models need, or what a run needs rarely, is a kernel of its own: the loops that call it are compiled
without it, a model that does not need it never compiles it, and several can be compiled side by side.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.core import cgutils
from numba.core.errors import TypingError
from numba.extending import intrinsic

#: Addresses by what asked for them.
found: dict[Any, Any] = {}


def address_of(dispatcher: Any, signature: tuple[Any, ...], result: Any) -> int:
    """Address of a kernel for arguments of these types; it is compiled, or taken from the cache.

    Raises
    ------
    TypeError
        It does not return what is wanted.
    """
    key = dispatcher, signature
    if key not in found:
        found[key] = _compiled(dispatcher, signature, result)
    return int(found[key])


def _compiled(dispatcher: Any, signature: tuple[Any, ...], result: Any) -> int:
    dispatcher.compile(signature)
    compiled = dispatcher.overloads[signature]
    returned = compiled.signature.return_type
    if returned != result:
        raise TypeError(f"{dispatcher.py_func.__name__} returns {returned}, not {result}")
    return int(compiled.library.get_pointer_to_function(compiled.fndesc.llvm_func_name))


def caller(result: Any, given: tuple[Any, ...] | None = None, nothing: Any = None) -> Any:
    """Intrinsic ``call(address, arguments)`` for kernels that return a type.

    Parameters
    ----------
    result : numba type
    given : tuple of numba types, optional
        What the kernels take: numbers are converted, other arguments must be of these types, but any address
        serves as a record.  By default they take what is given.
    nothing : number, optional
        What is returned where the address is 0; nothing is called then.
    """

    @intrinsic
    def call(typing, place, arguments):
        wanted = tuple(arguments) if given is None else given
        if len(wanted) != len(arguments) or not all(map(_fits, arguments, wanted)):
            raise TypingError(f"a kernel that takes {wanted} was given {tuple(arguments)}")

        def generate(context, builder, signature, values):
            place, packed = values
            items = [
                context.cast(builder, item, have, want) if isinstance(want, types.Number) else item
                for item, have, want in zip(
                    cgutils.unpack_tuple(builder, packed), arguments, wanted, strict=True
                )
            ]
            if nothing is None:
                none = context.get_constant_null(result)
            else:
                none = context.get_constant(result, nothing)
            out = cgutils.alloca_once_value(builder, none)
            with builder.if_then(cgutils.is_not_null(builder, place)):
                builder.store(call_at(context, builder, place, items, wanted, result), out)
            return builder.load(out)

        return result(types.int64, arguments), generate

    return call


def _fits(have: Any, want: Any) -> bool:
    """Whether an argument can be given: any number for a number, any address for a record."""
    if isinstance(want, types.Number):
        return isinstance(have, types.Number)
    return have == want or (want == types.voidptr and hasattr(have, "batch"))


@intrinsic
def pointer(typing, number):
    """An address as kernels hand on records."""

    def generate(context, builder, signature, values):
        return builder.inttoptr(values[0], context.get_value_type(types.voidptr))

    return types.voidptr(types.int64), generate


def call_at(context: Any, builder: Any, place: Any, items: Any, given: tuple[Any, ...], result: Any) -> Any:
    """Call the kernel at an address with values of these types."""
    function = builder.inttoptr(place, context.call_conv.get_function_type(result, given).as_pointer())
    status, value = context.call_conv.call_function(builder, function, result, given, items)
    with cgutils.if_unlikely(builder, status.is_error):
        context.call_conv.return_status_propagate(builder, status)
    return value
