"""Recognising leaves; see :mod:`harness.diagram.fast.leaves` for the proofs.

``slots``, the result: row r is the r-th port counter-clockwise from corner 0, with its *place*
(0, 2, 4: at corner 0, 1, 2; 1, 3, 5: on the side that follows) and the candidate that owns the
piece after it.  Without ports, row 0 names the owner.
"""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.forms import (
    SIDES,
    UNKNOWN,
    collinear_quadratic,
    cubic,
    divided_by_distance,
    gradient_controls,
    relation,
    sure_signs,
    value_and_gradient,
)
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import (
    ARC,
    CROSSING,
    EMPTY,
    FAILED,
    MOST_PORTS,
    OPEN,
    QUAD,
    SADDLE,
    TRIPLE,
    TWO_ARCS,
    germ,
    has_two_zeros,
    has_cone,
    hull_determinant,
    is_radial,
    meet,
    side_value,
    side_zero,
    sign_changes,
)

_ORDER = np.array([2, 0, 1])


@compiled
def new_scratch():
    """Working space: values, signs, bounds of all pairs, controls, and small vectors."""
    return (
        np.zeros((4, 4, 10)),
        np.zeros((4, 4, 10), np.int64),
        np.zeros((4, 4)),
        np.zeros((4, 4, 6, 2)),
        np.zeros((MOST_PORTS, 2), np.int64),
        np.zeros(3),
        np.zeros(2),
        np.zeros(MOST_PORTS, np.int64),
    )


@compiled
def all_pairs(tables, start, m, sides, norms, factor, far, world, spots, ids, w):
    """F of all pairs a < b of candidates, and its opposite for b > a, into the scratch ``w``.

    ``sides``: the sign of L of every candidate on the triangle.
    """
    values, signs, bounds = w[0], w[1], w[2]
    lines, lengths, classes, tie_first, ties = world
    for a in range(m):
        for b in range(a + 1, m):
            i, j = ids[start + a], ids[start + b]
            t, s = tables[start + a], tables[start + b]
            if lines[i] >= 0 and lines[i] == lines[j]:
                bound = factor * (norms[start + a, 1] * lengths[j] + norms[start + b, 1] * lengths[i])
                collinear_quadratic(t, s, lengths[i], lengths[j], bound, values[a, b], signs[a, b])
            else:
                bound = factor * (
                    norms[start + a, 1] * norms[start + b, 0]
                    + norms[start + b, 1] * norms[start + a, 0]
                )
                known = relation(i, j, classes, tie_first, ties, spots)
                cubic(t, s, sides[a], sides[b], bound, far, known, values[a, b], signs[a, b])
                if known & 1 and _vanishes_far(signs[a, b], far):
                    near = 0 if far == 6 else (1 if far == 5 else 2)
                    divided_by_distance(values[a, b], signs[a, b], near)
                    bound *= 9.0
                    sure_signs(values[a, b], bound, signs[a, b])
            bounds[a, b] = bounds[b, a] = bound
            for c in range(10):
                values[b, a, c] = -values[a, b, c]
                sign = signs[a, b, c]
                signs[b, a, c] = sign if sign == UNKNOWN else -sign


@compiled
def _vanishes_far(signs, far):
    """Whether a cubic is zero by construction on a side at infinity."""
    if far == 6:
        k = 0
    elif far == 5:
        k = 1
    elif far == 3:
        k = 2
    else:
        return False
    return (
        signs[SIDES[k, 0]] == 0
        and signs[SIDES[k, 1]] == 0
        and signs[SIDES[k, 2]] == 0
        and signs[SIDES[k, 3]] == 0
    )


@compiled
def _winner_near(signs, m, k, at_end):
    """The candidate that wins near one end of side k, or −1."""
    for a in range(m):
        wins = True
        for b in range(m):
            if b != a and germ(signs[a, b], k, at_end) != 1:
                wins = False
                break
        if wins:
            return a
    return -1


@compiled
def _never_loses(signs, k):
    """Whether a cubic is certainly ≥ 0 on side k, and > 0 somewhere."""
    some = False
    for r in range(4):
        sign = signs[SIDES[k, r]]
        if sign == -1 or sign == UNKNOWN:
            return False
        some = some or sign == 1
    return some


