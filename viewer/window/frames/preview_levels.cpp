#include "window/frames/preview_levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "settings/quality.h"

namespace tenebra::viewer {
namespace {

constexpr int few_points = 8, cast_rays = 8, cast_downscale = 4;

int part_of(int pixels, int divisor) {
  return std::max(1, (pixels + divisor / 2) / divisor);
}

/// At most `count` light points, where lights are points.
int fewer_points(int asked, int count) {
  return std::min(asked, count);
}

void take_fewer(render::RenderSettings& settings, int rays, int downscale) {
  const render::RenderSettings fast = settings::quality_settings(settings::Quality::fast);
  settings.soft.error_255 = std::max(settings.soft.error_255, fast.soft.error_255);
  settings.ao.error_255 = std::max(settings.ao.error_255, fast.ao.error_255);
  settings.ao.rays = std::min(settings.ao.rays, rays);
  settings.ao.downscale = std::max(settings.ao.downscale, downscale);
  settings.hard.variant = Variant::tiles;  // the same masks
}

}  // namespace

PreviewSubject preview_subject(const void* scene, const render::RenderSettings& asked, bool compares,
                               bool explains) {
  return {.scene = scene,
          .size = {asked.width, asked.height},
          .shadows = asked.shadows,
          .soft_points = asked.soft_points,
          .soft_error = asked.soft.error_255,
          .ao = asked.ao.mode,
          .ao_error = asked.ao.error_255,
          .ao_rays = asked.ao.rays,
          .ao_downscale = asked.ao.downscale,
          .antialias = asked.antialias,
          .compares = compares,
          .explains = explains};
}

std::vector<PreviewLevel> preview_levels(const PreviewSubject& subject) {
  const bool soft = subject.shadows == render::ShadowMode::soft, occludes = subject.ao != AoMode::none;
  const render::RenderSettings fast = settings::quality_settings(settings::Quality::fast);
  const bool has_fewer =
      (soft && (subject.soft_points > 0 ? subject.soft_points > few_points
                                        : subject.soft_error < fast.soft.error_255)) ||
      (occludes && (subject.ao == AoMode::adaptive
                        ? subject.ao_error < fast.ao.error_255
                        : subject.ao_rays > fast.ao.rays || subject.ao_downscale < fast.ao.downscale));
  const bool has_plain = occludes || (soft && subject.soft_points != 1);
  std::vector<PreviewLevel> levels{{PreviewMethod::as_asked, 1}};
  const auto add = [&](PreviewMethod method, std::initializer_list<int> divisors) {
    for (const int divisor : divisors) levels.push_back({method, divisor});
  };
  if (subject.antialias > 1) add(PreviewMethod::single, {1});
  add(PreviewMethod::single, {2});
  if (subject.compares) {
    add(PreviewMethod::fewer, {2, 4, 8});
  } else if (subject.explains || !has_plain) {
    add(PreviewMethod::single, {4, 8});
  } else {
    if (has_fewer) add(PreviewMethod::fewer, {1, 2});
    if (occludes && subject.ao != AoMode::adaptive) add(PreviewMethod::cast, {2, 4});
    add(PreviewMethod::plain, {1, 2, 4, 8});
  }
  return levels;
}

render::RenderSettings preview_settings(const render::RenderSettings& asked, PreviewLevel level) {
  render::RenderSettings settings = asked;
  settings.width = part_of(asked.width, level.divisor);
  settings.height = part_of(asked.height, level.divisor);
  const render::RenderSettings fast = settings::quality_settings(settings::Quality::fast);
  if (level.method != PreviewMethod::as_asked) {
    settings.antialias = 1;
    settings.antialias_everywhere = false;
  }
  switch (level.method) {
    case PreviewMethod::as_asked:
    case PreviewMethod::single:
      break;
    case PreviewMethod::fewer:
      take_fewer(settings, fast.ao.rays, fast.ao.downscale);
      settings.soft_points = fewer_points(settings.soft_points, few_points);
      break;
    case PreviewMethod::cast:
      take_fewer(settings, cast_rays, cast_downscale);
      settings.soft_points = 1;
      if (asked.ao.mode != AoMode::none) settings.ao.mode = AoMode::rays;
      settings.ao.place = AoPlace::pixels;
      break;
    case PreviewMethod::plain:
      take_fewer(settings, 1, 1);
      settings.soft_points = 1;
      settings.ao.mode = AoMode::none;
      break;
  }
  return settings;
}

ViewRays view_in_pixels(ViewRays view, Size before, Size now) {
  view.dx *= static_cast<float>(before.width) / static_cast<float>(now.width);
  view.dy *= static_cast<float>(before.height) / static_cast<float>(now.height);
  return view;
}

std::string preview_text(const render::RenderSettings& asked, PreviewLevel level) {
  const render::RenderSettings drawn = preview_settings(asked, level);
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (level.divisor > 1) add(fmt::format("1/{} size", level.divisor));
  if (asked.shadows == render::ShadowMode::soft && drawn.soft_points != asked.soft_points)
    add(drawn.soft_points == 1 ? "hard shadows" : fmt::format("{} light points", drawn.soft_points));
  else if (asked.shadows == render::ShadowMode::soft && drawn.soft.error_255 != asked.soft.error_255)
    add(fmt::format("penumbrae to {:.3g}/255", drawn.soft.error_255));
  if (asked.ao.mode != AoMode::none && drawn.ao.mode == AoMode::none) {
    add("no occlusion");
  } else if (asked.ao.mode == AoMode::adaptive) {
    if (drawn.ao.error_255 != asked.ao.error_255)
      add(fmt::format("occlusion to {:.3g}/255", drawn.ao.error_255));
  } else if (asked.ao.mode != AoMode::none &&
             (drawn.ao.rays != asked.ao.rays || drawn.ao.downscale != asked.ao.downscale)) {
    add(fmt::format("{} occlusion rays", drawn.ao.rays));
  }
  if (text.empty() && drawn.antialias != asked.antialias) add("1 sample per pixel");
  return text;
}

}  // namespace tenebra::viewer
