"""Lanes and triples in kernels against NumPy on the same data, of any sizes, places and strides."""

import numpy as np
import pytest

from ancf.compiled import kernel
from ancf.simd import (
    LANES,
    absolute,
    cos_and_sin,
    decay,
    every,
    gather,
    gather_lanes,
    gather_nodes,
    greatest,
    load,
    load_six,
    put,
    put_lanes,
    put_nodes,
    replaced,
    scatter,
    scatter_nodes,
    sqrt,
    store,
    store_columns,
    store_six,
    total,
    vector,
    zero,
)

RNG = np.random.default_rng(5)
SPECIAL = np.array([0.0, -0.0, np.inf, -np.inf, np.nan, 5e-324, -1e308, 1e308])


@kernel
def of_lanes(x, y, s, out):
    """Every operator of lanes with lanes and with a number, on both sides."""
    a, b = load(x, 0), load(y, 1, 0)
    found = (
        a + b,
        a - b,
        a * b,
        a / b,
        -a,
        a + s,
        s - a,
        a - 2,
        2 * a,
        a * s,
        s / a,
        a / 3,
        absolute(a),
        sqrt(absolute(a)),
        every(s),
        greatest(a, 0.1),
        greatest(a, b),
    )
    for k in range(17):
        store(found[k], out, k)


@kernel
def sums(x):
    return total(2.0 * (load(x, 3) - 1.0))


@kernel
def of_triples(x, s, out):
    """Operators of triples with triples, lanes and numbers."""
    a, b, c = load(x, 0, 0), load(x, 0, 1), load(x, 0, 2)
    p, q = vector(a, b, c), vector(c, 2.0 * a, b) + zero()
    found = (p + q, p - q, a * p, p * a, s * p, p * s, p / c, p / s, -p, 3 * p)
    for k in range(10):
        store(found[k][0], out, k, 0)
        store(found[k][1], out, k, 1)
        store(found[k][2], out, k, 2)


@kernel
def moved(x, places, r):
    scatter(2.0 * gather(x, places, 0, 1), r, places, 1, 0)
    first, second = gather_nodes(x, places, 1, 1)
    scatter_nodes(first + second, first - second, r, places, 0, 0)


@kernel
def written(x, places, r):
    first, second = gather_nodes(x, places, 1, 1)
    put_nodes(second, first, r, places, 0, 0)
    put(gather(x, places, 0, 1), r, places, 1, 0)


@kernel
def turned_about(x, places, r):
    a, b, c, d, e, f, g, h = gather_lanes(x, places, 1)
    put_lanes(h, a + b, c, d, 2.0 * e, f, g, b, r, places, 0)


@pytest.mark.parametrize("x", [RNG.standard_normal(LANES), SPECIAL], ids=["random", "special"])
def test_operators_of_lanes(x):
    """To the last bit, but the division, which may be a product with the inverse."""
    y, s = RNG.standard_normal((2, 2, LANES)), 0.7
    out, plain = np.zeros((2, 17, LANES))
    of_lanes(x, y, s, out)
    with np.errstate(all="ignore"):
        of_lanes.py_func(x, y, s, plain)
    np.testing.assert_allclose(out, plain, rtol=3e-16, atol=0)
    exact = [0, 1, 2, 4, 5, 6, 7, 8, 9, 12, 13, 14, 15, 16]
    np.testing.assert_array_equal(out[exact], plain[exact])


@pytest.mark.parametrize("at", [3, 5])
def test_sum_from_any_place(at):
    x = RNG.standard_normal(20)
    assert sums(x[at - 3 :].copy()) == pytest.approx(np.sum(2 * x[at : at + LANES] - 2), rel=1e-14)


def test_operators_of_triples():
    x, s = RNG.standard_normal((1, 3, LANES)), -1.3
    out, plain = np.zeros((2, 10, 3, LANES))
    of_triples(x, s, out)
    of_triples.py_func(x, s, plain)
    np.testing.assert_allclose(out, plain, rtol=5e-16, atol=0)


@pytest.mark.parametrize("kind", ["chain", "reversed", "same", "overlapping", "anywhere"])
def test_from_places_and_back(kind):
    """Also where lanes share numbers: each lane adds to what the one before has left."""
    lane = np.arange(LANES)
    first = {
        "chain": 6 * lane,
        "reversed": 6 * lane[::-1],
        "same": 0 * lane + 4,
        "overlapping": 2 * lane,
        "anywhere": RNG.permutation(40)[:LANES],
    }[kind]
    places = np.stack([first, first + 3, first + 1, first]).reshape(2, 2, LANES)
    x = RNG.standard_normal(60)
    r, wanted = np.zeros((2, 60))
    moved(x, places, r)
    moved.py_func(x, places, wanted)
    np.testing.assert_allclose(r, wanted, rtol=1e-14, atol=1e-15)
    r = RNG.standard_normal(60)
    wanted = r.copy()
    written(x, places, r)
    written.py_func(x, places, wanted)
    np.testing.assert_array_equal(r, wanted)


