#include "bench/ao/scenes/ao_scene_ours.h"

#include "bench/ao/ao_race.h"
#include "bench/common/bench_report.h"
#include "settings/quality.h"

namespace tenebra::bench {
namespace {

/// Of the last call of compute(); fields give none.
std::optional<double> estimate_of(const AmbientOcclusion& ao, AoMode mode) {
  return mode == AoMode::adaptive ? std::optional(ao.stats().error_255) : std::nullopt;
}

struct Setting {
  const char* name;
  settings::Quality quality;
  AoMode mode;
};
constexpr Setting settings_shown[] = {{"default", settings::Quality::balanced, AoMode::adaptive},
                                      {"exact", settings::Quality::exact, AoMode::adaptive},
                                      {"fast", settings::Quality::fast, AoMode::adaptive},
                                      {"fields", settings::Quality::balanced, AoMode::field}};

}  // namespace

std::vector<AoSceneSetting> scene_settings(float reach_m, const std::filesystem::path& fields, bool tiny) {
  std::vector<AoSceneSetting> settings;
  for (const auto& [name, quality, mode] : settings_shown) {
    render::RenderSettings chosen;
    settings::apply_quality(quality, chosen);
    AoConfig config = chosen.ao;
    config.mode = mode;
    config.distance_m = static_cast<double>(reach_m);
    config.cache = fields;
    if (tiny) config.positions = config.directions = 64;
    settings.push_back({name, config});
  }
  return settings;
}

Expected<double> OurAoScene::compute(const BenchFrame& frame) {
  CostClock clock;
  if (auto done =
          ao_.compute(view_.scene, frame.geometry, frame.points, frame.normals, setting_.config, values_);
      !done)
    return tl::unexpected(done.error());
  return clock.ms();
}

Expected<void> OurAoScene::start() {
  const auto ms = compute(view_.before);
  if (!ms) return tl::unexpected(ms.error());
  first_ms_ = *ms;
  const auto warm = compute(view_.now);  // samples that this frame alone needs
  if (!warm) return tl::unexpected(warm.error());
  return {};
}

Expected<void> OurAoScene::run() {
  for (const BenchFrame* frame : {&view_.before, &view_.now}) {
    const auto ms = compute(*frame);
    if (!ms) return tl::unexpected(ms.error());
    if (frame == &view_.now) times_.push_back(*ms);
  }
  return {};
}

double OurAoScene::ms() const {
  return median(times_);
}

AoSceneResult OurAoScene::result(const AoSceneTruth& truth) const {
  return {scene_errors(values_, truth),           first_ms_, ms(), ao_.stats(),
          estimate_of(ao_, setting_.config.mode), values_};
}

}  // namespace tenebra::bench
