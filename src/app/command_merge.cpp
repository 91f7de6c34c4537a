#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/commands.h"
#include "app/option_values.h"
#include "app/output_guard.h"
#include "app/outputs.h"
#include "app/part_note.h"
#include "app/picture_files.h"
#include "app/signals.h"
#include "base/error.h"
#include "image/layered_image.h"

namespace troffer {

namespace {

constexpr size_t most_pixels = size_t(1) << 30;  // limit on all layers together

// The parts joined so far.
struct Joined {
  PartNote note;  // note of the first part
  std::vector<Layer> layers;
  std::vector<std::string> files;  // file of each part; empty: missing
  std::vector<uint8_t> is_there;   // per pixel
};

[[noreturn]] void refuse(const std::string& file, const std::string& what) {
  throw InputError(file, 0, 0, what);
}

// Checks that a part belongs to the same picture as the first one.
void check_note(const PartNote& n, const Joined& all, const std::string& file,
                const std::string& first) {
  const PartNote& f = all.note;
  if (n.key.program != f.key.program)
    refuse(file, "made by troffer " + n.key.program + ", and " + first + " by " + f.key.program);
  if (n.key.scene != f.key.scene)
    refuse(file, "shows another scene, or other light, than " + first);
  if (n.key.settings != f.key.settings)
    refuse(file, "made with other options, or another camera, than " + first);
  if (n.key.preparation != f.key.preparation)
    refuse(file, "made with another --solution than " + first);
  if (n.share.parts != f.share.parts)
    refuse(file,
           fmt::format("one of {} parts, and {} one of {}", n.share.parts, first, f.share.parts));
  if (n.asked != f.asked || n.width != f.width || n.height != f.height || n.has_crop != f.has_crop)
    refuse(file, "part of a picture of another size than " + first);
}

// Allocates the whole picture.
void begin(const PartNote& note, const LayeredImage& part, const MergeCommand& c, Joined& all) {
  const int width = note.asked[2] - note.asked[0], height = note.asked[3] - note.asked[1];
  if (size_t(width) * size_t(height) > most_pixels / part.layers.size())
    refuse(c.parts[0], fmt::format("picture of {}x{} pixels is too large", width, height));
  if (size_t(note.share.parts) > c.parts.size())
    throw UsageError(
        fmt::format("{} of {} parts: some are missing", c.parts.size(), note.share.parts));
  all.note = note;
  for (const Layer& l : part.layers)
    all.layers.push_back({l.name, l.channels, Image(width, height)});
  all.files.resize(size_t(note.share.parts));
  all.is_there.assign(size_t(width) * size_t(height), 0);
}

void add(const LayeredImage& part, const std::string& file, Joined& all) {
  const int x0 = part.window.x - all.note.asked[0], y0 = part.window.y - all.note.asked[1];
  const Image& picture = part.layers[0].image;
  const int width = all.note.asked[2] - all.note.asked[0],
            height = all.note.asked[3] - all.note.asked[1];
  if (x0 < 0 || y0 < 0 || picture.width > width - x0 || picture.height > height - y0)
    refuse(file, "has pixels outside the picture");
  if (part.layers.size() != all.layers.size()) refuse(file, "has other layers");
  for (size_t l = 0; l < all.layers.size(); ++l) {
    const Layer& from = part.layers[l];
    Layer& to = all.layers[l];
    if (from.name != to.name || from.channels != to.channels) refuse(file, "has other layers");
    for (int y = 0; y < picture.height; ++y)
      std::copy_n(&from.image.at(0, y), picture.width, &to.image.at(x0, y0 + y));
  }
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      uint8_t& is_there = all.is_there[size_t(y0 + y) * size_t(width) + size_t(x0 + x)];
      if (is_there != 0) refuse(file, "has pixels that another part has too");
      is_there = 1;
    }
}

Joined join(const MergeCommand& c) {
  Joined all;
  for (const std::string& file : c.parts) {
    const LayeredImage part = read_layers(file, most_pixels);
    if (part.note.empty()) refuse(file, "not a part of a picture (made by troffer render --part)");
    const PartNote note = parse_part_note(part.note, file);
    if (all.layers.empty())
      begin(note, part, c, all);
    else
      check_note(note, all, file, c.parts[0]);
    if (!note.is_complete) refuse(file, "this part is unfinished: render it to the end");
    std::string& before = all.files[size_t(note.share.part - 1)];
    if (!before.empty())
      refuse(file, fmt::format("part {} of {}, as {}", note.share.part, note.share.parts, before));
    before = file;
    add(part, file, all);
  }
  for (const uint8_t is_there : all.is_there)
    if (is_there == 0) refuse(c.parts[0], "the parts do not make up all of the picture");
  return all;
}

}  // namespace

void add_merge(CLI::App& app, MergeCommand& c) {
  CLI::App* s = app.add_subcommand("merge", "Join the parts of a picture made by render --part");
  s->add_option("output", c.output, "Picture to write: .exr .hdr .pfm .png")->required();
  s->add_option("parts", c.parts, "All parts, in any order: .exr")->required();
  s->add_option("--exposure", c.exposure, "Exposure of .png in stops, or auto [as for render]");
  s->add_option("--tone-map", c.tone_map, "Tone curve of .png")
      ->check(one_of({"filmic", "none"}))
      ->capture_default_str();
  s->add_flag("--quiet", c.is_quiet, "No warnings");
}

int run_merge(const MergeCommand& c) {
  check_exposure(c.exposure);
  image_format(c.output);  // throws UsageError for an unknown ending
  OutputGuard guard;
  for (const std::string& part : c.parts) guard.add_input("the part", part);
  guard.add_output("the output", c.output);
  const std::vector<OutputReservation> reserved = reserve_outputs({c.output}, {});
  const Joined all = join(c);
  install_stop_handlers();  // from here on the result is written even if a signal comes
  // Written like the output of a command that renders the whole picture.
  RenderCommand whole;
  whole.outputs = {c.output};
  whole.exposure = c.exposure;
  whole.tone_map = c.tone_map;
  whole.options.width = all.note.width;
  whole.options.height = all.note.height;
  whole.options.has_crop = all.note.has_crop;
  whole.options.crop = all.note.asked;
  write_image(c.output, all.layers,
              write_options(whole, Camera(), all.layers[0].image, c.is_quiet));
  return exit_done;
}

}  // namespace troffer
