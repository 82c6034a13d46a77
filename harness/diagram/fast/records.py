"""What a subdivision leaves behind: tokens in preorder, and the leaves.

The arrays grow between two runs of the innermost loop, never in it: a compiled loop that may
exchange an array counts references to it in every round, which costs more than the round's work.
So before each triangle it is asked whether there is room for it, whatever it turns out to be.
"""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import EMPTY, HARD, MOST_PORTS
from harness.diagram.fast.memory import borrowed

#: The token of a leaf.
LEAF = 3

#: What is counted while records are written.
TOKENS, LEAVES, SLOTS, SHAPES, LOWS, OPENS, OPEN_IDS = range(7)


@compiled
def grown(array, needed):
    """``array`` with room for ``needed`` rows, contents kept."""
    if needed <= len(array):
        return array
    bigger = np.empty((max(needed, 2 * len(array)), *array.shape[1:]), array.dtype)
    bigger[: len(array)] = array
    return bigger


@compiled
def new_records(widest):
    """Empty records: tokens; kinds, choices, first slot of each leaf; slots; λ of the corners,
    points and roots of the leaves that are not empty; which of them have low parts, and these;
    first candidate and candidates of the open leaves."""
    return (
        np.empty(1024, np.int8),
        np.empty(512, np.int8),
        np.empty(512, np.int8),
        np.empty(512, np.int64),
        np.empty((1024, 2), np.int32),
        np.empty((256, 9)),
        np.empty((256, 2)),
        np.empty(256, np.int32),
        np.empty(16, np.int64),
        np.empty((16, 9)),
        np.empty(65, np.int64),
        np.empty(256 + widest, np.int64),
    )


@compiled
def enlarged(records, count, widest):
    """Records with room for one more triangle of at most ``widest`` candidates."""
    leaves, shapes, lows = count[LEAVES] + 2, count[SHAPES] + 1, count[LOWS] + 1
    return (
        grown(records[0], count[TOKENS] + 1),
        grown(records[1], leaves),
        grown(records[2], leaves),
        grown(records[3], leaves),
        grown(records[4], count[SLOTS] + MOST_PORTS),
        grown(records[5], shapes),
        grown(records[6], shapes),
        grown(records[7], shapes),
        grown(records[8], lows),
        grown(records[9], lows),
        grown(records[10], count[OPENS] + 2),
        grown(records[11], count[OPEN_IDS] + widest),
    )


@compiled
def lent(records):
    """Borrowed views of the records."""
    return (
        borrowed(records[0]),
        borrowed(records[1]),
        borrowed(records[2]),
        borrowed(records[3]),
        borrowed(records[4]),
        borrowed(records[5]),
        borrowed(records[6]),
        borrowed(records[7]),
        borrowed(records[8]),
        borrowed(records[9]),
        borrowed(records[10]),
        borrowed(records[11]),
    )


@compiled
def room_of(records):
    """The rows there are of everything that is counted."""
    return (
        len(records[0]),
        len(records[1]),
        len(records[4]),
        len(records[5]),
        len(records[8]),
        len(records[10]),
        len(records[11]),
    )


@compiled
def is_full(room, count, m):
    """Whether room may be short for one more triangle of m candidates."""
    return (
        count[TOKENS] + 1 > room[TOKENS]
        or count[LEAVES] + 2 > room[LEAVES]
        or count[SLOTS] + MOST_PORTS > room[SLOTS]
        or count[SHAPES] + 1 > room[SHAPES]
        or count[LOWS] + 1 > room[LOWS]
        or count[OPENS] + 2 > room[OPENS]
        or count[OPEN_IDS] + m > room[OPEN_IDS]
    )


@compiled
def record_halving(records, count, k):
    """A triangle whose side opposite to corner k is halved."""
    records[0][count[TOKENS]] = k
    count[TOKENS] += 1


@compiled
def record_leaf(records, count, leaf, found, ids, scratch, lam, root):
    """A leaf: (kind, ports, choice), what is ``found`` on its sides, and whose it may be.

    ``leaf``: (first, number) of its candidates in ``ids``.
    """
    kind, ports, choice = found
    start, m = leaf
    records[0][count[TOKENS]] = LEAF
    count[TOKENS] += 1
    row, slot = count[LEAVES], count[SLOTS]
    records[1][row], records[2][row], records[3][row] = kind, choice, slot
    count[LEAVES] += 1
    pieces = 0 if kind == HARD else max(ports, 1)
    for c in range(pieces):
        records[4][slot + c, 0] = scratch[4][c, 0]
        records[4][slot + c, 1] = ids[start + scratch[4][c, 1]]
    count[SLOTS] += pieces
    if kind == EMPTY:
        return
    shape = count[SHAPES]
    some = False
    for c in range(9):
        records[5][shape, c] = lam[c]
        some = some or lam[9 + c] != 0.0
    records[6][shape, 0], records[6][shape, 1] = scratch[6][0], scratch[6][1]
    records[7][shape] = root
    if some:
        low = count[LOWS]
        records[8][low] = shape
        for c in range(9):
            records[9][low, c] = lam[9 + c]
        count[LOWS] += 1
    count[SHAPES] += 1
    if kind == HARD or choice < 0:
        first = count[OPEN_IDS]
        records[10][count[OPENS]] = first
        for a in range(m):
            records[11][first + a] = ids[start + a]
        count[OPEN_IDS] += m
        count[OPENS] += 1


@compiled
def finished(records, count):
    """Copies of the records, without the room that is left."""
    leaves, shapes, lows = count[LEAVES], count[SHAPES], count[LOWS]
    records[3][leaves] = count[SLOTS]
    records[10][count[OPENS]] = count[OPEN_IDS]
    return (
        records[0][: count[TOKENS]].copy(),
        records[1][:leaves].copy(),
        records[2][:leaves].copy(),
        records[3][: leaves + 1].copy(),
        records[4][: count[SLOTS]].copy(),
        records[5][:shapes].copy(),
        records[8][:lows].copy(),
        records[9][:lows].copy(),
        records[6][:shapes].copy(),
        records[7][:shapes].copy(),
        records[10][: count[OPENS] + 1].copy(),
        records[11][: count[OPEN_IDS]].copy(),
    )
