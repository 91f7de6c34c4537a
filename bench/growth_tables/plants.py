"""A hall full of plants: plants.write(path, count, triangles, is_copied).

20 x 15 x 4 m, under 12 lamps. Pots stand in rows on its floor, turned and of different sizes, some
mirrored. Every plant is the same bush of curved leaves with about `triangles` triangles: one object
and its instances, or copies.
"""

import math
import os

import numpy as np

from rooms import quad, write_ply

WIDE, DEEP, HIGH = 20, 15, 4


def bush(triangles):
    """Leaves on a ball of radius 1 about the origin, each a bent strip of ten triangles."""
    rng = np.random.default_rng(3)
    leaves = max(1, round(triangles / 10))
    root = rng.normal(size=(leaves, 3))
    root *= (rng.uniform(0.1, 1, (leaves, 1)) ** (1 / 3)) / np.linalg.norm(root, axis=1, keepdims=True)
    along = root / np.linalg.norm(root, axis=1, keepdims=True) + rng.normal(size=(leaves, 3)) * 0.5
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    side = np.cross(along, rng.normal(size=(leaves, 3)))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    droop = np.cross(side, along)
    length = 2.2 / math.sqrt(leaves) ** 0.7
    t = np.linspace(0, 1, 6)
    middle = (root[:, None] + along[:, None] * (t * length)[None, :, None]
              - droop[:, None] * (0.5 * t**2 * length)[None, :, None])
    half = side[:, None] * (0.16 * length * np.sin(math.pi * (0.12 + 0.83 * t)))[None, :, None]
    points = np.stack([middle - half, middle + half], axis=2).reshape(-1, 3)
    k = 2 * np.arange(5)
    strip = np.concatenate([np.stack([k, k + 2, k + 1], 1), np.stack([k + 1, k + 2, k + 3], 1)])
    faces = (12 * np.arange(leaves)[:, None, None] + strip[None]).reshape(-1, 3)
    return points.astype("<f4"), faces.astype("<i4")


def places(count):
    rng = np.random.default_rng(5)
    columns = math.ceil(math.sqrt(count * WIDE / DEEP))
    step = WIDE / columns
    for i in range(count):
        x, y = (i % columns + 0.5) * step, (i // columns + 0.5) * step
        size = 0.45 * step * rng.uniform(0.8, 1.1)
        mirrored = -1 if i % 5 == 0 else 1
        yield (f"Translate {x:.4f} {y:.4f} {0.9 * min(size, 1.5):.4f} Rotate {rng.uniform(0, 360):.1f} 0 0 1 "
               f"Scale {mirrored * size:.4f} {size:.4f} {0.9 * min(size, 1.5):.4f}")


def box():
    x, y, z = WIDE, DEEP, HIGH
    return [((0, 0, 0), (x, 0, 0), (x, y, 0), (0, y, 0)), ((0, 0, z), (0, y, z), (x, y, z), (x, 0, z)),
            ((0, 0, 0), (0, 0, z), (x, 0, z), (x, 0, 0)), ((0, y, 0), (x, y, 0), (x, y, z), (0, y, z)),
            ((0, 0, 0), (0, y, 0), (0, y, z), (0, 0, z)), ((x, 0, 0), (x, 0, z), (x, y, z), (x, y, 0))]


def write(path, count, triangles, is_copied):
    folder = os.path.splitext(path)[0]
    os.makedirs(folder, exist_ok=True)
    write_ply(f"{folder}/bush.ply", *bush(triangles))
    shape = f'Shape "plymesh" "string filename" "{os.path.basename(folder)}/bush.ply"\n'
    text = ['Film "rgb" "integer xresolution" 256 "integer yresolution" 256\n'
            'Scale -1 1 1\nLookAt 0.5 0.5 3.2  12 9 0.3  0 0 1\n'
            'Camera "perspective" "float fov" 65\nWorldBegin\n'
            'Material "diffuse" "rgb reflectance" [ 0.7 0.68 0.62 ]\n']
    text += [quad(*c) for c in box()]
    text += ["AttributeBegin\n", 'AreaLightSource "diffuse" "rgb L" [ 9 8.5 8 ]\n']
    for i in range(12):
        x, y, z = WIDE * (i % 4 + 0.5) / 4, DEEP * (i // 4 + 0.5) / 3, HIGH - 0.02
        text.append(quad((x - .6, y - .3, z), (x - .6, y + .3, z), (x + .6, y + .3, z), (x + .6, y - .3, z)))
    text += ["AttributeEnd\n", 'Material "diffuse" "rgb reflectance" [ 0.2 0.45 0.12 ]\n']
    if not is_copied:
        text += [f'ObjectBegin "bush"\n{shape}ObjectEnd\n']
    use = shape if is_copied else 'ObjectInstance "bush"\n'
    text += [f"AttributeBegin\n{place}\n{use}AttributeEnd\n" for place in places(count)]
    with open(path, "w") as file:
        file.write("".join(text))
