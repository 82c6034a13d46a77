"""Root triangles from the arrangement of lines: what they are said to be, exactly."""

import random
from dataclasses import replace
from fractions import Fraction
from itertools import combinations, count, islice, pairwise

import numpy as np
import pytest

from generators.registry import generate
from harness.diagram import build
from harness.diagram.fast.arranged import ArrangedCorners
from harness.diagram.fast.arrangement import arrange
from harness.diagram.fast.boxes import sift_triangles
from harness.diagram.fast.faces import arranged_interior, arranged_roots
from harness.diagram.fast.line_points import points_on, within_hull
from harness.diagram.fast.lines import lines_of
from harness.diagram.fast.plane import plane_roots
from harness.diagram.fast.prepare import prepare
from harness.diagram.fast.ties import tie_arrays
from harness.errors import UserError
from harness.geometry.instance import Instance
from harness.geometry.predicates import compare_visual_angles, orientation
from tests.diagram.fast.agreement import Case, examined
from tests.diagram.fast.sources import SOURCES, instance

POLYGONS = ("star", "zigzag", "convex-valtr", "lattice-star", "lattice-simple", "symmetric", "far")


def made(source, index=0):
    return instance(source, 11, index)


def placed(lines, points):
    """The exact points of an arrangement, in its integer coordinates."""
    for i, j in points.pairs.tolist():
        if i < 0:
            yield points.others[j]
        else:
            x, y, w = lines.crossing(i, j)
            yield Fraction(x, w), Fraction(y, w)


def homogeneous(roots, corner):
    x, y = roots.corners.exact[corner]
    return x, y, Fraction(roots.corners.weights[corner])


def determinant(a, b, c):
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def areas(roots):
    return [
        determinant(*(homogeneous(roots, corner) for corner in row))
        for row in roots.triangles.tolist()
    ]


@pytest.mark.parametrize("source", SOURCES)
@pytest.mark.parametrize("index", [0, 1])
def test_points_are_in_order_and_all_there(source, index):
    prepared = prepare(made(source, index), parallels=True)
    lines = lines_of(prepared)
    points = points_on(lines)
    exact = list(placed(lines, points))
    rows = [
        points.vertex[a:b].tolist() for a, b in zip(points.first, points.first[1:], strict=False)
    ]
    for i, row in enumerate(rows):
        assert all(lines.contains(i, exact[v]) for v in row)
        along = [lines.parameter_of_point(i, exact[v]) for v in row]
        assert all(one < two for one, two in pairwise(along))
    assert len(set(exact)) == len(exact)
    for i, j in combinations(range(len(rows)), 2):
        assert len(set(rows[i]) & set(rows[j])) == (lines.rank[i] != lines.rank[j])


def fine_digit(exponent):
    """Segments of which one coordinate is very much smaller than the others."""
    rows = [[[-(2.0**exponent), 0], [1, 1]], [[3, 1], [4, 1]], [[2, -1], [2.5, -3]]]
    return Instance.from_arrays("segments", rows)


def many_digits():
    """Segments whose coordinates have a common denominator far beyond the doubles."""
    rng = random.Random(1)

    def free():
        return Fraction(rng.randrange(10**20), rng.randrange(10**20, 10**21))

    return Instance.from_arrays(
        "segments", [[[k + free(), free()], [k + free(), 3 + free()]] for k in range(5)]
    )


@pytest.mark.parametrize("exponent", [-520, -1000])
def test_fine_digits_change_nothing(exponent):
    fine, plain = fine_digit(exponent), fine_digit(-300)
    expected = build(plain, builder="reference").counts
    assert replace(build(fine).counts, builder="reference") == expected
    lines = lines_of(prepare(fine, parallels=True))
    points = points_on(lines)
    exact = list(placed(lines, points))
    for i in range(len(lines.d)):
        row = points.vertex[points.first[i] : points.first[i + 1]].tolist()
        along = [lines.parameter_of_point(i, exact[v]) for v in row]
        assert all(one < two for one, two in pairwise(along))


def test_many_digits_are_counted():
    plain = Instance.from_arrays("segments", many_digits().floats)
    expected = build(plain, builder="reference").counts
    assert replace(build(many_digits()).counts, builder="reference") == expected


@pytest.mark.parametrize("length", [Fraction(1), Fraction(1, 10**13), Fraction(1, 10**30)])
def test_segments_on_one_line_are_known_however_short(length):
    def on_line(t):
        return [Fraction(1, 3) + t, Fraction(1, 7) + 2 * t]

    half = Fraction(3, 2)
    rows = [
        [on_line(0), on_line(length)],
        [on_line(half), on_line(half + length * Fraction(7, 3))],
        [[3, 1], [4, 2]],
        [[-3, 1], [-1, 2]],
    ]
    prepared = prepare(Instance.from_arrays("segments", rows), parallels=True)
    assert prepared.lines[0] == prepared.lines[1] >= 0
    assert prepared.lines[2] == prepared.lines[3] == -1
    assert sorted(map(len, lines_of(prepared, squares=False).segments)) == [1, 1, 2]


