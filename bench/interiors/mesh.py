"""Triangles of simple bodies, and scenes of them as pbrt-v4 files. Metres, z up."""

import math


class Mesh:
    def __init__(self):
        self.points, self.triangles = [], []

    def quad(self, a, b, c, d):
        n = len(self.points)
        self.points += [a, b, c, d]
        self.triangles += [(n, n + 1, n + 2), (n, n + 2, n + 3)]

    def triangle(self, a, b, c):
        n = len(self.points)
        self.points += [a, b, c]
        self.triangles.append((n, n + 1, n + 2))

    def box(self, low, high, turn=0.0, tilt=0.0, centre=None):
        """Adds a box, tilted about y, then turned about z, in radians, around its centre."""
        (x0, y0, z0), (x1, y1, z1) = low, high
        c = centre or ((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2)

        def turned(p):
            x, y, z = (p[k] - c[k] for k in range(3))
            x, z = x * math.cos(tilt) - z * math.sin(tilt), x * math.sin(tilt) + z * math.cos(tilt)
            x, y = x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn)
            return (x + c[0], y + c[1], z + c[2])

        n = len(self.points)
        self.points += [turned((x, y, z)) for z in (z0, z1) for y in (y0, y1) for x in (x0, x1)]
        for p, q, r, s in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2),
                           (1, 3, 7, 5)):
            self.triangles += [(n + p, n + q, n + r), (n + p, n + r, n + s)]

    def tube(self, a, b, radius, sides=8, has_caps=True):
        d = [b[k] - a[k] for k in range(3)]
        size = math.sqrt(sum(x * x for x in d))
        d = [x / size for x in d]
        h = (1, 0, 0) if abs(d[0]) < 0.8 else (0, 1, 0)
        u = [h[1] * d[2] - h[2] * d[1], h[2] * d[0] - h[0] * d[2], h[0] * d[1] - h[1] * d[0]]
        size = math.sqrt(sum(x * x for x in u))
        u = [x / size for x in u]
        w = [d[1] * u[2] - d[2] * u[1], d[2] * u[0] - d[0] * u[2], d[0] * u[1] - d[1] * u[0]]
        n = len(self.points)
        for end in (a, b):
            for k in range(sides):
                t = 2 * math.pi * k / sides
                self.points.append(tuple(end[j] + radius * (math.cos(t) * u[j] + math.sin(t) * w[j])
                                         for j in range(3)))
        for k in range(sides):
            m = (k + 1) % sides
            self.triangles += [(n + k, n + m, n + sides + m), (n + k, n + sides + m, n + sides + k)]
        if has_caps:
            for k in range(1, sides - 1):
                self.triangles += [(n, n + k + 1, n + k),
                                   (n + sides, n + sides + k, n + sides + k + 1)]

    def ball(self, centre, radius, rings=12, stretch=1.0):
        n = len(self.points)
        for j in range(rings + 1):
            t = math.pi * j / rings
            for k in range(2 * rings):
                f = math.pi * k / rings
                self.points.append((centre[0] + radius * math.sin(t) * math.cos(f),
                                    centre[1] + radius * math.sin(t) * math.sin(f),
                                    centre[2] + stretch * radius * math.cos(t)))
        for j in range(rings):
            for k in range(2 * rings):
                a, b = n + j * 2 * rings + k, n + j * 2 * rings + (k + 1) % (2 * rings)
                if j > 0:
                    self.triangles.append((a, a + 2 * rings, b))
                if j < rings - 1:
                    self.triangles.append((b, a + 2 * rings, b + 2 * rings))

    def text(self):
        points = " ".join("%.6g %.6g %.6g" % p for p in self.points)
        indices = " ".join("%d %d %d" % t for t in self.triangles)
        return f'Shape "trianglemesh" "point3 P" [ {points} ] "integer indices" [ {indices} ]\n'


def facing_down(x, y, z, width, depth):
    m = Mesh()
    x0, x1, y0, y1 = x - width / 2, x + width / 2, y - depth / 2, y + depth / 2
    m.quad((x0, y0, z), (x0, y1, z), (x1, y1, z), (x1, y0, z))
    return m


class Scene:
    def __init__(self, eye, target, fov, size=(256, 192)):
        self.head = ("LookAt %g %g %g  %g %g %g  0 0 1\n" % (*eye, *target)
                     + f'Camera "perspective" "float fov" [{fov:g}]\n'
                     + f'Film "rgb" "integer xresolution" [{size[0]}] '
                     + f'"integer yresolution" [{size[1]}] "string filename" ["picture.exr"]\n'
                     + 'Sampler "halton"\nIntegrator "path"\nWorldBegin\n')
        self.body = []

    def matte(self, rgb):
        self.body.append('Material "diffuse" "rgb reflectance" [%g %g %g]\n' % rgb)

    def coated(self, rgb, roughness):
        self.body.append('Material "coateddiffuse" "rgb reflectance" [%g %g %g] '
                         '"float roughness" [%g]\n' % (*rgb, roughness))

    def metal(self, rgb, roughness):
        self.body.append('Material "conductor" "rgb reflectance" [%g %g %g] '
                         '"float roughness" [%g]\n' % (*rgb, roughness))

    def add(self, mesh):
        self.body.append(mesh.text())

    def light(self, shape, rgb):
        text = shape if isinstance(shape, str) else shape.text()
        self.body.append('AttributeBegin\nMaterial "diffuse" "rgb reflectance" [0 0 0]\n'
                         'AreaLightSource "diffuse" "rgb L" [%g %g %g]\n' % rgb + text
                         + "AttributeEnd\n")

    def room(self, low, high, wall=(0.7, 0.7, 0.7), floor=(0.4, 0.3, 0.25), ceiling=(0.8, 0.8, 0.8)):
        (x0, y0, z0), (x1, y1, z1) = low, high
        self.matte(floor)
        m = Mesh()
        m.quad((x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0))
        self.add(m)
        self.matte(ceiling)
        m = Mesh()
        m.quad((x0, y0, z1), (x0, y1, z1), (x1, y1, z1), (x1, y0, z1))
        self.add(m)
        self.matte(wall)
        m = Mesh()
        m.quad((x0, y0, z0), (x0, y0, z1), (x1, y0, z1), (x1, y0, z0))
        m.quad((x0, y1, z0), (x1, y1, z0), (x1, y1, z1), (x0, y1, z1))
        m.quad((x0, y0, z0), (x0, y1, z0), (x0, y1, z1), (x0, y0, z1))
        m.quad((x1, y0, z0), (x1, y0, z1), (x1, y1, z1), (x1, y1, z0))
        self.add(m)

    def save(self, path):
        with open(path, "w") as file:
            file.write(self.head + "".join(self.body))
