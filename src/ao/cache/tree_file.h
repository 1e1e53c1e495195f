// Trees of triangles on disk (cache_file.h): their order alone (bvh_order.h), known by a key of the
// triangles. Boxes and corners come from the triangles themselves, so no file can make a ray miss one.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/stop_flag.h>
#include "ao/cache/cache_file.h"
#include "trees/triangle_bvh.h"

namespace tenebra::ao {

/// Of the triangles and the version of the method.
CacheKey tree_key(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles);

/// FOLDER/KEY.tree, the key in hexadecimal.
std::filesystem::path tree_path(const std::filesystem::path& folder, const CacheKey& key);

/// Whole or absent. Creates the folder if it is missing.
Expected<void> save_tree(const std::filesystem::path& folder, const CacheKey& key,
                         const trees::TriangleBvh& tree);

/// The tree of these triangles, as it was saved; a sentence if there is no such file or it is not as it was
/// written. Memory is bounded by the number of triangles.
Expected<trees::TriangleBvh> load_tree(const std::filesystem::path& folder, const CacheKey& key,
                                       std::span<const glm::vec3> positions,
                                       std::span<const glm::uvec3> triangles);

/// Trees that are kept on disk, so that the next process has them at once.
struct KeptTrees {
  /// A tree of fewer triangles is built faster than it is read.
  static constexpr std::size_t least_triangles = 2048;

  std::filesystem::path folder;    ///< empty: all are built, none is kept
  std::vector<std::string> notes;  ///< files that were damaged, and made anew; the first one not written
  bool unwritten = false;          ///< which was noted

  /// Read or built: the same tree. None if `stop` was requested while it was built.
  std::optional<trees::TriangleBvh> make(std::span<const glm::vec3> positions,
                                         std::span<const glm::uvec3> triangles, const StopFlag* stop);
};

}  // namespace tenebra::ao