def test_lines_that_meet_too_far_away_are_refused():
    rows = [[[0, 0], [1, 0]], [[0, 1], [1, f"1.{'0' * 399}1"]]]
    with pytest.raises(UserError, match="powers of two"):
        build(Instance.from_arrays("segments", rows))


@pytest.mark.parametrize("source", SOURCES)
def test_faces_are_convex_cells_of_the_plane(source):
    prepared = prepare(made(source), parallels=True)
    lines = lines_of(prepared)
    points = points_on(lines)
    found = arrange(lines, points)
    exact = list(placed(lines, points))
    # Euler's formula with one vertex at infinity, where all rays end.
    assert len(exact) + 1 - len(found.line) + found.faces == 2
    for f in range(found.faces):
        corners = list(found.cycle[found.first[f] : found.first[f + 1]].tolist())
        finite = [exact[v] for v in (int(found.heads[h]) for h in corners) if v >= 0]
        for i, (dx, dy) in enumerate(lines.d):
            sides = {(s > 0) - (s < 0) for s in (dx * y - dy * x - lines.c[i] for x, y in finite)}
            assert not {-1, 1} <= sides  # no line runs through a face


@pytest.mark.parametrize("source", SOURCES)
@pytest.mark.parametrize("seed", [0, 3])
def test_triangles_of_the_plane_fit_together(source, seed):
    roots = arranged_roots(prepare(made(source), parallels=True), seed)
    assert min(areas(roots)) > 0
    roots.opposite()  # every side has two triangles, but those at infinity


@pytest.mark.parametrize("source", POLYGONS)
@pytest.mark.parametrize("index", [0, 1, 2])
def test_triangles_fill_a_polygon(source, index):
    several = (made(source, k) for k in count())
    polygon = next(islice((p for p in several if p.kind == "polygon"), index, None))
    roots = arranged_interior(prepare(polygon, parallels=False), index)
    assert min(areas(roots)) > 0
    roots.opposite()
    p = [polygon.exact_vertex(k) for k in range(polygon.n)]
    twice = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(p, [*p[1:], p[0]], strict=True))
    assert sum(areas(roots)) == abs(twice)


@pytest.mark.parametrize("source", ["segments", "square-grid", "aligned", "lattice-star"])
def test_no_line_crosses_a_triangle_but_at_its_own_segment(source):
    prepared = prepare(made(source), parallels=True)
    roots = arranged_roots(prepared, 0)
    for row in roots.triangles.tolist():
        corners = [homogeneous(roots, c) for c in row]
        for k, (a, b) in enumerate(prepared.instance.rational_segments()):
            line = [determinant((*a, Fraction(1)), (*b, Fraction(1)), c) for c in corners]
            if min(line) < 0 < max(line):
                # A triangle beside a piece of the segment k: its side ends on the segment.
                on = [c for c, side in zip(row, line, strict=True) if side == 0]
                assert on
                assert any(
                    2 * k in roots.corners.incident[c] or 2 * k + 1 in roots.corners.incident[c]
                    for c in on
                )


@pytest.mark.parametrize("domain", ["plane", "interior"])
def test_a_hub_becomes_a_corner_and_nothing_else_changes(domain):
    polygon = made("lattice-star", 4)
    prepared = prepare(polygon, parallels=True)
    hubs = [(Fraction(1, 97), Fraction(1, 89)), (Fraction(1, 96), Fraction(1, 89))]
    if domain == "plane":
        hubs.append((Fraction(10**7, 3), Fraction(10**9, 7)))
        roots = arranged_roots(prepared, 0, hubs, [(Fraction(1), Fraction(1, 7))])
    else:
        roots = arranged_interior(prepared, 0, hubs)
        assert sum(areas(roots)) == sum(areas(arranged_interior(prepared, 0)))
    assert min(areas(roots)) > 0
    roots.opposite()
    exact = list(roots.corners.exact)
    for hub in hubs:
        number = exact.index(hub)
        assert roots.corners.special[number]
        around = roots.triangles[(roots.triangles == number).any(axis=1)]
        assert len(around) >= 3
        assert not roots.corners.special[np.setdiff1d(around, [number])].any()


def test_coordinates_are_those_of_the_exact_points():
    polygon = made("rational")
    prepared = prepare(polygon, parallels=True)
    lines = lines_of(prepared)
    corners = ArrangedCorners(prepared, lines, points_on(lines))
    for (high_x, low_x, high_y, low_y), (x, y) in zip(corners.frame, corners.exact, strict=True):
        for value, high, low, centre in (
            (x, high_x, low_x, prepared.centre[0]),
            (y, high_y, low_y, prepared.centre[1]),
        ):
            true = (value - centre) * prepared.scale
            assert abs(Fraction(high) + Fraction(low) - true) <= abs(true) / 2**100


