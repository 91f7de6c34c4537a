"""Scenes of random rooms as data: parts with a material, lights, a camera. Metres, z up, W/(m² sr).

write_pbrt.py and write_gltf.py write them as files.
"""

import math
import os
import struct
import sys
import zlib

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../interiors"))
from mesh import Mesh  # noqa: E402  pylint: disable=wrong-import-position

lumens_per_watt = 179


class Material:
    """kind: matte, coated, metal, glass (solid), pane (thin sheet) or translucent (a cloth).
    width: of the glossy lobe (GGX), 0 for a mirror. texture: name of a PNG in the scene's folder."""

    def __init__(self, kind, rgb=(1, 1, 1), width=0.0, texture=None):
        self.kind, self.rgb, self.width, self.texture = kind, tuple(rgb), width, texture


class Part:
    """A mesh, or an exact sphere (centre, radius). emission: radiance of the front."""

    def __init__(self, material, mesh=None, sphere=None, emission=None):
        self.material, self.mesh, self.sphere, self.emission = material, mesh, sphere, emission


class Scene:
    def __init__(self):
        self.parts = []
        self.points = []  # point lights and spots: (kind, position, target, W/sr, degrees)
        self.luminaires = []  # (IES file, position, flux in lumens)
        self.files = {}  # further files: name, bytes
        self.options = []  # of troffer render: sky and sun
        self.tags = set()
        self.camera = None  # (eye, target, degrees over the shorter side)

    def add(self, material, mesh, emission=None):
        if mesh.triangles:
            self.parts.append(Part(material, mesh, None, emission))

    def add_sphere(self, material, centre, radius, emission=None):
        self.parts.append(Part(material, None, (centre, radius), emission))


def along(p, *steps):
    """Returns p plus the sum of (vector, length) pairs."""
    return tuple(p[k] + sum(v[k] * s for v, s in steps) for k in range(3))


def sheet(mesh, origin, u, v, width, height, holes=()):
    """Adds a rectangle with rectangular holes (u0, u1, v0, v1) that do not overlap along u."""
    at = 0.0
    for u0, u1, v0, v1 in sorted(holes) + [(width, width, 0, 0)]:
        for a, b, c, d in ((at, u0, 0, height), (u0, u1, 0, v0), (u0, u1, v1, height)):
            if b > a and d > c:
                mesh.quad(*(along(origin, (u, p), (v, q)) for p, q in
                            ((a, c), (b, c), (b, d), (a, d))))
        at = u1


def tunnel(mesh, origin, u, v, out, hole, depth):
    """Adds the four sides of a hole, from its rim along `out`."""
    u0, u1, v0, v1 = hole
    rim = [along(origin, (u, p), (v, q)) for p, q in ((u0, v0), (u1, v0), (u1, v1), (u0, v1))]
    for a, b in zip(rim, rim[1:] + rim[:1]):
        mesh.quad(a, b, along(b, (out, depth)), along(a, (out, depth)))


def grid(mesh, point, rows, columns):
    """Adds a curved surface: point(s, t) for s, t from 0 to 1."""
    n = len(mesh.points)
    mesh.points += [point(i / rows, j / columns) for i in range(rows + 1)
                    for j in range(columns + 1)]
    for i in range(rows):
        for j in range(columns):
            a = n + i * (columns + 1) + j
            mesh.triangles += [(a, a + 1, a + columns + 2), (a, a + columns + 2, a + columns + 1)]


def turned(mesh, centre, profile, sides=24):
    """Adds a surface of revolution about a vertical axis. profile: (radius, height) pairs."""
    def point(s, t):
        r, z = profile[min(int(s * (len(profile) - 1) + 0.5), len(profile) - 1)]
        return (centre[0] + r * math.cos(2 * math.pi * t), centre[1] + r * math.sin(2 * math.pi * t),
                centre[2] + z)
    grid(mesh, point, len(profile) - 1, sides)


def rounded_box(mesh, low, high, power=0.35, rings=10):
    """Adds a superellipsoid: a cushion that fills the box."""
    centre = [(a + b) / 2 for a, b in zip(low, high)]
    half = [(b - a) / 2 for a, b in zip(low, high)]

    def root(x):
        return math.copysign(abs(x) ** power, x) if abs(x) > 1e-9 else 0.0

    def point(s, t):
        p, q = math.pi * (s - 0.5), 2 * math.pi * t
        return (centre[0] + half[0] * root(math.cos(p)) * root(math.cos(q)),
                centre[1] + half[1] * root(math.cos(p)) * root(math.sin(q)),
                centre[2] + half[2] * root(math.sin(p)))
    grid(mesh, point, rings, 2 * rings)


def png(width, height, rgb):
    """Returns an RGB picture as the bytes of a PNG. rgb(x, y): three bytes."""
    rows = b"".join(b"\0" + b"".join(bytes(rgb(x, y)) for x in range(width)) for y in range(height))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def uv_of(p):
    """Texture coordinates of a point of a wall or floor: one repetition per metre."""
    return (p[0] + p[1], p[2] + 0.37 * p[1])
