"""Order of the nodes and the pattern of L: a narrow band where there is one, minimum degree elsewhere."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ..arrays import IntArray
from ..later import csc_matrix, csr_matrix, eye_array, reverse_cuthill_mckee, splu

#: Ratio of the numbers of blocks in L up to which an ordering counts as equally good.
NEAR = 1.15
MINIMUM_DEGREE = "minimum degree"
#: Least length, by the square of its width, of a band that is eliminated from both ends; chains always are.
SHORT = 16


def fill_pattern(pairs: IntArray, n: int) -> tuple[IntArray, IntArray]:
    """Rows of L for a symmetric pattern, by the elimination tree.

    Parameters
    ----------
    pairs : ndarray, shape (m, 2)
        Coupled blocks in the order of elimination, any order, repeats allowed.
    n : int
        Number of blocks.

    Returns
    -------
    row_start : ndarray, shape (n + 1,)
    column : ndarray
        Columns j < i of the blocks L_ij, ascending in each row.
    """
    rows = [sorted(row) for row in _rows(pairs, n)]
    row_start = np.concatenate([[0], np.cumsum([len(r) for r in rows])]).astype(np.int64)
    column = np.array([j for r in rows for j in r], dtype=np.int64)
    return row_start, column


def _keys(pairs: IntArray, n: int) -> IntArray:
    """Row times n plus column of each pair of two blocks, ascending, each once."""
    one, other = pairs[:, 0], pairs[:, 1]
    high, low = np.maximum(one, other), np.minimum(one, other)
    return np.unique((high * n + low)[high > low])


def _rows(pairs: IntArray, n: int) -> Iterator[list[int]]:
    """Columns of the blocks of L, row by row, in no order."""
    key = _keys(pairs, n)
    first = np.searchsorted(key, n * np.arange(n + 1)).tolist()
    left = (key % max(n, 1)).tolist()
    parent, passed = [-1] * n, [-1] * n
    for i in range(n):
        row: list[int] = []
        passed[i] = i
        for j in left[first[i] : first[i + 1]]:
            while passed[j] != i:  # climb the elimination tree: every node passed is filled
                passed[j] = i
                row.append(j)
                if parent[j] < 0:
                    parent[j] = i
                j = parent[j]
        yield row


def _count(pairs: IntArray, n: int, most: float = np.inf) -> float:
    """Number of the blocks of L; infinite as soon as there are more than so many."""
    count = 0
    for row in _rows(pairs, n):
        count += len(row)
        if count > most:
            return np.inf
    return count


def order(pairs: IntArray, n: int) -> tuple[IntArray, str]:
    """Order in which the blocks are eliminated.

    Compares the order given, reverse Cuthill-McKee (a narrow band) and minimum degree by the number
    of blocks in L and takes the first whose number is within NEAR of the least: a narrow band is worth
    somewhat more fill, for its rows are read one after the other.

    Returns
    -------
    rank : ndarray, shape (n,)
        New place of each block.
    name : str
        ``"as given"``, ``"band"`` or ``"minimum degree"``.
    """
    given = np.arange(n)
    least = len(_keys(pairs, n))
    if _count(pairs, n, NEAR * least) <= NEAR * least:  # no other order can be better by more
        return given, "as given"
    candidates = {"as given": given, "band": band(pairs, n)}
    counts = {"band": _count(candidates["band"][pairs], n)}
    if counts["band"] > 1.02 * least:  # a tree or a chain cannot do better than no fill
        candidates[MINIMUM_DEGREE] = _minimum_degree(pairs, n)
        counts[MINIMUM_DEGREE] = _count(candidates[MINIMUM_DEGREE][pairs], n)
    counts["as given"] = _count(pairs, n, NEAR * min(counts.values()))
    best = min(counts.values())
    name = next(k for k in candidates if counts[k] <= NEAR * best)
    return candidates[name], name


def behind(rank: IntArray, pairs: IntArray, later: Sequence[int], last: Sequence[int]) -> IntArray:
    """Order in which some blocks come right behind all that they are coupled with, others at the end.

    Blocks of multipliers have no entries of their own on the diagonal: what stands there is the result of
    eliminating the bodies first.

    Parameters
    ----------
    rank : ndarray, shape (n,)
        Place of each block.
    pairs : ndarray, shape (m, 2)
        Coupled blocks.
    later, last : sequences of int
        Blocks to be moved behind their neighbours, and to the end.

    Returns
    -------
    ndarray, shape (n,)
    """
    if not (len(later) or last):
        return rank
    key = rank.astype(np.float64)
    for block in later:
        met = np.unique(pairs[(pairs == block).any(axis=1)])
        key[block] = np.max(rank[np.setdiff1d(met, later)], initial=0) + 0.5
    key[last] = len(rank) + np.arange(len(last))
    place = np.empty(len(rank), dtype=np.int64)
    place[np.argsort(key, kind="stable")] = np.arange(len(rank))
    return place


def from_both_ends(rank: IntArray, spread: int) -> IntArray:
    """The blocks of a band in turn from its beginning and from its end.

    The two eliminations and solves, which meet in the middle, do not wait for each other: a processor works
    at both at a time.  Where they meet L has a few blocks more, up to about 3 spread^2, but none in a chain.

    Parameters
    ----------
    rank : ndarray, shape (n,)
        Place of each block.
    spread : int
        Largest difference of the places of two blocks that are coupled.

    Returns
    -------
    ndarray, shape (n,)
        As it is where the band is too short for its width.
    """
    n = len(rank)
    if n < SHORT * spread * (spread - 1):
        return rank
    return np.where(2 * rank < n, 2 * rank, 2 * (n - 1 - rank) + 1)


def _graph(pairs: IntArray, n: int) -> csr_matrix:
    i, j = pairs.T if len(pairs) else (np.zeros(0, int), np.zeros(0, int))
    graph = csr_matrix((np.ones(len(i)), (i, j)), shape=(n, n))
    return csr_matrix(graph + graph.T)


def band(pairs: IntArray, n: int) -> IntArray:
    """Places of the blocks that give a narrow band (reverse Cuthill-McKee), shape (n,)."""
    permutation = reverse_cuthill_mckee(_graph(pairs, n), symmetric_mode=True)
    rank = np.empty(n, dtype=np.int64)
    rank[permutation] = np.arange(n)
    return rank


def _minimum_degree(pairs: IntArray, n: int) -> IntArray:
    graph = _graph(pairs, n)
    graph.data[:] = -1.0
    degree = np.asarray(-graph.sum(axis=1)).ravel()
    laplacian = csc_matrix(graph + csr_matrix(eye_array(n)).multiply((degree + 1.0)[:, None]))
    factor = splu(
        laplacian, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
    return np.asarray(factor.perm_c, dtype=np.int64)
