// Benchmark of direct light from flat sources at camera hits: shadow rays, the bintrees of 1992,
// certified visibility. bench/direct runs it for every scene and makes tables and plots of its CSV
// files.
//
//   bench_direct curves --scene NAME [--size WxH] [--tiles N] [--spp N]   error against time
//   bench_direct bias   --scene NAME … [--seeds N]                        mean error over seeds
//   bench_direct thin   … [--only NAME] [--error E]                       thin occluders
//   bench_direct shapes                                                   unoccluded light
//     --rays N --replicates N   reference: number of Owen-Sobol rays and of independent sets
//     --keep FOLDER             keep references in FOLDER
//     --csv FOLDER              append rows to the files in FOLDER
//     --quick                   fewer settings
//   NAME: clutter, foliage, one of the thin-occluder scenes, or a file in scenes/ or
//   ../shared/scenes
#include <fmt/format.h>

#include <exception>
#include <stdexcept>
#include <string>

#include "experiments.h"

using namespace troffer::bench;

namespace {

Arguments parse(int argc, char** argv) {
  Arguments a;
  if (argc < 2) throw std::invalid_argument("curves, bias, thin or shapes?");
  a.mode = argv[1];
  for (int i = 2; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--quick") {
      a.is_quick = true;
      continue;
    }
    if (i + 1 == argc) throw std::invalid_argument(name + " needs a value");
    const std::string value = argv[++i];
    if (name == "--scene")
      a.scene = value;
    else if (name == "--only")
      a.only = value;
    else if (name == "--view")
      a.view_name = value;
    else if (name == "--tiles")
      a.view.tiles = std::stoi(value);
    else if (name == "--spp")
      a.view.spp = std::stoi(value);
    else if (name == "--seeds")
      a.seeds = std::stoull(value);
    else if (name == "--error")
      a.error = std::stod(value);
    else if (name == "--rays")
      a.reference.rays = uint32_t(std::stoul(value));
    else if (name == "--replicates")
      a.reference.replicates = uint32_t(std::stoul(value));
    else if (name == "--keep")
      a.reference.folder = value;
    else if (name == "--csv")
      a.csv_folder = value;
    else if (name == "--size") {
      const size_t x = value.find('x');
      if (x == std::string::npos) throw std::invalid_argument("--size WxH");
      a.view.width = std::stoi(value.substr(0, x));
      a.view.height = std::stoi(value.substr(x + 1));
    } else
      throw std::invalid_argument("unknown option " + name);
  }
  return a;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Arguments a = parse(argc, argv);
    if (a.mode == "curves")
      curves(a);
    else if (a.mode == "bias")
      bias(a);
    else if (a.mode == "thin")
      thin(a);
    else if (a.mode == "shapes")
      shapes(a);
    else
      throw std::invalid_argument("no such experiment: " + a.mode);
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
  return 0;
}
