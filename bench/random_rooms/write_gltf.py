"""Writes a random room as a glTF 2.0 file with its data inside. glTF has y up and counts in lumens."""

import base64
import json
import math
import struct

from scene import Mesh, lumens_per_watt, uv_of


def y_up(p):
    return (p[0], p[2], -p[1])


def material_of(m, emission, textures):
    pbr = {"metallicFactor": 1 if m.kind == "metal" else 0,
           "roughnessFactor": 1 if m.kind in ("matte", "translucent") else math.sqrt(m.width),
           "baseColorFactor": [*m.rgb, 1]}
    if m.texture:
        pbr["baseColorTexture"] = {"index": textures.index(m.texture)}
        pbr["baseColorFactor"] = [1, 1, 1, 1]
    made = {"pbrMetallicRoughness": pbr, "doubleSided": emission is None}
    extensions = {}
    if m.kind in ("matte", "translucent"):
        extensions["KHR_materials_specular"] = {"specularFactor": 0}
    if m.kind == "translucent":
        extensions["KHR_materials_diffuse_transmission"] = {
            "diffuseTransmissionFactor": 0.45, "diffuseTransmissionColorFactor": list(m.rgb)}
    if m.kind in ("glass", "pane"):
        extensions["KHR_materials_transmission"] = {"transmissionFactor": 1}
        if m.kind == "glass":
            extensions["KHR_materials_volume"] = {"thicknessFactor": 1}
    if emission:
        strength = max(emission)
        made["emissiveFactor"] = [e / strength for e in emission]
        extensions["KHR_materials_emissive_strength"] = {
            "emissiveStrength": strength * lumens_per_watt}
    if extensions:
        made["extensions"] = extensions
    return made


class Buffer:
    def __init__(self):
        self.data, self.views, self.accessors = b"", [], []

    def add(self, values, kind, width):
        """Adds rows of floats (kind VEC3, VEC2) or indices (SCALAR); returns the accessor."""
        is_index = kind == "SCALAR"
        flat = [v for row in values for v in row]
        packed = struct.pack("<%d%s" % (len(flat), "I" if is_index else "f"), *flat)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(packed)})
        accessor = {"bufferView": len(self.views) - 1, "componentType": 5125 if is_index else 5126,
                    "count": len(flat) // width, "type": kind}
        if kind == "VEC3":
            accessor["min"] = [min(row[k] for row in values) for k in range(3)]
            accessor["max"] = [max(row[k] for row in values) for k in range(3)]
        self.accessors.append(accessor)
        self.data += packed
        return len(self.accessors) - 1


def rotation_to(direction):
    """Quaternion that turns -z to a direction (the camera's view), with y as upright as can be."""
    size = math.sqrt(sum(c * c for c in direction))
    x, y, z = (c / size for c in direction)
    yaw, pitch = math.atan2(-x, -z), math.asin(max(-1.0, min(1.0, y)))
    sy, cy, sp, cp = (math.sin(yaw / 2), math.cos(yaw / 2), math.sin(pitch / 2),
                      math.cos(pitch / 2))
    return [cy * sp, sy * cp, -sy * sp, cy * cp]


def mesh_of(part):
    if part.mesh:
        return part.mesh
    mesh = Mesh()
    mesh.ball(part.sphere[0], part.sphere[1], 8)
    return mesh


def punctual_of(kind, position, target, intensity, degrees):
    """Returns a light of KHR_lights_punctual and its node."""
    strength = max(intensity)
    light = {"type": kind, "color": [v / strength for v in intensity],
             "intensity": strength * lumens_per_watt}
    node = {"translation": list(y_up(position))}
    if kind == "spot":
        light["spot"] = {"outerConeAngle": math.radians(degrees),
                         "innerConeAngle": math.radians(degrees - 4)}
        node["rotation"] = rotation_to(y_up([b - a for a, b in zip(position, target)]))
    return light, node


def text_of(scene):
    eye, target, fov = scene.camera
    textures = sorted({p.material.texture for p in scene.parts if p.material.texture})
    buffer, materials, meshes, nodes, lights = Buffer(), [], [], [], []
    for part in scene.parts:
        mesh = mesh_of(part)
        attributes = {"POSITION": buffer.add([y_up(p) for p in mesh.points], "VEC3", 3)}
        if part.material.texture:
            attributes["TEXCOORD_0"] = buffer.add([uv_of(p) for p in mesh.points], "VEC2", 2)
        materials.append(material_of(part.material, part.emission, textures))
        meshes.append({"primitives": [{"attributes": attributes, "material": len(materials) - 1,
                                       "indices": buffer.add(mesh.triangles, "SCALAR", 1)}]})
        nodes.append({"mesh": len(meshes) - 1, "name": f"part{len(nodes)}"})
    for point in scene.points:
        light, node = punctual_of(*point)
        node["extensions"] = {"KHR_lights_punctual": {"light": len(lights)}}
        lights.append(light)
        nodes.append(node)
    nodes.append({"camera": 0, "translation": list(y_up(eye)), "name": "camera",
                  "rotation": rotation_to(y_up([b - a for a, b in zip(eye, target)]))})
    made = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}],
            "nodes": nodes, "meshes": meshes, "materials": materials,
            "cameras": [{"type": "perspective", "perspective": {
                "yfov": math.radians(fov), "aspectRatio": 4 / 3, "znear": 0.01}}],
            "accessors": buffer.accessors, "bufferViews": buffer.views,
            "buffers": [{"byteLength": len(buffer.data), "uri": "data:application/octet-stream;base64,"
                         + base64.b64encode(buffer.data).decode()}],
            "extensionsUsed": sorted({e for m in materials for e in m.get("extensions", {})})}
    if textures:
        made["images"] = [{"uri": name} for name in textures]
        made["textures"] = [{"source": k} for k in range(len(textures))]
    if lights:
        made["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
        made["extensionsUsed"].append("KHR_lights_punctual")
    return json.dumps(made)
