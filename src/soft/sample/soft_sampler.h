// Soft shadows with an allowed error: where exact solving takes longer, pixels are sampled at places on the
// light by exact hard shadows, and at more of them until the estimated error is no larger, or each phase has
// 1,024 places.
#pragma once

#include <array>
#include <span>

#include <tenebra/frame_timings.h>
#include <tenebra/hard_shadows.h>
#include "soft/light/light_places.h"
#include "soft/sample/light_means.h"

namespace tenebra::soft {

/// Places on the light that pixels look at first, in each phase.
std::uint32_t first_places(double error_255);

/// The candidates of a group: all, and those of its middle (GroupDecision).
struct CandidateCounts {
  std::uint32_t all, from_middle;
};
/// Whether points of a group are sampled at this many places on the light, or solved exactly.
bool worth_sampling(const CandidateCounts& candidates, std::uint32_t places);

/// A frame, and what a unit of irradiance makes of light in the picture at each pixel; empty: 1.
struct ShownFrame {
  const SoftFrame& soft;
  std::span<const float> shown;

  /// Of what frame.out holds for the pixel.
  double light_at(std::uint32_t pixel) const {
    const auto irradiance = static_cast<double>(soft.out.irradiance[pixel]);
    return shown.empty() ? irradiance : irradiance * static_cast<double>(shown[pixel]);
  }
};

struct SampledGroup {
  std::uint32_t group;  ///< its number
  CandidateCounts candidates;
  std::span<const std::uint32_t> pixels;
};

/// The errors of the sampled pixels.
struct SampledErrors {
  std::vector<double> squares;       ///< of each block: sum over its pixels
  std::vector<std::uint32_t> count;  ///< of each block: pixels
  double square = 0;
  std::uint64_t pixels = 0, penumbra = 0;
};

/// Buffers kept from frame to frame.
class SoftSampler {
public:
  SoftSampler();

  /// Multiplies frame.soft.out of the groups' pixels, which hold the unoccluded light, by the visible shares,
  /// and adds to `stats`, which have the pixels that were solved exactly. Groups that would take longer this
  /// way than exactly are left alone: `left` gets their numbers. `errors_255`, one for each pixel, gets the
  /// estimated errors of the others, in 1/255 of white. The bits do not depend on the order of groups,
  /// threads or instruction set. Returns false if frame.soft.stop was requested.
  bool solve(const ShownFrame& frame, const AreaLight& light, std::span<const SampledGroup> groups,
             SoftStats& stats, std::vector<std::uint32_t>& left, std::span<float> errors_255);
  /// After a call: the sum of the squares of the pixels' estimated errors, in 1/255 of white.
  double square_error() const { return square_error_; }

private:
  bool look(const SoftFrame& frame, const LightPlaces& places, std::span<const std::uint32_t> chosen,
            std::uint32_t from, std::uint32_t to, SoftStats& stats);

  /// What one phase needs of its own: phases are traced side by side.
  struct Phase {
    ShadowTracer tracer;  ///< all phases' share one tree over the triangles
    ShadowMask mask;
    VisiblePoints points;
    std::uint64_t rays = 0;
    bool done = false;
  };
  void look(const SoftFrame& frame, const LightPlaces& places, std::span<const std::uint32_t> chosen,
            std::uint32_t phase, std::uint32_t from, std::uint32_t to);
  void leave(const ShownFrame& frame, double much, std::uint32_t places, std::vector<SampledGroup>& groups,
             std::vector<std::uint32_t>& left);
  void write_errors(const ShownFrame& frame, double unit, std::span<float> errors_255) const;
  void write(const SoftFrame& frame, SoftStats& stats) const;

  double square_error_ = 0;
  std::uint64_t left_penumbra_ = 0;  ///< pixels in penumbra of groups that were left
  std::array<Phase, phases> phases_;
  TriangleView triangles_;  ///< of the frame at hand, with a version of their own for the tracers
  SampledBlocks blocks_;
  LightTally tally_;
  LightMeans means_;
  SampledErrors errors_;
  std::vector<SampledGroup> sampled_;           ///< groups that are not left
  std::vector<std::uint32_t> pixels_, chosen_;  ///< of all groups; blocks that look again
  std::vector<float> values_;                   ///< of pixels, among which white is
};

}  // namespace tenebra::soft
