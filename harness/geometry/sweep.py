"""A plane sweep that finds two segments in conflict, or shows that there are none.

Shamos and Hoey, "Geometric intersection problems", FOCS 1976.  The sweep visits the endpoints in
lexicographic order; a treap (Seidel and Aragon, "Randomized search trees", 1996) keeps the
segments that meet the sweep line from bottom to top; every pair that becomes adjacent is tested.
All decisions are signs of orientations of three endpoints.

The functions are plain loops for :func:`harness.geometry.compiling.compiled`; points are known
by their rank in lexicographic order, equal points by one rank, so that shared endpoints, vertical
segments and comparisons along a line need no arithmetic at all.
"""

from __future__ import annotations

from typing import Final

Known = list[tuple[int, int, int, int]]

#: A filter's answer when rounding could change the sign; so high that products of it tell.
UNSURE: Final = 2

_ROUND: Final = 5 * 2.0**-53
_SPLIT: Final = 2.0**27 + 1
_SAFE: Final = 2.0**-400


def turn(x: list[float], y: list[float], slack: float, known: Known, p: int, q: int, r: int) -> int:
    """The orientation of points p, q, r: 1 left, −1 right, 0 collinear, UNSURE if not decided.

    The coordinates are at most 1 in absolute value, and each differs by at most ε from the true
    one, where ``slack`` = 0 says ε = 0 and otherwise slack ≥ 18 ε + 2⁻¹⁰⁶⁰.

    *Error bound.*  Write u = 2⁻⁵³, D = (q − p)ₓ(r − p)ᵧ − (q − p)ᵧ(r − p)ₓ for the true value
    and d₁ … d₄ for the computed differences: each is off by δ ≤ 2ε + u|dᵢ|, as subtraction does
    not underflow.  A product a = fl(d₁d₂) differs from d₁d₂ by at most u|a| + 2⁻¹⁰⁷⁵ and d₁d₂
    from the true product by at most |d₁|δ₂ + |d₂|δ₁ + δ₁δ₂ ≤ (2u + u²)|d₁d₂| + 8.1 ε + 4 ε²,
    since |dᵢ| ≤ 2(1 + u) and ε < 2⁻¹⁰.  The last subtraction adds u|det|.  Altogether
    |det − D| ≤ (4u + 9u²)(|a| + |b|) + 17 ε + 2⁻¹⁰⁷² < 5u·fl(|a| + |b|) + 18 ε + 2⁻¹⁰⁶⁰.

    *Exact stage*, only with slack = 0.  A product of which one factor is zero is exact, and a
    computed difference is zero only if it truly is.  If all four differences are exact (the
    error of a subtraction is computed without error by Knuth's two-sum) and each is zero or in
    [2⁻⁴⁰⁰, 2], each product is the exact sum of its rounding h and a tail t (Dekker 1971; no
    tail underflows, as the products are multiples of 2⁻⁹⁰⁴); rounding is monotone, so (h, t)
    are compared lexicographically.
    """
    if p in (q, r) or q == r:
        return 0
    d1, d2 = x[q] - x[p], y[r] - y[p]
    d3, d4 = y[q] - y[p], x[r] - x[p]
    a, b = d1 * d2, d3 * d4
    determinant = a - b
    bound = _ROUND * (abs(a) + abs(b)) + (slack if slack > 0.0 else 2.0**-1060)
    if determinant > bound:
        return 1
    if determinant < -bound:
        return -1
    if slack == 0.0:
        exact = (
            (d1 == 0.0 or d2 == 0.0 or (_exact_difference(x[q], x[p], d1) and abs(d1) > _SAFE))
            and (d1 == 0.0 or d2 == 0.0 or (_exact_difference(y[r], y[p], d2) and abs(d2) > _SAFE))
            and (d3 == 0.0 or d4 == 0.0 or (_exact_difference(y[q], y[p], d3) and abs(d3) > _SAFE))
            and (d3 == 0.0 or d4 == 0.0 or (_exact_difference(x[r], x[p], d4) and abs(d4) > _SAFE))
        )
        if exact:
            if a == b:
                a, b = _tail(d1, d2, a), _tail(d3, d4, b)
            return 1 if a > b else (-1 if a < b else 0)
    for row in range(len(known)):
        if known[row][0] == p and known[row][1] == q and known[row][2] == r:
            return known[row][3]
    return UNSURE


