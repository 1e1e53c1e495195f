// Ambient occlusion of a frame, from its visible points to one value per pixel: the data of a scene kept from
// frame to frame, and the choice of the method.
#include <tenebra/ambient_occlusion.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "ao/adaptive/adaptive_pass.h"
#include "ao/shade/field_pass.h"
#include "ao/shade/ray_pass.h"
#include "ao/shade/see_through.h"
#include "base/fail.h"
#include "base/stopwatch.h"
#include "math/box.h"
#include "parallel/parallel.h"
#include "points/positions.h"

namespace tenebra {
namespace {

using glm::dvec3;
using glm::vec3;

Expected<void> check(const AoConfig& config, const VisiblePoints& points, std::span<const vec3> normals) {
  constexpr int most_rays = 1 << 16, most_downscale = 8;
  constexpr double least_error = 0.1;
  if (config.rays < 1 || config.rays > most_rays)
    return base::fail("ambient occlusion: {} rays per point, expected 1 to {}", config.rays, most_rays);
  if (!(config.error_255 >= least_error && config.error_255 <= 255))
    return base::fail("ambient occlusion: an error of {}/255, expected {} to 255", config.error_255,
                      least_error);
  if (!(config.distance_m >= 0) || !std::isfinite(config.distance_m))
    return base::fail("ambient occlusion: distance {}, expected a length or 0", config.distance_m);
  if (config.downscale < 1 || config.downscale > most_downscale)
    return base::fail("ambient occlusion: scale 1/{}, expected 1/1 to 1/{}", config.downscale,
                      most_downscale);
  constexpr int most_memory_mb = 1'000'000;
  if (config.memory_mb < 1 || config.memory_mb > most_memory_mb)
    return base::fail("ambient occlusion: {} MB of memory, expected 1 to {}", config.memory_mb,
                      most_memory_mb);
  const auto size = ao::field_shape({config.layout, config.positions, config.directions, config.bits});
  if (!size) return tl::unexpected(size.error());
  const std::size_t pixels = points.triangles.size();
  const bool made = points.positions.empty();  // worked out from the triangles
  if ((!made && points.positions.size() != pixels) || normals.size() != pixels || points.width < 0 ||
      points.height < 0 ||
      static_cast<std::size_t>(points.width) * static_cast<std::size_t>(points.height) != pixels)
    return base::fail("ambient occlusion: {} points and {} normals, expected one per pixel of {} x {}",
                      made ? pixels : points.positions.size(), normals.size(), points.width, points.height);
  return {};
}

/// Of all that is drawn at the start of the first clip: the same for every frame.
double scene_diagonal(const Scene& scene) {
  FrameGeometry frame;
  evaluate_frame(scene, scene.clips.empty() ? -1 : 0, scene.clips.empty() ? 0 : scene.clips.front().start_s,
                 frame);
  constexpr std::size_t grain = 1 << 16;
  std::vector<math::Box<double>> boxes((frame.triangles.size() + grain - 1) / grain);
  parallel::parallel_ranges(frame.triangles.size(), grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t t = first; t < last; ++t) {
      if (frame.triangles[t] == glm::uvec3(0)) continue;
      for (int k = 0; k < 3; ++k) boxes[first / grain].add(dvec3(frame.positions[frame.triangles[t][k]]));
    }
  });
  math::Box<double> box;
  for (const math::Box<double>& part : boxes) box.add(part);
  return box.diagonal() > 0 ? box.diagonal() : 1;
}

}  // namespace

struct AmbientOcclusion::State {
  VisiblePoints positions;  ///< where the given points have none
  ao::SceneObjects objects;
  bool found = false;
  double diagonal = 0;  ///< of the scene; 0: not needed yet
  double reach = 0;
  std::uint64_t frame = 0;  ///< counts calls
  ao::MemoryBudget budget;
  ao::Occluders occluders{budget};
  ao::Bodies bodies{budget};
  ao::SeeThroughOccluders see_through;
  ao::PointRays rays;
  ao::AoKernels kernels;
  std::vector<float> values;
  ao::FieldRoom field_room;
  ao::RayRoom ray_room;
  ao::AdaptiveOcclusion adaptive;
  std::optional<ao::ReferenceRays> reference;  ///< of the last frame, if by rays
  std::vector<std::string> noted;              ///< deforming meshes already named
  bool noted_memory = false;

