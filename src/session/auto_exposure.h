// One exposure for all pictures of a scene.
#pragma once

#include "session/staged_scene.h"

namespace tenebra::session {

/// How bright a scene's pictures are.
struct Meter {
  std::array<int, shade::tones.size()> steps{};  ///< of exposure, eighths of a doubling, by tone
  /// Whether an exposure of 1 shows the scene well, in its own tone: in no picture more than one pixel in
  /// twenty is above 0.95, and not in all of them more than half are below 0.01.
  bool one_will_do = true;

  /// 2^(k/8) for each tone, the same floats on every machine; of `fewer` steps less.
  settings::AutoExposures exposures(int fewer = 0) const;
};

/// For each tone the largest of the exposures 2^(k/8), from 2^-12 to 2^6, with which at most one pixel of a
/// hundred shows a channel above 0.76, what the neutral tone leaves as it is. Measured in small pictures with
/// hard shadows of all lights (soft ones where emissive meshes are lights, which then do not count
/// themselves), at nine times spread evenly over the whole clip, by the camera of the settings; the brightest
/// one decides. So it is a function of the scene with its edits and surroundings, the clip, the camera and
/// the picture's shape alone: it is the same for every frame, in every part of a render, with every method,
/// on every machine. 1 where nothing is seen.
Expected<Meter> meter(const StagedScene& staged, const settings::SceneSettings& settings);

/// Its exposures: those that --exposure auto stands for after edits. Where a grey sky was added beside lamps,
/// stage_scene measures without it and takes two steps off instead: both differ by two steps at most.
Expected<settings::AutoExposures> meter_exposures(const StagedScene& staged,
                                                  const settings::SceneSettings& settings);

}  // namespace tenebra::session
