"""Interiors for benchmarks, generated with fixed seeds: interiors.write(name, path).

They represent real buildings: stairs with bars and a chandelier in front of the only light, a window
behind blinds, a dark room next to a lit one (one floor and a wall without thickness), coves. No
setting of troffer was chosen on them.
"""

import math
import random

from dense import DENSE, crystals, furniture, room
from mesh import Mesh, Scene, facing_down


def staircase(is_metal=False):
    rng = random.Random(1)
    s = Scene((1.0, 0.8, 1.6), (4.2, 6.5, 2.2), 70)
    s.room((0, 0, 0), (6, 9, 6.5), wall=(0.75, 0.72, 0.65))
    s.matte((0.45, 0.25, 0.12))
    steps, rail, n = Mesh(), Mesh(), 18
    for k in range(n):
        y, z = 2.2 + 0.28 * k, 0.17 * (k + 1)
        steps.box((3.6, y, z - 0.05), (5.6, y + 0.3, z))
        for q in range(3):
            rail.tube((3.65, y + 0.05 + 0.1 * q, z), (3.65, y + 0.05 + 0.1 * q, z + 0.9), 0.012)
    top = 0.17 * n + 0.17
    rail.tube((3.65, 2.2, 1.07), (3.65, 2.2 + 0.28 * n, 0.17 * n + 1.07), 0.03, 10)
    steps.box((3.6, 7.24, top - 0.22), (6, 9, top))
    steps.box((0, 7.24, top - 0.22), (3.6, 9, top))
    s.add(steps)
    for k in range(30):
        rail.tube((0.1 + 0.12 * k, 7.3, top), (0.1 + 0.12 * k, 7.3, top + 0.93), 0.012)
    s.metal((0.8, 0.6, 0.3), 0.15) if is_metal else s.matte((0.25, 0.25, 0.25))
    s.add(rail)
    s.metal((0.9, 0.9, 0.9), 0.1) if is_metal else s.matte((0.8, 0.8, 0.8))
    chandelier = Mesh()
    crystals(chandelier, (2.6, 4.5, 5.6), rng, 8, 90, 0.25, 0.8, 0.012)
    s.add(chandelier)
    s.matte((0.6, 0.1, 0.1))
    m = Mesh()
    m.box((0.4, 3, 0), (1.2, 4.6, 0.45))
    m.ball((2.2, 3.2, 0.35), 0.35, 14)
    s.add(m)
    s.light(facing_down(2.6, 4.5, 6.45, 1.6, 1.6), (9, 8.4, 7.2))
    return s