def _exact_difference(a: float, b: float, difference: float) -> bool:
    """Whether a − b has no rounding error (Knuth's two-sum)."""
    back = a - difference
    return (a - (difference + back)) + (back - b) == 0.0


def _tail(a: float, b: float, product: float) -> float:
    """a·b minus its rounding ``product``, exactly (Dekker's product)."""
    high = _SPLIT * a
    a1 = high - (high - a)
    a2 = a - a1
    high = _SPLIT * b
    b1 = high - (high - b)
    b2 = b - b1
    return a2 * b2 - (((product - a1 * b1) - a2 * b1) - a1 * b2)


Verdict = tuple[int, int, int, int]


def conflict(
    x: list[float],
    y: list[float],
    slack: float,
    known: Known,
    left: list[int],
    right: list[int],
    closed: bool,
    s: int,
    t: int,
) -> Verdict:
    """Whether segments s and t are in conflict: (1 or 0, …), or (UNSURE, p, q, r) to be told.

    ``left`` and ``right`` are the ranks of the endpoints.  Conflict means that the relative
    interiors meet; with ``closed`` also that the segments meet at all, unless at a shared
    endpoint.  Along a line, order by rank is order along the line.
    """
    a, b, c, d = left[s], right[s], left[t], right[t]
    shared = a in (c, d) or b in (c, d)
    o1 = turn(x, y, slack, known, a, b, c)
    if o1 == UNSURE:
        return UNSURE, a, b, c
    o2 = turn(x, y, slack, known, a, b, d)
    if o2 == UNSURE:
        return UNSURE, a, b, d
    if o1 == 0 and o2 == 0:
        low, high = max(a, c), min(b, d)
        return (1 if low < high or (closed and low == high and not shared) else 0), 0, 0, 0
    if shared or o1 * o2 > 0 or (o1 * o2 == 0 and not closed):
        return 0, 0, 0, 0
    o3 = turn(x, y, slack, known, c, d, a)
    if o3 == UNSURE:
        return UNSURE, c, d, a
    o4 = turn(x, y, slack, known, c, d, b)
    if o4 == UNSURE:
        return UNSURE, c, d, b
    return (1 if o3 * o4 < 0 or (closed and o3 * o4 == 0) else 0), 0, 0, 0


def rotate(lower: list[int], upper: list[int], parent: list[int], node: int) -> None:
    """Lift ``node`` over its parent in the treap, keeping the order of the nodes."""
    top = parent[node]
    if lower[top] == node:
        moved = upper[node]
        lower[top], upper[node] = moved, top
    else:
        moved = lower[node]
        upper[top], lower[node] = moved, top
    if moved >= 0:
        parent[moved] = top
    parent[node], parent[top] = parent[top], node
    if parent[node] >= 0:
        if lower[parent[node]] == top:
            lower[parent[node]] = node
        else:
            upper[parent[node]] = node


Outcome = tuple[int, int, int, int, int]