  AoStats stats;
  FrameTimings timings;
  std::vector<std::string> notes;

  State() {
    budget.set_drop([this] { return drop_oldest(); });
  }
  bool drop_oldest();
  void note_memory(const AoConfig& config);
  void find(const Scene& scene, const FrameGeometry& geometry, const AoConfig& config, const StopFlag* stop);
  void note_deforming(const AoConfig& config);
  Expected<void> run(const ao::AoFrame& frame, const AoConfig& config, std::span<float> out,
                     const AoProgress& progress, const StopFlag* stop);
  Expected<void> from_rays(const ao::ReceiverSet& set, const FrameGeometry& geometry, const StopFlag* stop);
  bool all_casters_stand(const FrameGeometry& geometry) const;
};

AmbientOcclusion::AmbientOcclusion() : state_(std::make_unique<State>()) {}
AmbientOcclusion::AmbientOcclusion(AmbientOcclusion&&) noexcept = default;
AmbientOcclusion& AmbientOcclusion::operator=(AmbientOcclusion&&) noexcept = default;
AmbientOcclusion::~AmbientOcclusion() = default;

const AoStats& AmbientOcclusion::stats() const {
  return state_->stats;
}
const FrameTimings& AmbientOcclusion::timings() const {
  return state_->timings;
}
const std::vector<std::string>& AmbientOcclusion::notes() const {
  return state_->notes;
}

/// Brings objects and everything that depends on them to this instant; not all of it if `stop` is requested.
void AmbientOcclusion::State::find(const Scene& scene, const FrameGeometry& geometry, const AoConfig& config,
                                   const StopFlag* stop) {
  const bool kept = found && ao::move_objects(scene, geometry, objects);
  if (!kept) {
    found = false;
    reference.reset();
    objects = ao::find_objects(scene, geometry, stop);
    occluders.reset(objects);
    diagonal = 0;
    if (stop_requested(stop)) return;
    found = true;
  }
  if (config.distance_m == 0 && diagonal == 0) diagonal = scene_diagonal(scene);
  const double wanted = config.distance_m > 0 ? config.distance_m : diagonal / 20;
  if (!kept || wanted != reach) bodies.reset(objects, wanted);
  reach = wanted;
  kernels = ao::ao_kernels(config.simd);
  rays.begin_frame(objects, config.rays, reach, kernels);
  ++frame;
  occluders.begin_frame(objects, geometry, config, reach, frame, stop);
  bodies.begin_frame(frame, config.cache);
  constexpr std::size_t megabyte = std::size_t{1} << 20;
  budget.begin_frame(static_cast<std::size_t>(config.memory_mb) * megabyte);
  see_through.begin_frame(scene, geometry, stop);
  note_deforming(config);
}

/// Of one shape, samples are dropped before its field.
bool AmbientOcclusion::State::drop_oldest() {
  const auto samples = bodies.oldest(), field = occluders.fields().oldest();
  if (samples && (!field || *samples <= *field)) {
    bodies.drop_oldest();
  } else if (field) {
    occluders.drop_field(field->object);
  }
  return samples || field;
}

void AmbientOcclusion::State::note_memory(const AoConfig& config) {
  if (noted_memory || !budget.refused()) return;
  noted_memory = true;
  notes.push_back(
      fmt::format("A frame's fields and surface samples found no room within {} MB: rays are cast for bodies "
                  "without room, which takes longer; --ao-memory gives more.",
                  config.memory_mb));
}

void AmbientOcclusion::State::note_deforming(const AoConfig& config) {
  for (const std::string& name : objects.deforming_names) {
    if (std::find(noted.begin(), noted.end(), name) != noted.end()) continue;
    noted.push_back(name);
    notes.push_back(fmt::format("{} deforms, so it has no displacement field: {}.", name,
                                config.deforming ? "rays meet it as it is" : "it hides no ambient light"));
  }
}

/// Then what rays meet is the same from frame to frame.
bool AmbientOcclusion::State::all_casters_stand(const FrameGeometry& geometry) const {
  return objects.objects.empty() &&
         std::none_of(objects.deforming.begin(), objects.deforming.end(),
                      [&](std::uint32_t id) { return geometry.casts_shadow[id] != 0; });
}

