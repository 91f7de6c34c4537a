#include "view/view_service.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "base/error.h"
#include "image/encode.h"
#include "render/measurements_csv.h"
#include "render/seen_point.h"
#include "view/dimmed.h"
#include "view/json_values.h"
#include "view/measuring_grid.h"
#include "view/page_files.h"

namespace troffer {

namespace {

using nlohmann::json;

HttpResponse json_response(const json& j) {
  return {200, "application/json", text_of_json(j), ""};
}

uint64_t number_of(const HttpRequest& r, const std::string& key) {
  return std::strtoull(r.value(key).c_str(), nullptr, 10);
}

HttpResponse page_file(const std::string& name) {
  const std::string wanted = name.empty() ? "view.html" : name;
  for (const PageFile& f : page_files()) {
    if (f.name != wanted) continue;
    const char* type = wanted.ends_with(".js")    ? "text/javascript; charset=utf-8"
                       : wanted.ends_with(".css") ? "text/css; charset=utf-8"
                                                  : "text/html; charset=utf-8";
    return {200, type, std::string(f.text), ""};
  }
  return {404, "text/plain; charset=utf-8", "nothing here\n", ""};
}

std::string as_text(const std::vector<uint8_t>& bytes) {
  return {bytes.begin(), bytes.end()};
}

// Replaces characters that EXR does not allow in a part of a channel's name.
std::string channel_name(std::string name) {
  for (char& c : name)
    if (c == '.' || static_cast<unsigned char>(c) <= ' ') c = '_';
  return name;
}

json json_of(const Measurement& m) {
  return {m.illuminance_lx, m.standard_error, m.irradiance.r, m.irradiance.g, m.irradiance.b};
}

}  // namespace

ImageSize moderate_size(const Camera& camera) {
  constexpr double pixels = 640 * 480;
  const ImageSize own = image_size(camera, 0, 0);
  const double aspect = double(own.width) / own.height;
  const double height = std::sqrt(pixels / aspect);
  return {std::max(1, int(std::lround(height * aspect))), std::max(1, int(std::lround(height)))};
}

ViewService::ViewService(std::shared_ptr<Lighting> lighting, ViewSettings settings,
                         LayerBoard& board, Painter& painter, MeasuringQueue& desk)
    : lighting_(std::move(lighting)),
      settings_(std::move(settings)),
      board_(board),
      painter_(painter),
      desk_(desk) {
  const ImageSize own = moderate_size(settings_.camera);
  if (settings_.year)
    year_ = std::make_unique<YearAnswers>(settings_.year, lighting_->bounds(), settings_.file);
  const bool is_asked = settings_.width > 0 && settings_.height > 0;
  show(settings_.camera, is_asked ? ImageSize{settings_.width, settings_.height} : own);
}

std::vector<std::string> ViewService::notes() const {
  return year_ ? year_->notes() : std::vector<std::string>{};
}

void ViewService::show(const Camera& camera, const ImageSize& size) {
  painter_.show({lighting_, camera, size});
}

HttpResponse ViewService::answer(const HttpRequest& request) {
  return request.is_post ? post(request) : get(request);
}

HttpResponse ViewService::get(const HttpRequest& r) {
  if (r.path == "state") return state();
  if (r.path == "layer") return layer(r);
  if (r.path == "picture") return picture(r);
  if (r.path == "measured") return measured(r, false);
  if (r.path == "measured.csv") return measured(r, true);
  if (year_ && r.path == "year/seen") return sensors_in_sight();
  if (year_ && (r.path == "year" || r.path.starts_with("year/"))) return year_->answer(r);
  return page_file(r.path);
}

HttpResponse ViewService::post(const HttpRequest& r) {
  if (r.path == "pick") return pick(r.body);
  if (r.path == "grid") return grid(r.body);
  if (r.path == "measure") return measure_again(r.body);
  if (r.path == "camera") {
    move(r.body);
  } else if (r.path == "extras") {
    change_extras(r.body);
  } else if (r.path == "time") {
    change_time(r.body);
  } else if (r.path == "close") {
    is_closed_ = true;
  } else {
    return {404, "text/plain; charset=utf-8", "nothing here\n", ""};
  }
  return json_response({{"view", painter_.state().view}});
}

HttpResponse ViewService::state() const {
  const PaintingState s = painter_.state();
  const ViewRequest request = painter_.request();
  const ViewExtras extras = painter_.extras();
  json j = {{"view", s.view},
            {"stage", s.stage},
            {"progress", s.progress},
            {"seconds", s.seconds},
            {"seconds_to_first", s.seconds_to_first},
            {"failure", s.failure},
            {"file", settings_.file},
            {"notice", settings_.notice},
            {"method", std::string(settings_.options.method.row().name)},
            {"error_asked", settings_.options.error},
            {"second", extras.second ? std::string(extras.second->row().name) : ""},
            {"is_dimmed", extras.is_dimmed()},
            {"is_photometric", lighting_->is_photometric()},
            {"time", settings_.time},
            {"has_time", settings_.relit != nullptr},
            {"has_year", year_ != nullptr},
            {"size", {request.size.width, request.size.height}},
            {"up", troffer::json_of(Vec3d(settings_.up))},
            {"camera", json_of_camera(request.camera, lighting_->origin())}};
  const Boxd& box = lighting_->bounds();
  if (!box.is_empty()) j["bounds"] = {troffer::json_of(box.lower), troffer::json_of(box.upper)};
  j["cameras"] = json::array();
  for (const Camera& c : lighting_->cameras())
    j["cameras"].push_back(json_of_camera(c, lighting_->origin()));
  j["dimmers"] = json::array();
  for (const Dimmer& d : lighting_->dimmers())
    j["dimmers"].push_back({{"name", d.name}, {"power", std::isfinite(d.power) ? d.power : 0}});
  j["layers"] = json::object();
  for (const auto& [name, l] : board_.list())
    j["layers"][name] = {{"version", l.version}, {"view", l.view}, {"error", l.error}};
  return json_response(j);
}

// One byte per sensor of the year: 1 if the current view shows it.
HttpResponse ViewService::sensors_in_sight() const {
  return {200, "application/octet-stream",
          as_text(points_in_sight(*lighting_->whole(), painter_.request().camera, year_->points())),
          ""};
}

// The body is four 32-bit words (width, height, channels, version), then floats, row by row from
// the top.
HttpResponse ViewService::layer(const HttpRequest& r) const {
  const std::string name = r.value("name");
  const auto l = board_.get(name);
  if (!l) return {404, "text/plain; charset=utf-8", "no such layer\n", ""};
  const uint32_t channels = name == "error" ? 1 : 3;
  const std::array<uint32_t, 4> head{uint32_t(l->image.width), uint32_t(l->image.height), channels,
                                     uint32_t(l->version)};
  HttpResponse out{200, "application/octet-stream", "", ""};
  out.body.append(reinterpret_cast<const char*>(head.data()), sizeof(head));
  if (channels == 3) {
    out.body.append(reinterpret_cast<const char*>(l->image.pixels.data()),
                    l->image.pixels.size() * sizeof(Rgb));
  } else {
    for (const Rgb& p : l->image.pixels)
      out.body.append(reinterpret_cast<const char*>(&p.r), sizeof(float));
  }
  return out;
}

HttpResponse ViewService::picture(const HttpRequest& r) const {
  const DimmerSettings dimmers = parse_dimmers(r.value("dimmers"), lighting_->dimmers().size());
  std::vector<Layer> layers{{"", {"R", "G", "B"}, dimmed_picture(board_, dimmers)}};
  const std::string format = r.value("format");
  if (format == "png") {
    const double stops = std::strtod(r.value("stops").c_str(), nullptr);
    const Display display{std::isfinite(stops) ? std::clamp(stops, -60.0, 60.0) : 0,
                          r.value("tone_map") == "none" ? ToneMap::none : ToneMap::filmic};
    return {200, "image/png", as_text(encode_png(layers[0].image, display, 1)), "view.png"};
  }
  if (format == "hdr")
    return {200, "image/vnd.radiance", as_text(encode_hdr(layers[0].image)), "view.hdr"};
  if (format != "exr") throw UsageError("format: png, hdr or exr");
  const auto add = [&](const std::string& from, const std::string& name, bool is_grey) {
    const auto l = board_.get(from);
    const Image& first = layers[0].image;
    if (!l || l->image.width != first.width || l->image.height != first.height) return;
    layers.push_back(
        {name, is_grey ? std::vector<std::string>{"V"} : std::vector<std::string>{"R", "G", "B"},
         l->image});
  };
  add("albedo", "albedo", false);
  add("error", "error", true);
  for (size_t i = 0; i < lighting_->dimmers().size(); ++i)
    add("dimmer" + std::to_string(i),
        "light" + std::to_string(i) + "_" + channel_name(lighting_->dimmers()[i].name), false);
  return {200, "image/x-exr", as_text(encode_exr(layers, {}, "")), "view.exr"};
}

HttpResponse ViewService::measured(const HttpRequest& r, bool is_csv) const {
  const auto a = desk_.answer(number_of(r, "number"));
  if (!a) throw UsageError("there is no measurement with that number");
  if (is_csv) {
    const DimmerSettings dimmers =
        parse_dimmers(r.value("dimmers"), a->task.lighting->dimmers().size());
    return {200, "text/csv; charset=utf-8",
            measurements_csv(a->task.points, dimmed_measurements(*a, dimmers)), "measured.csv"};
  }
  json values = json::array();
  for (const auto& row : a->values) {
    json of_row = json::array();
    for (const Measurement& m : row) of_row.push_back(json_of(m));
    values.push_back(std::move(of_row));
  }
  return json_response({{"is_done", a->is_done},
                        {"failure", a->failure},
                        {"by_dimmers", a->task.by_dimmers},
                        {"values", std::move(values)}});
}

void ViewService::move(const std::string& body) {
  const json j = parse_object(body);
  const ViewRequest now = painter_.request();
  Camera base = now.camera;
  if (j.contains("index")) {
    const std::vector<Camera>& cameras = lighting_->cameras();
    const double index = number_in(j, "index", 0, double(cameras.size()) - 1);
    base = cameras[size_t(index)];
  }
  ImageSize size = now.size;
  if (j.contains("width")) {
    constexpr double most = 4096;
    size = {int(number_in(j, "width", 1, most)), int(number_in(j, "height", 1, most))};
  }
  show(camera_of_json(j, base, lighting_->origin()), size);
}

void ViewService::change_extras(const std::string& body) {
  const json j = parse_object(body);
  ViewExtras extras;
  const json dimmers = j.value("dimmers", json(""));
  if (dimmers.is_string() && !dimmers.get<std::string>().empty())
    extras.settings = parse_dimmers(dimmers.get<std::string>(), lighting_->dimmers().size());
  const json second = j.value("second", json(""));
  if (second.is_string() && !second.get<std::string>().empty()) {
    extras.second = Method::find(second.get<std::string>());
    if (!extras.second) throw UsageError("there is no such method, but " + Method::names());
  }
  painter_.set_extras(extras);
}

void ViewService::change_time(const std::string& body) {
  const json j = parse_object(body);
  const auto at = j.find("time");
  if (!settings_.relit || at == j.end() || !at->is_string())
    throw UsageError("the scene has no time of day");
  const auto time = at->get<std::string>();
  lighting_ = std::make_shared<Lighting>(settings_.relit(time));
  settings_.time = time;
  const ViewRequest now = painter_.request();
  show(now.camera, now.size);
}

MeasuringPoint ViewService::point_at(double x, double y, std::string* name) const {
  const ViewRequest now = painter_.request();
  const auto seen = point_seen(*lighting_->whole(), now.camera, now.size.width, now.size.height,
                               {float(x * now.size.width), float(y * now.size.height)});
  if (!seen) throw UsageError("there is no surface at that place");
  if (name != nullptr) *name = seen->name;
  return seen->point;
}

HttpResponse ViewService::begin_measuring(const MeasuringTask& task, const json& more) {
  json about = more;
  about["number"] = desk_.add(task);
  about["points"] = json::array();
  for (const MeasuringPoint& p : task.points)
    about["points"].push_back(
        {p.position.x, p.position.y, p.position.z, p.normal.x, p.normal.y, p.normal.z});
  return json_response(about);
}

HttpResponse ViewService::pick(const std::string& body) {
  const json j = parse_object(body);
  std::string name;
  const MeasuringPoint p = point_at(number_in(j, "x", 0, 1), number_in(j, "y", 0, 1), &name);
  return begin_measuring({lighting_, {p}, painter_.extras().is_dimmed()}, {{"name", name}});
}

HttpResponse ViewService::grid(const std::string& body) {
  const json j = parse_object(body);
  MeasuringPoint first = point_at(number_in(j, "x0", 0, 1), number_in(j, "y0", 0, 1), nullptr);
  const MeasuringPoint second =
      point_at(number_in(j, "x1", 0, 1), number_in(j, "y1", 0, 1), nullptr);
  const double above = number_in(j, "above", -1000, 1000);
  first.position = first.position + Vec3d(first.normal) * above;
  const MeasuringGrid g =
      grid_between(first, second.position, settings_.up, int(number_in(j, "along", 1, 1000)));
  return begin_measuring(
      {lighting_, g.points, painter_.extras().is_dimmed()},
      {{"columns", g.columns}, {"rows", g.rows}, {"width", g.width}, {"depth", g.depth}});
}

// Measures the points of a task again, by dimmers or under another light.
HttpResponse ViewService::measure_again(const std::string& body) {
  const json j = parse_object(body);
  const auto a = desk_.answer(uint64_t(number_in(j, "number", 0, 1e15)));
  if (!a) throw UsageError("there is no measurement with that number");
  return begin_measuring({lighting_, a->task.points, painter_.extras().is_dimmed()},
                         json::object());
}

}  // namespace troffer
