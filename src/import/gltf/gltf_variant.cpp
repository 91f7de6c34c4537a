#include "import/gltf/gltf_variant.h"

#include "base/error.h"

namespace troffer {

namespace {

constexpr const char* extension_name = "KHR_materials_variants";

}  // namespace

std::optional<uint32_t> find_gltf_variant(const JsonNode& root,
                                          const std::optional<std::string>& name,
                                          WarningLog& warnings) {
  const auto extension = root.extension(extension_name);
  const auto list = extension ? extension->find("variants") : std::nullopt;
  std::string names;
  for (size_t i = 0; list && i < list->size(); ++i) {
    const std::string is = list->element(i).member("name").as_string();
    if (name && is == *name) return uint32_t(i);
    names += (i > 0 ? ", " : "") + printable(is);
  }
  if (name)
    throw UsageError("--variant: the scene has no variant '" + printable(*name) + "'" +
                     (names.empty() ? "" : ", but " + names));
  if (!names.empty())
    warnings.add("the materials have variants; the default is shown, --variant chooses one of: " +
                 names);
  return std::nullopt;
}

std::optional<uint32_t> gltf_variant_material(const JsonNode& root, const JsonNode& primitive,
                                              uint32_t variant) {
  const auto extension = primitive.extension(extension_name);
  if (!extension) return std::nullopt;
  const size_t variants = root.extension(extension_name)->member("variants").size();
  const JsonNode mappings = extension->member("mappings");
  for (size_t i = 0; i < mappings.size(); ++i) {
    const JsonNode mapping = mappings.element(i), list = mapping.member("variants");
    for (size_t k = 0; k < list.size(); ++k) {
      if (list.element(k).as_index(variants, "variants") != variant) continue;
      const auto materials = root.find("materials");
      return mapping.member("material").as_index(materials ? materials->size() : 0, "materials");
    }
  }
  return std::nullopt;
}

}  // namespace troffer
