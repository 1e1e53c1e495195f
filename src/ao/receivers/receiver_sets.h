// Where ambient occlusion is computed: at all pixels, at one of N x N, or at the vertices of visible
// triangles; and how the pixels get their values from there.
#pragma once

#include <span>
#include <vector>

#include <tenebra/visible_points.h>
#include "ao/receivers/receivers.h"

namespace tenebra::ao {

/// The input of a frame.
struct AoFrame {
  const FrameGeometry& geometry;
  const VisiblePoints& points;
  std::span<const glm::vec3> normals;
  const SceneObjects& objects;
};

/// Receivers in small groups of neighbours. Each has an index below `values()` for its result.
class ReceiverSet {
public:
  virtual ~ReceiverSet() = default;
  virtual int groups() const = 0;
  virtual std::size_t values() const = 0;
  virtual void receivers(int group, std::vector<Receiver>& out) const = 0;
  /// One per pixel from one per receiver; 1 where there is no receiver.
  virtual void spread(std::span<const float> values, std::span<float> pixels) const = 0;
};

/// Every pixel, or with `step` > 1 one of step x step, in tiles of 16 x 16.
class PixelReceivers : public ReceiverSet {
public:
  PixelReceivers(const AoFrame& frame, int step, float reach);
  int groups() const override { return columns_ * rows_; }
  std::size_t values() const override {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }
  void receivers(int group, std::vector<Receiver>& out) const override;
  void spread(std::span<const float> values, std::span<float> pixels) const override;

private:
  std::size_t pixel(int x, int y) const;  ///< the one that stands for a coarse one
  float blurred(std::span<const float> values, int x, int y) const;

  AoFrame frame_;
  int step_, width_, height_, columns_, rows_;
  float reach_;
};

/// The corners of visible triangles, as in the paper. Vertices with a normal of their own are shared.
class VertexReceivers : public ReceiverSet {
public:
  explicit VertexReceivers(const AoFrame& frame);
  int groups() const override { return static_cast<int>((vertices_.size() + group_size - 1) / group_size); }
  std::size_t values() const override { return vertices_.size(); }
  void receivers(int group, std::vector<Receiver>& out) const override;
  void spread(std::span<const float> values, std::span<float> pixels) const override;

private:
  static constexpr std::size_t group_size = 128;
  struct Vertex {
    std::uint32_t triangle;
    std::uint32_t corner;
    glm::vec3 normal;
  };
  struct Corners3 {
    std::uint32_t index[3];
  };
  glm::vec3 corner_normal(std::uint32_t triangle, std::uint32_t corner, const glm::vec3& seen) const;

  AoFrame frame_;
  std::vector<Vertex> vertices_;
  std::vector<std::uint32_t> slots_;  ///< triangle id -> its place in corners_, or no_triangle
  std::vector<Corners3> corners_;
};

}  // namespace tenebra::ao
