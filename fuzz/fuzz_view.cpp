// Feeds requests that libFuzzer makes to the page's service, as the server passes them on: lines of
// "get NAME KEY=VALUE…" and "post NAME BODY". They must be refused with UsageError, or answered.
#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "base/error.h"
#include "render/camera.h"
#include "support/scenes.h"
#include "view/view_service.h"

namespace {

using namespace troffer;

Scene lit_room() {
  Scene s;
  test::add_box_inside(s, test::add_diffuse(s, Rgb{0.5f}), {-2, -2, 0}, {2, 2, 3});
  test::add_ceiling_light(s, 1, 2.9f, Rgb{10});
  Light other;
  other.name = "other";
  other.kind = LightKind::point;
  other.position = {1, 1, 2};
  other.radiance = Rgb{1};
  s.lights.push_back(other);
  s.cameras.push_back(look_at({0, -1.5f, 1.2f}, {0, 0, 1}, {0, 0, 1}, 60));
  return s;
}

// Limits the size of pictures, so that each input is fast.
std::string with_small_picture(const std::string& body) {
  constexpr int most = 8;
  nlohmann::json j = nlohmann::json::parse(body, nullptr, false);
  if (!j.is_object()) return body;
  bool is_changed = false;
  for (const char* key : {"width", "height"}) {
    const auto at = j.find(key);
    if (at == j.end() || !at->is_number() || !(at->get<double>() > most)) continue;
    *at = most;
    is_changed = true;
  }
  return is_changed ? j.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) : body;
}

HttpRequest request_of(const std::string& line) {
  std::istringstream words(line);
  std::string kind;
  HttpRequest r;
  words >> kind >> r.path;
  r.is_post = kind == "post";
  if (r.is_post) {
    std::getline(words, r.body);
    r.body = with_small_picture(r.body);
    return r;
  }
  for (std::string word; words >> word;) {
    const size_t equals = std::min(word.find('='), word.size());
    r.query[word.substr(0, equals)] = word.substr(std::min(equals + 1, word.size()));
  }
  return r;
}

class Target {
 public:
  void run(const std::string& lines) const {
    LayerBoard board;
    MeasuringQueue desk(measuring_);
    Painter painter(board, settings_.options);
    ViewService service(lighting_, settings_, board, painter, desk);
    constexpr int most = 16;  // the measuring queue allows four times as many waiting tasks
    std::istringstream in(lines);
    std::string line;
    for (int n = 0; n < most && std::getline(in, line); ++n) {
      try {
        service.answer(request_of(line));
      } catch (const UsageError&) {
        continue;
      }
    }
  }

 private:
  static ViewSettings settings() {
    ViewSettings s;
    s.camera = lit_room().cameras[0];
    s.width = 8;
    s.height = 6;
    s.up = {0, 0, 1};
    s.options.method = Method::path;
    s.options.error = 0.5;
    s.options.threads = 1;
    s.time = "2026-06-21T12:00Z";
    s.relit = [](const std::string&) { return lit_room(); };
    return s;
  }
  static MeasureOptions measuring() {
    MeasureOptions o;
    o.method = Method::path;
    o.spp = 2;
    o.threads = 1;
    return o;
  }

  const std::shared_ptr<Lighting> lighting_ = std::make_shared<Lighting>(lit_room());
  const ViewSettings settings_ = settings();
  const MeasureOptions measuring_ = measuring();
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const Target target;
  target.run({reinterpret_cast<const char*>(data), size});
  return 0;
}
