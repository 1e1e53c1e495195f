// Lights with an area: one side of a polygon, or both.
#include <fmt/core.h>
#include <algorithm>

#include "base/fail.h"
#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "render/lighter.h"
#include "shade/light_terms.h"
#include "soft/light/even_emission.h"

namespace tenebra::render {
namespace {

/// What weighing evenly makes of a unit of irradiance (soft::weigh_evenly): the light without over that with
/// the cosine at the light; `path`: from the point to the light's centre. From two of its sides away each by
/// Gauss's rule of two places along each axis of the rectangle: errors alone are weighed by it.
double even_over_lambert(const AreaLight& light, const glm::dvec3& path, const glm::dvec3& normal) {
  if (glm::dot(path, path) < 4 * light.area_m2) {
    const glm::dvec3 at = light.centre - path;
    const double whole = soft::whole_irradiance(light, at, normal);
    return whole > 0 ? soft::even_irradiance(light, at, normal) / whole : 0;
  }
  constexpr double place = 0.5773502691896258;  // 1 / sqrt(3), of the way to the corner
  double even = 0, lambert = 0;
  for (const glm::dvec2& corner : light.polygon) {
    const glm::dvec3 to = path + place * (corner.x * light.ex + corner.y * light.ey);
    const double square = glm::dot(to, to), above = std::max(glm::dot(normal, to), 0.0);
    even += above / (square * std::sqrt(square)), lambert += above / (square * square);
  }
  const double height = std::abs(glm::dot(light.normal, path));
  return lambert * height > 0 ? even / (lambert * height) : 0;
}

/// What a unit of irradiance makes of light in the picture at each sample: fading as seen from the light's
/// centre, and of lights that shine alike in every direction even_over_lambert(). Empty: the same everywhere.
void shown_of_irradiance(const DrawnLight& light, const LitSamples& at, std::vector<float>& out) {
  const VisiblePoints& points = at.lit_at();
  const shade::LightTerms terms = shade::light_terms(light, ViewRays{});
  const bool even = light.back.has_value();
  const bool fades = terms.spot || terms.range_m > 0 || terms.distance_power != 0;
  out.clear();
  if (terms.directional || !(even || fades)) return;
  out.resize(points.triangles.size());
  parallel::parallel_ranges(out.size(), 1 << 12, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (points.triangles[i] == no_triangle) continue;
      const glm::dvec3 path = light.area->centre - points.positions[i];
      const double distance = glm::length(path);
      if (!(distance > 0)) continue;
      const double fade = fades ? shade::fade_of(terms, path / distance, distance) : 1;
      out[i] = static_cast<float>(
          even ? fade * even_over_lambert(*light.area, path, glm::dvec3(at.normals[i])) : fade);
    }
  });
}

/// Writes the light of the light's back where only that is seen.
void add_back(const VisiblePoints& points, const AreaLight& front, const SampleLight& back, SampleLight& out,
              const LightMask& back_mask, LightMask* mask) {
  for (std::size_t i = 0; i < points.triangles.size(); ++i) {
    if (points.triangles[i] == no_triangle ||
        !(glm::dot(front.normal, points.positions[i] - front.centre) < 0))
      continue;
    out.soft.visible_fraction[i] = std::max(out.soft.visible_fraction[i], back.soft.visible_fraction[i]);
    out.soft.irradiance[i] = std::max(out.soft.irradiance[i], back.soft.irradiance[i]);
    if (mask != nullptr && !mask->classes.empty()) mask->classes[i] = back_mask.classes[i];
    if (mask != nullptr && !mask->error.pixels.empty()) mask->error.pixels[i] = back_mask.error.pixels[i];
  }
  TintMask& tint = out.tint.mask;
  tint.pixels.insert(tint.pixels.end(), back.tint.mask.pixels.begin(), back.tint.mask.pixels.end());
  tint.factors.insert(tint.factors.end(), back.tint.mask.factors.begin(), back.tint.mask.factors.end());
}

}  // namespace

