"""Named tuples at an address: kernels read from them what Python has put in."""

import copy
import pickle
from typing import ClassVar, NamedTuple

import numpy as np
import pytest
from numba import typeof, types

import ancf
from ancf import records, words
from ancf.addresses import address_of, caller, pointer
from ancf.compiled import kernel, separate_kernel
from ancf.records import Located, recorded, type_of, words_of
from ancf.solvers.block import kernels_of
from ancf.solvers.runs import run_of
from ancf.system.system import System
from ancf.words import asked, asked_begin, begin_of, looked_up, spelled


@recorded
class Inner(NamedTuple):
    """What another one holds by its address."""

    x: np.ndarray
    flag: bool


class Plain(NamedTuple):
    """What another one holds itself."""

    n: int
    y: np.ndarray


@recorded
class Outer(NamedTuple):
    """One of each kind of field."""

    first: bool
    number: float
    plain: Plain
    inner: Inner
    items: tuple
    none: tuple
    cube: np.ndarray
    last: int


@pytest.fixture
def rng():
    return np.random.default_rng(5)


def made(rng, shape):
    some = rng.standard_normal(shape)
    inner = Inner(some[0, 0].copy(), bool(rng.integers(2)))
    plain = Plain(int(rng.integers(-9, 9)), np.arange(int(rng.integers(1, 5)), dtype=np.int64))
    return Outer(True, rng.standard_normal(), plain, inner, (inner, 2.5), (), some, -3)


@kernel
def all_of(o, out):
    out[0] = 1.0 if o.first else 0.0
    out[1] = o.number
    out[2] = o.plain.n + o.plain.y.sum()
    out[3] = o.inner.x.sum()
    out[4] = 1.0 if o.inner.flag else 0.0
    out[5] = o.items[0].x[0] * o.items[1] + len(o.none)
    out[6] = o.cube[1, 0, 2]
    out[7] = o.cube.shape[0] + 10 * o.cube.shape[1] + 100 * o.cube.shape[2] + o.cube.size
    out[8] = o.last


@kernel
def set_first(o, number):
    o.inner.x[0] = number


@pytest.mark.parametrize("shape", [(2, 1, 3), (3, 2, 5), (2, 4, 4)])
def test_fields(rng, shape):
    for _ in range(3):
        given, found = made(rng, shape), np.zeros(9)
        all_of(given, found)
        cube = given.cube
        wanted = [1.0, given.number, given.plain.n + given.plain.y.sum(), given.inner.x.sum()]
        wanted += [float(given.inner.flag), given.inner.x[0] * 2.5, cube[1, 0, 2]]
        wanted += [shape[0] + 10 * shape[1] + 100 * shape[2] + cube.size, -3.0]
        np.testing.assert_allclose(found, wanted, rtol=1e-14)


def test_entries_are_those_of_the_tuple(rng):
    given = made(rng, (2, 1, 3))
    set_first(given, 7.0)
    assert given.inner.x[0] == 7.0


def test_a_changed_copy_has_a_record_of_its_own(rng):
    given, found = made(rng, (2, 1, 3)), np.zeros(9)
    all_of(given, found)
    for other in (given._replace(number=4.0), pickle.loads(pickle.dumps(given))._replace(number=4.0)):
        assert isinstance(other, Outer)
        all_of(other, found)
        assert found[1] == 4.0
    assert copy.copy(given).address != given.address


def test_an_array_in_steps_is_another_type(rng):
    """Strides are kept; a type says whether an array has gaps."""
    given = made(rng, (4, 1, 3))
    gaps = given._replace(cube=given.cube[::2])
    assert type_of(gaps) != type_of(given)
    found = np.zeros(9)
    all_of(gaps, found)
    assert found[6] == given.cube[2, 0, 2]


@pytest.mark.parametrize("shape", [(), (3,), (2, 0), (4, 2)])
def test_where_numbers_begin(shape):
    array = np.zeros(shape)
    assert looked_up(array) == asked_begin(array)
    assert looked_up(array[..., ::-1] if shape else array) == asked_begin(
        array[..., ::-1] if shape else array
    )


def test_a_record_is_small(rng):
    """An array is its address, its shape and its strides; a recorded tuple an address, its words behind."""
    given = made(rng, (2, 1, 3))
    assert len(words_of(given)) == 1 + 1 + (1 + 3) + 1 + (1 + 1) + 0 + 7 + 1 + 2 * (3 + 1)


class Table(NamedTuple):
    x: np.ndarray
    table: np.ndarray


