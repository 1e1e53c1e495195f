#include "bench/ao/ao_contestants.h"

#include "base/fail.h"
#include "base/stopwatch.h"

namespace tenebra::bench {

ObjectTree::ObjectTree(const Object& object) {
  base::Stopwatch watch;
  bvh = trees::build_triangle_bvh(object.positions, object.triangles);
  build_ms = watch.lap_ms();
  const ao::Ellipsoid sphere =
      ao::bounding_ellipsoid(object.positions, object.triangles, FieldLayout::positions_directions);
  ball = {sphere.centre, sphere.axes.x};
}

Expected<std::unique_ptr<BuiltField>> build_field(const Object& object, const ObjectTree& tree,
                                                  const ao::FieldSettings& settings, Inside inside) {
  auto built = std::make_unique<BuiltField>();
  base::Stopwatch watch;
  auto field = ao::build_field(object.positions, object.triangles, tree.bvh, settings);
  if (!field) return tl::unexpected(field.error());
  built->build_ms = watch.lap_ms();
  built->field = std::move(*field);
  const auto placed =
      ao::place_field(built->field, inside == Inside::near_rays ? &tree.bvh : nullptr, glm::dmat4(1.0),
                      inside == Inside::first_hit ? ao::FieldEnds::first : ao::FieldEnds::both);
  if (!placed) return base::fail("{}: expected a field that can be placed, found none", object.name);
  built->placed = *placed;
  return built;
}

Tracer field_tracer(const BuiltField& built) {
  const auto nearest_hits = ao::field_kernels(SimdLevel::automatic).nearest_hits;
  return [nearest_hits, placed = &built.placed](std::span<const trees::RayBatch> rays, float* distances) {
    nearest_hits(*placed, rays, distances);
  };
}

std::string shape_name(const ao::DisplacementField& field) {
  const char* layout = field.layout == FieldLayout::chords ? "chords" : "paper";
  return fmt::format("{} {}^2 x {}^2", layout, field.shape.position_side, field.shape.direction_side);
}

}  // namespace tenebra::bench
