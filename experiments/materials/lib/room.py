"""A room for balls of one material each (pbrt-v4), and a way to give them glTF materials."""
import json
import os
import subprocess

FILM = 'Film "rgb" "integer xresolution" {} "integer yresolution" {}\n'
VIEW = """Scale -1 1 1
LookAt 0 -7 4.4  0 0 .42  0 0 1
Camera "perspective" "float fov" {}
"""
WORLD = """WorldBegin
MakeNamedMedium "green" "string type" "homogeneous" "rgb sigma_a" [3 .3 2] "rgb sigma_s" [0 0 0]
Texture "checks" "spectrum" "checkerboard" "float uscale" 16 "float vscale" 8
  "rgb tex1" [.8 .8 .8] "rgb tex2" [.1 .1 .3]
AttributeBegin
Scale .15 .15 .15
Texture "solid" "spectrum" "checkerboard" "integer dimension" 3 "rgb tex1" [.8 .7 .5]
  "rgb tex2" [.3 .05 .05]
AttributeEnd
AttributeBegin
Scale .08 .08 .08
Texture "heights" "float" "wrinkled" "integer octaves" 4
Texture "bumps" "float" "scale" "texture tex" "heights" "float scale" .03
AttributeEnd
AttributeBegin
Scale .2 .2 .2
Texture "amount" "float" "wrinkled"
Texture "clouds" "spectrum" "mix" "texture amount" "amount" "rgb tex1" [.1 .2 .6]
  "rgb tex2" [.9 .9 .9]
AttributeEnd
Texture "floor" "spectrum" "checkerboard" "float uscale" 24 "float vscale" 16
  "rgb tex1" [.5 .5 .5] "rgb tex2" [.3 .3 .3]
Material "diffuse" "texture reflectance" "floor"
Shape "trianglemesh" "point3 P" [-6 -4 0  6 -4 0  6 4 0  -6 4 0] "integer indices" [0 1 2 0 2 3]
  "point2 uv" [0 0 1 0 1 1 0 1]
Material "diffuse" "rgb reflectance" [.6 .6 .6]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3  4 5 6 4 6 7  8 9 10 8 10 11  12 13 14 12 14 15
  16 17 18 16 18 19] "point3 P" [-6 4 0  6 4 0  6 4 5  -6 4 5   -6 -9 0  -6 4 0  -6 4 5  -6 -9 5
  6 4 0  6 -9 0  6 -9 5  6 4 5   -6 -9 5  -6 4 5  6 4 5  6 -9 5   6 -9 0  -6 -9 0  -6 -9 5  6 -9 5]
AttributeBegin
Material "diffuse" "rgb reflectance" [0 0 0]
AreaLightSource "diffuse" "rgb L" [9 9 9]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3  4 5 6 4 6 7] "point3 P" [
  -4 -3 4.9  -4 0 4.9  -1.5 0 4.9  -1.5 -3 4.9   2 -5 4.9  2 -4 4.9  4 -4 4.9  4 -5 4.9]
AttributeEnd
"""


def scene(balls, size, fov, columns, far):
    """balls: [(name, pbrt's lines)], in rows of `columns`; far: y of the first row."""
    text = FILM.format(*size) + VIEW.format(fov) + WORLD
    for i, (name, material) in enumerate(balls):
        x, row = i % columns - (columns - 1) / 2, i // columns
        text += (f'# {name}\nAttributeBegin\nTranslate {x} {far - .9 * row} .4\n{material}\n'
                 'Shape "sphere" "float radius" .4\nAttributeEnd\n')
    return text


def plain(names):
    """Balls for `with_materials`, with a texture so that they have texture coordinates."""
    return [(name, f'MakeNamedMaterial "{name}" "string type" "diffuse" "texture reflectance" "checks"\n'
             f'NamedMaterial "{name}"') for name in names]


def _with_textures(part, number_of):
    if isinstance(part, dict):
        return {k: number_of[v] if k == "index" and v in number_of else _with_textures(v, number_of)
                for k, v in part.items()}
    return part


def with_materials(program, file, materials, images=None):
    """Converts the pbrt file to glTF and replaces its named materials: {name: material in glTF}. images:
    {name: data URI}; a texture's `index` may be such a name."""
    gltf = os.path.splitext(file)[0] + ".gltf"
    subprocess.run([program, "convert", file, gltf], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)  # spheres become triangles
    with open(gltf) as f:
        data = json.load(f)
    used = set(data.get("extensionsUsed", []))
    number_of = {}
    for name, uri in (images or {}).items():
        data.setdefault("images", []).append({"uri": uri})
        number_of[name] = len(data.setdefault("textures", []))
        data["textures"].append({"source": len(data["images"]) - 1})
    for material in data["materials"]:
        made = materials.get(material.get("name"))
        if made:
            material.clear()
            material.update(_with_textures(made, number_of), doubleSided=True)
            used |= set(made.get("extensions", {}))
    data["extensionsUsed"] = sorted(used)
    with open(gltf, "w") as f:
        json.dump(data, f)
    return gltf
