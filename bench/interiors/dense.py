"""Rooms of one kind each: dense occluders in front of the light, and lights of many kinds and
numbers. Room, table and ceiling light are the same unless a case varies them."""

import math
import random

from mesh import Mesh, Scene, facing_down


def room(fill, light=None, eye=(0.6, 0.6, 1.5), target=(3, 3, 0.8)):
    rng = random.Random(7)
    s = Scene(eye, target, 65)
    s.room((0, 0, 0), (5, 4, 2.8))
    fill(s, rng)
    if light:
        light(s, rng)
    else:
        s.light(facing_down(2.5, 2, 2.78, 1.2, 0.8), (12, 12, 12))
    return s


def table(s, _rng=None):
    s.matte((0.5, 0.3, 0.2))
    m = Mesh()
    m.box((1.8, 1.4, 0.7), (3.6, 2.6, 0.75))
    for x in (1.85, 3.5):
        for y in (1.45, 2.5):
            m.box((x, y, 0), (x + 0.06, y + 0.06, 0.7))
    s.add(m)


def furniture(s, rng):
    table(s)
    s.matte((0.5, 0.5, 0.55))
    m = Mesh()
    for _ in range(25):
        x, y = 0.4 + 4.2 * rng.random(), 0.4 + 3.2 * rng.random()
        a = 0.1 + 0.15 * rng.random()
        m.box((x - a, y - a, 0), (x + a, y + a, 0.1 + 0.8 * rng.random()), turn=rng.random())
    for _ in range(8):
        m.ball((0.5 + 4 * rng.random(), 0.5 + 3 * rng.random(), 1 + rng.random()), 0.12, 10)
    s.add(m)


# ---- occluders ----

def crystals(mesh, top, rng, rings, per_ring, radius, height, size, has_caps=True):
    for ring in range(rings):
        r = radius + 0.06 * ring
        for k in range(per_ring):
            t = 2 * math.pi * (k + rng.random()) / per_ring
            p = (top[0] + r * math.cos(t), top[1] + r * math.sin(t), top[2] - height * rng.random())
            q = size * (0.6 + rng.random())
            above, below = (p[0], p[1], p[2] + 1.6 * q), (p[0], p[1], p[2] - 1.6 * q)
            waist = [(p[0] + q * math.cos(f), p[1] + q * math.sin(f), p[2])
                     for f in (0, math.pi / 2, math.pi, 3 * math.pi / 2)]
            for i in range(4):
                mesh.triangle(above, waist[i], waist[(i + 1) % 4])
                mesh.triangle(below, waist[(i + 1) % 4], waist[i])
        for k in range(48):
            t, u = 2 * math.pi * k / 48, 2 * math.pi * (k + 1) / 48
            mesh.tube((top[0] + r * math.cos(t), top[1] + r * math.sin(t), top[2]),
                      (top[0] + r * math.cos(u), top[1] + r * math.sin(u), top[2]), 0.006, 6,
                      has_caps)


def chandelier(s, rng):
    s.matte((0.8, 0.8, 0.8))
    m = Mesh()
    crystals(m, (2.5, 2, 2.5), rng, 6, 60, 0.15, 0.5, 0.01, False)
    s.add(m)
    table(s)


def banisters(s, _rng):
    s.matte((0.3, 0.3, 0.3))
    m = Mesh()
    for row in range(4):
        y = 1.0 + 0.7 * row
        for k in range(40):
            m.tube((0.3 + 0.11 * k, y, 0), (0.3 + 0.11 * k, y, 1.1), 0.012, 10)
        m.box((0.2, y - 0.03, 1.1), (4.8, y + 0.03, 1.14))
    s.add(m)


def blinds(s, _rng):
    s.matte((0.8, 0.8, 0.75))
    m = Mesh()
    for k in range(90):
        y = 0.6 + 0.028 * k
        m.box((1, y, 2.2), (4, y + 0.025, 2.202))
    s.add(m)
    table(s)


def wires(s, rng):
    s.matte((0.2, 0.2, 0.2))
    m = Mesh()
    for _ in range(2500):
        x, y = 1 + 3 * rng.random(), 1.6 + 0.5 * rng.random()
        m.tube((x, y, 2.5), (x + 0.05 * rng.gauss(0, 1), y + 0.05 * rng.gauss(0, 1), 0.4), 0.002, 4,
               False)
    s.add(m)