def test_near_the_hull_nothing_is_left_out():
    """Crossings in the polygon's bounding box that are inside its hull are found on both lines."""
    polygon = Instance.from_generated(generate("star", 9, 5))
    prepared = prepare(polygon, parallels=False)
    lines = lines_of(prepared, squares=False)
    every, some = points_on(lines), points_on(lines, within=within_hull(lines))
    inside = set(placed(lines, some))
    hull = _hull([p for segment in lines.ends for p in segment])
    sides = [*pairwise(hull), (hull[-1], hull[0])]
    for point in placed(lines, every):
        if all(orientation(a, b, point) >= 0 for a, b in sides):
            assert point in inside
    assert len(inside) < len(every.pairs)


def _hull(points):
    points = sorted({(Fraction(x), Fraction(y)) for x, y in points})
    chains = []
    for row in (points, points[::-1]):
        chain = []
        for p in row:
            while len(chain) > 1 and orientation(chain[-2], chain[-1], p) <= 0:
                chain.pop()
            chain.append(p)
        chains += chain[:-1]
    return chains


def nearly_parallel(n, difference, seed=2):
    """Segments whose directions differ by so little that their lines meet very far away."""
    rng = random.Random(seed)
    rows = []
    for k in range(n):
        x, length = rng.uniform(-1, 1), 10 ** rng.uniform(-2, 0)
        slope = 1 + difference * rng.uniform(-1, 1)
        rows.append([[x, 0.3 * k], [x + length, 0.3 * k + length * slope]])
    return Instance.from_arrays("segments", rows)


@pytest.mark.parametrize(
    "made_here",
    [
        *(
            pytest.param(Instance.from_generated(generate(family, n, 3)), id=family)
            for family, n in (("grid", 24), ("segments", 24), ("zigzag", 14))
        ),
        *(pytest.param(nearly_parallel(9, d), id=f"parallel up to {d}") for d in (1e-8, 1e-11)),
    ],
)
def test_no_winner_is_sifted_out(made_here):
    """The segment seen under the least angle from a point is a candidate of its triangle."""
    rng, n = random.Random(5), made_here.n
    prepared = prepare(made_here, parallels=True)
    roots = arranged_roots(prepared, 0)
    frame, weights, _, _ = roots.corners.arrays(prepared.centre, prepared.scale)
    first, rows = tie_arrays(set(), len(weights))
    world = (prepared.lines, prepared.lengths, prepared.classes, first, rows)
    start, number, flat = sift_triangles(
        *(roots.triangles, frame, weights, n, prepared.segments, prepared.size, 1.0, False),
        world,
        1,
    )
    assert number.mean() < 0.75 * n
    segments = made_here.rational_segments()
    reach = np.abs(frame[roots.triangles]).max(axis=(1, 2))
    outermost = np.argsort(-np.where(weights[roots.triangles].all(axis=1), reach, 0)).tolist()
    for t in rng.sample(outermost, 150) + rng.sample(outermost[: len(outermost) // 2], 150):
        shares = [Fraction(rng.randint(1, 99)) for _ in range(3)]
        corners = [homogeneous(roots, c) for c in roots.triangles[t].tolist()]
        x, y, w = (
            sum((s * c[axis] for s, c in zip(shares, corners, strict=True)), Fraction(0))
            for axis in range(3)
        )
        if w == 0:
            continue
        point = (x / w, y / w)
        best = 0
        for k in range(1, n):
            order = compare_visual_angles(point, segments[best], segments[k])
            best = k if order is not None and order > 0 else best
        assert best in flat[start[t] : start[t] + number[t]]


@pytest.mark.parametrize("difference", [1e-9, 1e-11, 1e-13])
def test_nearly_parallel_segments_are_counted(difference):
    case = Case(nearly_parallel(8, difference), "plane", "smallest")
    outcome = examined(case, tolerance=10)
    assert not outcome.differences
    assert not outcome.handed_over


def test_endpoints_that_doubles_do_not_tell_apart_are_corners():
    near = [[[0.25, 0.25], [1, 0.125]], [[0.25, 0.25 + 2.0**-54], [0.125, 1]], [[2, 3], [1.5, -1]]]
    made_here = Instance.from_arrays("segments", near)
    roots = plane_roots(made_here, 0)
    ends = {point for segment in made_here.rational_segments() for point in segment}
    assert ends <= {roots.corners.exact[c] for c in np.unique(roots.triangles).tolist()}
    assert min(areas(roots)) > 0
    roots.opposite()
    outcome = examined(Case(made_here, "plane", "largest"), tolerance=10)
    assert not outcome.differences
    assert not outcome.handed_over


@pytest.mark.parametrize("objective", ["smallest", "largest"])
def test_a_vertex_inside_a_side_of_the_kernel_that_doubles_do_not_see(objective):
    half, slack = Fraction(1, 2), Fraction(1, 10**20)
    left = [(half - slack - Fraction(y, 10), y) for y in (2, 1)]
    right = [(half + slack + Fraction(y, 10), y) for y in (1, 2)]
    polygon = Instance.from_arrays("polygon", [[-1, 0], [half, 0], [2, 0], *right, *left])
    outcome = examined(Case(polygon, "kernel", objective), tolerance=10)
    assert not outcome.differences
    assert not outcome.handed_over
