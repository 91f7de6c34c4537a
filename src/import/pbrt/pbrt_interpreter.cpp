// Files, blocks, transforms and the directives before WorldBegin.
#include "import/pbrt/pbrt_interpreter.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/error.h"
#include "import/file.h"
#include "import/pbrt/pbrt_transform.h"

namespace troffer {

namespace {

constexpr size_t max_include_depth = 64;
// bounds the exponential growth of files that include each other twice
constexpr size_t max_files = 20'000;
constexpr size_t max_open_blocks = 100'000;

}  // namespace

PbrtInterpreter::PbrtInterpreter(Scene& scene, const std::string& path, PlacedBounds& bounds)
    : scene_(scene),
      path_(path),
      materials_(scene, folder_of(path)),
      placer_(scene, materials_, bounds) {
  state_.material = std::make_shared<PbrtMaterial>();
  state_.material->type = "diffuse";
  state_.material->name = "default";
  state_.defaults = std::make_shared<const Defaults>();
}

void PbrtInterpreter::run() {
  run_file(path_, nullptr);
  if (!saved_.empty())
    fail_at(saved_.back().place, saved_.back().block == Block::object
                                     ? "ObjectBegin without ObjectEnd"
                                     : "AttributeBegin without AttributeEnd");
  if (!is_in_world_) throw InputError(path_, 0, 0, "the file ends without WorldBegin");
}

void PbrtInterpreter::run_file(const std::string& path, const PbrtPlace* included_at) {
  if (included_at) {
    if (std::find(files_.open.begin(), files_.open.end(), path) != files_.open.end())
      fail_at(*included_at, "'" + path + "' includes itself");
    if (files_.open.size() > max_include_depth) fail_at(*included_at, "files nest too deeply");
    if (++files_.read > max_files) fail_at(*included_at, "too many included files");
  }
  std::string text;
  try {
    text = read_text_file(
        path, default_max_file_bytes - std::min(files_.bytes_read, default_max_file_bytes));
  } catch (const InputError& error) {
    if (!included_at) throw;
    fail_at(*included_at, "cannot read '" + path + "': " + error.reason());
  }
  files_.bytes_read += text.size();
  files_.open.push_back(path);
  materials_.textures.expect_images_of(text);
  PbrtTokenizer tokens(path, text);
  for (PbrtToken token = tokens.next(); token.kind != PbrtTokenKind::end; token = tokens.next()) {
    if (token.kind != PbrtTokenKind::word)
      fail_at(tokens.place(token),
              "expected a directive, found '" + std::string(token.text.substr(0, 40)) + "'");
    run_directive(token, tokens);
  }
  files_.open.pop_back();
}

void PbrtInterpreter::run_directive(const PbrtToken& word, PbrtTokenizer& tokens) {
  const auto found = handlers().find(word.text);
  if (found != handlers().end()) {
    (this->*found->second)(word, tokens);
    return;
  }
  const auto transform = parse_transform(word, tokens);
  if (!transform)
    fail_at(tokens.place(word), "unknown directive '" + std::string(word.text.substr(0, 40)) + "'");
  if (!state_.is_start_active || !state_.is_end_active)
    scene_.warnings.add("animated transforms are not supported: shown at the start of the shutter");
  if (!state_.is_start_active) return;
  state_.transform =
      transform->is_absolute ? transform->value : state_.transform * transform->value;
}

std::string PbrtInterpreter::parse_string(const PbrtToken& word, PbrtTokenizer& tokens) {
  // Some files put single strings in brackets.
  const bool has_brackets = tokens.peek().kind == PbrtTokenKind::open_bracket;
  if (has_brackets) tokens.next();
  const PbrtToken token = tokens.next();
  if (token.kind != PbrtTokenKind::string)
    fail_at(tokens.place(token), std::string(word.text) + " needs a string in quotes here");
  const std::string text = unescaped(token.text);
  if (has_brackets && tokens.peek().kind != PbrtTokenKind::close_bracket)
    fail_at(tokens.place(tokens.peek()), "expected ']'");
  if (has_brackets) tokens.next();
  return text;
}

PbrtParams PbrtInterpreter::parse_typed(const PbrtToken& word, PbrtTokenizer& tokens,
                                        const std::string& type, const std::string& target) {
  PbrtParams params = parse_params(tokens, std::string(word.text) + " \"" + type + "\"",
                                   tokens.place(word), scene_.warnings);
  const bool shines = word.text == "LightSource" || word.text == "AreaLightSource";
  params.change_all([&](PbrtParam& param) { to_srgb(param, state_.color_space, shines); });
  const auto defaults = state_.defaults->find(target);
  if (defaults != state_.defaults->end())
    for (const PbrtParam& param : defaults->second) params.add(param);
  return params;
}

void PbrtInterpreter::need_world(const PbrtToken& word, PbrtTokenizer& tokens) const {
  if (!is_in_world_)
    fail_at(tokens.place(word), std::string(word.text) + " must stand after WorldBegin");
}

void PbrtInterpreter::need_options(const PbrtToken& word, PbrtTokenizer& tokens) const {
  if (is_in_world_)
    fail_at(tokens.place(word), std::string(word.text) + " must stand before WorldBegin");
}

void PbrtInterpreter::push(Block block, const PbrtPlace& place) {
  if (saved_.size() >= max_open_blocks) fail_at(place, "blocks nest too deeply");
  saved_.push_back({state_, block, place});
}

void PbrtInterpreter::pop(Block block, const PbrtToken& word, PbrtTokenizer& tokens) {
  if (saved_.empty() || saved_.back().block != block)
    fail_at(tokens.place(word), std::string(word.text) + " without its beginning");
  state_ = std::move(saved_.back().state);
  saved_.pop_back();
}

void PbrtInterpreter::on_include(const PbrtToken& word, PbrtTokenizer& tokens) {
  const PbrtPlace place = tokens.place(tokens.peek());
  const std::string name = parse_string(word, tokens);
  const ConfinedPath path = confined_path(folder_of(path_), name);
  if (!path.is_fine()) fail_at(place, "cannot use '" + name + "': " + path.problem);
  run_file(path.path, &place);
}

// Runs an imported file and restores the graphics state afterwards.
void PbrtInterpreter::on_import(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_world(word, tokens);
  const State before = state_;
  const size_t open_blocks = saved_.size();
  on_include(word, tokens);
  if (saved_.size() != open_blocks)
    fail_at(tokens.place(word), "the imported file has blocks that do not match");
  state_ = before;
}

void PbrtInterpreter::on_attribute_begin(const PbrtToken& word, PbrtTokenizer& tokens) {
  if (word.text == "TransformBegin")
    scene_.warnings.add("TransformBegin is deprecated; read as AttributeBegin, as pbrt-v4 does");
  push(Block::attribute, tokens.place(word));
}

void PbrtInterpreter::on_attribute_end(const PbrtToken& word, PbrtTokenizer& tokens) {
  pop(Block::attribute, word, tokens);
}

void PbrtInterpreter::on_attribute(const PbrtToken& word, PbrtTokenizer& tokens) {
  const PbrtPlace place = tokens.place(tokens.peek());
  const std::string target = parse_string(word, tokens);
  if (target != "shape" && target != "light" && target != "material" && target != "medium" &&
      target != "texture")
    fail_at(place, "Attribute: unknown target \"" + target + "\"");
  const PbrtParams params = parse_params(tokens, "Attribute", place, scene_.warnings);
  Defaults defaults = *state_.defaults;
  // Newer defaults stand first, so that a lookup finds them before older ones.
  std::vector<PbrtParam> list;
  for (PbrtParam param : params.all()) {
    param.is_default = true;
    to_srgb(param, state_.color_space, target == "light");
    list.push_back(std::move(param));
  }
  for (PbrtParam& old : defaults[target]) {
    const auto is_same = [&](const PbrtParam& p) { return p.name == old.name; };
    if (std::none_of(list.begin(), list.end(), is_same)) list.push_back(std::move(old));
  }
  defaults[target] = std::move(list);
  state_.defaults = std::make_shared<const Defaults>(std::move(defaults));
}

void PbrtInterpreter::on_coordinate_system(const PbrtToken& word, PbrtTokenizer& tokens) {
  named_.coordinate_systems[parse_string(word, tokens)] = state_.transform;
}

void PbrtInterpreter::on_coordinate_system_transform(const PbrtToken& word, PbrtTokenizer& tokens) {
  const std::string name = parse_string(word, tokens);
  const auto found = named_.coordinate_systems.find(name);
  if (found != named_.coordinate_systems.end())
    state_.transform = found->second;
  else
    scene_.warnings.add(
        at_place(tokens.place(word), "no coordinate system \"" + name + "\"; ignored"));
}

void PbrtInterpreter::on_active_transform(const PbrtToken& word, PbrtTokenizer& tokens) {
  const PbrtToken which = tokens.next();
  const bool is_start = which.text == "StartTime", is_end = which.text == "EndTime";
  if (!is_start && !is_end && which.text != "All")
    fail_at(tokens.place(which), std::string(word.text) + " needs StartTime, EndTime or All");
  state_.is_start_active = !is_end;
  state_.is_end_active = !is_start;
}

void PbrtInterpreter::on_transform_times(const PbrtToken& word, PbrtTokenizer& tokens) {
  parse_numbers(tokens, 2, word.text);
}

void PbrtInterpreter::on_reverse_orientation(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_world(word, tokens);
  state_.is_reversed = !state_.is_reversed;
}

void PbrtInterpreter::on_camera(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_options(word, tokens);
  const std::string type = parse_string(word, tokens);
  if (camera_)
    scene_.warnings.add(at_place(tokens.place(word), "a second Camera replaces the first"));
  camera_ = std::make_unique<PendingCamera>();
  camera_->type = type;
  camera_->params = parse_typed(word, tokens, type, "camera");
  camera_->camera_from_world = state_.transform;
  if (state_.transform.determinant() != 0)
    named_.coordinate_systems["camera"] = inverse(state_.transform);
}

void PbrtInterpreter::on_film(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_options(word, tokens);
  const std::string type = parse_string(word, tokens);
  film_ = read_pbrt_film(type, parse_typed(word, tokens, type, "film"), scene_.warnings);
}

// Sampler, Integrator, PixelFilter and Accelerator are ignored: the command line sets how to
// render.
void PbrtInterpreter::on_sampling(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_options(word, tokens);
  const std::string type = parse_string(word, tokens);
  parse_typed(word, tokens, type, "");
}

// Ignores options that only change how pbrt works; warns of those that change its pictures.
void PbrtInterpreter::on_option(const PbrtToken& word, PbrtTokenizer& tokens) {
  constexpr std::array<std::string_view, 8> of_no_consequence{"disablepixeljitter",
                                                              "disablewavelengthjitter",
                                                              "msereferenceimage",
                                                              "msereferenceout",
                                                              "pixelstats",
                                                              "rendercoordsys",
                                                              "seed",
                                                              "wavefront"};
  constexpr std::array<std::string_view, 3> left_out{"disabletexturefiltering",
                                                     "displacementedgescale", "forcediffuse"};
  const auto is_in = [](const auto& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const PbrtParams params = parse_params(tokens, "Option", tokens.place(word), scene_.warnings);
  for (const PbrtParam& param : params.all()) {
    if (is_in(of_no_consequence, param.name)) continue;
    const bool is_off = param.booleans.size() == 1 && !param.booleans[0];
    if (!is_in(left_out, param.name))
      scene_.warnings.add("Option \"" + param.name + "\" is unknown: ignored");
    else if (!is_off)
      scene_.warnings.add("Option \"" + param.name + "\" is not supported: left out");
  }
}

void PbrtInterpreter::on_color_space(const PbrtToken& word, PbrtTokenizer& tokens) {
  const std::string name = parse_string(word, tokens);
  read_pbrt_color_space(name, tokens.place(word), state_.color_space, scene_.warnings);
}

void PbrtInterpreter::on_world_begin(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_options(word, tokens);
  is_in_world_ = true;
  state_.transform = Affine();
  state_.is_start_active = state_.is_end_active = true;
  named_.coordinate_systems["world"] = Affine();
  if (!camera_) return;
  scene_.cameras.push_back(read_pbrt_camera(camera_->type, camera_->params,
                                            camera_->camera_from_world, scene_.origin, film_,
                                            materials_.textures.folder(), scene_.warnings));
  camera_.reset();
}

void PbrtInterpreter::on_world_end(const PbrtToken& word, PbrtTokenizer& tokens) {
  scene_.warnings.add(at_place(tokens.place(word), "WorldEnd is pbrt-v3 syntax; ignored"));
}

}  // namespace troffer
