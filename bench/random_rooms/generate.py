#!/usr/bin/env python3
"""Writes random rooms as scene files: generate.py FIRST COUNT FOLDER

Each seed gives one building: one to four rooms joined by doorways or gaps, lit by lamps of any kind
and power, by the sky or by both, furnished, and seen from within. Most files are pbrt-v4, every
fourth is glTF. Prints for each the command line of its picture.
"""

import os
import random
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import building  # noqa: E402  pylint: disable=wrong-import-position
import furniture  # noqa: E402  pylint: disable=wrong-import-position
import lamps  # noqa: E402  pylint: disable=wrong-import-position
import write_gltf  # noqa: E402  pylint: disable=wrong-import-position
import write_pbrt  # noqa: E402  pylint: disable=wrong-import-position
from scene import Material, Scene, png  # noqa: E402  pylint: disable=wrong-import-position


def texture(rng, scene):
    """Adds a picture of tiles, stripes or noise; returns its name."""
    kind, n = rng.choice(["tiles", "stripes", "noise"]), rng.choice([2, 4, 8])
    a, b = ([rng.randint(20, 240) for _ in range(3)] for _ in range(2))
    noise = [rng.random() for _ in range(256)]

    def rgb(x, y):
        if kind == "noise":
            f = noise[(x + 16 * y) % 256]
            return [int(p + (q - p) * f) for p, q in zip(a, b)]
        parity = x * n // 16 + (y * n // 16 if kind == "tiles" else 0)
        return a if parity % 2 else b
    name = f"texture{len(scene.files)}.png"
    scene.files[name] = png(16, 16, rgb)
    scene.tags.add("texture")
    return name


def surfaces(rng, scene):
    """Materials of a room's shell."""
    def wall():
        grey = rng.choice([0.1, 0.5, 0.7, 0.8, 0.9])
        return Material("matte", [min(0.95, grey * rng.uniform(0.85, 1.15)) for _ in range(3)])
    floor = furniture.wood(rng)
    if rng.random() < 0.35:
        floor = Material("coated", floor.rgb, rng.choice([0.0, 0.05, 0.15, 0.4]))
        scene.tags.add("glossy floor")
    elif rng.random() < 0.3:
        floor = Material("matte", (1, 1, 1), 0, texture(rng, scene))
    walls = wall()
    if rng.random() < 0.3:
        walls = Material("matte", (1, 1, 1), 0, texture(rng, scene))
    return {"floor": floor, "walls": walls, "ceiling": wall()}


def outside(rng, scene):
    """Sky, and in half of all cases the sun."""
    sky = rng.choice(["overcast", "clear", "even"])
    azimuth, altitude = rng.uniform(130, 320), rng.uniform(10, 60)
    if sky == "clear":
        scene.options += ["--sky", "clear", "--sun", f"{azimuth:.1f},{altitude:.1f}"]
        scene.tags.add("sun")
    else:
        scene.options += ["--sky", f"{sky},{rng.choice([300, 5000, 10000])}"]
    scene.tags.add("sky")


def view(rng, rooms, lit, seen):
    """A camera, mostly in a lit room, that looks through a doorway, at a mirror or piece, or across."""
    room = rng.choice(lit if lit and rng.random() < 0.8 else rooms)
    eye = None
    for _ in range(200):
        x, y = room.inside(rng, 0.25)
        if room.is_free((x - 0.15, y - 0.15), (x + 0.15, y + 0.15)):
            eye = (x, y, rng.uniform(1.0, 1.7))
            break
    if eye is None:
        eye = (room.x0 + 0.2, room.y0 + 0.2, 1.9)
    far = (room.x0 + room.x1 - eye[0], room.y0 + room.y1 - eye[1], rng.uniform(0.5, 1.6))
    target = far
    if room.doors and rng.random() < 0.4:
        target = (*rng.choice(room.doors)[0][:2], 1.2)
    elif seen.get(room) and rng.random() < 0.5:
        target = rng.choice(seen[room])
    if abs(target[0] - eye[0]) + abs(target[1] - eye[1]) < 0.3:
        target = (eye[0] + 0.7, eye[1] + 0.4, 1.0)
    return eye, target, rng.uniform(40, 75)


def lamp_rooms(rng, rooms, has_sky):
    """Returns the room of each lamp. Without a sky there is at least one lamp."""
    count = rng.choice([1, 1, 2, 3, 6]) if not has_sky else rng.choice([0, 0, 1, 2])
    return [rng.choice(rooms) for _ in range(count)]


def make(seed):
    rng, scene = random.Random(f"random room {seed}"), Scene()
    rooms, lit = building.plan(rng), []
    has_sky = rng.random() < 0.45
    if has_sky:
        outside(rng, scene)
        for room in rooms:
            # A later room may stand behind y1.
            free = [s for s in ("x0", "y0") if not room.holes[s] and not room.doors or s == "y0" and
                    not room.holes[s]]
            for side in free[:rng.choice([1, 1, 2])]:
                building.window(rng, scene, room, side, furniture.paint)
                lit.append(room)
    for room in lamp_rooms(rng, rooms, has_sky):
        kinds = [k for k in lamps.kinds if k is not lamps.downlights or not room.ceiling_holes]
        rng.choice(kinds)(rng, scene, room)
        lit.append(room)
    seen = {}
    for room in rooms:
        if rng.random() < 0.2:
            building.stairs(rng, scene, room, furniture.paint, furniture.metal)
        seen[room] = furniture.furnish(rng, scene, room)
        building.shell(rng, scene, room, surfaces(rng, scene), has_sky)
        if any(h[1] - h[0] < 0.1 for s in room.holes for h in room.holes[s]):
            scene.tags.add("gap")
    scene.tags.add(f"{len(rooms)} rooms" if len(rooms) > 1 else "1 room")
    scene.camera = view(rng, rooms, lit, seen)
    return scene


def write(seed, folder):
    """Writes a room's files. Returns the scene file, options of troffer render, and the tags."""
    scene = make(seed)
    is_gltf = seed % 4 == 3
    folder = os.path.join(folder, f"room{seed}")
    os.makedirs(folder, exist_ok=True)
    for name, data in scene.files.items():
        with open(os.path.join(folder, name), "wb") as file:
            file.write(data)
    path = os.path.join(folder, "room.gltf" if is_gltf else "room.pbrt")
    with open(path, "w", encoding="utf-8") as file:
        file.write(write_gltf.text_of(scene) if is_gltf else write_pbrt.text_of(scene))
    options = list(scene.options) + ([] if is_gltf else ["--up", "z"])
    if scene.luminaires:
        table = os.path.join(folder, "luminaires.csv")
        with open(table, "w", encoding="utf-8") as file:
            file.write("file,x,y,z,dx,dy,dz,lumens\n")
            for name, p, flux in scene.luminaires:
                p, d = (write_gltf.y_up(p), (0, -1, 0)) if is_gltf else (p, (0, 0, -1))
                file.write(",".join([name] + ["%.6g" % v for v in (*p, *d, flux)]) + "\n")
        options += ["--luminaires", table]
    return path, options, sorted(scene.tags)


if __name__ == "__main__":
    for number in range(int(sys.argv[1]), int(sys.argv[1]) + int(sys.argv[2])):
        scene_file, wanted, tags_of_it = write(number, sys.argv[3])
        print(" ".join(["troffer render", scene_file, *wanted, "-o", f"room{number}.png"]),
              " #", ", ".join(tags_of_it))
