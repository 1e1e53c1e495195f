// The light of a whole lightmap: exact, within an error, and by rays of the same error.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "bake/baked_scene.h"
#include "bake/surface_light.h"
#include "base/fail.h"
#include "base/stopwatch.h"
#include "bench/bake/bake_rays.h"
#include "bench/bake/bake_session.h"
#include "bench/common/bench_frame.h"
#include "render/frame_lights.h"
#include "shade/light_terms.h"

namespace tenebra::bench {
namespace {

constexpr double error_255 = 0.5;  ///< of the goal
constexpr std::size_t most_rays = 1024;

/// A scene's samples, one per texel, in the order of `tenebra bake`, and its one light.
struct MapScene {
  Scene scene;
  render::FrameInput input;
  std::vector<bake::Sample> samples;
  render::RenderSettings settings;
  std::optional<AreaLight> light;
  float white_of_radiance = 1;  ///< what a white surface shows of irradiance 1

  std::size_t texels() const { return samples.size(); }
};

Expected<void> take_light(MapScene& map) {
  std::vector<std::string> notes;
  const auto drawn = render::drawn_lights(map.scene, map.input, map.settings, notes);
  if (!drawn) return tl::unexpected(drawn.error());
  if (drawn->size() != 1 || !drawn->front().area)
    return base::fail("{}: found {} lights, expected one with an area", map.scene.name, drawn->size());
  map.light = drawn->front().area;
  const auto terms = shade::light_terms(drawn->front(), {});
  map.white_of_radiance = terms.color.r;
  return {};
}

Expected<void> load_map(int size, MapScene& map) {
  auto scene = load_scene(std::string(TENEBRA_SCENES_DIR) + "/room.glb");
  if (!scene) return tl::unexpected(scene.error());
  map.scene = std::move(*scene);
  bake::separate_meshes(map.scene);
  evaluate_frame(map.scene, -1, 0, map.input.geometry);
  map.input.lights = evaluate_lights(map.scene, -1, 0);
  map.settings.shadows = render::ShadowMode::soft;
  const auto places = bake::place_in_map(map.scene, map.input.geometry, size);
  if (!places) return tl::unexpected(places.error());
  const bake::TexelCoverage coverage(places->triangles, size, 1);
  std::vector<bake::Sample> band;
  for (int row = 0; row < size; row += bake::TexelCoverage::band_rows) {
    coverage.samples_of_band(row, band);
    bake::move_inside(map.input.geometry, bake::edge_margin(bake::extent_of(map.input.geometry)), band);
    map.samples.insert(map.samples.end(), band.begin(), band.end());
  }
  return take_light(map);
}

/// Red of each texel.
using Reds = std::vector<float>;

struct Run {
  std::string by;
  double ms = 0;
  Reds reds;
};

/// What `tenebra bake` computes, its trees made before.
Expected<Run> bake_map(const MapScene& map, const SoftShadowConfig& soft, int rounds) {
  bake::LightRequest request{.settings = map.settings};
  request.settings.soft = soft;
  std::vector<std::string> notes;
  auto light = bake::SurfaceLight::create(map.scene, map.input, request, notes);
  if (!light) return tl::unexpected(light.error());
  std::vector<bake::Light> values(map.texels());
  std::vector<double> times;
  for (int round = 0; round <= rounds; ++round) {
    base::Stopwatch watch;
    if (auto done = light->at(map.samples, values, nullptr, {}); !done) return tl::unexpected(done.error());
    if (round > 0) times.push_back(watch.lap_ms());
  }
  Run run{"tenebra", median(times), Reds(map.texels())};
  for (std::size_t i = 0; i < run.reds.size(); ++i) run.reds[i] = values[i].r;
  return run;
}

Run trace_map(const MapScene& map, const EmbreeScene& casters, const BakeRays& rays, float lift_m,
              int rounds) {
  Run run{"", 0, Reds(map.texels())};
  std::vector<double> times;
  for (int round = 0; round <= rounds; ++round) {
    base::Stopwatch watch;
    const auto receivers = texel_receivers(map.input.geometry, map.samples, lift_m);
    rays.trace(casters, receivers, run.reds);
    if (round > 0) times.push_back(watch.lap_ms());
  }
  run.ms = median(times);
  for (float& red : run.reds) red *= map.white_of_radiance;
  return run;
}

/// What errors are counted against.
struct MapTruth {
  Reds reds;
  double white = 1;
  std::vector<std::uint8_t> penumbra;
};

MapTruth truth_of(const MapScene& map, Reds reds) {
  MapTruth truth{std::move(reds), 1, std::vector<std::uint8_t>(map.texels())};
  const auto receivers = texel_receivers(map.input.geometry, map.samples, 0.0f);
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const float open = map.white_of_radiance * open_irradiance(*map.light, receivers[i]);
    truth.penumbra[i] = truth.reds[i] > 0 && truth.reds[i] < open * (1 - 1e-4f) ? 1 : 0;
  }
  Reds sorted = truth.reds;
  const auto rank = static_cast<std::ptrdiff_t>((sorted.size() * 999 + 999) / 1000 - 1);
  std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
  if (sorted[static_cast<std::size_t>(rank)] > 0) truth.white = sorted[static_cast<std::size_t>(rank)];
  return truth;
}

/// In 1/255 of white.
struct MapErrors {
  double rms = 0, penumbra = 0, worst = 0;
};

MapErrors errors_of(const MapTruth& truth, const Reds& reds) {
  MapErrors errors;
  double sum = 0, penumbra = 0, count = 0;
  for (std::size_t i = 0; i < reds.size(); ++i) {
    const double off =
        255 / truth.white * std::abs(static_cast<double>(reds[i]) - static_cast<double>(truth.reds[i]));
    sum += off * off;
    if (truth.penumbra[i] != 0) penumbra += off * off, ++count;
    errors.worst = std::max(errors.worst, off);
  }
  errors.rms = std::sqrt(sum / std::max(1.0, static_cast<double>(reds.size())));
  errors.penumbra = std::sqrt(penumbra / std::max(1.0, count));
  return errors;
}

class Table {
public:
  Table(const MapTruth& truth, Report& report) : truth_(truth), report_(report) {}

