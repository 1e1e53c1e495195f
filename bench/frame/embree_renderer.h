// The opponent of whole frames: the renderer that one would write on Embree. A tree over all triangles
// follows the animation; a square of 16x16 pixels at a time gets its primary rays and then the shadow rays of
// each light, in coherent packets; what is seen and what each light reaches is shaded by Tenebra's own vector
// code.
#pragma once

#include <memory>
#include <vector>

#include "bench/common/packet_tracer.h"
#include "io/image.h"
#include "shade/surfaces.h"

namespace tenebra::bench {

/// Milliseconds of a frame of the opponent.
struct EmbreeFrameTimes {
  double evaluate = 0, tree = 0;
  double primary = 0, shadows = 0;  ///< shares of the time of both, in a frame that is not measured otherwise
  double shade = 0;
  double total = 0;
};

/// What is drawn of a scene: its first clip, its first camera.
struct FrameTask {
  const Scene& scene;
  const shade::SurfaceTable& surfaces;
  int width, height;
  int threads;
};

class EmbreeRenderer {
public:
  /// `first`, `last`: frames between which vertices move, from which two-level trees know what stands still.
  EmbreeRenderer(const FrameTask& task, TreeKind kind, const PacketPlan& plan, int first, int last);

  /// A frame after the one before. `split`: primary and shadow rays are timed apart, which takes time itself.
  EmbreeFrameTimes draw(int frame, bool split = false);
  /// What the rays of the frame drawn last take by another plan, which is kept. Milliseconds.
  double retrace(const PacketPlan& plan);
  const io::Image8& image() const { return image_; }
  TreeKind kind() const { return kind_; }
  const PacketPlan& plan() const { return plan_; }
  const EmbreeTree& tree() const { return *tree_; }

private:
  struct Shares {
    double primary = 0, shadows = 0;
  };
  /// Ids and masks of the frame.
  void trace(std::vector<Shares>* shares);
  void trace_row(const TileGrid& grid, int row, std::span<const LightAim> lights, PacketTracer& tracer,
                 Shares* shares);

  const FrameTask task_;
  const TreeKind kind_;
  PacketPlan plan_;
  FrameGeometry geometry_;
  std::unique_ptr<EmbreeTree> tree_;
  ViewRays view_;
  std::vector<ShadowLight> lights_;
  float wide_m_ = 0;
  std::vector<std::uint32_t> ids_;
  std::vector<std::vector<std::uint8_t>> masks_;  // of each light
  io::Image8 image_;
};

}  // namespace tenebra::bench