@kernel
def traced(o):
    o.x[0] = 9.0
    total = 0.0
    for k in range(o.table.shape[0]):
        total += o.table[k, k]
    return total


def test_located(rng):
    """A named tuple of any class, read and written by its address."""
    given = Table(np.zeros(2), rng.standard_normal((3, 3)))
    assert traced(Located(given)) == pytest.approx(np.trace(given.table))
    assert given.x.tolist() == [9.0, 0.0]


def test_what_no_record_has(rng):
    @recorded
    class Odd(NamedTuple):
        x: np.ndarray
        z: complex

    @kernel
    def of_odd(o):
        return o.z.real

    with pytest.raises(Exception, match="complex"):
        of_odd(Odd(np.zeros(2), 1.0j))


@separate_kernel
def scaled(x, factor, out):
    for i in range(x.shape[0]):
        out[i] = factor * x[i]
    return factor > 1.0


class TestCalls:
    VECTOR = types.Array(types.float64, 1, "C")
    GIVEN = (VECTOR, types.float64, VECTOR)

    def test_by_an_address(self, rng):
        call = caller(types.boolean, self.GIVEN)

        @kernel
        def some(address, x, factor, out):
            return call(address, (x, factor, out))

        address = address_of(scaled, self.GIVEN, types.boolean)
        for factor in (3, 0.5):  # a whole number is converted
            x, out = rng.standard_normal(5), np.zeros(5)
            assert some(address, x, factor, out) == (factor > 1.0)
            np.testing.assert_array_equal(out, factor * x)
        before = out.copy()
        assert some(0, x, 9.0, out) is False  # nothing is called
        np.testing.assert_array_equal(out, before)

    def test_of_wrong_types(self):
        call = caller(types.boolean, self.GIVEN)

        @kernel
        def some(address, x, factor, out):
            return call(address, (x, factor, out))

        with pytest.raises(Exception, match="was given"):
            some(0, np.zeros(4)[::2], 1.0, np.zeros(2))

    def test_what_it_returns_is_checked(self):
        with pytest.raises(TypeError, match="scaled returns bool"):
            address_of(
                scaled, (self.VECTOR, types.float64, types.Array(types.float64, 1, "A")), types.float64
            )

    def test_records(self, rng):
        """An address serves as a record."""
        given = made(rng, (2, 1, 3))

        @separate_kernel
        def number_of(o):
            return o.number

        call = caller(types.float64, (types.voidptr,))

        @kernel
        def some(address, record):
            return call(address, (pointer(record),))

        address = address_of(number_of, (type_of(given),), types.float64)
        assert some(address, given.address) == given.number


