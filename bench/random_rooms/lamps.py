"""Lamps of random rooms, from a candle to a ceiling of light. Each adds its tag."""

import math

from scene import Material, Mesh, lumens_per_watt, tunnel

black = Material("matte", (0.02, 0.02, 0.02))


def colour(rng):
    return rng.choice([(1, 1, 1), (1, 0.8, 0.55), (1, 0.65, 0.35), (0.85, 0.95, 1)])


def lumens(rng, low, high):
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def radiance(rng, flux, area):
    """Radiance of a diffuse surface of a flux in lumens."""
    return tuple(c * flux / lumens_per_watt / (math.pi * area) for c in colour(rng))


def facing(mesh, x, y, z, width, depth, is_up=False):
    corners = [(x - width / 2, y - depth / 2, z), (x - width / 2, y + depth / 2, z),
               (x + width / 2, y + depth / 2, z), (x + width / 2, y - depth / 2, z)]
    mesh.quad(*(corners[::-1] if is_up else corners))


def height_at(room, y):
    middle = (room.y0 + room.y1) / 2
    return room.height + room.ridge * (1 - abs(y - middle) / (room.y1 - middle))


def downlights(rng, scene, room):
    """A row of niches in a flat ceiling, each with a lamp at its top."""
    if room.ridge > 0:
        return panel(rng, scene, room)
    n, y = rng.randint(1, 5), room.inside(rng, 0.5)[1] - room.y0
    size, depth, flux = rng.uniform(0.06, 0.2), rng.uniform(0.05, 0.3), lumens(rng, 100, 1500)
    niche = Mesh()
    for k in range(n):
        x = (room.x1 - room.x0) * (k + 0.5) / n
        hole = (x - size / 2, x + size / 2, y - size / 2, y + size / 2)
        room.ceiling_holes.append(hole)
        tunnel(niche, (room.x0, room.y0, room.height), (1, 0, 0), (0, 1, 0), (0, 0, 1), hole, depth)
        lamp = Mesh()
        facing(lamp, room.x0 + x, room.y0 + y, room.height + depth, size, size)
        scene.add(black, lamp, radiance(rng, flux, size * size))
    scene.add(Material("matte", (0.8, 0.8, 0.8)) if rng.random() < 0.6 else
              Material("metal", (0.85, 0.85, 0.85), rng.choice([0.05, 0.3])), niche)
    scene.tags.add("downlights")
    return None


def panel(rng, scene, room):
    x, y = room.inside(rng, 0.7)
    mesh, w, d = Mesh(), rng.uniform(0.2, 1.2), rng.uniform(0.2, 1.0)
    facing(mesh, x, y, room.height - 0.01, w, d)
    scene.add(black, mesh, radiance(rng, lumens(rng, 300, 6000), w * d))
    scene.tags.add("panel")


def ies_text(rng):
    """A luminaire of rotational symmetry: a beam, a batwing, or light up and down."""
    kind = rng.choice(["beam", "batwing", "both"])
    size = rng.choice([(0, 0), (0.6, 0.6), (0.3, 1.2), (-0.1, -0.1)])
    width = rng.uniform(8, 40)
    angles = [2.5 * k for k in range(73)]

    def candela(a):
        t = math.radians(a)
        if kind == "beam":
            return 3000 * math.exp(-0.69 * (a / width) ** 2) if a < 90 else 0
        if kind == "batwing":
            return 900 * max(0.0, math.cos(t)) * (0.3 + math.sin(2 * t) ** 2) if a < 90 else 0
        return 400 * max(0.0, math.cos(t)) + 700 * max(0.0, -math.cos(t))
    rows = [angles, [0], [candela(a) for a in angles]]
    return kind, ("IES:LM-63-2002\n[TEST] computed\n[TESTLAB] none\n[ISSUEDATE] 2026\n[MANUFAC] none\n"
                  f"TILT=NONE\n1 -1 1 73 1 1 2 {size[0]} {size[1]} 0\n1 1 10\n" +
                  "".join("\n".join(" ".join("%.5g" % v for v in row[k:k + 10])
                                    for k in range(0, len(row), 10)) + "\n" for row in rows))


def measured(rng, scene, room):
    """One to six luminaires with the distribution of an IES file."""
    kind, text = ies_text(rng)
    name = f"luminaire{len(scene.files)}.ies"
    scene.files[name] = text.encode()
    flux = lumens(rng, 200, 4000)
    for _ in range(rng.choice([1, 2, 6])):
        x, y = room.inside(rng, 0.4)
        drop = 0.5 if kind == "both" else 0.02
        scene.luminaires.append((name, (x, y, room.height - drop), flux))
    scene.tags.add("IES " + kind)


