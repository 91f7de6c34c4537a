#include "app/solution_file.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "image/atomic_file.h"
#include "image/read_image.h"

namespace troffer {

SolutionKind kind_of_solution(const std::string& path) {
  if (path.empty()) return SolutionKind::none;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) return SolutionKind::missing;
  // A pipe can be read only once.
  if (status.type() != std::filesystem::file_type::regular) return SolutionKind::radiosity;
  std::array<uint8_t, 8> first{};
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(first.data()), std::streamsize(first.size()));
  return are_cells({first.data(), size_t(file.gcount())}) ? SolutionKind::cells
                                                          : SolutionKind::radiosity;
}

std::unique_ptr<CellStore> cells_of_file(const PreparedScene& scene, Method method,
                                         Indirect indirect, const std::string& path) {
  if (path.empty() || !needs_cells(method, indirect)) return nullptr;
  if (kind_of_solution(path) == SolutionKind::missing) return std::make_unique<CellStore>();
  return std::make_unique<CellStore>(load_kept_cells(scene, read_file_bytes(path), path));
}

void keep_cells(const PreparedScene& scene, const CellStore* store, const std::string& path,
                bool is_quiet) {
  if (store == nullptr || !store->map || !store->is_changed) return;
  const std::vector<uint8_t> bytes = save_kept_cells(scene, *store);
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
  if (!is_quiet)
    fmt::print(stderr, "kept {} cells in {} ({:.1f} MB)\n", store->map->size(), path,
               double(bytes.size()) * 1e-6);
}

}  // namespace troffer
