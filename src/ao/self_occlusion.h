// How much a body that keeps its shape hides itself: sampled over its surface as points are first seen, kept
// for good, interpolated. Serves what stands as well as what moves rigidly: neither ever changes for itself.
//
// Samples lie on the triangles, so nothing seeps through walls: on a large triangle at the points of a
// triangular grid of a sixteenth of the reach, on a small one at its corners, where corners that lie within
// half of that and face alike share a sample. Each is pulled a little into its triangle and answered by
// `sample_rays` rays about its shading normal. A sample depends on nothing but the shape and the reach, so
// what is interpolated does not depend on which frame or thread saw it first.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "ao/ao_kernels.h"
#include "ao/objects.h"
#include "parallel/stop_flag.h"

namespace tenebra {

/// How far off the surface rays start: beyond the rounding to float of the point, and of the corners of two
/// triangles that touch (each at most sqrt(3)/2 ulp of its largest coordinate; one ulp more for the sums).
float surface_lift(double largest_coordinate);
double largest_coordinate(const ObjectShape& shape);

class SelfOcclusion {
public:
  static constexpr int sample_rays = 256;
  static constexpr std::size_t most_samples = std::size_t{1} << 24;  ///< two sides each; 64 MiB of values

  /// Three samples and their weights, which add up to 1.
  struct Blend {
    std::uint32_t samples[3];
    float weights[3];
  };

  /// `reach`: where occlusion has fallen off to nothing, in units of the shape. Keeps references to both.
  SelfOcclusion(const ObjectShape& shape, const TriangleBvh& casters, double reach);

  /// At barycentric weights v, w of the second and third corner; `front`: the side from which the triangle
  /// runs counter-clockwise.
  Blend blend(std::uint32_t triangle, float v, float w, bool front) const;
  bool known(std::uint32_t sample) const;
  float occlusion(const Blend& blend) const;  ///< 0..1; all samples must be known

  /// Casts the rays of samples (unique). False if stopped.
  bool fill(std::span<const std::uint32_t> samples, const AoKernels& kernels,
            const std::function<void(double)>& progress, const StopFlag* stop);

  double reach() const { return reach_; }
  std::uint64_t filled() const { return filled_; }
  std::size_t bytes() const;

private:
  /// Where a sample lies.
  struct Place {
    std::uint32_t triangle;
    float v, w;
    bool front;
  };
  void lay_grids(double spacing);
  void weld_corners(double cell);
  std::uint64_t corner_key(std::uint32_t triangle, int corner, double cell) const;
  Place place(std::uint32_t sample) const;
  float cast(const Place& place, const AoKernels& kernels) const;

  const ObjectShape& shape_;
  const TriangleBvh& casters_;
  double reach_;
  float lift_;  ///< off the surface: more than the rounding of points and corners
  RayPattern pattern_;

  /// A triangle's samples: from `first` on if it has a grid of `steps` > 1 steps along a side, else three
  /// entries of corners_ from 3 x first on.
  struct Grid {
    std::uint32_t first = 0;
    std::uint32_t steps = 1;
  };
  std::vector<Grid> grids_;             ///< one a triangle
  std::vector<std::uint32_t> corners_;  ///< shared samples of small triangles' corners
  std::vector<std::uint32_t> shared_;   ///< shared sample -> triangle * 3 + corner
  std::vector<std::uint32_t> large_;    ///< triangles with grids, by ascending first sample
  std::vector<std::uint16_t> values_;   ///< two a sample: front, back; `unknown` or 0..65534
  std::uint64_t filled_ = 0;
};

}  // namespace tenebra
