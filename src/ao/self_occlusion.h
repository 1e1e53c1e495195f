// How much a body that keeps its shape hides itself: sampled over its surface as points are first seen, kept
// for good, interpolated. Serves what stands as well as what moves rigidly: neither ever changes for itself.
//
// Samples lie on the triangles, so nothing seeps through walls: on a large triangle at the points of a grid
// of reach / 12, and of a quarter of that where something is near; on a small one at its corners, where
// corners at one place that face alike share a sample. Where those around a point disagree, its cell is
// divided further. Each is pulled a little into its triangle and answered by rays about its shading normal.
// Samples that lie inside something (most rays see backs) and those in the open are never mixed. A sample
// depends on nothing but the shape and the reach, so what is interpolated does not depend on which frame or
// thread saw it first.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "ao/ao_kernels.h"
#include "ao/scene_objects.h"
#include "parallel/stop_flag.h"

namespace tenebra {

/// How far off the surface rays start: beyond the rounding to float of the point, and of the corners of two
/// triangles that touch (each at most sqrt(3)/2 ulp of its largest coordinate; one ulp more for the sums).
float surface_lift(double largest_coordinate);
double largest_coordinate(const ObjectShape& shape);

/// A point of a shape's surface.
struct SurfacePoint {
  std::uint32_t triangle = 0;
  float v = 0, w = 0;  ///< barycentric weights of the second and third corner
  bool front = true;   ///< seen from where the triangle runs counter-clockwise
};

class SelfOcclusion {
public:
  static constexpr int sample_rays = 256;
  static constexpr std::size_t most_samples = std::size_t{1} << 24;  ///< two sides each; 64 MiB of values

  /// `reach`: where occlusion has fallen off to nothing, in units of the shape. Keeps references to both.
  SelfOcclusion(const ObjectShape& shape, const TriangleBvh& casters, double reach);

  /// Three samples around a point and their weights, which add up to 1.
  struct Blend {
    std::uint32_t samples[3];
    float weights[3];
  };

  /// The samples that answer the point. Adds what it lacks to `missing`: if there is any, it has to be
  /// asked again when they are filled, for what they see decides whether finer ones are needed.
  Blend find_samples(const SurfacePoint& point, std::vector<std::uint64_t>& missing) const;
  /// Hidden share, 0..1, by the point's samples, all known. Where some are buried and some are not, rays
  /// answer the point itself.
  float occlusion(const SurfacePoint& point, const Blend& samples, const AoKernels& kernels) const;

  /// Casts the rays of what is missing (ascending, unique). False if stopped.
  bool fill(std::span<const std::uint64_t> missing, const AoKernels& kernels,
            const std::function<void(double)>& progress, const StopFlag* stop);

  double reach() const { return reach_; }
  std::uint64_t filled() const { return filled_; }
  std::size_t bytes() const;

private:
  /// What rays from a point have found.
  struct Seen {
    float occlusion = 0;
    bool near = false;    ///< something stands close: samples have to be closer too
    bool buried = false;  ///< most rays see the back of something
  };
  void lay_grids();
  void weld_corners();
  std::uint64_t corner_key(std::uint32_t triangle, int corner) const;
  /// A triangle between neighbouring points of a grid, and where a point lies in it.
  struct GridCell {
    std::uint32_t i[3], j[3];
    float weights[3];
    bool upper;
  };
  static GridCell grid_cell(float v, float w, std::uint32_t count);
  /// On every `stride`th point of the triangle's grid.
  Blend blend(const SurfacePoint& point, std::uint32_t stride) const;
  bool is_rough(const Blend& blend) const;
  bool are_mixed(const Blend& blend) const;
  bool disagree(const Blend& blend) const;
  bool lacks(const Blend& blend, std::vector<std::uint64_t>& missing) const;
  std::uint64_t patch_key(const SurfacePoint& point) const;
  void add_patch(std::uint64_t key);
  SurfacePoint place_in_patch(std::uint32_t sample) const;
  SurfacePoint place(std::uint32_t sample) const;
  Seen look(const SurfacePoint& point, const AoKernels& kernels) const;

  const ObjectShape& shape_;
  const TriangleBvh& casters_;
  double reach_;
  double spacing_;  ///< of the wide grids
  float lift_;      ///< off the surface: more than the rounding of points and corners
  RayPattern pattern_, grazing_;

  /// A triangle's samples: from `first` on if it has a grid of `steps` > 1 (fine) steps along a side, else
  /// three entries of corners_ from 3 x first on.
  struct Grid {
    std::uint32_t first = 0;
    std::uint32_t steps = 1;
  };
  std::vector<Grid> grids_;             ///< one a triangle
  std::vector<std::uint32_t> corners_;  ///< shared samples of small triangles' corners
  std::vector<std::uint32_t> shared_;   ///< shared sample -> triangle * 3 + corner
  std::vector<std::uint32_t> large_;    ///< triangles with grids, by ascending first sample
  std::vector<std::uint16_t> values_;   ///< two a sample: front, back; see self_occlusion.cpp
  std::size_t in_patches_ = 0;          ///< from this value on they belong to patches
  std::vector<std::uint64_t> patches_;  ///< divided cells by their keys, in the order of their values
  std::unordered_map<std::uint64_t, std::uint32_t> patch_at_;  ///< key -> index of the first value
  std::uint64_t filled_ = 0;
};

}  // namespace tenebra
