"""Writes a random room as a pbrt-v4 file."""

from scene import uv_of


def numbers(values):
    return "[ " + " ".join("%.6g" % v for v in values) + " ]"


def material_text(m):
    if m.texture:
        colour = f'"texture reflectance" "{m.texture}"'
    else:
        colour = f'"rgb reflectance" {numbers(m.rgb)}'
    roughness = f'"float roughness" [{m.width ** 2:.6g}]'
    if m.kind == "matte":
        return f'Material "diffuse" {colour}\n'
    if m.kind == "coated":
        return f'Material "coateddiffuse" {colour} {roughness}\n'
    if m.kind == "metal":
        return f'Material "conductor" "rgb reflectance" {numbers(m.rgb)} {roughness}\n'
    if m.kind == "glass":
        return 'Material "dielectric" "float eta" [1.5]\n'
    if m.kind == "pane":
        return 'Material "thindielectric" "float eta" [1.5]\n'
    assert m.kind == "translucent"
    return (f'Material "diffusetransmission" "rgb reflectance" {numbers(c * 0.5 for c in m.rgb)} '
            f'"rgb transmittance" {numbers(c * 0.45 for c in m.rgb)}\n')


def mesh_text(mesh, has_uv):
    indices = " ".join("%d %d %d" % t for t in mesh.triangles)
    text = (f'Shape "trianglemesh" "point3 P" {numbers(c for p in mesh.points for c in p)} '
            f'"integer indices" [ {indices} ]')
    if has_uv:
        text += f' "point2 uv" {numbers(c for p in mesh.points for c in uv_of(p))}'
    return text + "\n"


def text_of(scene):
    eye, target, fov = scene.camera
    out = ["# " + " ".join(sorted(scene.tags)) + "\n",
           "LookAt %.6g %.6g %.6g  %.6g %.6g %.6g  0 0 1\n" % (*eye, *target),
           f'Camera "perspective" "float fov" [{fov:.4g}]\n',
           'Film "rgb" "integer xresolution" [96] "integer yresolution" [72]\nWorldBegin\n']
    for name in sorted({p.material.texture for p in scene.parts if p.material.texture}):
        out.append(f'Texture "{name}" "spectrum" "imagemap" "string filename" "{name}"\n')
    for part in scene.parts:
        out += ["AttributeBegin\n", material_text(part.material)]
        if part.emission:
            out.append(f'AreaLightSource "diffuse" "rgb L" {numbers(part.emission)}\n')
        if part.sphere:
            centre, radius = part.sphere
            out.append("Translate %.6g %.6g %.6g\n" % tuple(centre) +
                       f'Shape "sphere" "float radius" [{radius:.6g}]\n')
        else:
            out.append(mesh_text(part.mesh, part.material.texture is not None))
        out.append("AttributeEnd\n")
    for kind, position, target, intensity, degrees in scene.points:
        text = f'LightSource "{kind}" "rgb I" {numbers(intensity)} "point3 from" {numbers(position)}'
        if kind == "spot":
            text += (f' "point3 to" {numbers(target)} "float coneangle" [{degrees:.4g}] '
                     '"float conedeltaangle" [4]')
        out.append(text + "\n")
    return "".join(out)