def sweep(
    start: int,
    x: list[float],
    y: list[float],
    slack: float,
    known: Known,
    left: list[int],
    right: list[int],
    closed: bool,
    events: list[int],
    priority: list[int],
    lower: list[int],
    upper: list[int],
    parent: list[int],
    below: list[int],
    above: list[int],
    root: list[int],
) -> Outcome:
    """Sweep on from event ``start``: (event, status, i, j, k).

    Status 0: no conflict.  1: segments i and j are in conflict.  UNSURE: nothing of ``event`` has
    been done yet, the orientation of points i, j, k is needed (among ``known``) to go on.

    ``events`` holds −1 − s where segment s ends and s where it starts, in order; ends come before
    starts at one point.  The treap is (``lower``, ``upper``, ``parent``, ``root[0]``) and the
    list of its nodes in order (``below``, ``above``); −1 stands for none.

    Why adjacent pairs suffice although segments may touch: take the first point p at which
    interiors of two segments meet.  Just before p these two are in the tree, and those between
    them run through p too or end there.  If one runs through, take it instead; if all end, they
    are removed first when p is reached.  Either way two that are in conflict become adjacent no
    later than at p before anything starts there, and the order was correct until then.  Overlap
    begins at a left endpoint, which is compared with its neighbours at its insertion.

    O(n log n) expected time (over the random ``priority``).
    """
    for event in range(start, len(events)):
        s = events[event]
        if s < 0:  # segment s ends
            s = -1 - s
            i, j = below[s], above[s]
            if i >= 0 and j >= 0:
                verdict = conflict(x, y, slack, known, left, right, closed, i, j)
                if verdict[0] == UNSURE:
                    return event, UNSURE, verdict[1], verdict[2], verdict[3]
                if verdict[0] == 1:
                    return event, 1, i, j, 0
            while lower[s] >= 0 or upper[s] >= 0:  # sink it to a leaf, then cut it off
                i, j = lower[s], upper[s]
                if j < 0 or (i >= 0 and priority[i] > priority[j]):
                    rotate(lower, upper, parent, i)
                    j = i
                else:
                    rotate(lower, upper, parent, j)
                if root[0] == s:
                    root[0] = parent[s]
            if parent[s] < 0:
                root[0] = -1
            elif lower[parent[s]] == s:
                lower[parent[s]] = -1
            else:
                upper[parent[s]] = -1
            if below[s] >= 0:
                above[below[s]] = above[s]
            if above[s] >= 0:
                below[above[s]] = below[s]
            continue
        # segment s starts: find its place, comparing its left endpoint, then its direction
        node, under, over = root[0], -1, -1
        p, q = left[s], right[s]
        while node >= 0:
            a, b = left[node], right[node]
            side = turn(x, y, slack, known, a, b, p)
            if side == UNSURE:
                return event, UNSURE, a, b, p
            if side == 0:
                verdict = conflict(x, y, slack, known, left, right, closed, node, s)
                if verdict[0] == UNSURE:
                    return event, UNSURE, verdict[1], verdict[2], verdict[3]
                if verdict[0] == 1:
                    return event, 1, node, s, 0
                side = turn(x, y, slack, known, a, b, q)
                if side == UNSURE:
                    return event, UNSURE, a, b, q
            if side > 0:
                under, node = node, upper[node]
            else:
                over, node = node, lower[node]
        for neighbour in (under, over):
            if neighbour >= 0:
                verdict = conflict(x, y, slack, known, left, right, closed, neighbour, s)
                if verdict[0] == UNSURE:
                    return event, UNSURE, verdict[1], verdict[2], verdict[3]
                if verdict[0] == 1:
                    return event, 1, neighbour, s, 0
        # the leaf lies over `under` if that has no upper child, else under `over`
        below[s], above[s], lower[s], upper[s], parent[s] = under, over, -1, -1, -1
        if under >= 0:
            above[under] = s
        if over >= 0:
            below[over] = s
        if under >= 0 and upper[under] < 0:
            upper[under], parent[s] = s, under
        elif over >= 0:
            lower[over], parent[s] = s, over
        else:
            root[0] = s
        while parent[s] >= 0 and priority[parent[s]] < priority[s]:
            rotate(lower, upper, parent, s)
        if parent[s] < 0:
            root[0] = s
    return len(events), 0, 0, 0, 0


#: What :func:`sweep` calls, for the compiler.
HELPERS = (_exact_difference, _tail, turn, conflict, rotate)
