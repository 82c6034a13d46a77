"""Values of cubics at single points in double-double: what decides near ties.

The error of L and Q at a point of a triangle adds the sums with its weights to those of a table's
entries (:mod:`harness.diagram.fast.fine`): 42u²·ML and 80u²·MQ at most, so that a value of
Q_i L_j − Q_j L_i is off by less than 2 FINE (MQ_i ML_j + MQ_j ML_i).
"""

from __future__ import annotations

import numpy as np

from harness.diagram.fast.double import plus, plus_product, times
from harness.diagram.fast.fine import FINE, fine_coefficients, form_at, line_at
from harness.diagram.fast.forms import value_and_gradient
from harness.diagram.fast.jit import compiled
from harness.diagram.fast.leaves import OPEN, hull_determinant, meet


@compiled
def cubic_at(t, i, j, si, sj, x, y):
    """Q_i sj L_j − Q_j si L_i at λ = (1 − x − y, x, y); x and y are double-doubles (pairs)."""
    s = plus(x[0], x[1], y[0], y[1])
    z = plus(1.0, 0.0, -s[0], -s[1])
    qi, qj = form_at(t, i, z, x, y), form_at(t, j, z, x, y)
    li, lj = line_at(t, i, z, x, y), line_at(t, j, z, x, y)
    h, low = times(qi[0], qi[1], sj * lj[0], sj * lj[1])
    return plus_product(h, low, qj[0], qj[1], -si * li[0], -si * li[1])[0]


@compiled
def tie_of_three(t, a, b, c, sides, values_ab, values_ac, x, y):
    """A point near F_ab = F_ac = 0, from the doubles x, y by Newton's method; its last residues.

    Rows a, b, c of the tables t; ``sides``: their signs of L.  ``values``: both cubics' doubles.
    """
    px, py = (x, 0.0), (y, 0.0)
    out = np.empty(3)
    f = g = 0.0
    for step in range(4):
        f = cubic_at(t, a, b, sides[a], sides[b], px, py)
        g = cubic_at(t, a, c, sides[a], sides[c], px, py)
        if step == 3:
            break
        value_and_gradient(values_ab, px[0], py[0], out)
        fx, fy = out[1], out[2]
        value_and_gradient(values_ac, px[0], py[0], out)
        gx, gy = out[1], out[2]
        det = fx * gy - fy * gx
        if det == 0.0:
            break
        px = plus(px[0], px[1], -(f * gy - g * fy) / det, 0.0)
        py = plus(py[0], py[1], -(g * fx - f * gx) / det, 0.0)
    return px, py, f, g


@compiled
def pair_bound(norms, a, b):
    """The error bound of a cubic's value at a point, with fine tables."""
    return 2.0 * FINE * (norms[a, 1] * norms[b, 0] + norms[b, 1] * norms[a, 0])


@compiled
def fine_quad_choice(t, norms, sides, w):
    """As ``_quad_choice`` in :mod:`harness.diagram.fast.classify`, which has the proof."""
    values, bounds, controls, slots, out, point = w[0], w[2], w[3], w[4], w[5], w[6]
    for r in range(4):
        a, b = slots[r, 1], slots[(r + 1) & 3, 1]
        c, d = slots[(r + 2) & 3, 1], slots[(r + 3) & 3, 1]
        f, g = controls[min(a, b), max(a, b)], controls[min(a, c), max(a, c)]
        least = abs(hull_determinant(f, g, bounds[a, b], bounds[a, c]))
        if least == 0.0:
            continue
        meet(values[a, b], values[a, c], point, out)
        if not (abs(point[0]) < 2.0 and abs(point[1]) < 2.0):
            continue
        x, y, one, two = tie_of_three(
            t, a, b, c, sides, values[a, b], values[a, c], point[0], point[1]
        )
        inside = min(x[0], y[0], (1.0 - x[0] - y[0]) * 0.7)
        steep = slope = 0.0
        k = controls[min(a, d), max(a, d)]
        for s in range(6):
            steep = max(steep, f[s, 0] ** 2 + f[s, 1] ** 2 + g[s, 0] ** 2 + g[s, 1] ** 2)
            slope = max(slope, k[s, 0] ** 2 + k[s, 1] ** 2)
        residue = abs(one) + abs(two) + pair_bound(norms, a, b) + pair_bound(norms, a, c)
        radius = 1.01 * residue * np.sqrt(2.0 * steep) / least
        if not radius < 0.99 * inside:
            continue
        h = cubic_at(t, a, d, sides[a], sides[d], x, y)
        if abs(h) > pair_bound(norms, a, d) + 1.01 * radius * np.sqrt(slope):
            return (r & 1) if h > 0.0 else 1 - (r & 1)
    return OPEN