@compiled
def _loses_at(values, bounds, winner, loser, k, t):
    """1 if ``loser`` certainly loses at parameter t of side k, −1 if it wins, 0 if unsure."""
    value = side_value(values[winner, loser], k, t)
    if value > 2.0 * bounds[winner, loser]:
        return 1
    return -1 if value < -2.0 * bounds[winner, loser] else 0


@compiled
def _crosses_once(u, v, k, w):
    return sign_changes(w[1][u, v], w[0][u, v], w[2][u, v], k) == 1


@compiled
def _side_pieces(m, k, u, v, w):
    """The piece strictly between the pieces u and v at the ends of side k.

    Returns −1 if there is none, −2 if that is not certain or there are several.

    Let t be the zero of F_uv.  A candidate x with at most one zero of F_ux and of F_vx on the side
    loses to u before t if it loses to u at t, and to v after t if it loses to v at t.
    """
    values, signs, bounds = w[0], w[1], w[2]
    if u == v:
        between = -1
        for x in range(m):
            if x != u and not _never_loses(signs[u, x], k):
                if between >= 0 or not has_two_zeros(values[u, x], bounds[u, x], k):
                    return -2
                between = x
        return between
    if not _crosses_once(u, v, k, w):
        return -2
    t = side_zero(values[u, v], k, False)
    between = -1
    for x in range(m):
        if x in (u, v) or _never_loses(signs[u, x], k) or _never_loses(signs[v, x], k):
            continue
        if not (_crosses_once(u, x, k, w) and _crosses_once(v, x, k, w)):
            return -2
        to_u = _loses_at(values, bounds, u, x, k, t)
        to_v = _loses_at(values, bounds, v, x, k, t)
        if to_u == 1 and to_v == 1:
            continue
        if to_u != -1 or to_v != -1:
            return -2
        if between < 0 or side_value(values[x, between], k, t) > 0.0:
            between = x
    if between < 0:
        return -1
    x = between
    before, after = side_zero(values[u, x], k, False), side_zero(values[x, v], k, False)
    for y in range(m):
        if y in (u, v, x) or _never_loses(signs[u, y], k) or _never_loses(signs[v, y], k):
            continue
        if _loses_at(values, bounds, u, y, k, t) == 1 and _loses_at(values, bounds, v, y, k, t) == 1:
            continue
        if sign_changes(signs[x, y], values[x, y], bounds[x, y], k) < 0:
            return -2
        # y must lose to u up to ``before``, to x up to ``after``, and then to v.
        if (
            _loses_at(values, bounds, u, y, k, before) != 1
            or _loses_at(values, bounds, x, y, k, before) != 1
            or _loses_at(values, bounds, x, y, k, after) != 1
            or _loses_at(values, bounds, v, y, k, after) != 1
        ):
            return -2
    return x


@compiled
def trace_sides(m, w):
    """Ports and pieces around the triangle into the slots: the number of ports, or −1."""
    slots = w[4]
    signs = w[1]
    count = 0
    start = _winner_near(signs, m, 2, False)
    if start < 0:
        return -1
    before = _winner_near(signs, m, 1, True)
    if before < 0:
        return -1
    current = before
    for position in range(3):
        k = _ORDER[position]
        u = start if position == 0 else _winner_near(signs, m, k, False)
        v = before if position == 2 else _winner_near(signs, m, k, True)
        if u < 0 or v < 0:
            return -1
        if u != current:
            slots[count, 0], slots[count, 1] = 2 * position, u
            count += 1
        between = _side_pieces(m, k, u, v, w)
        if between == -2 or count > 8:
            return -1
        if between >= 0:
            slots[count, 0], slots[count, 1] = 2 * position + 1, between
            count += 1
        if u != v or between >= 0:
            slots[count, 0], slots[count, 1] = 2 * position + 1, v
            count += 1
        current = v
    if count == 0:
        slots[0, 0], slots[0, 1] = 1, start
    return count


