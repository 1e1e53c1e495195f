// Tenebra's ambient occlusion of a view at the settings of its presets, as a viewer or `render` would run it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tenebra/ambient_occlusion.h>
#include "bench/ao/scenes/ao_scene_errors.h"
#include "bench/ao/scenes/ao_scene_views.h"

namespace tenebra::bench {

struct AoSceneSetting {
  std::string name;  ///< of the preset; the default one is called "default"; "fields"
  AoConfig config;
};
/// Default, exact and fast, and displacement fields at the default's rays. `fields`: a folder that keeps what
/// is built. `tiny`: small tables.
std::vector<AoSceneSetting> scene_settings(float reach_m, const std::filesystem::path& fields, bool tiny);

struct AoSceneResult {
  AoSceneErrors errors;
  double first_ms = 0;                 ///< of the first frame, with what it had to build
  double ms = 0;                       ///< median of the later ones
  AoStats stats;                       ///< of a later one
  std::optional<double> estimate_255;  ///< the library's own estimate of its RMS error
  std::vector<float> values;           ///< one for each pixel
};

/// One setting on one view.
class OurAoScene {
public:
  OurAoScene(const AoSceneView& view, AoSceneSetting setting) : view_(view), setting_(std::move(setting)) {}

  /// The first frame of the animation: the one before the view's.
  Expected<void> start();
  /// The frame before, then the view's: its time counts. What moves has moved, and all that both frames need
  /// is there.
  Expected<void> run();
  AoSceneResult result(const AoSceneTruth& truth) const;
  const std::string& name() const { return setting_.name; }
  double ms() const;  ///< median so far
  double first_ms() const { return first_ms_; }

private:
  Expected<double> compute(const BenchFrame& frame);

  const AoSceneView& view_;
  AoSceneSetting setting_;
  AmbientOcclusion ao_;
  std::vector<float> values_;
  double first_ms_ = 0;
  std::vector<double> times_;
};

}  // namespace tenebra::bench