@compiled
def suspects_hub(t, norms, m, lsign, point):
    """Whether many candidates seem to tie in one point inside the triangle, left in ``point``.

    That is, as far as double-doubles can tell: five or more at a positive angle, or three whose
    lines meet.  Nothing depends on the answer but who looks at the triangle next.
    """
    crossing = 0
    for a in range(m):
        crossing += lsign[a] == 0
    if crossing >= 3:
        return _lines_meet(t, norms, m, lsign, point)
    if m < 5 or crossing > 0:
        return False
    sides = np.empty(m)
    for a in range(m):
        sides[a] = lsign[a]
    gradients = np.empty((m, 2))
    sizes = np.empty(m)
    out = np.empty(3)
    cubics = np.empty((m, 10))
    for a in range(1, m):
        coefficients = fine_coefficients(t, 0, a, sides[0], sides[a])
        sizes[a] = 0.0
        for c in range(10):
            cubics[a, c] = coefficients[c]
            sizes[a] = max(sizes[a], abs(coefficients[c]))
        if sizes[a] == 0.0:
            return False
        value_and_gradient(cubics[a], 1.0 / 3.0, 1.0 / 3.0, out)
        gradients[a, 0], gradients[a, 1] = out[1] / sizes[a], out[2] / sizes[a]
    best, b, c = 0.0, 0, 0
    for x in range(2, m):
        det = abs(gradients[1, 0] * gradients[x, 1] - gradients[1, 1] * gradients[x, 0])
        if det > best:
            best, b, c = det, 1, x
    if best == 0.0:
        return False
    meet(cubics[b], cubics[c], point, out)
    if not (abs(point[0]) < 2.0 and abs(point[1]) < 2.0):
        return False
    x, y, _, _ = tie_of_three(t, 0, b, c, sides, cubics[b], cubics[c], point[0], point[1])
    point[0], point[1] = x[0], y[0]
    if not (x[0] > 0.0 and y[0] > 0.0 and x[0] + y[0] < 1.0):
        return False
    count = 3
    for a in range(1, m):
        bound = 16.0 * pair_bound(norms, 0, a)
        if a not in (b, c) and bound < 2.0**-8 * sizes[a]:
            count += abs(cubic_at(t, 0, a, sides[0], sides[a], x, y)) <= bound
    return count >= 5


@compiled
def _lines_meet(t, norms, m, lsign, point):
    """Whether the lines of three candidates that cross the triangle seem to meet in a point."""
    rows = np.empty(m, np.int64)
    n = 0
    for a in range(m):
        if lsign[a] == 0:
            rows[n] = a
            n += 1
    a = rows[0]
    best, b = 0.0, 0
    for r in range(1, n):
        c = rows[r]
        ux, uy = t[a, 1] - t[a, 0], t[a, 2] - t[a, 0]
        vx, vy = t[c, 1] - t[c, 0], t[c, 2] - t[c, 0]
        size = (abs(ux) + abs(uy)) * (abs(vx) + abs(vy))
        det = ux * vy - uy * vx
        if size > 0.0 and abs(det) > best * size:
            best, b = abs(det) / size, c
    if best == 0.0:
        return False
    x, y = (1.0 / 3.0, 0.0), (1.0 / 3.0, 0.0)
    ux, uy = t[a, 1] - t[a, 0], t[a, 2] - t[a, 0]
    vx, vy = t[b, 1] - t[b, 0], t[b, 2] - t[b, 0]
    det = ux * vy - uy * vx
    for _ in range(4):
        s = plus(x[0], x[1], y[0], y[1])
        z = plus(1.0, 0.0, -s[0], -s[1])
        f, g = line_at(t, a, z, x, y)[0], line_at(t, b, z, x, y)[0]
        x = plus(x[0], x[1], -(f * vy - g * uy) / det, 0.0)
        y = plus(y[0], y[1], -(g * ux - f * vx) / det, 0.0)
    point[0], point[1] = x[0], y[0]
    if not (x[0] > 0.0 and y[0] > 0.0 and x[0] + y[0] < 1.0):
        return False
    s = plus(x[0], x[1], y[0], y[1])
    z = plus(1.0, 0.0, -s[0], -s[1])
    count = 2
    for r in range(1, n):
        c = rows[r]
        size = max(abs(t[c, 0]), abs(t[c, 1]), abs(t[c, 2]))
        bound = 16.0 * FINE * norms[c, 0]
        if c != b and bound < 2.0**-8 * size:
            count += abs(line_at(t, c, z, x, y)[0]) <= bound
    return count >= 3
