#include "ao/cache/tree_file.h"

#include <array>

#include "base/fail.h"
#include "trees/bvh_order.h"

namespace tenebra::ao {
namespace {

namespace fs = std::filesystem;

constexpr CacheKind kind{{'t', 'e', 'n', 'e', 't', 'r', 'e', '\n'}, 1, "tree"};

/// Stands in front of the lists of BvhOrder, which follow in their order.
struct Sizes {
  std::uint64_t children = 0, triangles = 0;
  std::size_t bytes() const { return sizeof(Sizes) + children + triangles * sizeof(std::uint32_t); }
};

auto lists(Sizes& sizes, trees::BvhOrder& order) {
  return std::array{std::as_writable_bytes(std::span(&sizes, 1)),
                    std::as_writable_bytes(std::span(order.children)),
                    std::as_writable_bytes(std::span(order.triangles))};
}

}  // namespace

CacheKey tree_key(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles) {
  return cache_key(
      {std::as_bytes(std::span(&kind.version, 1)), std::as_bytes(positions), std::as_bytes(triangles)});
}

fs::path tree_path(const fs::path& folder, const CacheKey& key) {
  return cache_path(folder, kind, key);
}

Expected<void> save_tree(const fs::path& folder, const CacheKey& key, const trees::TriangleBvh& tree) {
  trees::BvhOrder order = order_of(tree);
  Sizes sizes{order.children.size(), order.triangles.size()};
  std::string bytes;
  bytes.reserve(sizes.bytes());
  for (const auto& list : lists(sizes, order))
    bytes.append(reinterpret_cast<const char*>(list.data()), list.size());
  return save_cache_file(folder, kind, key, bytes);
}

Expected<trees::TriangleBvh> load_tree(const fs::path& folder, const CacheKey& key,
                                       std::span<const glm::vec3> positions,
                                       std::span<const glm::uvec3> triangles) {
  const Sizes most{triangles.size() * trees::bvh_width,
                   triangles.size()};  // there are no more nodes than triangles
  const auto file = CacheReader::open(folder, kind, key, sizeof(Sizes), most.bytes());
  if (!file) return tl::unexpected(file.error());
  const auto foreign = [&] {
    return base::fail("{}: found the order of another tree, expected one of {} triangles",
                      tree_path(folder, key).string(), triangles.size());
  };
  Sizes sizes;
  if (auto done = file->read(std::array{std::as_writable_bytes(std::span(&sizes, 1))}); !done)
    return tl::unexpected(done.error());
  if (sizes.children > most.children || sizes.triangles > most.triangles || sizes.bytes() != file->bytes())
    return foreign();
  trees::BvhOrder order;
  order.children.resize(sizes.children);
  order.triangles.resize(sizes.triangles);
  if (auto done = file->read(lists(sizes, order)); !done) return tl::unexpected(done.error());
  auto tree = trees::order_triangles(positions, triangles, order);
  if (!tree) return foreign();
  return std::move(*tree);
}

std::optional<trees::TriangleBvh> KeptTrees::make(std::span<const glm::vec3> positions,
                                                  std::span<const glm::uvec3> triangles,
                                                  const StopFlag* stop) {
  if (folder.empty() || triangles.size() < least_triangles)
    return trees::build_triangle_bvh(positions, triangles, stop);
  const CacheKey key = tree_key(positions, triangles);
  const bool there = cache_file_exists(tree_path(folder, key));  // others may write it just then
  auto loaded = load_tree(folder, key, positions, triangles);
  if (loaded) return std::move(*loaded);
  if (there) notes.push_back(loaded.error().message + "; it is made anew");
  auto built = trees::build_triangle_bvh(positions, triangles, stop);
  if (!built) return built;
  const auto saved = save_tree(folder, key, *built);
  if (!saved && !unwritten) notes.push_back(saved.error().message);
  unwritten |= !saved;
  return built;
}

}  // namespace tenebra::ao