@compiled
def _corners_are_plain(m, w):
    """At every corner at most two candidates compete, where there are more than two in all.

    That is so where at most one pair has a structural zero at the corner, or where one candidate
    has them with all others (the corner is an endpoint of its segment) but these do not tie.
    """
    signs = w[1]
    for corner in range(3):
        zeros = 0
        for a in range(m):
            for b in range(a + 1, m):
                zeros += signs[a, b, corner] == 0
        if zeros <= 1:
            continue
        common = False
        for a in range(m):
            count = 0
            for b in range(m):
                count += b != a and signs[a, b, corner] == 0
            common = common or count == zeros
        if not common:
            return False
    return True


@compiled
def _keeps_its_sign(signs):
    """Whether a cubic certainly has no zero inside the triangle."""
    positive = negative = False
    for c in range(10):
        if signs[c] == UNKNOWN:
            return False
        positive = positive or signs[c] == 1
        negative = negative or signs[c] == -1
    return positive != negative


@compiled
def _all_cones(m, w):
    for a in range(m):
        for b in range(a + 1, m):
            cone = has_cone(w[0][a, b], w[2][a, b], w[3][a, b])
            if not cone and not _keeps_its_sign(w[1][a, b]):
                return False
    return True


@compiled
def _is_simple(signs, values, bound, controls):
    """Whether the zero set of a cubic is known to be one arc for every two ports, and no loop."""
    if has_cone(values, bound, controls) or _keeps_its_sign(signs):
        return True
    for corner in range(3):
        if is_radial(signs, corner):
            return True
    return False


@compiled
def _ties_once(a, b, c, w):
    """Whether three candidates certainly tie in at most one point (hull)."""
    for x, y, z in ((a, b, c), (b, c, a), (c, a, b)):
        i, j, k, l = min(x, y), max(x, y), min(x, z), max(x, z)
        if hull_determinant(w[3][i, j], w[3][k, l], w[2][i, j], w[2][k, l]) != 0.0:
            return True
    return False


@compiled
def is_blurred(m, w):
    """Whether rounding blurs some F beyond what halving can mend: all of it is near its bound."""
    for a in range(m):
        for b in range(a + 1, m):
            largest = 0.0
            for c in range(10):
                largest = max(largest, abs(w[0][a, b, c]))
            if largest <= 32.0 * w[2][a, b]:
                return True
    return False


@compiled
def may_tie_at_corner(m, w, exponents, lam, corners, special):
    """Whether some F may be zero at a special corner without our knowing.

    Halving would not end: whether it is so must be found out otherwise.  ``exponents``: 0 at the
    triangle's corners that are corners of the root, which has the numbers ``corners``.
    """
    for k in range(3):
        if exponents[k] != 0:
            continue
        for c in range(3):
            if lam[3 * k + c] == 1.0 and special[corners[c]]:
                for a in range(m):
                    for b in range(a + 1, m):
                        if w[1][a, b, k] == UNKNOWN:
                            return True
    return False


@compiled
def classify_definite(m, w):
    """The kind of leaf and, for some kinds, a choice; FAILED if none is proved.

    The scratch ``w`` holds all pairs.
    """
    slots = w[4]
    ports = trace_sides(m, w)
    if ports < 0:
        return FAILED, 0, 0
    if m == 2:
        return _classify_pair(ports, w)
    if m > 4 or not _corners_are_plain(m, w) or not _all_cones(m, w):
        return FAILED, 0, 0
    if m == 3:
        if not _ties_once(0, 1, 2, w):
            return FAILED, 0, 0
        p0, p1, p2, p3 = slots[0, 1], slots[1, 1], slots[2, 1], slots[3, 1]
        if ports == 0:
            return EMPTY, 0, 0
        if ports == 2:
            return ARC, 2, 0
        if ports == 3 and p0 != p1 and p1 != p2 and p0 != p2:
            meet(w[0][p0, p1], w[0][p0, p2], w[6], w[5])
            return TRIPLE, 3, 0
        if ports == 4 and p0 == p2 and p1 != p3:
            return TWO_ARCS, 4, 1
        if ports == 4 and p1 == p3 and p0 != p2:
            return TWO_ARCS, 4, 0
        return FAILED, 0, 0
    if ports != 4:
        return FAILED, 0, 0
    for x in range(4):
        for y in range(x):
            if slots[x, 1] == slots[y, 1]:
                return FAILED, 0, 0
    for x in range(4):
        if not _ties_once((x + 1) & 3, (x + 2) & 3, (x + 3) & 3, w):
            return FAILED, 0, 0
    return QUAD, 4, _quad_choice(w)


