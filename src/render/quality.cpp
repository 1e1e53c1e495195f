#include "render/quality.h"

namespace tenebra::render {

std::string_view quality_name(Quality quality) {
  switch (quality) {
    case Quality::fast:
      return "fast";
    case Quality::balanced:
      return "balanced";
    case Quality::exact:
      return "exact";
  }
  return {};
}

std::optional<Quality> quality_from_name(std::string_view name) {
  for (const Quality quality : qualities) {
    if (quality_name(quality) == name) return quality;
  }
  return std::nullopt;
}

QualitySettings quality_settings(Quality quality) {
  switch (quality) {
    case Quality::fast:
      return {.soft_error = 4, .ao_error = 5, .ao_rays = 16, .ao_downscale = 2};
    case Quality::balanced:
      return {};
    case Quality::exact:
      return {.ao_error = 1, .ao_rays = 256};
  }
  return {};
}

void apply_quality(Quality quality, RenderSettings& settings) {
  const QualitySettings chosen = quality_settings(quality);
  settings.soft_points = 0;
  settings.soft.error_255 = chosen.soft_error;
  settings.ao.error_255 = chosen.ao_error;
  settings.ao.rays = chosen.ao_rays;
  settings.ao.downscale = chosen.ao_downscale;
}

}  // namespace tenebra::render
