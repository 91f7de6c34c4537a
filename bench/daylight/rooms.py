#!/usr/bin/env python3
"""Writes rooms lit by the sky as pbrt-v4 files (metres, z up): rooms.py FOLDER"""
import array
import math
import pathlib
import random
import sys


def quad(a, b, c, d):
    points = ' '.join('%g %g %g' % v for v in (a, b, c, d))
    return f'Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [{points}]\n'


def box(low, high):
    (x0, y0, z0), (x1, y1, z1) = low, high
    return (quad((x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0))
            + quad((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1))
            + quad((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1))
            + quad((x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0))
            + quad((x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0))
            + quad((x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)))


def head(eye, at, fov):
    return (f'LookAt {eye[0]} {eye[1]} {eye[2]}  {at[0]} {at[1]} {at[2]}  0 0 1\n'
            f'Camera "perspective" "float fov" [{fov}]\n'
            'Film "rgb" "integer xresolution" [64] "integer yresolution" [48] "string filename" "x.exr"\n'
            'WorldBegin\nMaterial "diffuse" "rgb reflectance" [.6 .6 .6]\n')


X, Y, Z, T = 5, 4, 2.7, 0.2  # size of a room, thickness of its walls


def room(window=None, skylight=None):
    """A room of boxes. window: y0, y1, z0, z1 in the wall at X; skylight: x0, x1, y0, y1."""
    s = head((.4, .5, 1.7), (3.5, 2.6, .8), 70)
    s += box((-T, -T, -T), (X + T, Y + T, 0)) + box((-T, -T, 0), (0, Y + T, Z))
    s += box((0, -T, 0), (X, 0, Z)) + box((0, Y, 0), (X, Y + T, Z))
    y0, y1, z0, z1 = window or (1, 1, 1, 1)
    s += box((X, -T, 0), (X + T, y0, Z)) + box((X, y1, 0), (X + T, Y + T, Z))
    if window:
        s += box((X, y0, 0), (X + T, y1, z0)) + box((X, y0, z1), (X + T, y1, Z))
    x0, x1, y0, y1 = skylight or (1, 1, 0, 0)
    s += box((-T, -T, Z), (x0, Y + T, Z + T)) + box((x1, -T, Z), (X + T, Y + T, Z + T))
    if skylight:
        s += box((x0, -T, Z), (x1, y0, Z + T)) + box((x0, y1, Z), (x1, Y + T, Z + T))
    s += box((1.5, 1, .7), (2.5, 2.4, .75))  # a table, three stools, a cupboard
    for x in (1.55, 2.4):
        for y in (1.05, 2.3):
            s += box((x, y, 0), (x + .05, y + .05, .7))
    for i in range(3):
        x = 3 + .3 * (i % 2)
        s += box((x, 1 + .8 * i, 0), (x + .4, 1.4 + .8 * i, .45))
    return s + box((.02, 1, 0), (.35, 2.2, 1.8))


def blinds():
    s = room(window=(1, 3, .9, 2.1))
    for i in range(50):
        z, half = .9 + 1.2 * (i + .5) / 50, .00625
        s += quad((X - .05, 1, z - half), (X - .05, 3, z - half), (X - .025, 3, z + half),
                  (X - .025, 1, z + half))
    return s


def atrium():
    """A courtyard of 12 x 12 x 16 m with three galleries and their railings, and beams above."""
    s = head((1, 1, 1.6), (8, 8, 6), 75) + box((-1, -1, -.2), (13, 13, 0))
    s += box((-1, -1, 0), (0, 13, 16)) + box((12, -1, 0), (13, 13, 16))
    s += box((0, -1, 0), (12, 0, 16)) + box((0, 12, 0), (12, 13, 16))
    for z in (4, 8, 12):
        s += box((0, 0, z - .3), (12, 1.8, z)) + box((0, 10.2, z - .3), (12, 12, z))
        s += box((0, 1.8, z - .3), (1.8, 10.2, z)) + box((10.2, 1.8, z - .3), (12, 10.2, z))
        for i in range(29):
            u = 1.8 + i * .3
            for x, y in ((u, 1.75), (u, 10.2), (1.75, u), (10.2, u)):
                s += box((x, y, z), (x + .03, y + .03, z + 1))
    for i in range(11):
        s += box((0, .6 + i * 1.08, 16), (12, .7 + i * 1.08, 16.3))
    return s


def tree():
    """Six thousand leaves over an open plain, where proofs do not help."""
    random.seed(3)
    s = head((0, -7, 1.7), (0, 0, 1.5), 60)
    s += quad((-30, -30, 0), (30, -30, 0), (30, 30, 0), (-30, 30, 0)) + box((-.1, -.1, 0), (.1, .1, 3))
    points, indices = [], []
    for _ in range(6000):
        c = [random.gauss(0, 1.4), random.gauss(0, 1.4), 3 + random.gauss(0, .8)]
        sides = [[random.gauss(0, 1) for _ in range(3)] for _ in range(2)]
        a, b = ([.12 * v / math.hypot(*side) for v in side] for side in sides)
        n = len(points)
        points += [[c[i] + a[i] for i in range(3)], [c[i] + b[i] for i in range(3)],
                   [c[i] - a[i] for i in range(3)]]
        indices += [n, n + 1, n + 2]
    positions = ' '.join('%.4f %.4f %.4f' % tuple(p) for p in points)
    return s + (f'Shape "trianglemesh" "integer indices" [{" ".join(map(str, indices))}] '
                f'"point3 P" [{positions}]\n')


SCENES = {'window': lambda: room(window=(1, 3, .9, 2.1)), 'blinds': blinds,
          'skylight': lambda: room(skylight=(2, 3.2, 1.2, 2.6)), 'atrium': atrium, 'tree': tree}


def image():
    """Surroundings as a PFM of 256 x 128: a sun of a few texels, 35 degrees high in the south-east."""
    values = array.array('f')
    for row in range(128):
        altitude = 180 * (row + .5) / 128 - 90  # the lowest row comes first
        for column in range(256):
            azimuth = 360 * (column + .5) / 256 - 180  # from the east
            if math.hypot(altitude - 35, azimuth - 30) < 2:
                values.extend((60000, 54000, 45000))
            elif altitude > 0:
                values.extend((25 + .2 * (90 - altitude), 35, 60))
            else:
                values.extend((12, 10, 7))
    return b'PF\n256 128\n-1.0\n' + values.tobytes()


def write(folder):
    for name, make in SCENES.items():
        (pathlib.Path(folder) / f'{name}.pbrt').write_text(make())
    (pathlib.Path(folder) / 'image.pfm').write_bytes(image())


if __name__ == '__main__':
    write(sys.argv[1])