void Lighter::note_changed_groups(const SoftShadowConfig& config, std::vector<std::string>& notes) const {
  if (!groups_changed_) return;
  // A tree gets less than a quarter of what all have together (soft::largest_tree).
  const bool together = config.memory_bytes && *config.memory_bytes / 4 < config.tree_bytes;
  const std::size_t most = together ? *config.memory_bytes : config.tree_bytes;
  notes.push_back(fmt::format(
      "Some groups of points were clipped in place of the BSP, whose trees would have outgrown {} MB "
      "({}). The picture is the same, and the log counts the groups; a larger --memory soft:MB gives "
      "trees more.",
      most >> 20, together ? "for all that soft shadows hold" : "each"));
}

Expected<void> Lighter::trace_visible_part(const Frame& frame, const DrawnLight& light, const LitSamples& at,
                                           SoftMask& out, FrameResult* told) {
  const RenderSettings& settings = frame.settings;
  const bool by_points = settings.soft_points > 0;
  const TriangleView triangles = traced_triangles(frame, light);
  const HardShadowConfig of_points{.variant = settings.hard.variant, .simd = settings.hard.simd};
  shown_.clear();
  if (!by_points && settings.soft.error_255 > 0) shown_of_irradiance(light, at, shown_);
  const bool done = by_points ? light_points_.trace(at.lit_at(), at.normals, triangles, *light.area,
                                                    settings.soft_points, of_points, out, frame.stop)
                              : soft_.trace(at.lit_at(), at.normals, triangles, *light.area, settings.soft,
                                            out, frame.stop, shown_);
  if (!done && !by_points && !soft_.refusal().empty())
    return base::fail(ErrorKind::memory, "{}", soft_.refusal());
  if (!done) return base::stopped();
  groups_changed_ |= !by_points && soft_.stats().groups_changed > 0;
  if (told == nullptr) return {};
  if (by_points) {
    told->stats += light_points_.stats();
    add_shadow_stages(told->timings, light_points_.timings());
  } else {
    told->soft += soft_.stats();
    add_shadow_stages(told->timings, soft_.timings());
  }
  return {};
}

Expected<void> Lighter::trace_side(const Frame& frame, const DrawnLight& light, const LitSamples& at,
                                   SampleLight& out, Told told) {
  if (auto done = trace_visible_part(frame, light, at, out.soft, told.result); !done) return done;
  if (told.mask != nullptr && frame.settings.soft_points == 0) {
    told.mask->classes.assign(soft_.classes().begin(), soft_.classes().end());
    if (frame.settings.error_maps)
      told.mask->error.pixels.assign(soft_.errors().begin(), soft_.errors().end());
  }
  out.tint.mask = {};
  if (!frame.has_glass()) return {};
  if (auto done = trace_tint(frame, light, at, out); !done) return done;
  if (told.result != nullptr) told.result->timings.tint_ms += tint_.stats().ms;
  return {};
}

Expected<void> Lighter::trace_area(const Frame& frame, const DrawnLight& light, const LitSamples& at,
                                   SampleLight& out, Told told) {
  const auto weigh = [&](const AreaLight& area, SampleLight& side) {
    base::Stopwatch watch;
    soft::weigh_evenly(at.lit_at(), at.normals, area, frame.settings.soft.simd, side.soft);
    if (told.result != nullptr) told.result->timings.irradiance_ms += watch.lap_ms();
  };
  if (auto done = trace_side(frame, light, at, out, told); !done || !light.back) return done;
  weigh(*light.area, out);
  if (!shines_behind(light) || !soft::any_behind(at.lit_at(), *light.area)) return {};
  DrawnLight turned = light;
  turned.area = *light.back;
  Told back = told;
  if (told.mask != nullptr) back.mask = &behind_mask_;
  if (auto done = trace_side(frame, turned, at, behind_, back); !done) return done;
  weigh(*turned.area, behind_);
  add_back(at.lit_at(), *light.area, behind_, out, behind_mask_, told.mask);
  return {};
}

}  // namespace tenebra::render
