"""Functions that only kernels call are translated with them and not by themselves."""

import numba
import pytest

from ancf.compiled import formula, inline_kernel
from ancf.parts import PartLibrary


@formula
def doubled(x):
    return 2.0 * x


@inline_kernel
def raised(x, n):
    y = 1.0
    for _ in range(n):
        y *= x
    return doubled(y)


@numba.njit  # without the cache of kernels, which would give it without its parts
def asked(x, n):
    return raised(x, n) + doubled(x)


def libraries(dispatcher):
    return [compiled.library for compiled in dispatcher.overloads.values()]


@pytest.mark.skipif(not hasattr(asked, "overloads"), reason="kernels are interpreted")
def test_only_the_kernel_is_translated():
    assert asked(3.0, 4) == 2.0 * 81.0 + 6.0
    for part in (doubled, raised):
        assert len(libraries(part)) == 1
        assert isinstance(libraries(part)[0], PartLibrary)
    name = asked.overloads[asked.signatures[0]].fndesc.llvm_func_name
    assert libraries(asked)[0].get_pointer_to_function(name) != 0
    name = raised.overloads[next(iter(raised.overloads))].fndesc.llvm_func_name
    engine = libraries(asked)[0].codegen._engine
    assert not engine.is_symbol_defined(name)


def test_a_part_is_no_function_of_its_own():
    with pytest.raises(TypeError, match="doubled is a part of kernels"):
        doubled(1.0)
