#include "render/explanation.h"

#include <algorithm>
#include <map>

#include <tenebra/threads.h>
#include "points/receiver.h"
#include "points/smooth_surface.h"
#include "render/light_casters.h"
#include "render/light_points.h"
#include "render/shadow_lights.h"
#include "soft/light/light_places.h"

namespace tenebra::render {
namespace {

using shadow::LightSight;
using shadow::Sightline;

constexpr int points_of_a_light = 16;

TrianglePlace place_of(const PixelQuestion& question, std::uint32_t triangle) {
  return {triangle, node_of_triangle(question.scene, question.geometry, triangle),
          static_cast<int>(question.geometry.materials[triangle])};
}

const LightMask* mask_of(const PixelQuestion& question, int light) {
  const auto found = std::find_if(question.masks.begin(), question.masks.end(),
                                  [&](const LightMask& mask) { return mask.light == light; });
  return found == question.masks.end() ? nullptr : &*found;
}

std::vector<Sightline> lines_to(const PixelQuestion& question, const shadow::Sample& sample,
                                const DrawnLight& light, std::span<const ShadowLight> targets) {
  std::vector<std::uint8_t> casters;
  TriangleView triangles = casters_of(question.scene, question.geometry, light, casters);
  if (lifts_points(question.settings)) triangles.normals = question.geometry.normals;
  HardShadowConfig config = question.settings.hard;
  if (light.area) config.cull_front = false;  // soft shadows do not cull by facing
  return shadow::find_sightlines(sample, triangles, targets, config);
}

/// The pixel's sample, where shadows ask about it, and its shading normal.
struct ShadedSample {
  shadow::Sample at;
  glm::vec3 normal{0.0f};
};

ShadedSample sample_of(const PixelQuestion& question, std::uint32_t id) {
  const auto x = static_cast<std::size_t>(question.pixel.x), y = static_cast<std::size_t>(question.pixel.y);
  TriangleView triangles = triangle_view(question.geometry);
  VisiblePoints one;
  one.width = one.height = 1;
  one.triangles = {id};
  one.seen_from = question.view;
  one.positions = {points::PixelRays(question.view).point_on(points::receiver_of(triangles, id), x, y)};
  std::vector<glm::vec3> normal;
  compute_shading_normals(one, question.geometry.normals, triangles, normal);
  if (lifts_points(question.settings)) triangles.normals = question.geometry.normals;
  const int side = visible_side(one, triangles, 0);
  const points::SmoothSurface smooth = points::smooth_surface(triangles, id, side);
  const glm::dvec3 point = one.positions[0];
  return {{smooth.lifts ? points::lifted(smooth, point) : point, id, side}, normal[0]};
}

void explain_point(const PixelQuestion& question, const ShadedSample& shaded, const DrawnLight& light,
                   LightExplanation& out) {
  const shadow::Sample& sample = shaded.at;
  const ShadowLight target = shadow_light(light.light, light.placed);
  const Sightline line = lines_to(question, sample, light, {&target, 1}).front();
  out.sight = line.sight;
  out.directional = target.directional;
  out.light_at = target.directional ? target.to_light : target.position;
  const glm::dvec3 way =
      target.directional ? glm::dvec3(target.to_light) : glm::dvec3(target.position) - sample.point;
  out.faces_shading = glm::dot(glm::dvec3(shaded.normal), way) > 0;
  if (line.first == no_triangle) return;
  out.occluder = place_of(question, line.first);
  out.met_at = line.met_at;
  out.held_by_it = 1;
}

/// What is first on most sightlines to points of the light; of equals the smallest id.
void explain_area(const PixelQuestion& question, const shadow::Sample& sample, const DrawnLight& light,
                  LightExplanation& out) {
  std::vector<ShadowLight> targets;
  for (const glm::vec3& place : points_on_light(*light.area, points_of_a_light)) {
    targets.push_back(soft::light_at(*light.area, place));
    if (light.area->at_infinity) continue;
    targets.back().spot_axis = glm::vec3(light.area->normal);
    targets.back().spot_cos_outer = 0;
  }
  const std::vector<Sightline> lines = lines_to(question, sample, light, targets);
  std::map<std::uint32_t, int> counts;
  for (const Sightline& line : lines) {
    if (line.first != no_triangle) ++counts[line.first];
  }
  out.asked = points_of_a_light;
  out.light_at = glm::vec3(light.area->centre);
  out.directional = light.area->at_infinity;
  const bool turned_away = std::all_of(lines.begin(), lines.end(), [](const Sightline& line) {
    return line.sight == LightSight::faces_away || line.sight == LightSight::out_of_reach;
  });
  out.sight = turned_away ? lines.front().sight : counts.empty() ? LightSight::lit : LightSight::blocked;
  for (const auto& [triangle, count] : counts) {
    if (count <= out.held_by_it) continue;
    out.held_by_it = count;
    out.occluder = place_of(question, triangle);
    const auto line = std::find_if(lines.begin(), lines.end(),
                                   [&](const Sightline& l) { return l.first == out.occluder->triangle; });
    out.met_at = line->met_at;
    const ShadowLight& target = targets[static_cast<std::size_t>(line - lines.begin())];
    out.light_at = target.directional ? target.to_light : target.position;
  }
}

LightExplanation explain_light(const PixelQuestion& question, const ShadedSample& sample,
                               const DrawnLight& light) {
  LightExplanation out{.number = light.number, .name = light.light.name};
  if (!light.area) {
    explain_point(question, sample, light, out);
    return out;
  }
  explain_area(question, sample.at, light, out);
  const LightMask* mask = mask_of(question, light.number);
  if (mask == nullptr || mask->visible_fraction.pixels.empty()) return out;
  const auto index = static_cast<std::size_t>(question.pixel.y) * static_cast<std::size_t>(question.width) +
                     static_cast<std::size_t>(question.pixel.x);
  out.visible_fraction = mask->visible_fraction.pixels[index];
  // The mask's fraction says more than a few points do.
  if (*out.visible_fraction > 0) out.sight = LightSight::lit;
  if (*out.visible_fraction == 0 && out.sight == LightSight::lit) out.sight = LightSight::blocked;
  return out;
}

}  // namespace

int node_of_triangle(const Scene& scene, const FrameGeometry& geometry, std::uint32_t triangle) {
  const auto next = std::upper_bound(geometry.parts.begin(), geometry.parts.end(), triangle);
  auto part = next - geometry.parts.begin() - 1;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].mesh >= 0 && part-- == 0) return static_cast<int>(i);
  }
  return -1;
}

PixelExplanation explain_pixel(const PixelQuestion& question) {
  PixelExplanation out;
  const auto x = static_cast<std::size_t>(question.pixel.x), y = static_cast<std::size_t>(question.pixel.y);
  const std::size_t index = y * static_cast<std::size_t>(question.width) + x;
  if (index >= question.ids.size() || question.ids[index] >= question.geometry.triangles.size()) return out;
  const ShadedSample sample = sample_of(question, question.ids[index]);
  out.background = false;
  out.seen = place_of(question, sample.at.triangle);
  out.point = sample.at.point;
  with_threads(question.settings.threads, [&] {
    for (const DrawnLight& light : question.lights)
      out.lights.push_back(explain_light(question, sample, light));
  });
  return out;
}

}  // namespace tenebra::render
