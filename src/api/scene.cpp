#include "troffer/scene.h"

#include <utility>

#include "api/scene_impl.h"
#include "api/script_words.h"
#include "api/values.h"
#include "base/error.h"
#include "render/camera.h"
#include "scene/orientation.h"

namespace troffer::api {

Scene::Scene(const SceneOptions& options)
    : impl_(std::make_unique<Impl>(Impl{
          ScriptScene(Vec3(direction(options.up, "the upward direction")), options.is_photometric),
          {}})) {}
Scene::Scene(const Scene& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Scene::Scene(Scene&& other) noexcept = default;
Scene& Scene::operator=(const Scene& other) {
  impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
Scene& Scene::operator=(Scene&& other) noexcept = default;
Scene::~Scene() = default;

Scene Scene::load(const std::string& path, const LoadOptions& options) {
  ImportOptions o;
  o.variant = options.variant;
  o.time = options.time;
  o.animation = options.animation;
  o.shows_baked = options.shows_baked;
  o.emission_scale = in_range(options.emission_scale, 0, 1e9, "emission_scale");
  Scene scene;
  scene.impl_ = with_script_words([&] {
    return std::make_unique<Impl>(Impl{ScriptScene(path, o), {}});
  });
  return scene;
}

const std::string& Scene::file() const {
  return impl_->script.scene().file;
}

std::vector<std::string> Scene::warnings() const {
  std::vector<std::string> texts;
  for (const Warning& w : impl_->script.scene().warnings.entries()) texts.push_back(w.text);
  return texts;
}

bool Scene::is_photometric() const {
  return impl_->script.scene().is_photometric;
}

std::size_t Scene::triangle_count() const {
  return troffer::triangle_count(impl_->script.scene());
}

std::pair<Point, Point> Scene::bounds() const {
  const Boxd box = bounds_in_file(impl_->script.scene());
  return {point(box.lower), point(box.upper)};
}

Point Scene::up() const {
  return point(Vec3d(impl_->script.up()));
}

std::vector<std::string> Scene::camera_names() const {
  std::vector<std::string> names;
  for (const troffer::Camera& c : impl_->script.scene().cameras) names.push_back(c.name);
  return names;
}

std::vector<std::string> Scene::light_names() const {
  return impl_->script.light_names();
}

LightInfo Scene::light(const std::string& name) const {
  const ScriptScene& s = impl_->script;
  const std::vector<size_t> lights = s.lights_named(name);
  return {name, name_of(s.scene().lights[lights.front()].kind), lights.size(), s.dimmer(name),
          color(s.radiance(name))};
}

void Scene::set_dimmer(const std::string& name, double dimmer) {
  impl_->script.set_dimmer(name, dimmer);
}

void Scene::set_radiance(const std::string& name, const Color& radiance) {
  impl_->script.set_radiance(name, rgb(radiance));
}

void Scene::dim(const std::string& pattern, double factor) {
  impl_->script.dim(pattern, factor);
}

const std::string& Camera::name() const {
  return impl_->camera.name;
}

Camera Scene::camera(const std::string& name) {
  ScriptScene& s = impl_->script;
  const troffer::Camera found = s.camera(name);
  return Camera(std::make_shared<const Camera::Impl>(Camera::Impl{found, s.scene().origin}));
}

Camera Scene::look_at(const LookAt& view) const {
  const ScriptScene& s = impl_->script;
  const Vec3d origin = s.scene().origin;
  const Vec3d eye = place(view.eye, "eye"), target = place(view.target, "target");
  const double distance = length(target - eye);
  if (!(distance > 0)) throw UsageError("a camera's eye and target differ");
  const double fov = in_range(view.fov, 0.01, 179, "fov");
  const double lens = in_range(view.lens_radius, 0, 1e3, "lens_radius");
  const double focus = in_range(view.focal_distance, 0, 1e9, "focal_distance");
  const Vec3 up = view.up ? Vec3(vec(*view.up)) : s.up();
  if (view.up) direction(*view.up, "a camera's upward direction");
  troffer::Camera made =
      troffer::look_at(Vec3(eye - origin), Vec3(target - origin), up, float(fov));
  if (lens > 0) {
    made.lens_radius = float(lens);
    made.focal_distance = float(focus > 0 ? focus : distance);
  }
  return Camera(std::make_shared<const Camera::Impl>(Camera::Impl{made, origin}));
}

void Scene::add_camera(const std::string& name, const LookAt& view) {
  ScriptScene& s = impl_->script;
  for (const troffer::Camera& c : s.scene().cameras)
    if (c.name == name) throw UsageError("there is a camera '" + name + "' already");
  troffer::Camera made = look_at(view).impl().camera;
  made.name = name;
  s.change().cameras.push_back(std::move(made));
}

troffer::Camera camera_in(const troffer::Scene& scene, const Camera& camera) {
  troffer::Camera c = camera.impl().camera;
  if (camera.impl().origin != scene.origin)
    c.position = Vec3(Vec3d(c.position) + camera.impl().origin - scene.origin);
  return c;
}

}  // namespace troffer::api
