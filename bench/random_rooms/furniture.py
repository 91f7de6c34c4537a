"""Furniture of random rooms: many small parts, curves, glass, metal, mirrors, leaves."""

import math

from scene import Material, Mesh, grid, rounded_box, turned


def wood(rng):
    rgb = [rng.uniform(0.15, 0.6) * f for f in (1, 0.7, 0.45)]
    return Material("coated", rgb, rng.choice([0.05, 0.2, 0.4])) if rng.random() < 0.4 else Material(
        "matte", rgb)


def metal(rng):
    return Material("metal", rng.choice([(0.9, 0.9, 0.92), (0.9, 0.7, 0.4), (0.3, 0.3, 0.32)]),
                    rng.choice([0.0, 0.08, 0.25, 0.4]))


def paint(rng):
    grey = rng.uniform(0.05, 0.9)
    return Material("matte", [min(0.95, grey * rng.uniform(0.6, 1.3)) for _ in range(3)])


def table(rng, scene, room):
    w, d, h = rng.uniform(0.6, 1.6), rng.uniform(0.5, 0.9), rng.uniform(0.4, 0.75)
    place = room.place(rng, w, d)
    if place is None:
        return None
    x, y = place
    top, legs = Mesh(), Mesh()
    kind = rng.choice(["glass", "pane", "wood", "wood"])
    if kind == "pane":
        top.quad((x, y, h), (x + w, y, h), (x + w, y + d, h), (x, y + d, h))
    else:
        top.box((x, y, h - (0.01 if kind == "glass" else 0.03)), (x + w, y + d, h))
    for p in (x + 0.05, x + w - 0.05):
        for q in (y + 0.05, y + d - 0.05):
            legs.tube((p, q, 0), (p, q, h - 0.031), 0.02, 10)
    scene.add(wood(rng) if kind == "wood" else Material(kind), top)
    scene.add(metal(rng), legs)
    scene.tags.add("table" if kind == "wood" else "glass table")
    return (x + w / 2, y + d / 2, h + 0.001)


def ornament(rng, scene, place):
    """Puts a vase, a metal ball or a ball of solid glass somewhere."""
    x, y, z = place
    kind = rng.random()
    if kind < 0.15:
        scene.add_sphere(Material("glass"), (x, y, z + 0.08), 0.08)
        scene.tags.add("glass ball")
    elif kind < 0.4:
        mesh = Mesh()
        mesh.ball((x, y, z + 0.1), 0.1, 14)
        scene.add(metal(rng), mesh)
    else:
        mesh, waist = Mesh(), rng.uniform(0.03, 0.08)
        turned(mesh, place, [(0, 0.0), (0.05, 0.0), (0.08, 0.06), (0.07, 0.14), (waist, 0.2),
                             (waist, 0.24), (waist + 0.02, 0.27)])
        scene.add(Material("coated", paint(rng).rgb, 0.1), mesh)


def chair(rng, scene, room):
    """A curved shell on four thin legs."""
    place = room.place(rng, 0.5, 0.5)
    if place is None:
        return
    x, y, turn = place[0] + 0.25, place[1] + 0.25, rng.uniform(0, 2 * math.pi)

    def stand(p, q, z):
        return (x + p * math.cos(turn) - q * math.sin(turn),
                y + p * math.sin(turn) + q * math.cos(turn), z)

    def point(s, t):
        a = -0.2 + 1.9 * s  # from the front edge up the back
        q = -0.22 + 0.4 * min(a, 1.0)
        z = 0.45 + 0.38 * max(0.0, a - 0.75) + 0.05 * (2 * t - 1) ** 2
        return stand(0.44 * (t - 0.5), q + 0.06 * max(0.0, a - 1), z)
    seat, legs = Mesh(), Mesh()
    grid(seat, point, 12, 8)
    for p, q in ((-0.18, -0.18), (0.18, -0.18), (-0.18, 0.16), (0.18, 0.16)):
        legs.tube(stand(p, q, 0), stand(0.8 * p, 0.8 * q, 0.44), 0.012, 8)
    scene.add(rng.choice([paint, wood])(rng), seat)
    scene.add(metal(rng), legs)


def shelf(rng, scene, room):
    """A bookcase: four boards and dozens of books."""
    w, d, h = rng.uniform(0.7, 1.4), 0.3, rng.uniform(1.2, 2.0)
    place = room.place(rng, w, d, True)
    if place is None:
        return
    x, y = place
    boards, books = Mesh(), (Mesh(), Mesh(), Mesh())
    boards.box((x, y, 0), (x + 0.02, y + d, h))
    boards.box((x + w - 0.02, y, 0), (x + w, y + d, h))
    for k in range(5):
        z = (h - 0.02) * k / 4
        boards.box((x + 0.02, y, z), (x + w - 0.02, y + d, z + 0.02))
        at = x + 0.03
        while k < 4 and at < x + w - 0.1:
            thick = rng.uniform(0.015, 0.05)
            tall = rng.uniform(0.5, 0.9) * h / 4
            rng.choice(books).box((at, y + 0.04, z + 0.02), (at + thick, y + 0.25, z + 0.02 + tall))
            at += thick + rng.choice([0.001, 0.001, 0.004, 0.1])
    scene.add(wood(rng), boards)
    for mesh in books:
        scene.add(paint(rng), mesh)


