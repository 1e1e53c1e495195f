// How much a body that keeps its shape hides itself: sampled over its surface as points are first seen, kept
// for good, interpolated. Serves what stands as well as what moves rigidly: neither ever changes for itself.
//
// Samples lie on the triangles (surface_layout.h), so nothing seeps through walls. A point is answered by the
// widest grid whose samples agree and see nothing near by its own measure; where even the finest disagree,
// the cell is divided. Samples that lie inside something (most rays see backs) and those in the open are
// never mixed. A sample depends on nothing but the shape and the reach, so what is interpolated does not
// depend on which frame or thread saw it first.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <tenebra/stop_flag.h>
#include "ao/surface/cell_numbers.h"
#include "ao/surface/surface_rays.h"

namespace tenebra::ao {

class SelfOcclusion {
public:
  /// Divided cells at most: some 40 MiB. Beyond, cells stay as they are, in the order of their first being
  /// seen: only then answers may depend on which frames came before.
  static constexpr std::size_t most_cells = std::size_t{1} << 19;

  /// `reach`: where occlusion has fallen off to nothing, in units of the shape. Keeps references to both.
  SelfOcclusion(const ObjectShape& shape, const TriangleBvh& casters, double reach,
                std::size_t cells = most_cells);

  enum class State {
    known,
    missing,  ///< samples have to be filled first; then finer ones may turn out to be missing
    mixed,    ///< between buried samples and open ones: rays have to answer the point itself
  };
  /// Hidden share of a point, 0..1, if known.
  struct Answer {
    State state;
    float occlusion;
  };
  /// Adds what the point lacks to `missing`.
  Answer find(const SurfacePoint& point, std::vector<std::uint64_t>& missing) const;
  /// By rays.
  float look(const SurfacePoint& point, const AoKernels& kernels) const {
    return rays_.look(point, kernels).occlusion;
  }

  /// Casts the rays of what is missing (ascending, unique). False if stopped.
  bool fill(std::span<const std::uint64_t> missing, const AoKernels& kernels,
            const std::function<void(double)>& progress, const StopFlag* stop);

  double reach() const { return reach_; }
  std::uint64_t filled() const { return filled_; }
  std::size_t cells() const { return cells_.keys().size(); }  ///< divided
  std::size_t bytes() const;

private:
  using Value = std::uint16_t;  ///< see self_occlusion.cpp

  /// A side of a small triangle: what its corners say, in one place.
  struct Side {
    enum Kind : std::uint16_t { unknown, corners, divided };
    Value values[3] = {};  ///< of the corners; divided: the first two are the cell's number
    std::uint16_t kind = unknown;
  };
  Answer find_small(const SurfacePoint& point, std::vector<std::uint64_t>& missing) const;
  Answer find_large(const SurfacePoint& point, std::vector<std::uint64_t>& missing) const;
  Answer find_in_cell(const SurfacePoint& point, std::uint32_t cell,
                      std::vector<std::uint64_t>& missing) const;
  bool cast(const std::vector<std::uint32_t>& samples, const AoKernels& kernels,
            const std::function<void(double)>& progress, const StopFlag* stop);
  bool add_cell(std::uint64_t key);
  void settle(std::uint64_t side);
  SurfacePoint place(std::uint32_t sample) const;

  double reach_;
  SurfaceLayout layout_;
  SurfaceRays rays_;
  std::size_t most_cells_;
  std::vector<Side> sides_;    ///< two per triangle; empty if all are large
  std::vector<Value> values_;  ///< of the layout's samples, then of divided cells
  CellNumbers cells_;          ///< divided ones, in the order of their values
  std::uint64_t filled_ = 0;
};

}  // namespace tenebra::ao
