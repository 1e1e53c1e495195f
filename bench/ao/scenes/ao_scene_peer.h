// The opponent: what you would write with Embree to get the ambient occlusion of a frame. Rays of a shifted
// lattice in coherent packets, at every pixel or one of four; a filter over normals and planes that removes
// their noise; and the step from half resolution to full.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "bench/ao/scenes/ao_scene_tracer.h"

namespace tenebra::bench {

/// How traced values are processed.
struct PeerVariant {
  int step = 1;    ///< 2: one of 2x2 pixels is traced
  int passes = 0;  ///< of the filter, each with twice the step of the one before; at most 3
  bool converges() const { return step == 1 && passes == 0; }
};
inline constexpr std::array peer_variants{PeerVariant{1, 0}, PeerVariant{1, 1}, PeerVariant{1, 2},
                                          PeerVariant{1, 3}, PeerVariant{2, 0}, PeerVariant{2, 1},
                                          PeerVariant{2, 2}, PeerVariant{2, 3}};
/// Where the filter's weights vanish; in units that make one choice serve all views. Of 29 choices tried with
/// 1, 4 and 16 rays on robots 100, city 150 and kitchen 100 those that left the least error, but for single
/// passes of 1 ray.
struct PeerFilter {
  float plane = 0.01f;                     ///< distance from the pixel's plane, in reaches
  float distance = 0.3f;                   ///< distance in space, in reaches
  float bend = 0.15f;                      ///< 1 - cosine between normals
  float tap[3] = {1, 2.0f / 3, 1.0f / 6};  ///< of a cubic B-spline
};
std::string peer_variant_name(const PeerVariant& variant);  ///< "half, 1 pass"

class AoScenePeer {
public:
  /// Width and height are even.
  explicit AoScenePeer(const AoSceneView& view, const PeerFilter& filter = {});
  void set_filter(const PeerFilter& filter);

  /// Times in milliseconds. The tree follows what moved since the frame before.
  double follow_ms() { return tracer_->follow_ms(); }
  /// Traces one of step x step pixels.
  double trace_ms(int rays, int step);
  /// From what was traced last with `variant.step` to a picture.
  double finish_ms(const PeerVariant& variant);
  /// The picture that was finished last, one value per pixel.
  std::vector<float> picture() const;

  /// What Embree is told of the packets' coherence, and which of the two is the faster with so many rays.
  void set_order(ao::EmbreeQuery::Rays order) { tracer_->set_order(order); }
  ao::EmbreeQuery::Rays faster_order(int rays);
  const char* tree() const { return tree_name(kind_); }

private:
  /// One resolution.
  struct Level {
    PixelGrid grid;
    PixelPlanes planes;
    std::vector<float> traced, filtered[3];
    Level(const BenchFrame& frame, int step, glm::ivec2 first);
    float* values() { return traced.data(); }
  };
  const float* filter(Level& level, int passes);
  void join(const float* half);
  void join_class(int number, const float* half);

  const AoSceneView& view_;
  TreeKind kind_ = TreeKind::high;
  std::unique_ptr<AoSceneTracer> tracer_;
  AoSceneKernels kernels_ = ao_scene_kernels();
  AoFilterWeights weights_;
  Level full_, half_;
  std::vector<PixelPlanes> rest_;                ///< the three pixels of four that half resolution leaves out
  std::vector<std::vector<float>> joined_;       ///< their values
  std::vector<std::vector<std::size_t>> alone_;  ///< by row: pixels without a neighbour like them
  std::unique_ptr<AoScenePattern> pattern_;      ///< of the rays traced last
  AoScenePattern enough_;                        ///< for pixels that no filter cleans
  const float* finished_ = nullptr;              ///< at full resolution, as full_ lies; null: in open_
  std::vector<float> open_;                      ///< one for each pixel
};

}  // namespace tenebra::bench
