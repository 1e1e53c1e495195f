// Files of --ao-cache from bytes: fields, surface samples and trees, as they lie on disk and, past the
// checksum, as what was packed. Whatever is read back must be whole: a tree of all its triangles.
#include <cstring>

#include "ao/cache/tree_file.h"
#include "ao/field/field_file.h"
#include "ao/surface/sample_file.h"
#include "fuzz/input_file.h"
#include "io/input_file.h"
#include "io/output_file.h"

namespace {

using namespace tenebra;
namespace fs = std::filesystem;

/// A mesh small enough to pack, and the files that are kept of it.
struct Kept {
  std::vector<glm::vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<glm::uvec3> triangles{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  ao::FieldSettings settings{FieldLayout::chords, 16, 16, 8};
  trees::TriangleBvh tree = trees::build_triangle_bvh(positions, triangles);
  ao::CacheKey tree_key = ao::tree_key(positions, triangles);
  ao::CacheKey field_key = ao::field_key(positions, triangles, settings);
  ao::CacheKey sample_key{1, 2};
  static constexpr std::size_t samples = 64;
};

/// Magic and version as a file that was saved has them.
ao::CacheKind kind_of(const fs::path& file, const char* name) {
  const auto bytes = io::read_file(file, std::size_t{1} << 20);
  ao::CacheKind kind{{}, 0, name};
  if (!bytes || bytes->size() < 12) std::abort();
  std::memcpy(kind.magic.data(), bytes->data(), 8);
  std::memcpy(&kind.version, bytes->data() + 8, 4);
  return kind;
}

struct Kinds {
  ao::CacheKind field, samples, tree;
};
Kinds kinds_in(const fs::path& folder, const Kept& kept) {
  const auto field = ao::build_field(kept.positions, kept.triangles, kept.tree, kept.settings);
  if (!field || !ao::save_field(folder, kept.field_key, *field) ||
      !ao::save_tree(folder, kept.tree_key, kept.tree) ||
      !ao::save_samples(folder, kept.sample_key, {}, Kept::samples))
    std::abort();
  return {kind_of(ao::field_path(folder, kept.field_key), "field"),
          kind_of(ao::sample_path(folder, kept.sample_key), "samples"),
          kind_of(ao::tree_path(folder, kept.tree_key), "tree")};
}

void put(const fs::path& folder, const ao::CacheKind& kind, const ao::CacheKey& key, std::string_view bytes,
         bool packed) {
  const bool done = packed ? ao::save_cache_file(folder, kind, key, bytes).has_value()
                           : io::write_file(ao::cache_path(folder, kind, key), bytes).has_value();
  if (!done) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFile input(".bin");
  static const fs::path folder = input.beside("");
  static const Kept kept;
  static const Kinds kinds = kinds_in(folder, kept);
  if (size == 0) return 0;
  const bool packed = (data[0] & 1) != 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] % 6 < 2) {
    put(folder, kinds.field, kept.field_key, bytes, packed);
    (void)ao::load_field(folder, kept.field_key, kept.settings);
  } else if (data[0] % 6 < 4) {
    put(folder, kinds.samples, kept.sample_key, bytes, packed);
    if (auto samples = ao::load_samples(folder, kept.sample_key, Kept::samples))
      if (!ao::save_samples(folder, kept.sample_key, *std::move(samples), Kept::samples)) std::abort();
  } else {
    put(folder, kinds.tree, kept.tree_key, bytes, packed);
    const auto tree = ao::load_tree(folder, kept.tree_key, kept.positions, kept.triangles);
    if (tree && tree->triangles != kept.tree.triangles) std::abort();
  }
  return 0;
}