def sofa(rng, scene, room):
    place = room.place(rng, 1.8, 0.85, True)
    if place is None:
        return
    x, y = place
    mesh = Mesh()
    rounded_box(mesh, (x, y, 0.05), (x + 1.8, y + 0.85, 0.42))
    rounded_box(mesh, (x, y + 0.02, 0.3), (x + 0.22, y + 0.85, 0.62))
    rounded_box(mesh, (x + 1.58, y + 0.02, 0.3), (x + 1.8, y + 0.85, 0.62))
    for k in range(3):
        rounded_box(mesh, (x + 0.25 + 0.43 * k, y + 0.1, 0.4), (x + 0.67 + 0.43 * k, y + 0.8, 0.5))
    scene.add(paint(rng), mesh)


def mirror(rng, scene, room):
    """A mirror in a frame on a wall without openings."""
    sides = [s for s, holes in room.holes.items() if not holes]
    if not sides:
        return None
    origin, u, out, length = room.wall(rng.choice(sides))
    w, h = min(rng.uniform(0.5, 2.0), length - 0.4), rng.uniform(0.6, 1.4)
    a, z = rng.uniform(0.2, length - w - 0.2), rng.uniform(0.3, 0.9)

    def at(p, q, height):
        return tuple(origin[i] + u[i] * p - out[i] * q for i in range(2)) + (height,)
    glass, frame = Mesh(), Mesh()
    glass.quad(at(a, 0.02, z), at(a + w, 0.02, z), at(a + w, 0.02, z + h), at(a, 0.02, z + h))
    for p, r, b, t in ((a - 0.05, a, z, z + h), (a + w, a + w + 0.05, z, z + h),
                       (a - 0.05, a + w + 0.05, z - 0.05, z), (a - 0.05, a + w + 0.05, z + h, z + h + 0.05)):
        corners = at(p, 0.001, b), at(r, 0.05, t)
        frame.box([min(c) for c in zip(*corners)], [max(c) for c in zip(*corners)])
    scene.add(Material("metal", (0.93, 0.93, 0.93), 0.0), glass)
    scene.add(wood(rng), frame)
    scene.tags.add("mirror")
    return at(a + w / 2, 0.02, z + h / 2)


def plant(rng, scene, room):
    place = room.place(rng, 0.5, 0.5)
    if place is None:
        return
    x, y = place[0] + 0.25, place[1] + 0.25
    pot, leaves = Mesh(), Mesh()
    turned(pot, (x, y, 0), [(0, 0.0), (0.12, 0.0), (0.16, 0.3), (0.14, 0.3), (0, 0.26)], 16)
    for _ in range(rng.choice([40, 150, 400])):
        c = (x + rng.gauss(0, 0.12), y + rng.gauss(0, 0.12), 0.7 + rng.gauss(0, 0.2))
        a, b = ([rng.gauss(0, 0.04) for _ in range(3)] for _ in range(2))
        if c[2] > 0.35:
            leaves.quad(*(tuple(c[k] + p * a[k] + q * b[k] for k in range(3))
                          for p, q in ((-1, 0), (0, -1), (1, 0), (0, 1))))
    scene.add(paint(rng), pot)
    scene.add(Material("translucent" if rng.random() < 0.5 else "matte", (0.15, 0.4, 0.1)), leaves)
    scene.tags.add("plant")


def clutter(rng, scene, room):
    """A stack of turned boxes and a few balls on the floor."""
    mesh = Mesh()
    for _ in range(rng.randint(5, 25)):
        place = room.place(rng, 0.2, 0.2)
        if place:
            centre, half = (place[0] + 0.1, place[1] + 0.1), rng.uniform(0.02, 0.07)
            mesh.box((centre[0] - half, centre[1] - half, 0.001),
                     (centre[0] + half, centre[1] + half, rng.uniform(0.05, 0.5)),
                     turn=rng.uniform(0, 3))
    scene.add(paint(rng), mesh)


pieces = [table, table, chair, chair, shelf, sofa, plant, clutter]


def furnish(rng, scene, room):
    """Furnishes a room; returns points worth looking at."""
    seen = []
    for _ in range(rng.choice([1, 3, 5, 8])):
        place = rng.choice(pieces)(rng, scene, room)
        if place:
            seen.append(place)
            if rng.random() < 0.7:
                ornament(rng, scene, place)
    if rng.random() < 0.3:
        place = mirror(rng, scene, room)
        if place:
            seen.append(place)
    return seen