def bathroom():
    rng = random.Random(2)
    s = Scene((0.4, 0.4, 1.6), (2.4, 3.2, 0.9), 75)
    h = 2.6
    s.matte((0.6, 0.6, 0.62))
    m = Mesh()
    m.quad((0, 0, 0), (3, 0, 0), (3, 4, 0), (0, 4, 0))
    m.quad((0, 0, h), (0, 4, h), (3, 4, h), (3, 0, h))
    m.quad((0, 0, 0), (0, 0, h), (3, 0, h), (3, 0, 0))
    m.quad((0, 0, 0), (0, 4, 0), (0, 4, h), (0, 0, h))
    m.quad((0, 4, 0), (3, 4, 0), (3, 4, h), (0, 4, h))
    for a, b, c, d in ((0, 1, 0, h), (3, 4, 0, h), (1, 3, 0, 0.9), (1, 3, 2.2, h)):
        m.quad((3, a, c), (3, a, d), (3, b, d), (3, b, c))
    for z in (0.9, 2.2):
        m.quad((3, 1, z), (3.2, 1, z), (3.2, 3, z), (3, 3, z))
    for y in (1, 3):
        m.quad((3, y, 0.9), (3.2, y, 0.9), (3.2, y, 2.2), (3, y, 2.2))
    s.add(m)
    s.matte((0.8, 0.8, 0.75))
    m = Mesh()
    for k in range(44):
        z = 0.92 + 0.029 * k
        m.box((3.0, 1.01, z - 0.0008), (3.028, 2.99, z + 0.0008), tilt=0.6)
    for y in (1.3, 2, 2.7):
        m.tube((3.014, y, 0.9), (3.014, y, 2.2), 0.0015, 6)
    s.add(m)
    s.matte((0.85, 0.85, 0.85))
    m = Mesh()
    m.box((0.1, 2.6, 0), (1.9, 3.9, 0.08))
    m.box((0.1, 2.6, 0.08), (0.2, 3.9, 0.55))
    m.box((1.8, 2.6, 0.08), (1.9, 3.9, 0.55))
    m.box((0.2, 2.6, 0.08), (1.8, 2.7, 0.55))
    m.box((0.2, 3.8, 0.08), (1.8, 3.9, 0.55))
    m.ball((0.6, 1.6, 0.4), 0.3, 20)
    m.tube((0.6, 1.6, 0), (0.6, 1.6, 0.2), 0.12, 20)
    s.add(m)
    s.matte((0.2, 0.45, 0.2))
    m = Mesh()
    for _ in range(1500):
        t, r, z = rng.random() * 2 * math.pi, 0.35 * math.sqrt(rng.random()), 0.5 + 0.8 * rng.random()
        p = (2.4 + r * math.cos(t), 3.5 + r * math.sin(t) * 0.8, z)
        u, v = ([rng.gauss(0, 1) for _ in range(3)] for _ in range(2))
        m.triangle(p, tuple(p[i] + 0.04 * u[i] for i in range(3)),
                   tuple(p[i] + 0.03 * v[i] for i in range(3)))
    m.tube((2.4, 3.5, 0), (2.4, 3.5, 0.5), 0.12, 20)
    s.add(m)
    s.matte((0.5, 0.5, 0.8))
    m = Mesh()
    for k in range(40):
        y, a, b = 0.3 + 0.02 * k, 0.02 + 0.015 * (k % 2), 0.02 + 0.015 * ((k + 1) % 2)
        m.quad((a, y, 0.6), (b, y + 0.02, 0.6), (b, y + 0.02, 1.4), (a, y, 1.4))
    s.add(m)
    m = Mesh()
    m.quad((3.2, 1, 0.9), (3.2, 1, 2.2), (3.2, 3, 2.2), (3.2, 3, 0.9))
    s.light(m, (16, 17, 18))
    return s


def ajar():
    s = Scene((0.5, 0.5, 1.6), (2.6, 3.4, 1.0), 70)
    s.matte((0.5, 0.4, 0.3))
    m = Mesh()
    m.quad((0, 0, 0), (8, 0, 0), (8, 5, 0), (0, 5, 0))
    s.add(m)
    s.matte((0.7, 0.7, 0.7))
    m = Mesh()
    m.quad((0, 0, 2.6), (0, 5, 2.6), (8, 5, 2.6), (8, 0, 2.6))
    m.quad((0, 0, 0), (0, 0, 2.6), (8, 0, 2.6), (8, 0, 0))
    m.quad((0, 5, 0), (8, 5, 0), (8, 5, 2.6), (0, 5, 2.6))
    m.quad((0, 0, 0), (0, 5, 0), (0, 5, 2.6), (0, 0, 2.6))
    m.quad((8, 0, 0), (8, 0, 2.6), (8, 5, 2.6), (8, 5, 0))
    m.quad((4, 0, 0), (4, 0, 2.6), (4, 3, 2.6), (4, 3, 0))
    m.quad((4, 3.9, 0), (4, 3.9, 2.6), (4, 5, 2.6), (4, 5, 0))
    m.quad((4, 3, 2.0), (4, 3, 2.6), (4, 3.9, 2.6), (4, 3.9, 2.0))
    s.add(m)
    s.matte((0.45, 0.25, 0.15))
    m = Mesh()
    m.box((4, 3.0, 0.01), (4.04, 3.9, 1.99), turn=-0.25, centre=(4.02, 3.9, 1))
    s.add(m)
    s.matte((0.2, 0.3, 0.6))
    m = Mesh()
    m.box((1, 3.6, 0), (3, 4.6, 0.45))
    m.box((1, 4.5, 0.45), (3, 4.6, 0.9))
    m.box((2.2, 1.8, 0.7), (3.2, 2.6, 0.74))
    for x in (2.25, 3.15):
        for y in (1.85, 2.55):
            m.tube((x, y, 0), (x, y, 0.7), 0.03)
    m.ball((2.6, 2.2, 0.9), 0.16, 14)
    s.add(m)
    s.light(facing_down(6, 2.5, 2.59, 1, 1), (25, 24, 22))
    return s


