"""Hypothesis strategies for instances rich in degeneracies, and slow oracles in fractions."""

from fractions import Fraction
from itertools import combinations

from hypothesis import strategies as st

from harness.geometry.instance import Instance

small = st.integers(0, 6)
lattice_points = st.tuples(small, small)


def cross(p, q, r):
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])


def sign(value):
    return (value > 0) - (value < 0)


def turn(p, q, r):
    return sign(cross(p, q, r))


#: Ways to write a small integer as a coordinate: exactly similar, or nearly so.
PLACEMENTS = {
    "integer": float,
    "tenths": lambda v: 0.1 * v + 0.3,  # rounds: almost collinear points
    "far away": lambda v: v + 2.0**50,
    "far and tiny": lambda v: 1.0 + v * 2.0**-52,
    "huge": lambda v: v * 1e300,
    "tiny": lambda v: v * 1e-300,
    "subnormal": lambda v: v * 5e-324,
    "mixed": lambda v: [0.0, 1e-300, 5e-324, 1.0, 1e300, -1e300, -1e-300][v],
    "sevenths": lambda v: Fraction(v, 7),
    "decimal strings": lambda v: f"{v}.1",
    "almost vanishing": lambda v: Fraction(v, 10**400),
}
placements = st.sampled_from(sorted(PLACEMENTS)).map(PLACEMENTS.__getitem__)


@st.composite
def lattice_polygons(draw, max_size=9):
    """Closed polygons on a few points: about half of them star-like, many not simple."""
    points = draw(st.lists(lattice_points, min_size=3, max_size=max_size))
    if draw(st.booleans()):
        points = around_centre(points)
    place = draw(placements)
    return Instance.from_arrays("polygon", [[place(x), place(y)] for x, y in points])


def around_centre(points):
    """The distinct points sorted by direction about a point near the middle."""
    from math import atan2

    points = sorted(set(points))
    cx, cy = 3.0001, 2.9998
    return sorted(points, key=lambda p: atan2(p[1] - cy, p[0] - cx))


@st.composite
def lattice_segments(draw, max_size=6):
    """Sets of segments on a few points, most of them in conflict somewhere."""
    ends = st.tuples(lattice_points, lattice_points)
    segments = draw(st.lists(ends, min_size=1, max_size=max_size))
    place = draw(placements)
    return Instance.from_arrays(
        "segments", [[[place(x), place(y)] for x, y in pair] for pair in segments]
    )


def conflicting_pairs(instance):
    """All pairs of segments that may not be as they are: quadratic, in fractions."""
    closed = instance.kind == "polygon"
    segments = [tuple(sorted(pair)) for pair in instance.rational_segments()]
    found = set()
    for i, j in combinations(range(len(segments)), 2):
        (a, b), (c, d) = segments[i], segments[j]
        o1, o2, o3, o4 = turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)
        shared = {a, b} & {c, d}
        if o1 == o2 == 0:
            low, high = max(a, c), min(b, d)
            bad = low < high or (closed and low == high and not shared)
        elif closed:
            bad = not shared and o1 * o2 <= 0 and o3 * o4 <= 0
        else:
            bad = o1 * o2 < 0 and o3 * o4 < 0
        if bad:
            found.add((i, j))
    return found


def clipped(instance, edges=None):
    """The intersection of the half-planes left of the edges, by clipping: its corners.

    Starts from a square that holds the whole bounding box well inside.
    """
    segments = instance.rational_segments()
    reach = 1 + max(abs(x) for pair in segments for point in pair for x in point)
    reach *= 10**9 if edges is not None else 1
    polygon = [(-reach, -reach), (reach, -reach), (reach, reach), (-reach, reach)]
    for index in range(len(segments)) if edges is None else edges:
        polygon = _clip(polygon, *segments[index])
    size = len(polygon)
    if size <= 2:
        return polygon
    kept = [
        polygon[k]
        for k in range(size)
        if turn(polygon[k - 1], polygon[k], polygon[(k + 1) % size]) != 0
    ]
    return kept or [min(polygon), max(polygon)]


def _clip(polygon, a, b):
    kept = []
    for p, q in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        before, after = cross(a, b, p), cross(a, b, q)
        if before >= 0:
            kept.append(p)
        if before * after < 0:
            t = before / (before - after)
            kept.append((p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])))
    return list(dict.fromkeys(kept))
