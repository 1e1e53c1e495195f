// Embree as the opponent of whole frames: the same visible points, the same reach, the same way from half
// resolution to full.
#pragma once

#include <memory>

#include "ao/receivers/receiver_sets.h"
#include "bench/ao/ao_peer.h"
#include "bench/common/bench_frame.h"

namespace tenebra::bench {

/// Openness at some pixels, by many rays.
struct SampledTruth {
  std::vector<std::size_t> pixels;
  std::vector<float> open;
  /// Of a whole frame's values, in 1/255.
  double rms_255(std::span<const float> frame) const;
};

/// How Embree traces.
enum class PeerMode { single_rays, packets };

class FramePeer {
public:
  /// Refers to `frame`. Faces have to be flat: rays start just off them.
  FramePeer(const Scene& scene, const BenchFrame& frame, float reach_m);

  /// One visible pixel in each square of `stride`, at a place of its own.
  SampledTruth truth(int rays, int stride) const;
  /// A frame with values at `pixels` only, and 1 elsewhere.
  std::vector<float> at(std::span<const std::size_t> pixels, int rays) const;
  /// A whole frame; downscale 2: at half resolution, blurred by the field's own code.
  std::vector<float> frame(int rays, int downscale, PeerMode mode = PeerMode::packets) const;

  /// Time of a frame in milliseconds without the step to full resolution: of one in `part` tiles, times
  /// `part`.
  double trace_ms(int rays, int downscale, PeerMode mode, int part) const;
  /// Time of the step from half resolution to full.
  double spread_ms() const;
  double build_ms() const { return peer_.build_ms(); }

private:
  struct Grid;
  void tile(const Grid& grid, int number, const CosineRays& rays, const Tracer& tracer,
            std::span<float> values) const;
  Tracer tracer(PeerMode mode) const;

  const BenchFrame& frame_;
  float reach_;
  ao::SceneObjects objects_;
  ao::AoFrame input_;
  AoPeer peer_;
};

}  // namespace tenebra::bench
