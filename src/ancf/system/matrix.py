"""Places of the elements' blocks, of held unknowns and of local axes in the block matrix."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import IntArray


def block_pairs(batches: list[Any]) -> IntArray:
    """Pairs of blocks that some batch couples, shape (m, 2), each once."""
    found = [np.where(batch.base >= 0, batch.base // 6, -1) for batch in batches]
    n = 1 + max((int(blocks.max(initial=-1)) for blocks in found), default=0)
    keys = [np.zeros(0, dtype=np.int64)]
    for blocks in found:
        high, low = blocks[:, :, None], blocks[:, None, :]
        keys.append((high * n + low)[(high > low) & (low >= 0)])
    key = np.unique(np.concatenate(keys))  # numbers: rows of two take ten times as long
    return np.stack([key // max(n, 1), key % max(n, 1)], axis=1)


class Places:
    """Where entry (i, j) of the matrix is stored; diagonal blocks whole, others below the diagonal."""

    def __init__(self, row_start: IntArray, column: IntArray) -> None:
        self.row_start, self.column = row_start, column
        self.n = len(row_start) - 1
        rows = np.repeat(np.arange(self.n), np.diff(row_start))
        self.key = rows * self.n + column  # ascending
        self.rows = rows

    @property
    def size(self) -> int:
        """Number of values."""
        return 36 * (self.n + len(self.column))

    def of(self, i: IntArray, j: IntArray) -> IntArray:
        """Places of the entries (i, j) of unknowns, -1: above the diagonal blocks, none, or i, j < 0."""
        (bi, ri), (bj, cj) = divmod(i, 6), divmod(j, 6)
        key = bi * self.n + bj
        k = np.searchsorted(self.key, key)
        stored = np.append(self.key, -1)[k] == key
        place = 36 * np.where(bi == bj, bi, self.n + k) + (6 * ri + cj)
        return np.where(((bi == bj) | stored) & (bi >= bj) & (bj >= 0), place, -1)

    def dest(self, slots: IntArray) -> IntArray:
        """Places of all 3x3 blocks of elements with these slots, shape (n, k*k)."""
        n, k = slots.shape
        return self.of(slots[:, :, None], slots[:, None, :]).reshape(n, k * k)

    @cached_property
    def by_column(self) -> tuple[IntArray, IntArray]:
        """Stored blocks below the diagonal, column by column, and where each column begins among them."""
        order = np.argsort(self.column, kind="stable")
        return order, np.searchsorted(self.column[order], np.arange(self.n + 1))

    def blocks_of(self, b: int) -> tuple[IntArray, IntArray]:
        """Numbers of the stored blocks in row b (diagonal included) and below in column b."""
        order, first = self.by_column
        row = self.n + np.arange(self.row_start[b], self.row_start[b + 1])
        return np.append(row, b), self.n + order[first[b] : first[b + 1]]

    def crosses(self, unknowns: IntArray) -> IntArray:
        """Places of the rows and columns of unknowns, the diagonal entries included; ascending."""
        b, c = unknowns // 6, unknowns % 6
        order, first = self.by_column
        of, row = _ranges(self.row_start[b], self.row_start[b + 1])
        below, k = _ranges(first[b], first[b + 1])
        starts = [36 * (self.n + row) + 6 * c[of], 36 * b + 6 * c]
        tops = [36 * (self.n + order[k]) + c[below], 36 * b + c]
        in_row = np.concatenate(starts)[:, None] + np.arange(6)
        in_column = np.concatenate(tops)[:, None] + 6 * np.arange(6)
        return np.unique(np.concatenate([in_row.ravel(), in_column.ravel()]))

    def pieces(self, slot: int) -> tuple[IntArray, IntArray]:
        """Places of the 3x6 pieces in the row of a slot and of the 6x3 pieces in its column."""
        row, column = self.blocks_of(slot // 6)
        c = slot % 6
        return 36 * row + 6 * c, 36 * np.append(column, slot // 6) + c


def _ranges(first: IntArray, last: IntArray) -> tuple[IntArray, IntArray]:
    """All numbers of ranges in a row, and which range each is of."""
    count = last - first
    of = np.repeat(np.arange(len(count)), count)
    return of, np.arange(len(of)) - np.repeat(np.cumsum(count) - count, count) + first[of]
