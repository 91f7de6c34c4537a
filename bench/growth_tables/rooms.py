"""A room of any number of triangles and lights: rooms.write(path, triangles, lights, texels).

8 x 6 x 3 m. The triangles are divided among 24 bumpy bodies; the lights are squares in a grid under
the ceiling with a total area of 3 m2, so the power is constant. With texels, each body has its own
image of texels² texels. Everything else is constant.
"""

import math
import os
import struct
import zlib

import numpy as np

BODIES = 24


def body(triangles, centre, radius, rng):
    """A bumpy ball of about `triangles` triangles."""
    rings = max(3, round(math.sqrt(triangles / 4)))
    t = np.linspace(0, math.pi, rings + 1)[:, None]
    f = np.linspace(0, 2 * math.pi, 2 * rings, endpoint=False)[None, :]
    phase = rng.uniform(0, 6, 4)
    r = radius * (1 + 0.12 * np.sin(5 * t + phase[0]) * np.sin(4 * f + phase[1])
                  + 0.04 * np.sin(17 * t + phase[2]) * np.sin(13 * f + phase[3]))
    points = np.stack([r * np.sin(t) * np.cos(f), r * np.sin(t) * np.sin(f),
                       r * np.cos(t) + 0 * f], axis=-1).reshape(-1, 3) + centre
    k, columns = np.arange(2 * rings), 2 * rings
    a = (np.arange(rings)[:, None] * columns + k[None, :]).ravel()
    b = (np.arange(rings)[:, None] * columns + ((k + 1) % columns)[None, :]).ravel()
    faces = np.concatenate([np.stack([a, a + columns, b], 1),
                            np.stack([b, a + columns, b + columns], 1)])
    # forward and back, so that there is no seam
    uvs = np.stack([np.abs(1 - f / math.pi) + 0 * t, t / math.pi + 0 * f], axis=-1).reshape(-1, 2)
    return np.concatenate([points, uvs], 1).astype("<f4"), faces.astype("<i4")


def write_png(path, size, rng):
    """Writes stripes and grain, 8 bits."""
    x, y = np.meshgrid(np.arange(size) / size, np.arange(size) / size)
    wave = 0.5 + 0.2 * np.sin(60 * x + 8 * np.sin(20 * y)) + rng.uniform(-0.1, 0.1, (size, size))
    tint = rng.uniform(0.4, 1, 3)
    texels = np.clip(255 * wave[..., None] * tint, 0, 255).astype(np.uint8)
    rows = np.concatenate([np.zeros((size, 1), np.uint8), texels.reshape(size, -1)], 1)

    def chunk(name, data):
        return (struct.pack(">I", len(data)) + name + data
                + struct.pack(">I", zlib.crc32(name + data)))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n"
                   + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(rows.tobytes(), 1)) + chunk(b"IEND", b""))


def write_ply(path, points, faces):
    record = np.zeros(len(faces), dtype=[("n", "u1"), ("v", "<i4", 3)])
    record["n"], record["v"] = 3, faces
    with open(path, "wb") as file:
        file.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
                    "property float x\nproperty float y\nproperty float z\n"
                    "property float u\nproperty float v\n"
                    f"element face {len(faces)}\nproperty list uchar int vertex_indices\n"
                    "end_header\n").encode())
        file.write(points.tobytes())
        file.write(record.tobytes())


def quad(*corners):
    points = " ".join("%.6g %.6g %.6g" % c for c in corners)
    return f'Shape "trianglemesh" "point3 P" [ {points} ] "integer indices" [ 0 1 2 0 2 3 ]\n'


def walls():
    x, y, z = 8, 6, 3
    return [((0, 0, 0), (x, 0, 0), (x, y, 0), (0, y, 0)), ((0, 0, z), (0, y, z), (x, y, z), (x, 0, z)),
            ((0, 0, 0), (0, 0, z), (x, 0, z), (x, 0, 0)), ((0, y, 0), (x, y, 0), (x, y, z), (0, y, z)),
            ((0, 0, 0), (0, y, 0), (0, y, z), (0, 0, z)), ((x, 0, 0), (x, 0, z), (x, y, z), (x, y, 0))]


def lights(count):
    columns = math.ceil(math.sqrt(count * 8 / 6))
    rows = math.ceil(count / columns)
    half = 0.5 * math.sqrt(3 / count)
    for i in range(count):
        x, y = 8 * (i % columns + 0.5) / columns, 6 * (i // columns + 0.5) / rows
        yield ((x - half, y - half, 2.98), (x - half, y + half, 2.98), (x + half, y + half, 2.98),
               (x + half, y - half, 2.98))


def write(path, triangles, light_count, texels=0):
    rng = np.random.default_rng(1)
    text = ['Film "rgb" "integer xresolution" 256 "integer yresolution" 256\n'
            'Scale -1 1 1\nLookAt 0.4 0.4 1.7  5 4 0.8  0 0 1\n'
            'Camera "perspective" "float fov" 65\nWorldBegin\n'
            'Material "diffuse" "rgb reflectance" [ 0.7 0.68 0.62 ]\n']
    text += [quad(*c) for c in walls()]
    folder = os.path.splitext(path)[0]
    os.makedirs(folder, exist_ok=True)
    for k in range(BODIES):
        centre = np.array([1.3 + 1.25 * (k % 6), 1.4 + 1.2 * (k // 6), 0.5 + 0.25 * (k % 3)])
        mesh = f"{folder}/{k}.ply"
        write_ply(mesh, *body(triangles / BODIES, centre, 0.42, rng))
        colour = " ".join("%.3g" % c for c in rng.uniform(0.2, 0.8, 3))
        reflectance = f'"rgb reflectance" [ {colour} ]'
        here = os.path.basename(folder)
        if texels > 0:
            write_png(f"{folder}/{k}.png", texels, rng)
            text.append(f'Texture "image {k}" "spectrum" "imagemap" "string filename" '
                        f'"{here}/{k}.png"\n')
            reflectance = f'"texture reflectance" "image {k}"'
        text.append(f'Material "diffuse" {reflectance}\nShape "plymesh" "string '
                    f'filename" "{here}/{k}.ply"\n')
    text.append('Material "diffuse" "rgb reflectance" [ 0 0 0 ]\n')
    for c in lights(light_count):
        text.append('AttributeBegin\nAreaLightSource "diffuse" "rgb L" [ 10 10 10 ]\n'
                    + quad(*c) + "AttributeEnd\n")
    with open(path, "w") as file:
        file.writelines(text)