@compiled
def _quad_choice(w):
    """0 if the owners of slots 0 and 2 share an edge, 1 if those of 1 and 3 do, OPEN if unsure.

    Let p be any point near the tie of a, b, c, and σ a bound with |Φ(p') − Φ(p)| ≥ σ|p' − p| for
    Φ = (F_ab, F_ac) (σ = least determinant / norm of the gradients).  If the ball of radius
    ρ = |Φ(p)|/σ about p lies in T, the tie is in it, by the degree of Φ; there F_ad differs from
    F_ad(p) by at most ρ·max|∇F_ad|.
    """
    values, bounds, controls, slots, out, point = w[0], w[2], w[3], w[4], w[5], w[6]
    for x in range(4):
        a, b, c, d = slots[x, 1], slots[(x + 1) & 3, 1], slots[(x + 2) & 3, 1], slots[(x + 3) & 3, 1]
        meet(values[a, b], values[a, c], point, out)
        px, py = point[0], point[1]
        inside = min(px, py, (1.0 - px - py) * 0.7)
        if not inside > 0.0:
            continue
        f, g, h = controls[min(a, b), max(a, b)], controls[min(a, c), max(a, c)], values[a, d]
        least = abs(hull_determinant(f, g, bounds[a, b], bounds[a, c]))
        if least == 0.0:
            continue
        steep = slope = 0.0
        k = controls[min(a, d), max(a, d)]
        for r in range(6):
            steep = max(steep, f[r, 0] ** 2 + f[r, 1] ** 2 + g[r, 0] ** 2 + g[r, 1] ** 2)
            slope = max(slope, k[r, 0] ** 2 + k[r, 1] ** 2)
        sigma = 0.99 * least / np.sqrt(2.0 * steep)
        value_and_gradient(values[a, b], px, py, out)
        residue = abs(out[0]) + 2.0 * bounds[a, b]
        value_and_gradient(values[a, c], px, py, out)
        residue += abs(out[0]) + 2.0 * bounds[a, c]
        radius = residue / sigma
        if not radius < inside:
            continue
        value_and_gradient(h, px, py, out)
        if abs(out[0]) > 2.0 * bounds[a, d] + 1.01 * radius * np.sqrt(slope):
            # d loses to a: a, b, c meet and a, c share an edge (slots x and x + 2).
            return (x & 1) if out[0] > 0.0 else 1 - (x & 1)
    return OPEN


@compiled
def _classify_pair(ports, w):
    values, signs, bounds, controls, slots = w[0][0, 1], w[1][0, 1], w[2][0, 1], w[3][0, 1], w[4]
    if ports == 4 and slots[0, 1] == slots[2, 1]:
        return _classify_saddle(w)
    if ports not in (0, 2):
        return FAILED, 0, 0
    if not has_cone(values, bounds, controls):
        radial = False
        for corner in range(3):
            radial = radial or is_radial(signs, corner)
        if not radial:
            return FAILED, 0, 0
    return (EMPTY, 0, 0) if ports == 0 else (ARC, 2, 0)


@compiled
def hessian_controls(b, out_x, out_y):
    """Control vectors of the gradients of ∂₁F and ∂₂F, linear on T: (3, 2) each."""
    # Coefficients of order two on the corners 200 020 002 and the sides 110 101 011 of ∂F.
    steps = np.zeros((6, 2))
    gradient_controls(b, steps)
    for axis in range(2):
        out = out_x if axis == 0 else out_y
        c0, c1, c2 = steps[0, axis], steps[1, axis], steps[2, axis]
        c3, c4, c5 = steps[3, axis], steps[4, axis], steps[5, axis]
        out[0, 0], out[0, 1] = 2.0 * (c3 - c0), 2.0 * (c4 - c0)
        out[1, 0], out[1, 1] = 2.0 * (c1 - c3), 2.0 * (c5 - c3)
        out[2, 0], out[2, 1] = 2.0 * (c5 - c4), 2.0 * (c2 - c4)


