"""Exports a room of a .blend file as glTF, under panels: the rooms of docs/results/public-scenes.md.

  blender -b ROOM.blend --python bench/export_room.py -- OUT.glb X0 Y0 X1 Y1 CEILING STEP

The room's own lights and cameras are removed. A grey ceiling at height CEILING over [X0,X1] x [Y0,Y1]
(metres, z up) carries panels of .6 m, about STEP apart and 2 cm below it, which emit on both sides.
The camera is placed where it sees most objects from eye height, looking slightly down.

  apartment               -5.7 -3.8 2.7 6 2.5 1.3
  tum_kitchen             0 -3 8.2 8.7 2.72 2.3
  laas/grande_salle       -6.3 -10.9 11.3 4 3 2
  indoors-1/indoor-1      -15 -13 15 14 3 3
(below data/environments of Debian's morse-simulator-data)
"""
import math
import sys

import bpy
from mathutils import Vector

field_of_view = math.radians(60)
eye_height = 1.6
looks_down = 0.2  # radians
least_distance = 0.5  # to the nearest visible object


def quad(scene, name, x0, y0, x1, y1, z, material):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(x0, y0, z), (x0, y1, z), (x1, y1, z), (x1, y0, z)], [], [(0, 1, 2, 3)])
    mesh.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new(name, mesh))


def material(name, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    made.use_backface_culling = False
    for key, value in {"Specular": 0, **inputs}.items():
        made.node_tree.nodes["Principled BSDF"].inputs[key.replace("_", " ")].default_value = value
    return made


def objects_seen(scene, graph, eye, forward):
    """Returns the number of visible objects and the distance of the nearest."""
    right = forward.cross(Vector((0, 0, 1))).normalized()
    up = right.cross(forward)
    reach = math.tan(field_of_view / 2) / 10
    seen, nearest = set(), math.inf
    for i in range(-10, 11):
        for j in range(-7, 8):
            way = (forward + (right * i + up * j) * reach).normalized()
            is_hit, place, _, _, thing, _ = scene.ray_cast(graph, eye, way)
            if is_hit:
                seen.add(thing.name)
                nearest = min(nearest, (place - eye).length)
    return len(seen), nearest


def best_view(scene, x0, y0, x1, y1):
    graph = bpy.context.evaluated_depsgraph_get()
    columns, rows = max(3, int((x1 - x0) / 0.8)), max(3, int((y1 - y0) / 0.8))
    best = (-1, None, None)
    for i in range(columns):
        for j in range(rows):
            eye = Vector((x0 + (i + 0.5) * (x1 - x0) / columns, y0 + (j + 0.5) * (y1 - y0) / rows,
                          eye_height))
            for k in range(8):
                turn = k * math.pi / 4
                forward = Vector((math.cos(turn) * math.cos(looks_down),
                                  math.sin(turn) * math.cos(looks_down), -math.sin(looks_down)))
                count, nearest = objects_seen(scene, graph, eye, forward)
                if nearest > least_distance and count > best[0]:
                    best = (count, eye, forward)
    return best


def main():
    out, *numbers = sys.argv[sys.argv.index("--") + 1:]
    x0, y0, x1, y1, height, step = map(float, numbers)
    scene = bpy.context.scene
    for thing in list(scene.objects):
        if thing.type in ("LIGHT", "CAMERA") or thing.hide_render:
            bpy.data.objects.remove(thing)
    count, eye, forward = best_view(scene, x0, y0, x1, y1)
    grey = material("ceiling", Base_Color=(0.7, 0.7, 0.7, 1), Roughness=1)
    quad(scene, "ceiling", x0 - 1, y0 - 1, x1 + 1, y1 + 1, height, grey)
    panel = material("panel", Base_Color=(0, 0, 0, 1), Emission=(1, 1, 1, 1), Emission_Strength=10)
    columns, rows = max(1, round((x1 - x0) / step)), max(1, round((y1 - y0) / step))
    for i in range(columns):
        for j in range(rows):
            x, y = x0 + (i + 0.5) * (x1 - x0) / columns, y0 + (j + 0.5) * (y1 - y0) / rows
            quad(scene, f"panel{i * rows + j}", x - 0.3, y - 0.3, x + 0.3, y + 0.3, height - 0.02, panel)
    camera = bpy.data.cameras.new("camera")
    camera.angle = field_of_view
    stand = bpy.data.objects.new("camera", camera)
    scene.collection.objects.link(stand)
    stand.location = eye
    stand.rotation_euler = forward.to_track_quat("-Z", "Y").to_euler()
    scene.camera = stand
    scene.render.resolution_x, scene.render.resolution_y = 128, 96
    bpy.ops.export_scene.gltf(filepath=out, export_format="GLB", export_cameras=True,
                              export_lights=False, export_apply=True, export_yup=True)
    print(f"{columns * rows} panels, {count} objects in sight")


main()
