"""What is recorded comes back, however often the arrays grew in between."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from harness.diagram.fast import records as rec
from harness.diagram.fast.leaves import EMPTY, HARD, MOST_PORTS, QUAD, TRIPLE

WIDEST = 40

halvings = st.tuples(st.just("halving"), st.integers(0, 2))
leaves = st.tuples(
    st.sampled_from([EMPTY, TRIPLE, QUAD, HARD]),
    st.integers(0, MOST_PORTS),
    st.sampled_from([-1, 0, 1]),
    st.integers(1, WIDEST),
    st.booleans(),
)


def _slots(kind: int, ports: int) -> int:
    return 0 if kind == HARD else max(ports, 1)


@given(st.lists(halvings | leaves, min_size=1, max_size=12), st.integers(1, 400))
def test_records_survive_growing(pattern: list[tuple], times: int) -> None:
    written = rec.new_records(WIDEST)
    count = np.zeros(7, dtype=np.int64)
    ids = np.arange(WIDEST + 3)
    scratch = (None,) * 4 + (np.zeros((MOST_PORTS, 2), np.int64), None, np.zeros(2))
    place, point = scratch[4], scratch[6]
    triangles = pattern * times
    for number, triangle in enumerate(triangles):
        m = WIDEST if triangle[0] == "halving" else triangle[3]
        if rec.is_full.py_func(rec.room_of.py_func(written), count, m):
            written = rec.enlarged(written, count, WIDEST)
        assert not rec.is_full.py_func(rec.room_of.py_func(written), count, m)
        if triangle[0] == "halving":
            rec.record_halving.py_func(written, count, triangle[1])
            continue
        kind, ports, choice, m, low = triangle
        place[:, 0], place[:, 1] = number % 6, np.arange(MOST_PORTS) % m
        point[:] = number, -number
        lam = np.array([float(number)] * 9 + [0.5 * low] * 9)
        rec.record_leaf.py_func(
            written, count, (3, m), (kind, ports, choice), ids, scratch, lam, number
        )
    tokens, kinds, choices, first_slot, slots, shapes, low_rows, lows, *rest = rec.finished(
        written, count
    )
    points, shape_roots, open_first, open_ids = rest
    found = [(n, t) for n, t in enumerate(triangles) if t[0] != "halving"]
    shaped = [(n, t) for n, t in found if t[0] != EMPTY]
    still_open = [t for _, t in shaped if t[0] == HARD or t[2] < 0]
    assert tokens.tolist() == [t[1] if t[0] == "halving" else rec.LEAF for t in triangles]
    assert kinds.tolist() == [t[0] for _, t in found]
    assert choices.tolist() == [t[2] for _, t in found]
    widths = [_slots(t[0], t[1]) for _, t in found]
    assert first_slot.tolist() == np.cumsum([0, *widths]).tolist()
    assert slots.tolist() == [
        [n % 6, 3 + c % t[3]] for n, t in found for c in range(_slots(t[0], t[1]))
    ]
    assert shapes[:, 0].tolist() == shapes[:, 8].tolist() == [n for n, _ in shaped]
    assert low_rows.tolist() == [row for row, (_, t) in enumerate(shaped) if t[4]]
    assert (lows == 0.5).all()
    assert points.tolist() == [[n, -n] for n, _ in shaped]
    assert shape_roots.tolist() == [n for n, _ in shaped]
    assert open_first.tolist() == np.cumsum([0, *(t[3] for t in still_open)]).tolist()
    assert open_ids.tolist() == [3 + a for t in still_open for a in range(t[3])]
