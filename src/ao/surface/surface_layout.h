// Where on a body's surface its own occlusion is sampled.
//
// On a large triangle the samples are the points of three grids, of reach / 12 and a half and a quarter of
// that (of two, where one wide step is longer than the triangle); on a small one its corners. Corners at one
// place that face alike share a sample, and so do grids where they meet. The finest cell of a grid, or a
// small triangle, can be divided once more. Samples are pulled a little into their triangles, clear of what
// touches them at edges and corners.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include <tenebra/stop_flag.h>
#include "ao/objects/surface_point.h"

namespace tenebra::ao {

/// Three samples around a point and their weights, which add up to 1.
struct SampleTriple {
  std::uint32_t at[3];
  float weights[3];
};

class SurfaceLayout {
public:
  static constexpr int most_levels = 3;                             ///< of the grids: wide, half, fine
  static constexpr std::size_t most_places = std::size_t{1} << 24;  ///< two samples each, front and back
  static constexpr std::uint32_t cell_samples = 15;                 ///< of a divided cell

  /// `reach`: where occlusion has fallen off to nothing, in units of the shape. Keeps a reference to it. Of
  /// no use if `stop` was requested.
  SurfaceLayout(const ObjectShape& shape, double reach, const StopFlag* stop = nullptr);

  std::size_t samples() const { return 2 * places_; }
  double spacing() const { return spacing_; }  ///< of the wide grids
  bool is_small(std::uint32_t triangle) const { return grids_[triangle].steps == 1; }
  int levels(std::uint32_t triangle) const;  ///< of a large one
  /// Corners of a small triangle.
  SampleTriple corners(const SurfacePoint& point) const;
  /// Points of a large triangle's grid. Defined in surface_layout_inline.h.
  SampleTriple around(const SurfacePoint& point, int level) const;
  SurfacePoint place(std::uint32_t sample) const;
  /// The one sample that stands for all at its place: a corner's, or that of the widest grid which has it.
  std::uint32_t shared(std::uint32_t sample) const;

  /// Names the finest cell around the point.
  std::uint64_t cell_key(const SurfacePoint& point) const;
  /// Samples of the divided cell, from 0 on.
  SampleTriple in_cell(const SurfacePoint& point) const;
  SurfacePoint place_in_cell(std::uint64_t key, std::uint32_t sample) const;

  std::size_t bytes() const;

private:
  struct Grid {
    std::uint32_t first = 0;  ///< place
    std::uint32_t steps = 1;  ///< fine ones along a side; 1: small
  };
  /// A triangle between neighbouring points of a grid, and where a point lies in it.
  struct Cell {
    std::uint32_t i[3], j[3];
    float weights[3];
    bool upper;
  };
  static Cell cell(float v, float w, std::uint32_t steps);
  std::uint32_t triangle_at(std::uint32_t place) const;
  void lay_grids(const StopFlag* stop);
  void weld_corners(const StopFlag* stop);

  const ObjectShape& shape_;
  double spacing_;
  std::size_t places_ = 0;
  std::vector<Grid> grids_;             ///< one per triangle
  std::vector<std::uint32_t> corners_;  ///< places of all triangles' corners
  std::vector<std::uint32_t> shared_;   ///< place -> triangle * 3 + corner
  std::vector<std::uint32_t> large_;    ///< triangles with grids, by ascending first place
};

}  // namespace tenebra::ao