@compiled
def _classify_saddle(w):
    """Saddle: at most one critical point in T, no extremum; the sign of F there decides.

    If F at the critical point p* is positive, the two pieces where F > 0 are joined: ascending
    lines leave p* on both sides.  That they reach different pieces follows if F − F(p*), too,
    changes sign just four times on the boundary; its coefficients are those of F, shifted, so we
    ask that no sign we used is within 2|F(p*)| of zero.
    """
    values, signs, bound = w[0][0, 1], w[1][0, 1], w[2][0, 1]
    slots, out = w[4], w[5]
    hx, hy = np.zeros((3, 2)), np.zeros((3, 2))
    hessian_controls(values, hx, hy)
    slack_unit = 24.0 * bound
    least, steep = np.inf, 0.0
    for r in range(3):
        steep = max(steep, hx[r, 0] ** 2 + hx[r, 1] ** 2 + hy[r, 0] ** 2 + hy[r, 1] ** 2)
        for s in range(3):
            det = hx[r, 0] * hy[s, 1] - hx[r, 1] * hy[s, 0]
            slack = slack_unit * (
                abs(hx[r, 0]) + abs(hx[r, 1]) + abs(hy[s, 0]) + abs(hy[s, 1]) + 4.0 * slack_unit
            )
            if not det < -1.1 * slack:
                return FAILED, 0, 0
            least = min(least, -det - slack)
    for c in range(10):
        if signs[c] == 0:
            return FAILED, 0, 0
    # Newton for the critical point.
    x = y = 1.0 / 3.0
    for _ in range(12):
        gx, gy, jxx, jxy, jyx, jyy = _gradient_and_hessian(values, hx, hy, x, y, out)
        det = jxx * jyy - jxy * jyx
        dx, dy = (gx * jyy - jxy * gy) / det, (jxx * gy - jyx * gx) / det
        x, y = x - dx, y - dy
        if not (abs(x) < 4.0 and abs(y) < 4.0):
            return FAILED, 0, 0
        if abs(dx) + abs(dy) < 1e-15:
            break
    inside = min(x, y, (1.0 - x - y) * 0.7)
    if not inside > 0.0:
        return FAILED, 0, 0
    sigma = 0.99 * least / np.sqrt(2.0 * steep)
    value_and_gradient(values, x, y, out)
    residue = abs(out[1]) + abs(out[2]) + 24.0 * bound
    radius = residue / sigma
    if not radius < inside:
        return FAILED, 0, 0
    # Within the ball |∇F| ≤ residue + radius·‖Hessian‖.
    reach = 2.0 * bound + 1.01 * radius * (residue + radius * np.sqrt(2.0 * steep))
    level = abs(out[0]) + reach
    for k in range(3):
        for r in range(4):
            if not abs(values[SIDES[k, r]]) > 2.0 * level + bound:
                return FAILED, 0, 0
    w[6][0], w[6][1] = x, y
    if abs(out[0]) <= reach:
        return SADDLE, 4, OPEN
    # The candidate 0 is joined if F > 0.  Joining slots 1 and 3 is choice 0.
    joined = 0 if out[0] > 0.0 else 1
    return TWO_ARCS, 4, (0 if slots[1, 1] == joined else 1)


@compiled
def _gradient_and_hessian(values, hx, hy, x, y, out):
    value_and_gradient(values, x, y, out)
    z = 1.0 - x - y
    jxx = z * hx[0, 0] + x * hx[1, 0] + y * hx[2, 0]
    jxy = z * hx[0, 1] + x * hx[1, 1] + y * hx[2, 1]
    jyx = z * hy[0, 0] + x * hy[1, 0] + y * hy[2, 0]
    jyy = z * hy[0, 1] + x * hy[1, 1] + y * hy[2, 1]
    return out[1], out[2], jxx, jxy, jyx, jyy