  MapErrors add(const Run& run, const std::string& parameter) {
    const MapErrors errors = errors_of(truth_, run.reds);
    rows_.push_back({run.by, parameter, fmt::format("{:.1f}", run.ms), fmt::format("{:.3f}", errors.rms),
                     fmt::format("{:.3f}", errors.penumbra), fmt::format("{:.2f}", errors.worst)});
    const auto figure = [&](const char* quantity, double value, const char* unit) {
      report_.add({"map", "room", run.by, parameter, quantity, value, unit});
    };
    figure("time", run.ms, "ms");
    figure("rms", errors.rms, "1/255");
    figure("penumbra_rms", errors.penumbra, "1/255");
    figure("worst", errors.worst, "1/255");
    return errors;
  }
  void print(const std::string& title) const { print_table(title, rows_); }

private:
  const MapTruth& truth_;
  Report& report_;
  Rows rows_{{"by", "setting", "ms", "rms", "penumbra", "worst"}};
};

/// The quickest run that errs by no more than the goal.
struct Best {
  double ms = std::numeric_limits<double>::infinity();
  std::size_t rays = 0;

  void take(double error, double time_ms, std::size_t count) {
    if (error <= error_255 && time_ms < ms) ms = time_ms, rays = count;
  }
  std::optional<double> ratio(double time_ms) const {
    return rays == 0 ? std::nullopt : std::optional<double>(time_ms / ms);
  }
};

/// Counts double until the error of the texels in penumbra is within the goal.
void race_rays(const MapScene& map, const EmbreeScene& casters, float lift_m, int rounds, Table& table,
               Best& over_map, Best& in_penumbra) {
  for (const Packing packing : {Packing::pixel, Packing::tile}) {
    for (const RaySum sum : {RaySum::plain, RaySum::scaled}) {
      double left = error_255 + 1;
      for (std::size_t count = 1; count <= most_rays && left > error_255; count *= 2) {
        const BakeRays rays(*map.light, count, packing, sum);
        Run run = trace_map(map, casters, rays, lift_m, rounds);
        run.by = fmt::format("rays, {}, {}", packing == Packing::tile ? "16 texels" : "16 cells",
                             ray_sum_name(sum));
        const MapErrors errors = table.add(run, fmt::format("rays={}", count));
        over_map.take(errors.rms, run.ms, count);
        in_penumbra.take(errors.penumbra, run.ms, count);
        left = errors.penumbra;
      }
    }
  }
}

}  // namespace

Expected<void> measure_bake_map(BakeSession& session) {
  const int size = session.by_effort(32, 512, 1024), rounds = session.by_effort(1, 3, 5);
  MapScene map;
  if (auto loaded = load_map(size, map); !loaded) return loaded;
  progress(fmt::format("room: {} texels of {}x{}", map.texels(), size, size));
  const auto reference = bake_map(map, {.solver = SoftSolver::bsp}, 1);  // found another way
  if (!reference) return tl::unexpected(reference.error());
  const MapTruth truth = truth_of(map, reference->reds);
  Table table(truth, session.report);
  auto exact = bake_map(map, {}, rounds);
  if (!exact) return tl::unexpected(exact.error());
  auto within = bake_map(map, {.error_255 = error_255}, rounds);
  if (!within) return tl::unexpected(within.error());
  session.headline.worst_255 = table.add(*exact, "exact").worst;
  table.add(*within, fmt::format("soft_error={}", error_255));

  const TriangleView triangles = triangle_view(map.input.geometry);
  const EmbreeScene casters(triangles, true);
  const float lift_m =
      lift_of_diagonal * static_cast<float>(2 * bake::extent_of(map.input.geometry));  // of a box that large
  Best over_map, in_penumbra;
  race_rays(map, casters, lift_m, rounds, table, over_map, in_penumbra);
  table.print(fmt::format("room: {}x{} texels, {} covered, {} in penumbra", size, size, map.texels(),
                          std::count(truth.penumbra.begin(), truth.penumbra.end(), 1)));
  session.headline.exact_over_rays = over_map.ratio(exact->ms);
  session.headline.within_over_rays = over_map.ratio(within->ms);
  session.headline.exact_over_rays_penumbra = in_penumbra.ratio(exact->ms);
  if (over_map.rays > 0) session.headline.rays = static_cast<double>(over_map.rays);
  return {};
}

}  // namespace tenebra::bench