def hung(**more):
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.01, rhoA=0.1, **more)
    cable = model.add_beam("cable", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    model.pin(cable.start)
    return model, cable


def beaded():
    model, cable = hung()
    model.slide(model.add_point_mass("bead", at=(0.4, 0, 0), mass=1.0), along=cable)
    return model


class TestApart:
    """What a model does not need has no address."""

    @pytest.mark.parametrize(
        ("make", "wanted"),
        [
            (lambda: hung()[0], {"new_matrix"}),
            (lambda: hung(bending_damping=1e-4)[0], {"new_matrix", "balance"}),
            (beaded, {"new_matrix", "renew_tail", "project"}),
        ],
        ids=["plain", "damped", "beaded"],
    )
    def test_what_a_model_needs(self, make, wanted):
        system = System(make())
        run = run_of(ancf.Trapezoidal(), system, 0.0, 1.0, 0.1, 1)
        _, apart = kernels_of(system.core, run.memory, run.sampling, False)
        assert {name for name, address in apart._asdict().items() if address} == wanted

    def test_explicit_steps_have_no_matrix(self):
        system = System(hung()[0])
        run = run_of(ancf.Explicit(), system, 0.0, 1.0, 0.1, 1)
        assert not any(run.kernels[1])


class TestSpelled:
    """What a kernel reads of tuples is what Python and NumPy tell of them."""

    ARRAYS = (
        np.zeros(3),
        np.zeros((2, 3, 4))[:, ::2],
        np.zeros((4, 5)).T,
        np.zeros(()),
        np.zeros((0, 2), dtype=bool),
        np.arange(6, dtype=np.int64)[::-1],
        np.zeros((1, 1, 2, 1, 3, 1, 2)),
        np.broadcast_to(np.zeros(2), (3, 2)),
    )
    RECORDED: ClassVar = {Inner, Outer}

    def some(self, rng, depth):
        """An item of any kind; numbers of all lengths, tuples in tuples."""
        kind = rng.integers(7 if depth > 0 else 5)
        if kind == 0:
            return self.ARRAYS[rng.integers(len(self.ARRAYS))]
        if kind == 1:
            return rng.choice([-1, 1]).item() * int(rng.integers(2**62)) >> int(rng.integers(63))
        if kind < 5:
            return (bool(rng.integers(2)), rng.standard_normal(), np.float64(rng.standard_normal()))[kind - 2]
        inner = tuple(self.some(rng, depth - 1) for _ in range(rng.integers(5)))
        return inner if kind == 5 else Inner(self.ARRAYS[rng.integers(len(self.ARRAYS))], inner)

    def test_a_kernel_reads(self):
        """Where it finds something else than Python tells, Python is asked, many times as slowly."""
        assert words._reads()

    @pytest.mark.parametrize("count", [0, 1, 8, 60])
    def test_words(self, rng, count):
        for _ in range(30):
            value = tuple(self.some(rng, 3) for _ in range(count))
            (read, _), (told, _) = spelled(value, self.RECORDED), asked(value, self.RECORDED)
            begin = begin_of(read), begin_of(told)
            assert len(read) == len(told)
            # addresses of records in it are those of the words themselves
            within = (read >= begin[0]) & (read < begin[0] + read.nbytes)
            np.testing.assert_array_equal(read[within] - begin[0], told[within] - begin[1])
            np.testing.assert_array_equal(read[~within], told[~within])

    def test_more_than_a_kernel_has_room_for(self, rng):
        """Python tells it then, as it does of what no kernel reads."""
        many = tuple(Inner(np.zeros(3), k) for k in range(700))
        deep = (1.5,)
        for _ in range(40):
            deep = (deep,)
        for value in (many, deep, tuple(range(5000)), (np.int32(7), 2)):
            read, told = (tell(value, self.RECORDED)[0] for tell in (spelled, asked))
            assert len(read) == len(told)
            same = read == told
            assert same.all() if value is not many else same.sum() == len(told) - len(many)

    @pytest.mark.parametrize("tell", [spelled, asked])
    def test_kinds(self, tell):
        """Equal for items of one kind and layout, whatever their sizes; different for all others."""
        frozen = np.zeros(3)
        frozen.flags.writeable = False
        others = [
            np.zeros(3),
            np.zeros(3, dtype=np.int64),
            np.zeros(6)[::2],
            np.zeros((3, 3)),
            frozen,
            5,
            5.0,
        ]
        others += [np.zeros((3, 3)).T, np.zeros(3, dtype=np.float32), True, (), (5,), ((5,),), (5, 5)]
        others += [Inner(np.zeros(3), True), Inner(np.zeros(3), 1), (Inner(np.zeros(3), True),)]
        told = [tell((one, 5), self.RECORDED)[1] for one in others]
        assert len(set(told)) == len(others)
        assert tell((np.ones(7), 6), self.RECORDED)[1] == told[0]
        assert tell((9, 9), self.RECORDED)[1] == told[5]
        assert tell(((5,), 5, 5), self.RECORDED)[1] != tell(((5, 5), 5), self.RECORDED)[1]


def test_types_of_records_tell_all(rng):
    """A type is looked up by what the record was made of, also of what it holds in plain tuples."""
    given = made(rng, (2, 1, 3))
    others = [
        given._replace(number=3),
        given._replace(items=(given.inner, 2)),
        given._replace(items=(given.inner,)),
        given._replace(items=((given.inner, 2.5),)),
        given._replace(plain=Plain(1, np.zeros(2))),
        given._replace(inner=given.inner._replace(x=np.zeros(4)[::2])),
        given._replace(cube=np.zeros((2, 3))),
    ]
    kinds = [type_of(one) for one in (given, *others)]
    assert all(kind == typeof(one) for kind, one in zip(kinds, (given, *others), strict=True))
    assert len(set(kinds)) == len(kinds)
    assert type_of(made(rng, (5, 2, 3))) is kinds[0]


def test_kinds_that_records_are_looked_up_by_stay(rng):
    """A kind of array that was read from a pickle is an object of its own, which must not make room."""
    kind = pickle.loads(pickle.dumps(np.dtype(np.float64)))
    given = made(rng, (2, 1, 3))._replace(cube=np.zeros((2, 1, 3), dtype=kind))
    type_of(given)
    assert any(one is given.cube.dtype for one in records._kinds)
