#include "import/import.h"

#include "base/error.h"
#include "import/file.h"
#include "import/gltf/gltf.h"
#include "import/gltf/mesh_instancer.h"
#include "import/hbjson/hbjson.h"
#include "import/mesh/obj.h"
#include "import/mesh/ply_scene.h"
#include "import/mesh/stl.h"
#include "import/mitsuba/mitsuba.h"
#include "import/pbrt/pbrt.h"
#include "import/radiance/radiance.h"
#include "import/reference_notes.h"
#include "import/surface_emission.h"
#include "import/thin_glass.h"

namespace troffer {

namespace {

Scene import_file(const std::string& path, const ImportOptions& options) {
  const std::string ending = lower_case_ending(without_gz(path));
  if (ending == "oct")
    throw InputError(
        path, 0, 0,
        "is a Radiance octree, which is not supported: give the .rad file that it was made from");
  const bool is_gltf = ending == "gltf" || ending == "glb";
  const bool is_hbjson = ending == "hbjson" || ending == "json";
  if (!is_gltf && ending != "pbrt" && ending != "obj" && ending != "xml" && ending != "rad" &&
      ending != "stl" && ending != "ply" && !is_hbjson)
    throw InputError(path, 0, 0,
                     "is not a scene: its name should end in .gltf, .glb, .pbrt, .obj, .ply, .stl, "
                     ".xml, .rad or .hbjson");
  if (!is_gltf && options.is_any())
    throw UsageError("--variant, --time, --animation and --baked need a .gltf or .glb");
  if (!is_hbjson && !options.states.empty()) throw UsageError("--state needs an .hbjson");
  if (size_of_file(path) == 0) throw InputError(path, 0, 0, "is empty");
  if (is_hbjson) return import_hbjson(path, options.states, options.blocked_groups);
  if (ending == "rad") return import_radiance(path);
  if (ending == "xml") return import_mitsuba(path, options.images);
  if (ending == "stl") return import_stl(path, {.progress = options.progress});
  if (ending == "ply") return import_ply(path, options.progress);
  return is_gltf            ? import_gltf(path, options)
         : ending == "pbrt" ? import_pbrt(path, options.images)
                            : import_obj(path, {.progress = options.progress}, options.images);
}

}  // namespace

Scene import_scene(const std::string& path, const ImportOptions& options) {
  const ReferenceNotes references;
  Scene scene = import_file(path, options);
  for (const std::string& note : references.notes()) scene.warnings.add(note);
  finalize_instances(scene);
  replace_thin_glass(scene);
  scale_surface_emission(scene, options.emission_scale);
  warn_of_weak_surfaces(scene);
  return scene;
}

}  // namespace troffer
