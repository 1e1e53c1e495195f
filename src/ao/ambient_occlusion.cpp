// Ambient occlusion of a frame, from its visible points to one value per pixel: the data of a scene kept from
// frame to frame, and the choice of the method.
#include <tenebra/ambient_occlusion.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ao/adaptive/adaptive_pass.h"
#include "ao/casters/casters.h"
#include "ao/casters/see_through.h"
#include "ao/presampled/presampled_occlusion.h"
#include "ao/reference/reference_occlusion.h"
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
  ao::RayKernels kernels;
  ao::Casters casters;
  ao::SeeThroughCasters see_through;
  ao::AdaptiveOcclusion adaptive;
  ao::PresampledOcclusion presampled{casters};
  ao::ReferenceOcclusion reference;
  ao::PointRays rays;              ///< of receivers, but for `adaptive`
  std::vector<float> values;       ///< of receivers
  std::vector<std::string> noted;  ///< deforming meshes already named

  AoStats stats;
  FrameTimings timings;
  std::vector<std::string> notes;

  void find(const Scene& scene, const FrameGeometry& geometry, const StopFlag* stop);
  void begin_frame(const Scene& scene, const FrameGeometry& geometry, const AoConfig& config,
                   const StopFlag* stop);
  void note_deforming(const AoConfig& config);
  bool all_casters_stand(const FrameGeometry& geometry) const;
  Expected<void> run_adaptive(const ao::AoFrame& frame, const AoConfig& config, std::span<float> out,
                              const StopFlag* stop);
  /// Openness of receivers, to `values`.
  Expected<void> solve(const ao::ReceiverSet& set, ao::AoPart part, const ao::AoFrame& frame,
                       const AoConfig& config, const AoProgress& progress, const StopFlag* stop);
  Expected<void> run_at_receivers(const ao::AoFrame& frame, const AoConfig& config, std::span<float> out,
                                  const AoProgress& progress, const StopFlag* stop);
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

/// Brings the objects to this instant; not all of them if `stop` is requested.
void AmbientOcclusion::State::find(const Scene& scene, const FrameGeometry& geometry, const StopFlag* stop) {
  if (found && ao::move_objects(scene, geometry, objects)) return;
  found = false;
  diagonal = 0;
  reference.drop();
  objects = ao::find_objects(scene, geometry, stop);
  casters.reset(objects);
  presampled.reset(objects);
  found = !stop_requested(stop);
}

/// Likewise everything that the configured method needs of the instant.
void AmbientOcclusion::State::begin_frame(const Scene& scene, const FrameGeometry& geometry,
                                          const AoConfig& config, const StopFlag* stop) {
  find(scene, geometry, stop);
  if (stop_requested(stop)) return;
  if (config.distance_m == 0 && diagonal == 0) diagonal = scene_diagonal(scene);
  reach = config.distance_m > 0 ? config.distance_m : diagonal / 20;
  kernels = ao::ray_kernels(config.simd);
  see_through.begin_frame(scene, geometry, stop);
  note_deforming(config);
  if (config.mode != AoMode::adaptive) rays.begin_frame(objects, config.rays, reach, kernels);
  if (config.mode != AoMode::rays)
    casters.begin_frame(objects, geometry, {reach, config.deforming, config.cache}, kernels, stop);
  if (config.mode == AoMode::field) presampled.begin_frame(config, reach, kernels, stop);
}

void AmbientOcclusion::State::note_deforming(const AoConfig& config) {
  if (config.mode == AoMode::rays || (config.mode == AoMode::adaptive && config.deforming)) return;
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

Expected<void> AmbientOcclusion::State::run_adaptive(const ao::AoFrame& frame, const AoConfig& config,
                                                     std::span<float> out, const StopFlag* stop) {
  const auto error = adaptive.compute({frame, casters, see_through, reach, kernels},
                                      ao::adaptive_settings(config.error_255), out, stats, stop);
  if (!error) return tl::unexpected(error.error());
  stats.error_255 = *error;
  return {};
}

Expected<void> AmbientOcclusion::State::solve(const ao::ReceiverSet& set, ao::AoPart part,
                                              const ao::AoFrame& frame, const AoConfig& config,
                                              const AoProgress& progress, const StopFlag* stop) {
  if (config.mode == AoMode::rays) {
    base::Stopwatch watch;
    auto begun = reference.begin_frame(frame.geometry, all_casters_stand(frame.geometry), stop);
    if (!begun) return begun;
    timings.ao_build_ms += watch.lap_ms();
    stats.points = reference.compute(set, rays, values, stop);
    stats.rays_cast = stats.points * static_cast<std::uint64_t>(rays.rays());
  } else if (auto done = presampled.compute(set, part, rays, values, stats, timings, progress); !done) {
    return done;
  }
  if (part != ao::AoPart::own && !see_through.empty())
    see_through.darken(set, rays, kernels, values, stats.rays_cast, stop);
  return stop_requested(stop) ? Expected<void>(base::stopped()) : Expected<void>();
}

/// Occlusion by other bodies can be blurred, that of a body by itself cannot: with a downscale only the
/// others' part is computed at a fraction of the pixels.
Expected<void> AmbientOcclusion::State::run_at_receivers(const ao::AoFrame& frame, const AoConfig& config,
                                                         std::span<float> out, const AoProgress& progress,
                                                         const StopFlag* stop) {
  const auto length = static_cast<float>(reach);
  if (config.place == AoPlace::vertices) {
    const ao::VertexReceivers set(frame);
    auto done = solve(set, ao::AoPart::all, frame, config, progress, stop);
    if (done) set.spread(values, out);
    return done;
  }
  const bool split = config.downscale > 1 && config.mode == AoMode::field;
  const ao::PixelReceivers set(frame, config.downscale, length);
  const ao::AoPart part = split ? ao::AoPart::others : ao::AoPart::all;
  if (auto done = solve(set, part, frame, config, progress, stop); !done) return done;
  set.spread(values, out);
  if (!split) return {};
  const std::uint64_t points = stats.points;
  const ao::PixelReceivers all(frame, 1, length);
  if (auto done = solve(all, ao::AoPart::own, frame, config, progress, stop); !done) return done;
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
  if (config.mode != AoMode::rays) s.reference.drop();
  if (config.mode == AoMode::none) return {};
  const VisiblePoints& points = points::with_positions(seen, triangle_view(geometry), s.positions);
  base::Stopwatch watch;
  s.begin_frame(scene, geometry, config, stop);
  if (stop_requested(stop)) return base::stopped();
  const double found_ms = s.timings.ao_build_ms = watch.lap_ms();

  const ao::AoFrame frame{geometry, points, normals, s.objects};
  auto done = config.mode == AoMode::adaptive ? s.run_adaptive(frame, config, out, stop)
                                              : s.run_at_receivers(frame, config, out, progress, stop);
  if (!done) return done;
  s.timings.ao_ms = watch.lap_ms() - (s.timings.ao_build_ms - found_ms);
  s.presampled.end_frame(s.stats, s.notes);
  for (std::string& note : s.casters.take_notes()) s.notes.push_back(std::move(note));
  return {};
}

}  // namespace tenebra