@compiled
def classify_mixed(t, s, la, lb, q, bound, far, known, w):
    """A leaf of two candidates of which at least one has its line through T; both Q have the sign q.

    Let F± = Q_a L_b ∓ Q_b L_a.  As F₊F₋ = Q_a²L_b² − Q_b²L_a², candidate a wins where both have one
    sign and b where they differ (if q = −1, the other way round), so the pieces are named by the two signs and every zero of F₊
    or F₋ is an edge.  With a cone for both, each zero set is one arc; the two meet only where
    Q_a L_b = Q_b L_a = 0: where both lines cross (angle 0), once at most and transversally.
    So if their ports alternate there is one crossing, otherwise none.
    """
    values, signs, controls, slots = w[0], w[1], w[3], w[4]
    cubic(t, s, 1.0, 1.0, bound, far, known, values[0, 1], signs[0, 1])
    cubic(t, s, -1.0, 1.0, bound, far, known, values[1, 0], signs[1, 0])
    for f in range(2):
        a, b = f, 1 - f
        if not _is_simple(signs[a, b], values[a, b], bound, controls[a, b]):
            return FAILED, 0, 0
    count = 0
    last_plus = germ(signs[0, 1], 1, True)
    last_minus = germ(signs[1, 0], 1, True)
    if last_plus == UNKNOWN or last_minus == UNKNOWN:
        return FAILED, 0, 0
    curves = w[7]
    for position in range(3):
        k = _ORDER[position]
        plus, minus = germ(signs[0, 1], k, False), germ(signs[1, 0], k, False)
        if plus == UNKNOWN or minus == UNKNOWN:
            return FAILED, 0, 0
        if plus != last_plus and minus != last_minus:
            # An endpoint's wedge, seen from its tip.  If a is mixed, F₊ + F₋ = 2Q_a L_b forbids
            # that both have the sign of −q L_b; if b is mixed, F₋ − F₊ = 2Q_b L_a.
            if la == 0 and lb != 0:
                first_is_plus = last_plus != q * lb
            elif lb == 0 and la != 0:
                first_is_plus = last_plus != -q * la
            else:
                return FAILED, 0, 0
            count = _add(slots, curves, count, 2 * position, 0 if first_is_plus else 1)
            count = _add(slots, curves, count, 2 * position, 1 if first_is_plus else 0)
        elif plus != last_plus:
            count = _add(slots, curves, count, 2 * position, 0)
        elif minus != last_minus:
            count = _add(slots, curves, count, 2 * position, 1)
        zeros_plus = sign_changes(signs[0, 1], values[0, 1], bound, k)
        zeros_minus = sign_changes(signs[1, 0], values[1, 0], bound, k)
        if zeros_plus < 0 or zeros_minus < 0 or count > 7:
            return FAILED, 0, 0
        if zeros_plus == 1 and zeros_minus == 1:
            at = side_zero(values[0, 1], k, plus < 0)
            there = side_value(values[1, 0], k, at)
            if not abs(there) > 2.0 * bound:
                return FAILED, 0, 0
            plus_first = (there > 0.0) == (minus > 0)
            count = _add(slots, curves, count, 2 * position + 1, 0 if plus_first else 1)
            count = _add(slots, curves, count, 2 * position + 1, 1 if plus_first else 0)
        elif zeros_plus == 1:
            count = _add(slots, curves, count, 2 * position + 1, 0)
        elif zeros_minus == 1:
            count = _add(slots, curves, count, 2 * position + 1, 1)
        last_plus = -plus if zeros_plus == 1 else plus
        last_minus = -minus if zeros_minus == 1 else minus
    # Owners of the pieces: the state after each port, from the one before corner 0.
    a, b = germ(signs[0, 1], 1, True), germ(signs[1, 0], 1, True)
    for r in range(count):
        if curves[r] == 0:
            a = -a
        else:
            b = -b
        slots[r, 1] = 0 if (a == b) == (q == 1) else 1
    if count == 0:
        slots[0, 0], slots[0, 1] = 1, 0 if (a == b) == (q == 1) else 1
        return EMPTY, 0, 0
    if count == 2:
        return (ARC, 2, 0) if curves[0] == curves[1] else (FAILED, 0, 0)
    if count != 4:
        return FAILED, 0, 0
    if curves[0] + curves[1] + curves[2] + curves[3] != 2:
        return FAILED, 0, 0
    if curves[0] != curves[1] and curves[1] != curves[2]:
        return CROSSING, 4, 0
    return TWO_ARCS, 4, (0 if curves[0] == curves[1] else 1)


@compiled
def _add(slots, curves, count, place, curve):
    slots[count, 0] = place
    curves[count] = curve
    return count + 1
