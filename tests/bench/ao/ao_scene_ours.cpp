#include "bench/ao/ao_scene_ours.h"

#include "bench/ao/ao_race.h"
#include "bench/common/bench_report.h"
#include "render/quality.h"

namespace tenebra::bench {
namespace {

/// None is given yet. It is to be asked of the last call of compute().
std::optional<double> estimate_of(const AmbientOcclusion&) {
  return std::nullopt;
}

}  // namespace

std::vector<AoSceneSetting> scene_settings(float reach_m, const std::filesystem::path& fields, bool tiny) {
  using render::Quality;
  std::vector<AoSceneSetting> settings;
  for (const auto& [name, quality] : {std::pair{"default", Quality::balanced},
                                      std::pair{"exact", Quality::exact}, std::pair{"fast", Quality::fast}}) {
    render::RenderSettings chosen;
    render::apply_quality(quality, chosen);
    AoConfig config = chosen.ao;
    config.mode = AoMode::field;
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
  return {scene_errors(values_, truth), first_ms_, ms(), ao_.stats(), estimate_of(ao_), values_};
}

}  // namespace tenebra::bench
