// Options of import_scene: a user's choices among the contents of one file. Most come from the
// command line (app/load.cpp). Options that a format does not have are a UsageError there.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "import/image_use.h"
#include "import/read_progress.h"

namespace troffer {

struct ImportOptions {
  std::optional<std::string> variant;    // name of a set of materials: KHR_materials_variants
  std::optional<double> time;            // seconds into an animation; none: at rest
  std::optional<std::string> animation;  // by name; none: the first
  bool shows_baked = false;              // glTF: show only the light baked into the file
  // HBJSON: the state of dynamic groups by name, from 0; others show state 0.
  std::map<std::string, size_t> states;
  // HBJSON: dynamic groups whose windows are black, for the light of the other windows.
  std::set<std::string> blocked_groups;
  TellProgress progress;  // called while .obj, .ply and .stl files are read
  ImageUse images = ImageUse::read;
  // Factor on the emission of surfaces, except luminaires with a photometric web
  // (import/surface_emission.h).
  double emission_scale = 1;

  bool is_any() const { return variant || time || animation || shows_baked; }
};

}  // namespace troffer
