// import troffer
#include "python/bindings.h"

PYBIND11_MODULE(troffer, m) {
  m.doc() = R"(Light in rooms: pictures, and illuminance at points.

    import troffer
    scene = troffer.load("room.gltf")
    picture = scene.render(width=640, height=480, error=0.02)
    picture.save("room.png")
    lux = scene.measure([[1.5, 2.0, 0.76, 0, 0, 1]]).illuminance

Lengths are metres. Light is linear, Rec. 709 primaries: radiance in W/(m2 sr), or luminance in
cd/m2 where Scene.is_photometric (glTF). Results are the same, bit for bit, for any number of
threads, and those of the program `troffer`.)";
  m.attr("__version__") = TROFFER_VERSION;
  troffer::bind_errors(m);
  troffer::bind_scene(m);
  troffer::bind_work(m);
  troffer::bind_images(m);
}
