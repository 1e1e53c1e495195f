// What ambient occlusion needs of a scene: fields, samples and look-ups.
#include <fmt/core.h>

#include <tenebra/ambient_occlusion.h>

#include "ao/presampled/field_occluders.h"
#include "bench/ao/ao_contestants.h"
#include "bench/trade/trade_needs.h"

namespace tenebra::bench {
namespace {

/// What all fields of a scene take, whoever feels them.
struct AllFields {
  int count = 0;
  double ms = 0;
};
AllFields build_all_fields(const ao::SceneObjects& objects, const ao::FieldSettings& settings) {
  AllFields all;
  for (const ao::ObjectShape& shape : objects.shapes) {
    if (shape.triangles.size() <= ao::FieldOccluders::few_triangles || !(shape.radius > 0)) continue;
    const Object object{"", shape.positions, shape.triangles};
    const ObjectTree tree(object);
    if (const auto built = build_field(object, tree, settings)) {
      all.count += 1;
      all.ms += tree.build_ms + (*built)->build_ms;
    }
  }
  return all;
}

}  // namespace

Expected<void> need_fields(TradeSession& session, const std::string& name, const Scene& scene,
                           const BenchFrame& frame) {
  const AoConfig config{.mode = AoMode::field,
                        .positions = session.by_effort(64, 4225, 4225),
                        .directions = session.by_effort(64, 1024, 1024)};
  AmbientOcclusion ambient;
  std::vector<float> open, again;
  if (auto done = ambient.compute(scene, frame.geometry, frame.points, frame.normals, config, open); !done)
    return done;
  const AoStats first = ambient.stats();
  const double first_ms = ambient.timings().ao_build_ms;
  if (auto done = ambient.compute(scene, frame.geometry, frame.points, frame.normals, config, again); !done)
    return done;
  session.needs.push_back({"fields and samples kept", name,
                           fmt::format("{} samples; all: the first frame", first.cache_cells),
                           ambient.timings().ao_build_ms, first_ms, open == again});
  const ao::SceneObjects objects = ao::find_objects(scene, frame.geometry);
  const AllFields all =
      build_all_fields(objects, {.positions = config.positions, .directions = config.directions});
  session.needs.push_back(
      {"fields of objects in reach", name,
       fmt::format("{} of {} fields; {} of {} objects; all fields: {} ms", first.fields_built, all.count,
                   first.objects, objects.objects.size(), short_number(all.ms))});
  const double rays = static_cast<double>(first.points) * config.rays;
  session.needs.push_back(
      {"look-ups of objects in reach", name,
       fmt::format("{} per ray, of {} objects",
                   short_number(rays > 0 ? static_cast<double>(ambient.stats().lookups) / rays : 0.0),
                   objects.objects.size())});
  return {};
}

}  // namespace tenebra::bench
