// The stages of a frame that only lights with an area have: one side of a light, or both.
#include <fmt/core.h>
#include <algorithm>

#include "base/fail.h"
#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "render/light_casters.h"
#include "render/renderer_state.h"
#include "soft/light/even_emission.h"

namespace tenebra::render {
namespace {

/// Writes the light of the light's back where only that is seen.
void add_back(const VisiblePoints& points, const AreaLight& front, const AreaSide& back, AreaSide& out) {
  for (std::size_t i = 0; i < points.triangles.size(); ++i) {
    if (points.triangles[i] == no_triangle ||
        !(glm::dot(front.normal, points.positions[i] - front.centre) < 0))
      continue;
    out.lit.visible_fraction[i] = std::max(out.lit.visible_fraction[i], back.lit.visible_fraction[i]);
    out.lit.irradiance[i] = std::max(out.lit.irradiance[i], back.lit.irradiance[i]);
    if (!out.classes.empty()) out.classes[i] = back.classes[i];
    if (!out.errors.empty()) out.errors[i] = back.errors[i];
  }
  out.tint.pixels.insert(out.tint.pixels.end(), back.tint.pixels.begin(), back.tint.pixels.end());
  out.tint.factors.insert(out.tint.factors.end(), back.tint.factors.begin(), back.tint.factors.end());
}

}  // namespace

void Renderer::State::note_changed_groups(const SoftShadowConfig& config,
                                          std::vector<std::string>& notes) const {
  if (!groups_changed) return;
  // A tree gets less than a third of what all have together (MemoryHold::largest_tree).
  const bool together = config.memory_bytes && *config.memory_bytes / 4 < config.tree_bytes;
  const std::size_t most = together ? *config.memory_bytes : config.tree_bytes;
  notes.push_back(fmt::format(
      "Some groups of points were clipped in place of the BSP, whose trees would have outgrown {} MB "
      "({}). The picture is the same, and the log counts the groups; a larger --soft-memory gives "
      "trees more.",
      most >> 20, together ? "for all that soft shadows hold" : "each"));
}

Expected<void> Renderer::State::trace_visible_part(const AreaTask& task, const DrawnLight& light,
                                                   SoftMask& out) {
  const RenderSettings& settings = task.settings;
  const TriangleView triangles = traced_triangles(task.input, light, settings);
  const HardShadowConfig of_points{.variant = settings.hard.variant, .simd = settings.hard.simd};
  bool done = false;
  done = settings.soft_points > 0
             ? light_points.trace(task.at, task.normals, task.input.view, triangles, *light.area,
                                  settings.soft_points, of_points, out, task.stop)
             : soft.trace(task.at, task.normals, task.input.view, triangles, *light.area, settings.soft, out,
                          task.stop);
  if (!done && !soft.refusal().empty()) return base::fail(ErrorKind::memory, "{}", soft.refusal());
  if (!done) return base::stopped();
  groups_changed |= settings.soft_points == 0 && soft.stats().groups_changed > 0;
  if (task.counts == nullptr) return {};
  if (settings.soft_points > 0) {
    task.counts->stats += light_points.stats();
    add_shadow_stages(task.counts->timings, light_points.timings());
  } else {
    task.counts->soft += soft.stats();
    add_shadow_stages(task.counts->timings, soft.timings());
  }
  return {};
}

Expected<void> Renderer::State::trace_side(const AreaTask& task, const DrawnLight& light, AreaSide& out) {
  if (auto done = trace_visible_part(task, light, out.lit); !done) return done;
  out.classes.clear();
  if (task.settings.soft_points == 0) out.classes.assign(soft.classes().begin(), soft.classes().end());
  out.errors.clear();
  if (task.settings.error_maps && task.settings.soft_points == 0)
    out.errors.assign(soft.errors().begin(), soft.errors().end());
  out.tint = {};
  if (task.input.geometry.see_through.empty()) return {};
  if (auto done = trace_tint(task.input, light, task.settings, task.at, task.normals, {}, out.lit, out.tint,
                             task.stop);
      !done)
    return done;
  if (task.counts != nullptr) task.counts->timings.tint_ms += tint.stats().ms;
  return {};
}

Expected<void> Renderer::State::trace_area(const AreaTask& task, const DrawnLight& light, AreaSide& out) {
  if (auto done = trace_side(task, light, out); !done) return done;
  if (!light.back) return {};
  const auto weigh = [&](const AreaLight& area, AreaSide& side) {
    base::Stopwatch watch;
    soft::weigh_evenly(task.at, task.normals, area, task.settings.soft.simd, side.lit);
    if (task.counts != nullptr) task.counts->timings.irradiance_ms += watch.lap_ms();
  };
  weigh(*light.area, out);
  if (!shines_behind(light) || !soft::any_behind(task.at, *light.area)) return {};
  DrawnLight turned = light;
  turned.area = *light.back;
  if (auto done = trace_side(task, turned, behind_light); !done) return done;
  weigh(*turned.area, behind_light);
  add_back(task.at, *light.area, behind_light, out);
  return {};
}

}  // namespace tenebra::render