def bookshelf(s, rng):
    s.matte((0.4, 0.25, 0.15))
    m = Mesh()
    for z in (0.1, 0.5, 0.9, 1.3, 1.7, 2.1):
        m.box((0.6, 3.6, z), (4.6, 3.98, z + 0.025))
    for x in (0.6, 1.6, 2.6, 3.6, 4.575):
        m.box((x, 3.6, 0), (x + 0.025, 3.98, 2.1))
    s.add(m)
    for colour in ((0.6, 0.2, 0.2), (0.2, 0.4, 0.5), (0.7, 0.6, 0.4)):
        s.matte(colour)
        m = Mesh()
        for z in (0.125, 0.525, 0.925, 1.325, 1.725):
            x = 0.64
            while x < 4.5:
                w = 0.015 + 0.04 * rng.random()
                if rng.random() < 0.34:
                    m.box((x, 3.62 + 0.05 * rng.random(), z),
                          (x + w, 3.9, z + 0.2 + 0.14 * rng.random()), tilt=0.06 * rng.gauss(0, 1))
                x += w + 0.002
        s.add(m)
    table(s)


def foliage(s, rng):
    s.matte((0.2, 0.5, 0.2))
    m = Mesh()
    for _ in range(20000):
        t, r = 2 * math.pi * rng.random(), 0.9 * math.sqrt(rng.random())
        p = (2.5 + r * math.cos(t), 2.2 + r * math.sin(t), 0.5 + 1.6 * rng.random())
        u = [rng.gauss(0, 0.03) for _ in range(3)]
        v = [rng.gauss(0, 0.03) for _ in range(3)]
        m.quad(p, tuple(p[i] + u[i] for i in range(3)),
               tuple(p[i] + u[i] + v[i] for i in range(3)), tuple(p[i] + v[i] for i in range(3)))
    s.add(m)


# ---- lights ----

def quads(n):
    """n lights under the ceiling with constant total flux."""
    size = 0.4 / math.sqrt(n) if n < 100 else 0.08 if n < 1000 else 0.03

    def light(s, _rng):
        columns = math.ceil(math.sqrt(n))
        for k in range(n):
            s.light(facing_down(0.3 + 4.4 * (k % columns + 0.5) / columns,
                                0.3 + 3.4 * (k // columns + 0.5) / columns, 2.78, size, size),
                    (3.6 / n / size**2,) * 3)
    return light


def nine(shape, radiance, height):
    def light(s, rng):
        for k in range(9):
            centre = (0.8 + 1.6 * (k % 3), 0.7 + 1.3 * (k // 3), height(rng))
            s.light(shape(k, centre), radiance)
    return light


def lantern(k, centre):
    m = Mesh()
    m.ball(centre, 0.16, 10 if k % 2 else 16, 1.2)
    return m


def sphere(_k, centre):
    return 'Translate %g %g %g\nShape "sphere" "float radius" [0.16]\n' % centre


def disk(_k, centre):
    return 'Translate %g %g %g\nScale 1 1 -1\nShape "disk" "float radius" [0.25]\n' % centre


def hanging(rng):
    return 1.9 + 0.2 * rng.random()


DENSE = {
    "chandelier": lambda: room(chandelier),
    "banisters": lambda: room(banisters),
    "blinds": lambda: room(blinds),
    "wires": lambda: room(wires),
    "bookshelf": lambda: room(bookshelf, eye=(2.5, 0.4, 1.5), target=(2.6, 3, 1)),
    "foliage": lambda: room(foliage),
    "lights10": lambda: room(furniture, quads(10)),
    "lights100": lambda: room(furniture, quads(100)),
    "lights1000": lambda: room(furniture, quads(1000)),
    "lights3000": lambda: room(furniture, quads(3000)),
    "lanterns": lambda: room(furniture, nine(lantern, (8, 6, 3), hanging)),
    "balls": lambda: room(furniture, nine(sphere, (8, 6, 3), hanging)),
    "disks": lambda: room(furniture, nine(disk, (10, 9, 8), lambda _rng: 2.7)),
}
