// Ambient occlusion of a frame, from its visible points to one value a pixel.
//
// A point is hidden by its own body (sampled on the surface once, self_occlusion.h) and by the rest, ray by
// ray: moving objects through their fields, what stands and what deforms by rays (occluders.h). The two are
// taken as independent: what is left is (1 - own) (1 - others).
#include "ao/ambient_occlusion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ao/occluders.h"
#include "ao/receiver_sets.h"
#include "ao/reference_rays.h"
#include "base/stopwatch.h"
#include "parallel/parallel.h"

namespace tenebra {
namespace {

using glm::dvec3;
using glm::vec3;

/// What of a receiver's occlusion is computed.
enum class AoPart {
  all,
  own,     ///< by its own body
  others,  ///< by all but its own body
};

/// A sample of a body that a receiver lacks.
struct MissingSample {
  std::uint32_t body;
  std::uint64_t sample;
  auto operator<=>(const MissingSample&) const = default;
};

/// What one group of receivers asks for, and what it cost.
struct GroupReport {
  std::vector<int> bodies;  ///< objects (or standing) that have no samples yet
  std::vector<MissingSample> samples;
  std::vector<int> occluders;  ///< not ready
  OccluderCounts counts;
  std::uint64_t points = 0;
  std::vector<int> reached;  ///< occluders that some receiver is in reach of
  bool complete() const { return bodies.empty() && samples.empty() && occluders.empty(); }
};

/// Buffers of a thread.
struct Scratch {
  std::vector<Receiver> receivers;
  std::vector<SelfOcclusion::Blend> blends;  ///< one a receiver
  std::vector<std::uint64_t> missing;
  std::vector<int> near;
  std::vector<RayBatch> rays;
  std::vector<float> distances;
};

Expected<void> check(const AoConfig& config, const VisiblePoints& points, std::span<const vec3> normals) {
  constexpr int most_rays = 1 << 16, most_downscale = 8;
  if (config.rays < 1 || config.rays > most_rays)
    return fail("ambient occlusion: {} rays a point, expected 1 to {}", config.rays, most_rays);
  if (!(config.distance_m >= 0) || !std::isfinite(config.distance_m))
    return fail("ambient occlusion: distance {}, expected a length or 0", config.distance_m);
  if (config.downscale < 1 || config.downscale > most_downscale)
    return fail("ambient occlusion: scale 1/{}, expected 1/1 to 1/{}", config.downscale, most_downscale);
  const auto size = field_shape({config.layout, config.positions, config.directions, config.bits});
  if (!size) return tl::unexpected(size.error());
  const std::size_t pixels = points.triangles.size();
  if (points.positions.size() != pixels || normals.size() != pixels || points.width < 0 ||
      points.height < 0 ||
      static_cast<std::size_t>(points.width) * static_cast<std::size_t>(points.height) != pixels)
    return fail("ambient occlusion: {} points and {} normals, expected one a pixel of {} x {}",
                points.positions.size(), normals.size(), points.width, points.height);
  return {};
}

/// Of all that is drawn at the start of the first clip: the same for every frame.
double scene_diagonal(const Scene& scene) {
  FrameGeometry frame;
  evaluate_frame(scene, scene.clips.empty() ? -1 : 0, scene.clips.empty() ? 0 : scene.clips.front().start_s,
                 frame);
  PointBox box;
  for (const glm::uvec3& t : frame.triangles) {
    if (t == glm::uvec3(0)) continue;
    for (int k = 0; k < 3; ++k) box.extend(dvec3(frame.positions[t[k]]));
  }
  const double diagonal = box.low.x <= box.high.x ? glm::length(box.high - box.low) : 0;
  return diagonal > 0 ? diagonal : 1;
}

/// Ascending, each once.
template <class T>
void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

struct AmbientOcclusion::State {
  /// One body's samples; instances of one size share them.
  struct Body {
    int shape = -1;
    double reach = 0;
    std::unique_ptr<SelfOcclusion> samples;
  };