def gallery():
    s = Scene((1, 1, 1.6), (7, 4, 1.8), 75)
    s.room((0, 0, 0), (12, 6, 4), wall=(0.8, 0.8, 0.78), floor=(0.35, 0.22, 0.15),
           ceiling=(0.85, 0.85, 0.85))
    s.matte((0.8, 0.8, 0.8))
    m, d, z = Mesh(), 0.5, 3.4
    for low, high in (((0, 0, z), (12, d, z + 0.05)), ((0, 6 - d, z), (12, 6, z + 0.05)),
                      ((0, d, z), (d, 6 - d, z + 0.05)), ((12 - d, d, z), (12, 6 - d, z + 0.05)),
                      ((d, d - 0.04, z + 0.05), (12 - d, d, z + 0.2)),
                      ((d, 6 - d, z + 0.05), (12 - d, 6 - d + 0.04, z + 0.2)),
                      ((d - 0.04, d, z + 0.05), (d, 6 - d, z + 0.2)),
                      ((12 - d, d, z + 0.05), (12 - d + 0.04, 6 - d, z + 0.2))):
        m.box(low, high)
    s.add(m)
    s.matte((0.15, 0.15, 0.5))
    m = Mesh()
    for k in range(5):
        m.box((1.5 + 2 * k, 5.96, 1.2), (2.7 + 2 * k, 5.99, 2.2))
    s.add(m)
    s.matte((0.7, 0.68, 0.6))
    m = Mesh()
    m.box((5, 2.4, 0), (7, 3.2, 0.42))
    m.ball((9, 3, 1.3), 0.5, 20)
    m.tube((9, 3, 0), (9, 3, 0.8), 0.35, 24)
    s.add(m)
    m = Mesh()
    for y in (0.25, 5.75):
        m.quad((0.6, y - 0.03, 3.5), (11.4, y - 0.03, 3.5), (11.4, y + 0.03, 3.5),
               (0.6, y + 0.03, 3.5))
    s.light(m, (220, 210, 190))
    return s


def gloss():
    s = Scene((0.6, 0.6, 1.5), (3, 3, 0.8), 65)
    s.room((0, 0, 0), (5, 4, 2.8))
    for k, roughness in enumerate((0.02, 0.05, 0.1, 0.2, 0.35, 0.6)):
        if k % 2:
            s.metal((0.9, 0.8, 0.6), roughness)
        else:
            s.coated((0.5, 0.2, 0.2), roughness)
        m = Mesh()
        m.box((0.5 + 0.7 * k, 2.8, 0.0), (1.1 + 0.7 * k, 2.85, 1.6))
        m.ball((0.8 + 0.7 * k, 2.0, 0.28), 0.28, 24)
        s.add(m)
    s.coated((0.4, 0.4, 0.4), 0.15)
    m = Mesh()
    m.quad((0.2, 0.2, 0.01), (4.8, 0.2, 0.01), (4.8, 3.8, 0.01), (0.2, 3.8, 0.01))
    s.add(m)
    for k, radius in enumerate((0.03, 0.08, 0.2)):
        s.light(f'Translate {1.2 + 1.3 * k:g} 3.2 2.2\nShape "sphere" "float radius" [{radius:g}]\n',
                (0.12 / radius**2,) * 3)
    s.light(facing_down(2.5, 2, 2.78, 1.5, 0.3), (10, 10, 10))
    return s


INTERIORS = {
    "staircase": staircase,
    "staircase-metal": lambda: staircase(True),
    "bathroom": bathroom,
    "ajar": ajar,
    "gallery": gallery,
    "furniture": lambda: room(furniture),
    "gloss": gloss,
    **DENSE,
}


def write(name, path):
    INTERIORS[name]().save(path)
