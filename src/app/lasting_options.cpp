#include "app/lasting_options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

#include "app/commands.h"
#include "app/option_values.h"
#include "base/error.h"
#include "image/write_image.h"

namespace troffer {

void parse_part(const std::string& text, int& part, int& parts) {
  constexpr int most = 1'000'000;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, part);
  bool is_sound = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  if (is_sound) {
    const auto second = std::from_chars(first.ptr + 1, end, parts);
    is_sound = second.ec == std::errc() && second.ptr == end;
  }
  if (!is_sound || parts < 1 || parts > most || part < 1 || part > parts)
    throw UsageError("--part: '" + text + "' is not K/N with K from 1 to N");
}

void add_lasting_options(CLI::App& app, LastingOptions& o) {
  const CLI::Validator seconds = number_between(0.001, 1e9);
  app.add_option("--time-limit", o.time_limit,
                 "Stop after this many seconds and write the picture as it is")
      ->check(seconds);
  app.add_option(
         "--error-limit", o.error_limit,
         "Stop when the estimated error of the picture, relative to its light, is at most this")
      ->check(number_between(1e-6, 10));
  app.add_option("--checkpoint", o.checkpoint,
                 "File to save the work done, at intervals and when interrupted");
  app.add_option("--checkpoint-interval", o.checkpoint_interval, "Seconds between checkpoints")
      ->check(seconds)
      ->capture_default_str();
  app.add_flag("--resume", o.is_resumed, "Continue from --checkpoint, if the file exists");
  app.add_option("--part", o.part,
                 "Render only part K of N of the picture; troffer merge joins the parts");
}

void apply_lasting_options(RenderCommand& c, bool has_spp) {
  const LastingOptions& l = c.lasting;
  for (const double v : {l.time_limit, l.error_limit, l.checkpoint_interval})
    if (!std::isfinite(v)) throw UsageError("limits must be numbers");
  if (l.is_resumed && l.checkpoint.empty()) throw UsageError("--resume needs --checkpoint FILE");
  if (!l.part.empty()) {
    parse_part(l.part, c.options.part, c.options.parts);
    if (l.error_limit > 0)
      throw UsageError("--error-limit applies to the whole picture and does not go with --part");
    if (c.has_preview) throw UsageError("--preview does not go with --part");
    for (const std::string& o : c.outputs)
      if (image_format(o) != ImageFormat::exr)
        throw UsageError(
            "--part writes .exr only; troffer merge joins the parts and writes any format");
  }
  c.options.error_limit = l.error_limit;
  // Methods without refinement get as many samples as the error limit needs.
  constexpr int most_rays = 1 << 16;
  if (l.error_limit > 0 && !has_spp && parse_method(c.method).row().refinement == 1)
    c.options.spp = most_rays;
}

}  // namespace troffer
