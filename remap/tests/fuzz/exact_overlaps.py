#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-3.0-or-later
"""Overlaps of pairs.h in exact arithmetic, rounded once: exact_overlaps.txt.

Line n is pair n: the area, and for every fifth pair the first moments, as hex
floats without the leading 0x. The clipping is Sutherland & Hodgman's over
fractions and shares no code with the library.

    python3 exact_overlaps.py > exact_overlaps.txt
"""
from fractions import Fraction

COUNT = 10000
MASK = (1 << 64) - 1
UNIT = Fraction(1, 1 << 50)


class Random:
    """Splitmix64 (Steele, Lea & Flood 2014)."""

    def __init__(self, seed):
        self.state = seed

    def __call__(self):
        self.state = (self.state + 0x9E3779B97F4A7C15) & MASK
        z = self.state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        return z ^ (z >> 31)

    def below(self, n):
        return self() % n

    def about(self, n):
        return self.below(2 * n + 1) - n


def coarse(r):
    return (r.below(1 << 20) << 30, r.below(1 << 20) << 30)


def between(a, b, k):
    return tuple(p + (q - p) // 1024 * k for p, q in zip(a, b))


def nudged(r, a, by):
    return (a[0] + r.about(by), a[1] + r.about(by))


def beside(r, a, b):
    p = between(a, b, r.below(1025))
    return nudged(r, p, 1 << (10 + r.below(27)))


def partner(r, kind, a):
    """The second triangle; kind 6 also changes the first."""
    b = [coarse(r), coarse(r), coarse(r)]
    if kind == 1:
        return [a[1], a[2], a[0]]
    if kind == 2:
        return [a[0], a[1], between(a[1], a[2], r.below(1025))]
    if kind == 3:
        return [a[1], a[0], tuple(a[0][i] + a[1][i] - a[2][i] for i in (0, 1))]
    if kind == 4:
        return [a[0], b[1], b[2]]
    if kind == 5:
        return [b[0], b[1], beside(r, b[0], b[1])]
    if kind == 6:
        a[2] = beside(r, a[0], a[1])
        return [b[0], b[1], beside(r, b[0], b[1])]
    if kind == 7:
        return [nudged(r, p, 16) for p in a]
    if kind == 8:
        return [between(a[0], a[1], r.below(1025)), b[1], b[2]]
    if kind == 9:
        start = between(a[0], a[1], r.about(512))
        return [start, between(a[0], a[1], r.below(1025)), b[2]]
    if kind == 10:
        return [between(a[i], a[(i + 1) % 3], r.below(1025)) for i in range(3)]
    if kind == 11:
        return [a[0], a[2], b[2]]
    if kind == 12:
        middle = between(b[0], b[1], r.below(1025))
        return [b[0], middle, b[0] if r.below(2) == 0 else b[1]]
    if kind == 13:
        first = nudged(r, a[0], 1 << r.below(40))
        return [first, nudged(r, a[1], 1 << r.below(40)), b[2]]
    if kind == 14:
        first = nudged(r, a[1], 16)
        return [first, nudged(r, a[0], 16), b[2]]
    if kind == 15:
        size = 1 << (8 + r.below(32))
        at = between(a[0], a[1], r.below(1025))
        return [nudged(r, at, size) for _ in range(3)]
    return b


def cross(o, a, b):
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])


def overlap(a, b):
    """Area and first moments, in lattice units."""
    polygon, window = ([*t] if cross(*t) >= 0 else [*reversed(t)] for t in (a, b))
    if cross(*window) == 0:
        return 0, 0, 0
    for i in range(3):
        u, v = window[i], window[(i + 1) % 3]
        out = []
        for p, q in zip(polygon, polygon[1:] + polygon[:1]):
            s, t = cross(u, v, p), cross(u, v, q)
            if s >= 0:
                out.append(p)
            if (s > 0 > t) or (s < 0 < t):
                w = Fraction(s, s - t)
                out.append(tuple(x + w * (y - x) for x, y in zip(p, q)))
        polygon = out
    area, mx, my = 0, 0, 0
    for p, q in zip(polygon, polygon[1:] + polygon[:1]):
        w = p[0] * q[1] - p[1] * q[0]
        area += w
        mx += w * (p[0] + q[0])
        my += w * (p[1] + q[1])
    return Fraction(area) / 2, Fraction(mx) / 6, Fraction(my) / 6


def short(value):
    """Hex float without 0x and without zeros at the end."""
    if not value:
        return "0"
    mantissa, exponent = float(value).hex().replace("0x", "").split("p")
    return f"{mantissa.rstrip('0').rstrip('.')}p{int(exponent)}"


for seed in range(COUNT):
    r = Random(seed)
    first = [coarse(r), coarse(r), coarse(r)]
    second = partner(r, seed % 16, first)
    v, x, y = overlap(first, second)
    answer = [v * UNIT**2] + ([x * UNIT**3, y * UNIT**3] if seed % 5 == 0 else [])
    print(*map(short, answer))
