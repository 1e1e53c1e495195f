#include "ao/field/shape_fields.h"

#include <unordered_map>

#include "ao/field/field_file.h"
#include "base/fail.h"
#include "parallel/parallel.h"

namespace tenebra::ao {

void ShapeFields::reset(const std::vector<ObjectShape>& shapes) {
  std::unordered_map<std::uint64_t, Kept> old;
  for (Kept& kept : fields_) old.emplace(kept.hash, std::move(kept));
  fields_.clear();
  for (const ObjectShape& shape : shapes) {
    const auto found = old.find(shape.hash);
    Kept& kept = fields_.emplace_back(found != old.end() ? std::move(found->second) : Kept{});
    kept.hash = shape.hash;
  }
}

void ShapeFields::begin_frame(const std::vector<ObjectShape>& shapes, const FieldSettings& settings,
                              const std::filesystem::path& cache, std::uint64_t frame) {
  for (Kept& kept : fields_) {
    kept.refused = false;
    if (settings != settings_) kept.drop();
  }
  shapes_ = &shapes;
  settings_ = settings;
  cache_ = cache;
  frame_ = frame;
  built_ = 0;
}

bool ShapeFields::make_room(Kept& kept) {
  kept.used = frame_;
  if (kept.share.bytes() > 0) return true;
  const auto size = field_shape(settings_);
  MemoryShare share(*budget_);
  kept.refused = !size || !share.take(field_memory(settings_, *size));
  kept.share = std::move(share);
  return !kept.refused;
}

CacheKey ShapeFields::key_of(int shape) const {
  const ObjectShape& of = (*shapes_)[static_cast<std::size_t>(shape)];
  return field_key(of.positions, casting_triangles(of), settings_);
}

void ShapeFields::load(std::span<const int> shapes) {
  if (cache_.empty()) return;
  std::vector<int> wanted;
  for (const int shape : shapes)
    if (find(shape) == nullptr && make_room(fields_[static_cast<std::size_t>(shape)]))
      wanted.push_back(shape);
  std::vector<std::string> damaged(wanted.size());
  parallel::parallel_tasks(static_cast<int>(wanted.size()), [&](int i) {
    const int shape = wanted[static_cast<std::size_t>(i)];
    const CacheKey key = key_of(shape);
    const bool there = cache_file_exists(field_path(cache_, key));  // others may write it just then
    auto loaded = load_field(cache_, key, settings_);
    if (loaded) {
      fields_[static_cast<std::size_t>(shape)].field = std::move(*loaded);
    } else if (there) {
      damaged[static_cast<std::size_t>(i)] = loaded.error().message + "; it is made anew";
    }
  });
  for (std::string& note : damaged)
    if (!note.empty()) notes_.push_back(std::move(note));
}

Expected<const DisplacementField*> ShapeFields::make(int shape, const trees::TriangleBvh& casters,
                                                     const FieldProgress& progress, const StopFlag* stop) {
  if (const DisplacementField* there = find(shape)) return there;
  Kept& kept = fields_[static_cast<std::size_t>(shape)];
  if (!make_room(kept)) return nullptr;
  const ObjectShape& of = (*shapes_)[static_cast<std::size_t>(shape)];
  const std::vector<glm::uvec3> triangles = casting_triangles(of, stop);
  if (stop_requested(stop)) return base::stopped();
  ++built_;
  auto built = build_field(of.positions, triangles, casters, settings_, progress, stop);
  if (!built) {
    kept.drop();
    return tl::unexpected(built.error());
  }
  kept.field = std::move(*built);
  if (!cache_.empty()) {
    if (auto saved = save_field(cache_, key_of(shape), *kept.field); !saved)
      notes_.push_back(saved.error().message);
  }
  return find(shape);
}

std::optional<LastUse> ShapeFields::oldest() const {
  std::optional<LastUse> oldest;
  for (std::size_t s = 0; s < fields_.size(); ++s) {
    const LastUse use{fields_[s].used, static_cast<int>(s)};
    if (fields_[s].share.bytes() > 0 && use.frame != frame_ && (!oldest || use < *oldest)) oldest = use;
  }
  return oldest;
}

std::size_t ShapeFields::bytes() const {
  std::size_t bytes = 0;
  for (const Kept& kept : fields_) bytes += kept.share.bytes();
  return bytes;
}

}  // namespace tenebra::ao