Expected<void> AmbientOcclusion::State::from_rays(const ao::ReceiverSet& set, const FrameGeometry& geometry,
                                                  const StopFlag* stop) {
  base::Stopwatch watch;
  if (!reference || !all_casters_stand(geometry)) {
    reference.reset();
    auto made = ao::ReferenceRays::create(triangle_view(geometry), stop);
    if (!made) return tl::unexpected(made.error());
    reference = std::move(*made);
  }
  timings.ao_build_ms += watch.lap_ms();
  stats.points = ao::cast_receivers(set, rays, *reference, values, ray_room, stop);
  stats.rays_cast = stats.points * static_cast<std::uint64_t>(rays.rays());
  return stop_requested(stop) ? Expected<void>(base::stopped()) : Expected<void>();
}

/// Occlusion by other bodies can be blurred, that of a body by itself cannot: with a downscale only the
/// others' part is computed at a fraction of the pixels.
Expected<void> AmbientOcclusion::State::run(const ao::AoFrame& frame, const AoConfig& config,
                                            std::span<float> out, const AoProgress& progress,
                                            const StopFlag* stop) {
  const auto solve = [&](const ao::ReceiverSet& set, ao::AoPart part) {
    Expected<void> done;
    if (config.mode == AoMode::rays) {
      done = from_rays(set, frame.geometry, stop);
    } else {
      done = ao::FieldPass{occluders, bodies, rays, kernels, stats, timings, field_room}.run(
          set, part, values, progress, stop);
    }
    if (done && part != ao::AoPart::own && !see_through.empty())
      see_through.darken(set, rays, kernels, values, stats, stop);
    return done && stop_requested(stop) ? Expected<void>(base::stopped()) : done;
  };
  const auto length = static_cast<float>(reach);
  if (config.mode == AoMode::adaptive) {
    const auto error = adaptive.compute({frame, occluders, see_through, reach, kernels},
                                        ao::adaptive_settings(config.error_255), out, stats, stop);
    if (!error) return tl::unexpected(error.error());
    stats.error_255 = *error;
    return {};
  }
  if (config.place == AoPlace::vertices) {
    const ao::VertexReceivers set(frame);
    auto done = solve(set, ao::AoPart::all);
    if (done) set.spread(values, out);
    return done;
  }
  const bool split = config.downscale > 1 && config.mode == AoMode::field;
  const ao::PixelReceivers set(frame, config.downscale, length);
  if (auto done = solve(set, split ? ao::AoPart::others : ao::AoPart::all); !done) return done;
  set.spread(values, out);
  if (!split) return {};
  const std::uint64_t points = stats.points;
  if (auto done = solve(ao::PixelReceivers(frame, 1, length), ao::AoPart::own); !done) return done;
  stats.points = points;
  parallel::parallel_ranges(out.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) out[i] *= values[i];
  });
  return {};
}

Expected<void> AmbientOcclusion::compute(const Scene& scene, const FrameGeometry& geometry,
                                         const VisiblePoints& seen, std::span<const vec3> normals,
                                         const AoConfig& config, std::vector<float>& out,
                                         const AoProgress& progress, const StopFlag* stop) {
  const parallel::FloatEnvironment ieee;
  State& s = *state_;
  s.stats = {};
  s.timings = {};
  if (auto checked = check(config, seen, normals); !checked) return checked;
  out.assign(seen.triangles.size(), 1.0f);
  if (config.mode != AoMode::rays) s.reference.reset();
  if (config.mode == AoMode::none) return {};
  const VisiblePoints& points = points::with_positions(seen, triangle_view(geometry), s.positions);
  base::Stopwatch watch;
  s.find(scene, geometry, config, stop);
  if (stop_requested(stop)) return base::stopped();
  const double found_ms = s.timings.ao_build_ms = watch.lap_ms();

  if (auto done = s.run({geometry, points, normals, s.objects}, config, out, progress, stop); !done)
    return done;
  s.bodies.save_grown();
  s.timings.ao_ms = watch.lap_ms() - (s.timings.ao_build_ms - found_ms);
  s.stats.fields_built = s.occluders.fields().built();
  s.stats.field_bytes = s.occluders.fields().bytes();
  s.stats.sample_bytes = s.bodies.bytes();
  s.stats.peak_bytes = s.budget.peak();
  s.stats.cache_cells = s.bodies.known();
  s.note_memory(config);
  for (std::string& note : s.occluders.take_notes()) s.notes.push_back(std::move(note));
  for (std::string& note : s.bodies.take_notes()) s.notes.push_back(std::move(note));
  return {};
}

}  // namespace tenebra
