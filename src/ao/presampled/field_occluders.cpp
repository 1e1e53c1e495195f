#include "ao/presampled/field_occluders.h"

#include <algorithm>
#include <unordered_map>

#include "base/fail.h"
#include "base/sort_unique.h"

namespace tenebra::ao {

void FieldOccluders::reset(const SceneObjects& objects) {
  std::unordered_map<std::uint64_t, bool> by_rays;
  for (const Shape& shape : shapes_) by_rays.emplace(shape.hash, shape.by_rays);
  shapes_.clear();
  for (const ObjectShape& shape : objects.shapes) {
    const auto known = by_rays.find(shape.hash);
    shapes_.push_back({shape.hash, known != by_rays.end() && known->second});
  }
  fields_.reset(objects.shapes);
  instances_.clear();
}

void FieldOccluders::begin_frame(const FieldSettings& settings, const std::filesystem::path& cache,
                                 SimdLevel level, std::uint64_t frame, const StopFlag* stop) {
  if (settings != settings_)
    for (Shape& shape : shapes_) shape.by_rays = false;
  settings_ = settings;
  stop_ = stop;
  kernels_ = field_kernels(level);
  const SceneObjects& objects = casters_->objects();
  fields_.begin_frame(objects.shapes, settings, cache, frame);
  instances_.assign(objects.objects.size(), std::nullopt);
  for (int object = 0; object < casters_->standing(); ++object)
    if (const DisplacementField* field = fields_.find(shape_of(object))) place(object, *field);
}

/// Not where it is not drawn or flat.
void FieldOccluders::place(int object, const DisplacementField& field) {
  const MovingObject& placed = casters_->objects().objects[index(object)];
  if (!placed.visible || !(casters_->objects().shapes[index(placed.shape)].radius > 0)) return;
  instances_[index(object)] = place_field(field, casters_->shape_tree(placed.shape), placed.to_world);
}

bool FieldOccluders::reaches(int occluder, std::span<const Receiver> receivers, std::uint8_t* out) const {
  const bool sampled = occluder == casters_->standing() ||
                       (casters_->is_object(occluder) && casters_->objects().objects[index(occluder)].rigid);
  return casters_->reaches(occluder, receivers, sampled ? Casters::Itself::left_out : Casters::Itself::counts,
                           out);
}

bool FieldOccluders::ready(int occluder) const {
  if (!casters_->is_object(occluder)) return casters_->tree(occluder) != nullptr;
  const int shape = shape_of(occluder);
  return instances_[index(occluder)] || shapes_[index(shape)].by_rays || fields_.refused(shape);
}

Expected<void> FieldOccluders::build(std::span<const int> missing, const AoProgress& progress) {
  load_fields(missing);
  for (const int occluder : missing) {
    if (!casters_->is_object(occluder)) {
      casters_->build({&occluder, 1});
    } else if (auto built = build_object(occluder, progress); !built) {
      return built;
    }
    if (stop_requested(stop_)) return base::stopped();
  }
  return {};
}

/// Not where triangles are few, or where the shape was found to be placed flat.
bool FieldOccluders::wants_field(int shape, const trees::TriangleBvh& tree) {
  bool& by_rays = shapes_[index(shape)].by_rays;
  by_rays |= tree.triangles <= few_triangles;
  return !by_rays;
}

void FieldOccluders::load_fields(std::span<const int> occluders) {
  std::vector<int> shapes;
  for (const int occluder : occluders) {
    if (!casters_->is_object(occluder)) continue;
    const int shape = shape_of(occluder);
    const trees::TriangleBvh* tree = casters_->shape_tree(shape);
    if (tree == nullptr) return;
    if (wants_field(shape, *tree)) shapes.push_back(shape);
  }
  base::sort_unique(shapes);
  fields_.load(shapes);
}

Expected<void> FieldOccluders::build_object(int object, const AoProgress& progress) {
  const int shape = shape_of(object);
  const trees::TriangleBvh* tree = casters_->shape_tree(shape);
  if (tree == nullptr) return base::stopped();
  if (!wants_field(shape, *tree)) return {};
  const FieldProgress report = [&](double done) {
    if (progress) progress("displacement fields", done);
  };
  const auto field = fields_.make(shape, *tree, report, stop_);
  if (!field) return tl::unexpected(field.error());
  if (*field == nullptr) return {};  // no room: by rays
  place(object, **field);
  if (!instances_[index(object)]) shapes_[index(shape)].by_rays = true;
  return {};
}

void FieldOccluders::use(int occluder) {
  if (casters_->is_object(occluder)) fields_.use(shape_of(occluder));
}

void FieldOccluders::drop_field(int shape) {
  fields_.drop(shape);
  for (int object = 0; object < static_cast<int>(instances_.size()); ++object)
    if (shape_of(object) == shape) instances_[index(object)].reset();
}

void FieldOccluders::meet(int occluder, std::int32_t owner, std::span<const trees::RayBatch> rays,
                          float* distances, OccluderCounts& counts) const {
  const FieldInstance* field =
      casters_->is_object(occluder) && instances_[index(occluder)] ? &*instances_[index(occluder)] : nullptr;
  if (field == nullptr || occluder == owner)
    return casters_->meet_each(occluder, rays, distances, counts.rays_cast);
  counts.lookups += rays.size() * trees::batch_size;
  counts.rays_cast += static_cast<std::uint64_t>(kernels_.nearest_hits(*field, rays, distances));
}

}  // namespace tenebra::ao
