#include "settings/quality.h"

#include "settings/method_settings.h"
#include "settings/tables.h"

namespace tenebra::settings {

std::string_view quality_name(Quality quality) {
  constexpr std::array<std::string_view, qualities.size()> names{"fast", "balanced", "exact"};
  return names[static_cast<std::size_t>(quality)];
}

void apply_quality(Quality quality, const Given& given, MethodSettings& method) {
  for (const Setting<MethodSettings>& setting : method_table()) {
    const std::string_view value = setting.by_quality[static_cast<std::size_t>(quality)];
    const bool replaced =
        setting.name == "soft-error" && given.contains("soft-points");  // points take its place
    if (!value.empty() && !replaced && !given.contains(setting.name))
      static_cast<void>(setting.read(method, std::string(value)));  // tests read every value of the table
  }
}

void apply_quality(Quality quality, render::RenderSettings& render) {
  MethodSettings method{.render = std::move(render)};
  apply_quality(quality, {}, method);
  render = std::move(method.render);
}

render::RenderSettings quality_settings(Quality quality) {
  render::RenderSettings render;
  apply_quality(quality, render);
  return render;
}

std::optional<Quality> quality_of(const render::RenderSettings& render) {
  const MethodSettings method{.render = render};
  for (const Quality quality : qualities) {
    MethodSettings preset = method;
    apply_quality(quality, {}, preset);
    if (preset == method) return quality;
  }
  return std::nullopt;
}

}  // namespace tenebra::settings