  SceneObjects objects;
  bool found = false;
  double diagonal = 0;
  double reach = 0;
  Occluders occluders;
  std::vector<Body> bodies;
  std::vector<int> body_of;  ///< one an object, the last of what stands; -1 until made
  RayPattern pattern;
  AoKernels kernels;
  float lift = 0;
  std::vector<float> values;
  std::vector<std::string> noted;  ///< deforming meshes already named

  AoStats stats;
  FrameTimings timings;
  std::vector<std::string> notes;

  void find(const Scene& scene, const FrameGeometry& geometry, const AoConfig& config);
  void note_deforming(const AoConfig& config);
  std::size_t body_index(int object) const {
    return object == TriangleOwner::standing ? objects.objects.size() : static_cast<std::size_t>(object);
  }
  /// Whether what it lies on keeps its shape.
  bool has_body(const Receiver& receiver) const {
    const std::int32_t object = receiver.owner.object;
    return object == TriangleOwner::standing ||
           (object >= 0 && objects.objects[static_cast<std::size_t>(object)].rigid);
  }
  /// The samples of what a receiver lies on; null if it has none or they are not made yet.
  const SelfOcclusion* body_under(const Receiver& receiver) const;
  void make_body(int object);
  float others(const Receiver& receiver, Scratch& scratch, GroupReport& report) const;
  void collect_samples(const Receiver& receiver, Scratch& scratch, GroupReport& report) const;
  void collect_occluders(const Receiver& receiver, const Scratch& scratch, GroupReport& report) const;
  void shade(const ReceiverSet& set, AoPart part, int group, Scratch& scratch, GroupReport& report);
  Expected<void> supply(std::vector<GroupReport>& reports, const AoProgress& progress, const StopFlag* stop);
  Expected<void> from_fields(const ReceiverSet& set, AoPart part, const AoProgress& progress,
                             const StopFlag* stop);
  Expected<void> run(const AoFrame& frame, const AoConfig& config, std::span<float> out,
                     const AoProgress& progress, const StopFlag* stop);
  Expected<void> from_rays(const ReceiverSet& set, const FrameGeometry& geometry, const StopFlag* stop);
  void cast_fan(const Receiver& receiver, Scratch& scratch) const;
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

/// Brings objects and what hangs on them to this instant.
void AmbientOcclusion::State::find(const Scene& scene, const FrameGeometry& geometry,
                                   const AoConfig& config) {
  const bool kept = found && move_objects(scene, geometry, objects);
  if (!kept) {
    objects = find_objects(scene, geometry);
    occluders.reset(objects);
    diagonal = scene_diagonal(scene);
    found = true;
  }
  const double wanted = config.distance_m > 0 ? config.distance_m : diagonal / 20;
  if (!kept || wanted != reach) {
    bodies.clear();
    body_of.assign(objects.objects.size() + 1, -1);
  }
  reach = wanted;
  if (pattern.rays != config.rays) pattern = make_ray_pattern(config.rays);
  kernels = ao_kernels(config.simd);
  lift = surface_lift(largest_coordinate(objects.standing));
  occluders.begin_frame(objects, geometry, config, reach);
  note_deforming(config);
}

void AmbientOcclusion::State::note_deforming(const AoConfig& config) {
  for (const std::string& name : objects.deforming_names) {
    if (std::find(noted.begin(), noted.end(), name) != noted.end()) continue;
    noted.push_back(name);
    notes.push_back(fmt::format("{} deforms, so it has no displacement field: {}.", name,
                                config.deforming ? "rays meet it as it is" : "it hides no ambient light"));
  }
}

const SelfOcclusion* AmbientOcclusion::State::body_under(const Receiver& receiver) const {
  if (!has_body(receiver)) return nullptr;
  const int body = body_of[body_index(receiver.owner.object)];
  return body < 0 ? nullptr : bodies[static_cast<std::size_t>(body)].samples.get();
}

void AmbientOcclusion::State::make_body(int object) {
  int& slot = body_of[body_index(object)];
  constexpr double alike = 1e-3;
  int shape = -1;
  double own_reach = reach;
  if (object != TriangleOwner::standing) {
    const MovingObject& rigid = objects.objects[static_cast<std::size_t>(object)];
    shape = rigid.shape;
    own_reach = reach / rigid.scale;
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b].shape == shape && std::abs(bodies[b].reach - own_reach) <= alike * own_reach) {
      slot = static_cast<int>(b);
      return;
    }
  }
  const ObjectShape& geometry =
      shape < 0 ? objects.standing : objects.shapes[static_cast<std::size_t>(shape)];
  slot = static_cast<int>(bodies.size());
  bodies.push_back(
      {shape, own_reach, std::make_unique<SelfOcclusion>(geometry, occluders.casters(shape), own_reach)});
}

/// Rays of a receiver into scratch.rays, distances at the reach.
void AmbientOcclusion::State::cast_fan(const Receiver& receiver, Scratch& scratch) const {
  constexpr double cell = 1.0 / 256;  // of the reach: rays are turned anew
  const dvec3 size = glm::abs(receiver.position);
  const float off = std::max(lift, surface_lift(std::max({size.x, size.y, size.z})));
  const double scale = receiver.owner.object >= 0
                           ? objects.objects[static_cast<std::size_t>(receiver.owner.object)].scale
                           : 1.0;
  scratch.rays.resize(pattern.batches.size());
  scratch.distances.assign(pattern.batches.size() * batch_size, static_cast<float>(reach));
  kernels.fan.spread(pattern, turned_axes(receiver.normal, receiver.local * scale, cell * reach),
                     receiver.face, vec3(receiver.position + double{off} * dvec3(receiver.face)),
                     scratch.rays.data());
}

/// Hidden share, 0..1, by all but the receiver's own body.
float AmbientOcclusion::State::others(const Receiver& receiver, Scratch& scratch, GroupReport& report) const {
  bool cast = false;
  for (const int occluder : scratch.near) {
    if (!occluders.reaches(occluder, receiver)) continue;
    if (!cast) cast_fan(receiver, scratch);
    cast = true;
    occluders.meet(occluder, receiver, scratch.rays, scratch.distances.data(), report.counts);
  }
  if (!cast) return 0;
  const float sum = kernels.fan.fall_off(scratch.distances.data(), static_cast<int>(scratch.rays.size()),
                                         static_cast<float>(reach));
  return std::clamp(sum / static_cast<float>(pattern.rays), 0.0f, 1.0f);
}

/// What of its own body's samples the receiver needs that is not there yet.
void AmbientOcclusion::State::collect_samples(const Receiver& receiver, Scratch& scratch,
                                              GroupReport& report) const {
  const std::int32_t object = receiver.owner.object;
  if (const SelfOcclusion* body = body_under(receiver)) {
    scratch.missing.clear();
    scratch.blends.back() = body->find_samples(receiver.on_shape(), scratch.missing);
    const auto number = static_cast<std::uint32_t>(body_of[body_index(object)]);
    for (const std::uint64_t sample : scratch.missing) report.samples.push_back({number, sample});
  } else if (has_body(receiver) && (report.bodies.empty() || report.bodies.back() != object)) {
    report.bodies.push_back(object);
  }
}

void AmbientOcclusion::State::collect_occluders(const Receiver& receiver, const Scratch& scratch,
                                                GroupReport& report) const {
  for (const int occluder : scratch.near) {
    const auto& reached = report.reached;
    if (std::find(reached.begin(), reached.end(), occluder) != reached.end()) continue;
    if (!occluders.reaches(occluder, receiver)) continue;
    report.reached.push_back(occluder);
    if (!occluders.ready(occluder)) report.occluders.push_back(occluder);
  }
}

void AmbientOcclusion::State::shade(const ReceiverSet& set, AoPart part, int group, Scratch& scratch,
                                    GroupReport& report) {
  set.receivers(group, scratch.receivers);
  scratch.near.clear();
  if (part != AoPart::own && !scratch.receivers.empty()) {
    PointBox box;
    for (const Receiver& receiver : scratch.receivers) box.extend(receiver.position);
    occluders.near(box, scratch.near);
  }
  scratch.blends.clear();
  for (const Receiver& receiver : scratch.receivers) {
    scratch.blends.emplace_back();
    if (part != AoPart::others) collect_samples(receiver, scratch, report);
    collect_occluders(receiver, scratch, report);
  }
  sort_unique(report.samples);
  if (!report.complete()) return;
  for (std::size_t i = 0; i < scratch.receivers.size(); ++i) {
    const Receiver& receiver = scratch.receivers[i];
    const SelfOcclusion* body = part == AoPart::others ? nullptr : body_under(receiver);
    const float own = body != nullptr ? body->occlusion(receiver.on_shape(), scratch.blends[i], kernels) : 0;
    values[receiver.index] = (1 - own) * (1 - others(receiver, scratch, report));
  }
  report.points = scratch.receivers.size();
}

/// Makes what the groups lack.
Expected<void> AmbientOcclusion::State::supply(std::vector<GroupReport>& reports, const AoProgress& progress,
                                               const StopFlag* stop) {
  std::vector<int> missing, without_samples;
  std::vector<MissingSample> samples;
  for (const GroupReport& report : reports) {
    missing.insert(missing.end(), report.occluders.begin(), report.occluders.end());
    without_samples.insert(without_samples.end(), report.bodies.begin(), report.bodies.end());
    samples.insert(samples.end(), report.samples.begin(), report.samples.end());
  }
  sort_unique(samples);
  stats.rays_cast += samples.size() * SelfOcclusion::sample_rays;
  for (std::size_t first = 0, last = 0; first < samples.size(); first = last) {
    std::vector<std::uint64_t> of_body;
    const std::uint32_t body = samples[first].body;
    for (; last < samples.size() && samples[last].body == body; ++last)
      of_body.push_back(samples[last].sample);
    const auto report = [&](double done) {
      if (progress)
        progress("surface samples",
                 (static_cast<double>(first) + done * static_cast<double>(of_body.size())) /
                     static_cast<double>(samples.size()));
    };
    if (!bodies[body].samples->fill(of_body, kernels, report, stop)) return fail("stopped");
  }
  sort_unique(missing);
  if (auto built = occluders.build(missing, progress, stop); !built) return built;
  sort_unique(without_samples);
  for (const int object : without_samples) make_body(object);
  return {};
}

Expected<void> AmbientOcclusion::State::from_fields(const ReceiverSet& set, AoPart part,
                                                    const AoProgress& progress, const StopFlag* stop) {
  values.assign(set.values(), 1.0f);
  std::vector<int> pending(static_cast<std::size_t>(set.groups()));
  for (std::size_t i = 0; i < pending.size(); ++i) pending[i] = static_cast<int>(i);
  std::vector<Scratch> scratch(static_cast<std::size_t>(thread_count()));
  std::vector<GroupReport> reports;
  std::vector<int> reached;
  Stopwatch watch;
  constexpr int most_rounds = 8;  // bodies, wide, fine and finest samples and occluders take six
  for (int round = 0; !pending.empty(); ++round) {
    if (round == most_rounds)
      return fail("ambient occlusion: what {} groups of points lack cannot be made", pending.size());
    reports.assign(pending.size(), {});
    parallel_tasks(static_cast<int>(pending.size()), [&](int i) {
      if (stop_requested(stop)) return;
      const auto at = static_cast<std::size_t>(i);
      shade(set, part, pending[at], scratch[static_cast<std::size_t>(thread_index())], reports[at]);
    });
    watch.lap_ms();
    if (stop_requested(stop)) return fail("stopped");
    std::vector<int> left;
    for (std::size_t i = 0; i < pending.size(); ++i) {
      const GroupReport& report = reports[i];
      if (!report.complete()) left.push_back(pending[i]);
      stats.points += report.points;
      stats.lookups += report.counts.lookups;
      stats.rays_cast += report.counts.rays_cast;
      reached.insert(reached.end(), report.reached.begin(), report.reached.end());
    }
    sort_unique(reached);
    pending = std::move(left);
    if (!pending.empty()) {
      if (auto supplied = supply(reports, progress, stop); !supplied) return supplied;
    }
    timings.ao_build_ms += watch.lap_ms();
  }
  stats.objects += static_cast<std::uint64_t>(
      std::count_if(reached.begin(), reached.end(), [](int occluder) { return occluder >= 0; }));
  return {};
}

Expected<void> AmbientOcclusion::State::from_rays(const ReceiverSet& set, const FrameGeometry& geometry,
                                                  const StopFlag* stop) {
  values.assign(set.values(), 1.0f);
  Stopwatch watch;
  const auto reference = ReferenceRays::create(triangle_view(geometry));
  if (!reference) return tl::unexpected(reference.error());
  timings.ao_build_ms += watch.lap_ms();
  std::vector<Scratch> scratch(static_cast<std::size_t>(thread_count()));
  std::vector<std::uint64_t> points(static_cast<std::size_t>(set.groups()), 0);
  parallel_tasks(set.groups(), [&](int group) {
    if (stop_requested(stop)) return;
    Scratch& own = scratch[static_cast<std::size_t>(thread_index())];
    set.receivers(group, own.receivers);
    points[static_cast<std::size_t>(group)] = own.receivers.size();
    for (const Receiver& receiver : own.receivers) {
      cast_fan(receiver, own);
      for (std::size_t b = 0; b < own.rays.size(); ++b)
        reference->nearest_hits(own.rays[b], own.distances.data() + b * batch_size);
      const float sum = kernels.fan.fall_off(own.distances.data(), static_cast<int>(own.rays.size()),
                                             static_cast<float>(reach));
      values[receiver.index] = 1 - std::clamp(sum / static_cast<float>(pattern.rays), 0.0f, 1.0f);
    }
  });
  for (const std::uint64_t count : points) stats.points += count;
  stats.rays_cast = stats.points * static_cast<std::uint64_t>(pattern.rays);
  return stop_requested(stop) ? Expected<void>(fail("stopped")) : Expected<void>();
}

/// Moving things blur well, what stands does not: with a downscale only the others' part is computed at a
/// fraction of the pixels.
Expected<void> AmbientOcclusion::State::run(const AoFrame& frame, const AoConfig& config,
                                            std::span<float> out, const AoProgress& progress,
                                            const StopFlag* stop) {
  const auto solve = [&](const ReceiverSet& set, AoPart part) {
    return config.mode == AoMode::rays ? from_rays(set, frame.geometry, stop)
                                       : from_fields(set, part, progress, stop);
  };
  const auto length = static_cast<float>(reach);
  if (config.place == AoPlace::vertices) {
    const VertexReceivers set(frame);
    auto done = solve(set, AoPart::all);
    if (done) set.spread(values, out);
    return done;
  }
  const bool split = config.downscale > 1 && config.mode == AoMode::field;
  const PixelReceivers set(frame, config.downscale, length);
  if (auto done = solve(set, split ? AoPart::others : AoPart::all); !done) return done;
  set.spread(values, out);
  if (!split) return {};
  const std::uint64_t points = stats.points;
  if (auto done = solve(PixelReceivers(frame, 1, length), AoPart::own); !done) return done;
  stats.points = points;
  parallel_ranges(out.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) out[i] *= values[i];
  });
  return {};
}

Expected<void> AmbientOcclusion::compute(const Scene& scene, const FrameGeometry& geometry,
                                         const VisiblePoints& points, std::span<const vec3> normals,
                                         const AoConfig& config, std::vector<float>& out,
                                         const AoProgress& progress, const StopFlag* stop) {
  const FloatEnvironment ieee;
  State& s = *state_;
  s.stats = {};
  s.timings = {};
  if (auto checked = check(config, points, normals); !checked) return checked;
  out.assign(points.triangles.size(), 1.0f);
  if (config.mode == AoMode::none) return {};
  Stopwatch watch;
  s.find(scene, geometry, config);
  const double found_ms = s.timings.ao_build_ms = watch.lap_ms();

  if (auto done = s.run({geometry, points, normals, s.objects}, config, out, progress, stop); !done)
    return done;
  s.timings.ao_ms = watch.lap_ms() - (s.timings.ao_build_ms - found_ms);
  s.stats.fields_built = s.occluders.fields_built();
  s.stats.field_bytes = s.occluders.field_bytes();
  for (const State::Body& body : s.bodies) s.stats.cache_cells += body.samples->filled();
  for (std::string& note : s.occluders.take_notes()) s.notes.push_back(std::move(note));
  return {};
}

}  // namespace tenebra
