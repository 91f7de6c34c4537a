"""The shell of a random building: rooms side by side, doorways, windows, roofs, stairs."""

import math

from scene import Material, Mesh, sheet, tunnel

thickness = 0.2  # of walls


class Room:
    """A room with a flat ceiling or a gabled roof. Rectangles on its floor that are in use are kept
    in `taken`, so that furniture and cameras do not meet."""

    def __init__(self, x0, y0, x1, y1, height, ridge=0.0):
        self.x0, self.y0, self.x1, self.y1 = x0, y0, x1, y1
        self.height, self.ridge = height, ridge  # ridge: metres above `height`
        self.holes = {"x0": [], "x1": [], "y0": [], "y1": []}  # (u0, u1, v0, v1)
        self.ceiling_holes = []
        self.doors = []  # centres of doorways
        self.taken = []

    def wall(self, side):
        """Origin, direction along the wall, outward normal, length. v is always up."""
        if side[0] == "x":
            x = self.x0 if side == "x0" else self.x1
            return ((x, self.y0, 0), (0, 1, 0), (-1 if side == "x0" else 1, 0, 0),
                    self.y1 - self.y0)
        y = self.y0 if side == "y0" else self.y1
        return ((self.x0, y, 0), (1, 0, 0), (0, -1 if side == "y0" else 1, 0), self.x1 - self.x0)

    def is_free(self, low, high, gap=0.05):
        return all(high[0] + gap < a or low[0] - gap > c or high[1] + gap < b or low[1] - gap > d
                   for a, b, c, d in self.taken)

    def place(self, rng, width, depth, at_wall=False):
        """Takes a free rectangle; returns its corner, or None."""
        for _ in range(30):
            x = rng.uniform(self.x0 + 0.05, self.x1 - 0.05 - width)
            y = rng.uniform(self.y0 + 0.05, self.y1 - 0.05 - depth)
            if at_wall:
                y = self.y0 + 0.02 if rng.random() < 0.5 else self.y1 - 0.02 - depth
            if x > self.x0 and y > self.y0 and self.is_free((x, y), (x + width, y + depth)):
                self.taken.append((x, y, x + width, y + depth))
                return x, y
        return None

    def inside(self, rng, margin=0.4):
        return (rng.uniform(self.x0 + margin, self.x1 - margin),
                rng.uniform(self.y0 + margin, self.y1 - margin))


def plan(rng):
    """Returns one to four rooms in a row, some with an annex, joined by doorways."""
    rooms, x = [], 0.0
    for _ in range(rng.choice([1, 2, 2, 3])):
        width, depth = rng.uniform(2.2, 6), rng.uniform(2.4, 6)
        ridge = rng.uniform(0.5, 1.6) if rng.random() < 0.25 else 0.0
        rooms.append(Room(x, 0, x + width, depth, rng.uniform(2.3, 3.4), ridge))
        x += width + thickness
    for a, b in zip(rooms, rooms[1:]):
        door(rng, a, "x1", b, "x0", min(a.y1, b.y1))
    if rng.random() < 0.3:
        base = rng.choice(rooms)
        annex = Room(base.x0, base.y1 + thickness, base.x1, base.y1 + rng.uniform(2.2, 4),
                     rng.uniform(2.2, 2.8))
        door(rng, base, "y1", annex, "y0", base.x1 - base.x0)
        rooms.append(annex)
    return rooms


def door(rng, a, side_a, b, side_b, length):
    """Cuts a doorway or a narrow gap through the walls of two neighbours."""
    width = rng.choice([0.03, 0.08, 0.7, 0.8, 0.9, 0.9, 1.6, 1.6])
    u0 = rng.uniform(0.15, length - width - 0.15)
    hole = (u0, u0 + width, 0.0, rng.uniform(1.9, 2.15))
    a.holes[side_a].append(hole)
    b.holes[side_b].append(hole)
    for room, side in ((a, side_a), (b, side_b)):
        origin, along_wall, _, _ = room.wall(side)
        middle = tuple(origin[k] + along_wall[k] * (u0 + width / 2) for k in range(3))
        if width > 0.5:
            room.doors.append((middle, a if room is b else b))
            room.taken.append((middle[0] - 0.6, middle[1] - 0.6, middle[0] + 0.6, middle[1] + 0.6))


def bars(mesh, room, side, hole, count, is_upright):
    """Adds glazing bars in the plane of a window."""
    origin, u, out, _ = room.wall(side)
    u0, u1, v0, v1 = hole
    for k in range(1, count + 1):
        f = k / (count + 1)
        a, b, c, d = ((u0 + f * (u1 - u0) - 0.02, u0 + f * (u1 - u0) + 0.02, v0, v1) if is_upright
                      else (u0, u1, v0 + f * (v1 - v0) - 0.02, v0 + f * (v1 - v0) + 0.02))
        corners = [tuple(origin[i] + u[i] * p + out[i] * q for i in range(2)) + (z,)
                   for p, q, z in ((a, 0.05, c), (b, 0.1, d))]
        mesh.box([min(p) for p in zip(*corners)], [max(p) for p in zip(*corners)])