@pytest.mark.parametrize("kind", ["apart", "overlapping", "anywhere"])
def test_eight_rows_are_columns_and_rows_again(kind):
    lane = np.arange(LANES)
    first = {"apart": 9 * lane, "overlapping": 3 * lane[::-1], "anywhere": RNG.permutation(90)[:LANES]}[kind]
    places, x = np.stack([first, 2 * lane + 1]), RNG.standard_normal(100)
    found = gather_lanes(x, places, 0)
    for k in range(LANES):
        np.testing.assert_array_equal(found[k], x[first + k])
    r, wanted = np.zeros((2, 100))
    turned_about(x, places, r)
    turned_about.py_func(x, places, wanted)
    np.testing.assert_array_equal(r, wanted)
    assert np.any(r)


@kernel
def sixes(x, i, j):
    store_six(2.0 * load_six(x, i), x, j)


@pytest.mark.parametrize(("size", "i", "j"), [(6, 0, 0), (12, 6, 0), (12, 0, 6), (19, 3, 13)])
def test_six_numbers_touch_no_others(size, i, j):
    """The last six of an array as well; what is behind it may belong to somebody else."""
    room = RNG.standard_normal(size + 2)
    x, wanted = room[:size].copy(), room[:size].copy()
    sixes(x, i, j)
    wanted[j : j + 6] = 2.0 * wanted[i : i + 6]
    np.testing.assert_array_equal(x, wanted)
    sixes.py_func(room, i, j)
    np.testing.assert_array_equal(room[:size], wanted)


@kernel
def numbers(x, k, y, out):
    """Number k of a value, and the value with another one in its place; k known when compiled, and not."""
    a = load(x, 0)
    store(replaced(a, k, y), out, 0)
    store(replaced(replaced(a, 2, y), 5, a[2]), out, 1)
    return a[k] - a[7]


@pytest.mark.parametrize("k", range(LANES))
def test_single_numbers(k):
    x, y = RNG.standard_normal(LANES), 0.3
    out, plain = np.zeros((2, 2, LANES))
    assert numbers(x, k, y, out) == numbers.py_func(x, k, y, plain) == x[k] - x[7]
    np.testing.assert_array_equal(out, plain)
    wanted = np.array([x, x])
    wanted[0, k] = wanted[1, 2] = y
    wanted[1, 5] = x[2]
    np.testing.assert_array_equal(out, wanted)


@kernel
def turned(x, i, j, out):
    store_columns(
        load_six(x, i),
        load_six(x, i + 6),
        load_six(x, i + 12),
        load_six(x, i + 18),
        load_six(x, i + 24),
        load_six(x, i + 30),
        out,
        j,
    )


@pytest.mark.parametrize(("i", "j"), [(0, 0), (3, 1), (36, 7)])
def test_rows_are_written_as_columns_and_touch_no_others(i, j):
    x, out = RNG.standard_normal(i + 36), RNG.standard_normal(j + 37)
    plain, wanted = out.copy(), out.copy()
    wanted[j : j + 36] = x[i : i + 36].reshape(6, 6).T.ravel()
    turned(x, i, j, out)
    turned.py_func(x, i, j, plain)
    np.testing.assert_array_equal(out, wanted)
    np.testing.assert_array_equal(plain, wanted)


def test_what_does_not_fit_is_refused_when_it_is_compiled():
    @kernel
    def two_triples(x):
        p = vector(load(x, 0), load(x, 0), load(x, 0))
        return (p * p)[0]

    @kernel
    def floats_as_places(x):
        return total(gather(x, x.reshape(1, 8), 0)[0])

    for wrong in (two_triples, floats_as_places):
        with pytest.raises(Exception, match="No implementation of function"):
            wrong(np.ones(8))


@kernel
def of_functions(x, out):
    for k in range(x.shape[0]):
        c, s = cos_and_sin(load(x, k))
        store(c, out, 0, k)
        store(s, out, 1, k)
        store(decay(-absolute(load(x, k))), out, 2, k)


@pytest.mark.parametrize("size", [1e-9, 0.3, 3.0, 39.0, 1e3, 1e5])
def test_functions_of_lanes(size):
    x = RNG.uniform(-size, size, (200, LANES))
    x[0] = 0.0, size, -size, 0.5 * np.pi, np.pi, -1.5 * np.pi, 40.0, -41.0
    out = np.empty((3, *x.shape))
    of_functions(x, out)
    assert np.max(np.abs(out[0] - np.cos(x))) < 5e-15
    assert np.max(np.abs(out[1] - np.sin(x))) < 5e-15
    assert np.max(np.abs(out[2] / np.exp(-np.minimum(np.abs(x), 40.0)) - 1.0)) < 1e-13