def shaded_bulb(rng, scene, room):
    """A bulb in a conical shade of cloth or tin, or in a thin globe of glass; hung or on a pole."""
    x, y = room.inside(rng, 0.4)
    z = room.height - rng.uniform(0.3, 0.9) if rng.random() < 0.6 else rng.uniform(1.0, 1.5)
    radius = rng.uniform(0.012, 0.04)
    light = radiance(rng, lumens(rng, 100, 1500), 4 * math.pi * radius ** 2)
    scene.add_sphere(black, (x, y, z), radius, light)
    wide, n, mesh = rng.uniform(0.1, 0.25), 28, Mesh()
    kind = rng.choice(["cloth", "cloth", "tin", "globe"])
    if kind == "globe":
        mesh.ball((x, y, z), wide * 0.6, 10)
        scene.add(Material("pane"), mesh)
    else:
        for k in range(n):
            a, b = (2 * math.pi * j / n for j in (k, k + 1))
            mesh.quad(*((x + r * math.cos(t), y + r * math.sin(t), z + h) for r, t, h in
                        ((wide, a, -0.1), (wide, b, -0.1), (wide * 0.5, b, 0.13),
                         (wide * 0.5, a, 0.13))))
        scene.add(Material("translucent", (0.85, 0.75, 0.6)) if kind == "cloth" else
                  rng.choice([black, Material("metal", (0.9, 0.8, 0.5), 0.2)]), mesh)
    pole = Mesh()
    pole.tube((x, y, 0 if z < 1.6 else z + radius), (x, y, z - radius if z < 1.6 else room.height),
              0.006, 6)
    scene.add(Material("metal", (0.8, 0.8, 0.8), 0.1), pole)
    scene.tags.add("bulb in " + kind)


def cove(rng, scene, room):
    """A ledge along a wall that hides a strip of light below the ceiling."""
    length, z = room.x1 - room.x0 - 0.1, room.height - rng.uniform(0.12, 0.3)
    deep, lip = rng.uniform(0.1, 0.2), rng.uniform(0.02, 0.08)
    ledge, strip = Mesh(), Mesh()
    x0, y0 = room.x0 + 0.05, room.y0 + 0.005
    ledge.box((x0, y0, z - 0.02), (x0 + length, y0 + deep, z))
    ledge.box((x0, y0 + deep, z - 0.02), (x0 + length, y0 + deep + 0.015, z + lip))
    parts = rng.choice([1, 1, 12])
    for k in range(parts):
        w = length / parts * (0.98 if parts == 1 else 0.3)
        facing(strip, x0 + length * (k + 0.5) / parts, y0 + deep / 2, z + 0.005, w, 0.02, True)
    scene.add(Material("matte", (0.85, 0.85, 0.85)), ledge)
    scene.add(black, strip, radiance(rng, lumens(rng, 500, 5000), 0.02 * w * parts))
    scene.tags.add("cove")


def tubes(rng, scene, room):
    """Fluorescent tubes: emitting meshes of eight sides."""
    for _ in range(rng.randint(1, 3)):
        x, y = room.inside(rng, 0.8)
        mesh, length, radius = Mesh(), 1.2, rng.choice([0.008, 0.013])
        x = min(x, room.x1 - length / 2 - 0.1)
        z = room.height - rng.uniform(0.05, 0.6)
        mesh.tube((x - length / 2, y, z), (x + length / 2, y, z), radius, 8)
        scene.add(black, mesh, radiance(rng, lumens(rng, 500, 3000), 2 * math.pi * radius * length))
    scene.tags.add("tubes")


def candles(rng, scene, room):
    for _ in range(rng.choice([1, 4, 15])):
        x, y = room.inside(rng, 0.3)
        radius, z = 0.006, rng.uniform(0.3, 1.6)
        scene.add_sphere(black, (x, y, z), radius,
                         radiance(rng, lumens(rng, 3, 15), 4 * math.pi * radius ** 2))
    scene.tags.add("candles")


def screen(rng, scene, room):
    """A bright screen on the wall at x1, or a strip of small lights there."""
    w, y = min(1.1, (room.y1 - room.y0) * 0.5), (room.y0 + room.y1) / 2
    if any(a < y + w / 2 - room.y0 and b > y - w / 2 - room.y0 for a, b, _, _ in room.holes["x1"]):
        return
    x, n = room.x1 - 0.04, rng.choice([1, 1, 16])
    for k in range(n):
        mesh, a, b = Mesh(), y - w / 2 + w * k / n, y - w / 2 + w * (k + (1 if n == 1 else 0.2)) / n
        high = 0.65 if n == 1 else 0.02
        mesh.quad((x, a, 0.9), (x, a, 0.9 + high), (x, b, 0.9 + high), (x, b, 0.9))
        scene.add(black, mesh, radiance(rng, lumens(rng, 20, 500) / n, (b - a) * high))
    scene.tags.add("screen" if n == 1 else "small lights")


def bare_point(rng, scene, room):
    x, y = room.inside(rng, 0.4)
    flux = lumens(rng, 50, 1500) / lumens_per_watt
    target = (*room.inside(rng, 0.3), 0.0)
    degrees = rng.uniform(10, 50)
    kind = rng.choice(["point", "spot"])
    solid = 4 * math.pi if kind == "point" else 2 * math.pi * (1 - math.cos(math.radians(degrees)))
    scene.points.append((kind, (x, y, room.height - 0.2), target,
                         tuple(c * flux / solid for c in colour(rng)), degrees))
    scene.tags.add(kind)


kinds = [downlights, downlights, panel, panel, measured, measured, shaded_bulb, shaded_bulb, cove,
         tubes, candles, screen, bare_point]
