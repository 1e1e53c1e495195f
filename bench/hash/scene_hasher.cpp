#include "bench/hash/scene_hasher.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/fail.h"
#include "bench/hash/hash_bits.h"
#include "parallel/parallel.h"
#include "render/area_lights.h"
#include "render/shadow_lights.h"

namespace tenebra::bench {
namespace {

constexpr std::size_t most_lights = 2;      // of the scene's own; the sun comes beside them
constexpr glm::vec3 to_sun{0.3f, 1, 0.2f};  // for scenes without a directional light
constexpr float light_side_percent = 2;     // of the scene's diagonal, for lights without an area
constexpr int points_on_a_light = 5;
constexpr int rays = 16;  // of ambient occlusion, per point
constexpr int table_positions = 81, table_directions = 64;

constexpr std::array variants{Variant::tiles,        Variant::precise,        Variant::precise_sorted,
                              Variant::spheres,      Variant::spheres_sorted, Variant::precise_sea,
                              Variant::precise_eatp, Variant::precise_seatp};
constexpr std::array fast_variants{Variant::tiles, Variant::precise_sorted};

void add_view(const ViewRays& view, BitHash& hash) {
  for (const glm::vec3& v : {view.eye, view.d0, view.dx, view.dy}) hash.add_value(v);
  hash.add_value(view.near_m).add_value(view.orthographic);
}

void add_light(const WorldLight& light, BitHash& hash) {
  hash.add_value(light.light);
  for (const glm::vec3& v : {light.position, light.direction, light.axis_x, light.axis_y}) hash.add_value(v);
}

/// Positions where no triangle is seen mean nothing.
std::uint64_t hash_points(const VisiblePoints& points) {
  BitHash hash;
  std::vector<glm::dvec3> seen;
  for (std::size_t i = 0; i < points.triangles.size(); ++i)
    if (points.triangles[i] != no_triangle) seen.push_back(points.positions[i]);
  return hash.add(points.triangles).add(seen).value();
}

}  // namespace

/// The frame as `picture` shows it: points with their tiles, and normals.
void SceneHasher::see(const HashFrame& frame, HashPicture picture) {
  const auto [clip, time_s] = frame_instant(scene_, frame.number);
  const auto [width, height] = hash_size(picture, frame.scale);
  frame_.view = evaluate_camera(scene_, clip, time_s, 0, width, height);
  const bool tiled = picture == HashPicture::hard || picture == HashPicture::wide;
  compute_visible_points(frame.ids[static_cast<std::size_t>(picture)], width, height, frame_.view,
                         frame_.triangles(), frame_.points,
                         tiled ? PointLayout::rows_and_tiles : PointLayout::rows);
  compute_shading_normals(frame_.points, frame_.geometry.normals, frame_.triangles(), frame_.normals);
}

void SceneHasher::add_points(const char* prefix) {
  add(fmt::format("{}.points", prefix), hash_points(frame_.points));
  add(fmt::format("{}.normals", prefix), hash_of(frame_.normals));
}

void SceneHasher::hash_geometry(const HashFrame& frame) {
  const auto [clip, time_s] = frame_instant(scene_, frame.number);
  FrameGeometry& g = frame_.geometry;
  evaluate_frame(scene_, clip, time_s, g);
  frame_.lights = evaluate_lights(scene_, clip, time_s);
  BitHash geometry, view;
  geometry.add(g.positions).add(g.normals).add(g.triangles).add(g.materials).add(g.casts_shadow).add(g.parts);
  add("geometry", geometry.value());
  add_view(evaluate_camera(scene_, clip, time_s, 0, 256, 256), view);
  for (const WorldLight& light : frame_.lights) add_light(light, view);
  add("view", view.value());
}

void SceneHasher::hash_masks(const std::string& name, const ShadowLight& light,
                             std::span<const Variant> traced) {
  const auto trace = [&](std::string_view variant, const HardShadowConfig& config) {
    hard_.trace_shadow_mask(frame_.points, frame_.triangles(), light, config, mask_);
    add(fmt::format("{}.{}", name, variant), hash_of(mask_));
  };
  for (const Variant variant : traced)
    trace(variant_name(variant), {.variant = variant, .simd = setting_.level});
  trace("culled", {.cull_front = true, .contact = ContactRule::none, .simd = setting_.level});
}

/// The first lights of the scene, and a sun.
void SceneHasher::hash_lights(const char* prefix, std::span<const Variant> traced) {
  add_points(prefix);
  for (std::size_t i = 0; i < std::min(most_lights, frame_.lights.size()); ++i) {
    const WorldLight& placed = frame_.lights[i];
    const Light& light = scene_.lights[static_cast<std::size_t>(placed.light)];
    // All variants for the first light; for the others, on which they do the same, one is enough.
    hash_masks(fmt::format("{}.{}", prefix, i), render::shadow_light(light, placed),
               i == 0 ? traced : traced.first(1));
  }
  hash_masks(fmt::format("{}.sun", prefix), {.directional = true, .to_light = to_sun}, traced);
}

void SceneHasher::hash_hard(const HashFrame& frame) {
  see(frame, HashPicture::hard);
  hash_lights("hard", variants);
  see(frame, HashPicture::wide);
  hash_lights("wide", fast_variants);
}

/// The first light that has an area or can be given one.
Expected<AreaLight> SceneHasher::area_light() const {
  render::AreaLightSettings settings;
  settings.size = glm::vec2(light_side_percent);
  settings.percent_of_diagonal = true;
  for (const WorldLight& placed : frame_.lights) {
    auto area = render::area_light_of(scene_.lights[static_cast<std::size_t>(placed.light)], placed, settings,
                                      render::box_of(frame_.geometry));
    if (!area) return tl::unexpected(area.error());
    if (*area) return std::move(**area);
  }
  return base::fail("no light of the scene can have an area");
}

Expected<void> SceneHasher::hash_soft(const HashFrame& frame) {
  see(frame, HashPicture::soft);
  add_points("soft");
  const auto light = area_light();
  if (!light) return tl::unexpected(light.error());
  std::vector<std::uint8_t> casters;
  TriangleView triangles = frame_.triangles();
  if (render::casters_off_plane(frame_.geometry, *light, casters)) triangles.casts_shadow = casters;
  const auto keep = [&](const std::string& name) {
    add(fmt::format("soft.{}.fraction", name), hash_of(soft_mask_.visible_fraction));
    add(fmt::format("soft.{}.irradiance", name), hash_of(soft_mask_.irradiance));
  };
  const auto trace = [&](const std::string& name, SoftShadowTracer& tracer, SoftShadowConfig config) {
    config.simd = setting_.level;
    tracer.trace(frame_.points, frame_.normals, triangles, *light, config, soft_mask_);
    keep(name);
  };
  for (const SoftSolver solver : {SoftSolver::automatic, SoftSolver::bsp, SoftSolver::clip}) {
    const std::string name(soft_solver_name(solver));
    trace(name + ".fast", soft_, {.solver = solver});
    trace(name + ".reference", precise_soft_, {.solver = solver});
  }
  trace("auto.triangle", soft_, {.grouping = SoftGrouping::triangle});
  light_points_.trace(frame_.points, frame_.normals, triangles, *light, points_on_a_light,
                      {.simd = setting_.level}, soft_mask_);
  keep("points");
  return {};
}

Expected<void> SceneHasher::hash_ambient(const HashFrame& frame) {
  see(frame, HashPicture::ambient);
  add_points("ao");
  const auto compute = [&](const char* name, AoConfig config) -> Expected<void> {
    config.mode = AoMode::field;
    config.rays = rays;
    config.positions = table_positions;
    config.directions = table_directions;
    config.simd = setting_.level;
    config.cache.clear();  // what earlier runs left in files must not count
    auto done = ambient_.compute(scene_, frame_.geometry, frame_.points, frame_.normals, config, open_);
    if (done) add(fmt::format("ao.{}", name), hash_of(open_));
    return done;
  };
  if (auto done = compute("chords", {}); !done) return done;
  if (auto done = compute("half", {.downscale = 2}); !done) return done;
  if (auto done = compute("vertices", {.place = AoPlace::vertices}); !done) return done;
  return compute("directions", {.layout = FieldLayout::positions_directions});
}

Expected<void> SceneHasher::hash_all(const HashFrame& frame) {
  items_.clear();
  hash_geometry(frame);
  hash_hard(frame);
  if (auto done = hash_soft(frame); !done) return done;
  return hash_ambient(frame);
}

Expected<std::vector<HashItem>> SceneHasher::hash(const HashFrame& frame) {
  Expected<void> done;
  with_threads(setting_.threads, [&] { done = hash_all(frame); });
  if (!done) return tl::unexpected(done.error());
  return items_;
}

}  // namespace tenebra::bench
