// Entry point of the Python module troffer.
#include "python/bindings.h"

PYBIND11_MODULE(troffer, m) {
  m.doc() = R"(Light in rooms: pictures, and illuminance at points.

    import troffer
    scene = troffer.load("room.gltf")
    picture = scene.render(width=640, height=480, error=0.02)
    picture.save("room.png")
    lux = scene.measure([[1.5, 2.0, 0.76, 0, 0, 1]]).illuminance

A scene can also be built from arrays:

    scene = troffer.Scene()
    scene.add_material("wall", base_color=(0.8, 0.8, 0.8))
    scene.add_mesh(positions, triangles, material="wall")
    scene.add_mesh(lamp_positions, lamp_triangles, emission=3000, name="lamp")

Lengths are metres. Light is linear, Rec. 709 primaries: radiance in W/(m2 sr), or luminance in
cd/m2 where Scene.is_photometric (glTF). Results are the same, bit for bit, for any number of
threads, and those of the program `troffer`.)";
  m.attr("__version__") = TROFFER_VERSION;
  troffer::bindings::bind_errors(m);
  troffer::bindings::bind_scene(m);
  troffer::bindings::bind_images(m);
}
