#include "shared/auto_exposure.h"

#include <algorithm>
#include <cmath>

#include "render/renderer.h"

namespace tenebra::viewer {
namespace {

constexpr int longer_side_px = 160, intervals = 8;
constexpr std::size_t pixels_to_one_bright = 100;
constexpr float bright = 0.95f;
constexpr int steps_to_double = 8, least_step = -12 * steps_to_double, most_step = 6 * steps_to_double;

/// 2^(step / 8): the same float on every machine.
float exposure_of(int step) {
  constexpr float eighths[steps_to_double] = {1.0f,        1.0905077f, 1.1892071f, 1.2968396f,
                                              1.41421354f, 1.5422108f, 1.6817929f, 1.8340081f};
  const int from_least = step - least_step, whole = from_least / steps_to_double;
  return std::ldexp(eighths[from_least % steps_to_double], whole + least_step / steps_to_double);
}

/// Linear colours of what pixels see; those that see nothing are left out.
using Colors = std::vector<glm::vec3>;

bool too_bright(const Colors& colors, const shade::Display& display) {
  std::size_t found = 0;
  for (const glm::vec3& color : colors) {
    const glm::vec3 shown = shade::shown(display, color);
    found += std::max(std::max(shown.x, shown.y), shown.z) > bright;
  }
  return found * pixels_to_one_bright > colors.size();
}

/// The largest step with which none of the pictures is too bright.
int step_for(const std::vector<Colors>& pictures, shade::Tone tone) {
  const auto fits = [&](int step) {
    return std::none_of(pictures.begin(), pictures.end(), [&](const Colors& colors) {
      return too_bright(colors, {.exposure = exposure_of(step), .tone = tone});
    });
  };
  int dark = least_step, light = most_step;
  if (fits(light)) return light;
  while (light - dark > 1) {
    const int middle = dark + (light - dark) / 2;
    (fits(middle) ? dark : light) = middle;
  }
  return dark;
}

Size metered_size(Size size) {
  const int longer = std::max(size.width, size.height);
  const auto scaled = [&](int side) {
    return std::max(1, static_cast<int>(std::int64_t{side} * std::min(longer, longer_side_px) / longer));
  };
  return {scaled(size.width), scaled(size.height)};
}

/// Pixels without a triangle count where an environment shows there.
Colors seen_colors(const render::FrameResult& drawn, bool background_too) {
  Colors colors;
  for (std::size_t i = 0; i < drawn.linear.pixels.size() / 3; ++i) {
    const float* rgb = &drawn.linear.pixels[3 * i];
    if (background_too || drawn.seen[i] != 0) colors.emplace_back(rgb[0], rgb[1], rgb[2]);
  }
  return colors;
}

std::vector<double> metered_times(const ScenePlan& plan) {
  if (plan.clip < 0) return {0.0};
  const Clip& clip = plan.scene.clips[static_cast<std::size_t>(plan.clip)];
  std::vector<double> times;
  for (int i = 0; i <= (clip.end_s > clip.start_s ? intervals : 0); ++i)
    times.push_back(clip.start_s + (clip.end_s - clip.start_s) * i / intervals);
  return times;
}

}  // namespace

Expected<AutoExposures> meter_exposures(const ScenePlan& plan, const SceneOptions& options) {
  auto raster = render::FrameRaster::create({.kind = render::RasterKind::cpu});
  if (!raster) return tl::unexpected(raster.error());
  render::Renderer renderer = render::Renderer::create(std::move(*raster), plan.scene);
  renderer.set_lights(stage::lights_of(plan.scene, options.edits));
  renderer.set_materials(stage::materials_of(plan.scene, options.edits));
  if (plan.environment) renderer.set_environment(*plan.environment);
  const Size size = metered_size(plan.size);
  const render::RenderSettings settings{.width = size.width, .height = size.height, .linear = true};
  render::FrameInput input;
  render::FrameResult drawn;
  std::vector<Colors> pictures;
  for (const double time_s : metered_times(plan)) {
    evaluate_frame(plan.scene, plan.clip, time_s, input.geometry);
    stage::apply_node_edits(plan.scene, options.edits, input.geometry);
    input.lights = stage::placed_lights(plan.scene, options.edits, plan.clip, time_s);
    input.view = view_of(plan, options, time_s, size);
    if (auto done = renderer.render_frame(input, settings, drawn); !done) return tl::unexpected(done.error());
    Colors colors = seen_colors(drawn, plan.environment.has_value());
    if (!colors.empty()) pictures.push_back(std::move(colors));
  }
  AutoExposures found;
  for (const shade::Tone tone : shade::tones)
    found[static_cast<std::size_t>(tone)] = pictures.empty() ? 1.0f : exposure_of(step_for(pictures, tone));
  return found;
}

}  // namespace tenebra::viewer
