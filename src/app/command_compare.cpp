#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/output_guard.h"
#include "app/signals.h"
#include "compare/compare.h"
#include "compare/maps.h"
#include "image/output_set.h"
#include "image/read_image.h"
#include "image/write_image.h"

namespace troffer {

void add_compare(CLI::App& app, CompareCommand& c) {
  CLI::App* s = app.add_subcommand("compare", "Compare a picture with a reference");
  s->add_option("image", c.image, "Picture: .exr .hdr .pfm .png .jpg")->required();
  s->add_option("reference", c.reference, "Reference of the same size")->required();
  s->add_option("--map", c.map, "Picture file for the FLIP error map");
  s->add_option("--difference", c.difference, "Picture file for the absolute difference");
  s->add_flag("--json", c.is_json, "Print JSON");
}

int run_compare(const CompareCommand& command) {
  for (const std::string& path : {command.map, command.difference})
    if (!path.empty()) image_format(path);
  OutputGuard guard;
  guard.add_input("the image", command.image);
  guard.add_input("the reference", command.reference);
  guard.add_output("--map", command.map);
  guard.add_output("--difference", command.difference);
  const Image image = read_image(command.image), reference = read_image(command.reference);
  const Comparison c = compare_images(image, reference, command.image);
  install_stop_handlers();  // maps are written together
  WriteOptions plain;       // maps are colours, not light: no tone map
  plain.display.tone_map = ToneMap::none;
  OutputSet maps;
  const auto add = [&](const std::string& path, Image map) {
    const Layer layer{"", {"R", "G", "B"}, std::move(map)};
    maps.add(path, std::span(&layer, 1), plain);
  };
  if (!command.map.empty()) add(command.map, flip_map(image, reference));
  if (!command.difference.empty())
    add(command.difference, absolute_difference_map(image, reference));
  maps.commit();

  const std::pair<const char*, double> rows[] = {{"mean_image", c.mean_image},
                                                 {"mean_reference", c.mean_reference},
                                                 {"average_difference", c.average_difference},
                                                 {"rmse", c.rmse},
                                                 {"relative_rmse", c.relative_rmse},
                                                 {"flip", c.flip}};
  if (command.is_json) {
    nlohmann::ordered_json j;
    for (const auto& [name, value] : rows) j[name] = value;
    j["compared_pixels"] = c.compared_pixels;
    j["non_finite_pixels"] = c.non_finite_pixels;
    fmt::print("{}\n", j.dump(2));
    return exit_done;
  }
  for (const auto& [name, value] : rows) fmt::print("{:<20}{:.6g}\n", name, value);
  if (c.non_finite_pixels > 0) fmt::print("{:<20}{}\n", "non_finite_pixels", c.non_finite_pixels);
  return exit_done;
}

}  // namespace troffer
