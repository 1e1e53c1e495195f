#include "session/auto_exposure.h"

#include <algorithm>
#include <cmath>

#include "session/session.h"

namespace tenebra::session {
namespace {

constexpr int longer_side_px = 160, intervals = 8;
constexpr std::size_t pixels_to_one_bright = 100;
constexpr double most_bright = 0.05, most_dark = 0.5;  // shares of a picture that an exposure of 1 may leave
constexpr float bright = 0.95f, dark = 0.01f;
/// What the brightest may show: all that the neutral tone leaves as it is. Above it, matte white and the
/// colours beside it are compressed towards one white.
constexpr float brightest = shade::neutral::start;
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

/// Pixels whose brightest channel is shown above a level.
std::size_t count_above(const Colors& colors, const shade::Display& display, float level) {
  return static_cast<std::size_t>(std::count_if(colors.begin(), colors.end(), [&](const glm::vec3& color) {
    const glm::vec3 shown = shade::shown(display, color);
    return std::max(std::max(shown.x, shown.y), shown.z) > level;
  }));
}

bool too_bright(const Colors& colors, const shade::Display& display) {
  return count_above(colors, display, brightest) * pixels_to_one_bright > colors.size();
}

bool shows_well(const std::vector<Colors>& pictures, const shade::Display& display) {
  const auto share = [&](const Colors& colors, float level) {
    return static_cast<double>(count_above(colors, display, level)) / static_cast<double>(colors.size());
  };
  const bool clipped = std::any_of(pictures.begin(), pictures.end(),
                                   [&](const Colors& colors) { return share(colors, bright) > most_bright; });
  const bool crushed = std::all_of(pictures.begin(), pictures.end(),
                                   [&](const Colors& colors) { return 1 - share(colors, dark) > most_dark; });
  return pictures.empty() || (!clipped && !crushed);
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

settings::Size metered_size(settings::Size size) {
  const int longer = std::max(size.width, size.height);
  const auto scaled = [&](int side) {
    return std::max(1, static_cast<int>(std::int64_t{side} * std::min(longer, longer_side_px) / longer));
  };
  return {scaled(size.width), scaled(size.height)};
}

/// Pixels without a triangle count where an environment shows there. Those that see an emissive surface do
/// not count where these are lights: lights may burn out.
Colors seen_colors(const Session& session, const render::FrameResult& drawn, bool emissive_lights) {
  Colors colors;
  const StagedScene& staged = session.staged();
  const auto emits = [&](std::uint32_t triangle) {
    const std::uint32_t material = session.placed().geometry.materials[triangle];
    return staged.scene.materials[material].emissive != glm::vec3(0.0f);
  };
  for (std::size_t i = 0; i < drawn.linear.pixels.size() / 3; ++i) {
    const float* rgb = &drawn.linear.pixels[3 * i];
    const bool seen = drawn.seen[i] != 0;
    const bool light = seen && emissive_lights && emits(session.renderer().triangle_ids()[i]);
    if ((seen || staged.environment) && !light) colors.emplace_back(rgb[0], rgb[1], rgb[2]);
  }
  return colors;
}

std::vector<double> metered_times(const StagedScene& staged) {
  if (staged.clip < 0) return {0.0};
  const Clip& clip = staged.scene.clips[static_cast<std::size_t>(staged.clip)];
  std::vector<double> times;
  for (int i = 0; i <= (clip.end_s > clip.start_s ? intervals : 0); ++i)
    times.push_back(clip.start_s + (clip.end_s - clip.start_s) * i / intervals);
  return times;
}

}  // namespace

settings::AutoExposures Meter::exposures(int fewer) const {
  settings::AutoExposures found;
  for (std::size_t i = 0; i < steps.size(); ++i)
    found[i] = exposure_of(std::max(steps[i] - fewer, least_step));
  return found;
}

Expected<Meter> meter(const StagedScene& staged, const settings::SceneSettings& settings) {
  // It lasts no longer than `staged`.
  const std::shared_ptr<const StagedScene> unowned(std::shared_ptr<const StagedScene>(), &staged);
  auto session = Session::open(unowned, settings.edits, {.kind = render::RasterKind::cpu});
  if (!session) return tl::unexpected(session.error());
  const settings::Size size = metered_size(staged.size);
  const Viewpoint viewpoint = viewpoint_of(staged, settings);
  render::FrameResult drawn;
  std::vector<Colors> pictures;
  for (const double time_s : metered_times(staged)) {
    session->place(time_s, rays_of(staged, viewpoint, time_s, size));
    const render::RenderSettings metered{
        .width = size.width,
        .height = size.height,
        .shadows = settings.emissive_lights ? render::ShadowMode::soft : render::ShadowMode::hard,
        .area_lights = {.emissive_quads = settings.emissive_lights},
        .linear = true};
    if (auto done = session->draw(metered, drawn); !done) return tl::unexpected(done.error());
    Colors colors = seen_colors(*session, drawn, settings.emissive_lights);
    if (!colors.empty()) pictures.push_back(std::move(colors));
  }
  Meter found;
  for (const shade::Tone tone : shade::tones)
    if (!pictures.empty()) found.steps[static_cast<std::size_t>(tone)] = step_for(pictures, tone);
  const bool linear = staged.display.transfer == Transfer::srgb;
  found.one_will_do = shows_well(pictures, {.tone = linear ? shade::Tone::neutral : shade::Tone::none});
  return found;
}

Expected<settings::AutoExposures> meter_exposures(const StagedScene& staged,
                                                  const settings::SceneSettings& settings) {
  const auto metered = meter(staged, settings);
  if (!metered) return tl::unexpected(metered.error());
  return metered->exposures();
}

}  // namespace tenebra::session