def window(rng, scene, room, side, palette):
    """Cuts a window or a slit; adds pane, bars, a light shelf or a curtain."""
    origin, u, out, length = room.wall(side)
    width = rng.choice([0.04, 0.5, 0.9, 1.2, 1.8, 1.8]) if length > 2.4 else 0.6
    u0 = rng.uniform(0.2, length - width - 0.2)
    sill = rng.choice([0.1, 0.9, 1.4])
    hole = (u0, u0 + width, sill, sill + rng.uniform(0.4, room.height - sill - 0.15))
    room.holes[side].append(hole)

    def at(p, q, z):
        return tuple(origin[i] + u[i] * p + out[i] * q for i in range(2)) + (z,)
    mesh = Mesh()
    tunnel(mesh, origin, u, (0, 0, 1), out, hole, thickness)
    if width > 0.4:
        bars(mesh, room, side, hole, rng.choice([0, 1, 3]), True)
        bars(mesh, room, side, hole, rng.choice([0, 1, 2]), False)
    scene.add(palette(rng), mesh)
    if rng.random() < 0.6:
        pane = Mesh()
        pane.quad(at(u0, 0.12, sill), at(hole[1], 0.12, sill), at(hole[1], 0.12, hole[3]),
                  at(u0, 0.12, hole[3]))
        scene.add(Material("pane"), pane)
        scene.tags.add("pane")
    kind = rng.random()
    if kind < 0.3 and width > 0.4:
        shelf, z = Mesh(), sill + 0.7 * (hole[3] - sill)
        corners = at(u0, -0.5, z), at(hole[1], thickness + 0.3, z + 0.03)
        shelf.box([min(p) for p in zip(*corners)], [max(p) for p in zip(*corners)])
        scene.add(Material("metal", (0.9, 0.9, 0.9), rng.choice([0.0, 0.15]))
                  if rng.random() < 0.5 else Material("matte", (0.85, 0.85, 0.85)), shelf)
        scene.tags.add("light shelf")
    elif kind < 0.5 and width > 0.4:
        curtain = Mesh()
        n = 24
        for k in range(n):  # folds
            a, b = (u0 - 0.1 + (width + 0.2) * 0.6 * j / n for j in (k, k + 1))
            p, q = (-0.1 - 0.04 * math.sin(1.3 * j) for j in (k, k + 1))
            curtain.quad(at(a, p, sill - 0.1), at(b, q, sill - 0.1), at(b, q, hole[3] + 0.1),
                         at(a, p, hole[3] + 0.1))
        scene.add(Material("translucent", (0.8, 0.78, 0.7)), curtain)
        scene.tags.add("curtain")
    scene.tags.add("window" if width > 0.1 else "slit")


def roof(rng, room, mesh, has_sky):
    """Adds the ceiling, or two slopes along x, perhaps with a roof window."""
    w, d, t = room.x1 - room.x0, room.y1 - room.y0, thickness / 4
    if room.ridge == 0:
        sheet(mesh, (room.x0, room.y0, room.height), (1, 0, 0), (0, 1, 0), w, d,
              room.ceiling_holes)
        return False
    slope = math.hypot(d / 2, room.ridge)
    up = (d / 2 / slope, room.ridge / slope)
    has_window = has_sky and rng.random() < 0.6
    for y, sign in ((room.y0, 1), (room.y1, -1)):
        v, hole = (0, sign * up[0], up[1]), []
        if has_window and sign == 1:
            hole = [(0.3 * w, 0.3 * w + 0.7, 0.3 * slope, 0.6 * slope)]
        sheet(mesh, (room.x0 - t, y, room.height), (1, 0, 0), v, w + 2 * t, slope, hole)
        for h in hole:
            tunnel(mesh, (room.x0 - t, y, room.height), (1, 0, 0), v, (0, 0, 1), h, 0.2)
    return has_window


def shell(rng, scene, room, materials, has_sky):
    """Adds floor, walls and ceiling. All holes must be known."""
    w, d = room.x1 - room.x0, room.y1 - room.y0
    floor, walls, top = Mesh(), Mesh(), Mesh()
    sheet(floor, (room.x0, room.y0, 0), (1, 0, 0), (0, 1, 0), w, d)
    for side in room.holes:
        origin, u, out, length = room.wall(side)
        height = room.height + (room.ridge if side[0] == "x" else 0)
        sheet(walls, origin, u, (0, 0, 1), length, height, room.holes[side])
        if side in ("x1", "y1"):  # doorways lead to the neighbour behind
            for hole in room.holes[side]:
                if hole[2] == 0:
                    tunnel(walls, origin, u, (0, 0, 1), out, hole, thickness)
    if roof(rng, room, top, has_sky):
        scene.tags.add("roof window")
    scene.add(materials["floor"], floor)
    scene.add(materials["walls"], walls)
    scene.add(materials["ceiling"], top)


def stairs(rng, scene, room, palette, metal):
    """Adds a flight of steps with a railing of thin bars."""
    n = rng.randint(5, 9)
    place = room.place(rng, 0.26 * n, 0.9, True)
    if place is None:
        return
    x, y = place
    steps, rail = Mesh(), Mesh()
    for k in range(n):
        z = 0.17 * (k + 1)
        steps.box((x + 0.26 * k, y, z - 0.05), (x + 0.26 * k + 0.28, y + 0.9, z))
        rail.tube((x + 0.26 * k + 0.1, y + 0.86, z), (x + 0.26 * k + 0.1, y + 0.86, z + 0.6), 0.01)
    rail.tube((x + 0.1, y + 0.86, 0.77), (x + 0.26 * n - 0.16, y + 0.86, 0.17 * n + 0.6), 0.02)
    scene.add(palette(rng), steps)
    scene.add(metal(rng), rail)
    scene.tags.add("stairs")
