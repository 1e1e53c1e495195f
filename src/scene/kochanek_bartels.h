// BART's key frames: Kochanek-Bartels splines through values, SQUAD with the same tangents through
// quaternions.
#pragma once

#include <span>

#include <tenebra/animation.h>

namespace tenebra::scene {

/// Position or scale. `out` has track.components values.
void evaluate_kochanek_bartels(const Track& track, double time_s, std::span<double> out);

/// Rotation (x, y, z, w), unit. The keys' quaternions are used as stored, unit or not.
void evaluate_kochanek_bartels_rotation(const Track& track, double time_s, std::span<double> out);

}  // namespace tenebra::scene
