// Soft shadows and ambient occlusion of further samples: those of pixels' centres nearby, or their own.
#pragma once

#include <cstdint>
#include <vector>

#include "render/antialias/sample_picture.h"
#include "render/antialias/sample_stages.h"

namespace tenebra::render {

/// Soft shadows and occlusion vary slowly: a sample has those of the nearest pixel's centre, its own first,
/// that sees the same surface. Samples that no such centre is next to get their own, one for each surface of
/// a pixel.
class BorrowedLight {
public:
  /// Adds the light of all lights with an area, and the openness, to samples that have points.
  Expected<void> add(const SampleStages& stages, const SamplePicture& samples, LitSamples& at);

private:
  /// Fills `from_` and `own_slots_`.
  void choose(const SampleStages& stages, const SamplePicture& samples);
  void find_nearest_centres(const SampleStages& stages, const SamplePicture& samples);
  /// The value at a sample, of the centres' or of those that samples have for themselves.
  template <class Values>
  auto value(const Values& of_centres, const Values& own, std::size_t slot) const;
  template <class Values>
  void gather(const SamplePicture& samples, const Values& of_centres, Values& own, Values& out) const;

  LitSamples own_;
  std::vector<std::uint32_t> from_;  // by slot: pixel of the frame; or first_own + 1 + index in own_slots_
  std::vector<std::uint32_t> own_slots_;  // of samples with light of their own
};

}  // namespace tenebra::render
