// How much a body that keeps its shape hides itself: sampled over its surface as points are first seen, kept
// as long as there is room, interpolated. Serves static geometry as well as rigidly moving objects: the
// samples of neither ever change.
//
// Samples lie on the triangles (surface_layout.h), so nothing seeps through walls. A point takes the widest
// grid whose samples agree and see nothing closer than one and a half of its steps; where even the finest
// disagree, the cell is divided. Samples that lie inside something (most rays see backs) and those in the
// open are never mixed. A sample depends on nothing but the shape and the reach, so what is interpolated does
// not depend on which frame, thread or process saw it first.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <tenebra/stop_flag.h>
#include "ao/cache/memory_budget.h"
#include "ao/surface/cell_numbers.h"
#include "ao/surface/surface_rays.h"

namespace tenebra::ao {

/// What is known of a body, to be kept on disk.
struct SurfaceSamples {
  static constexpr std::uint16_t unknown = 0xffff;
  struct Run {
    std::uint32_t first = 0, count = 0;  ///< of the layout's samples
  };
  std::vector<Run> runs;                   ///< of those that are known, ascending
  std::vector<std::uint16_t> values;       ///< of theirs, one after the other; see self_occlusion.cpp
  std::vector<std::uint64_t> cells;        ///< keys of divided ones
  std::vector<std::uint16_t> cell_values;  ///< of their samples, in this order

  /// `all`: of the layout's samples, known or not.
  void set_values(std::span<const std::uint16_t> all);
};

class SelfOcclusion {
public:
  /// The most divided cells: some 35 MiB. Where there is room for no more, rays are cast.
  static constexpr std::size_t most_cells = std::size_t{1} << 19;

  /// `reach`: where occlusion has fallen off to nothing, in units of the shape. Keeps references to all.
  /// Without samples until lay() is called.
  SelfOcclusion(const ObjectShape& shape, const trees::TriangleBvh& casters, double reach,
                std::size_t cells = most_cells, MemoryBudget* budget = nullptr);

  /// The part of lay() that takes time, and nothing of the budget: for many bodies at once.
  void prepare(const StopFlag* stop = nullptr);
  /// Makes room for samples, if there is none. False: the budget refuses, and rays answer all; or a stop was
  /// requested, and nothing has changed.
  bool lay(const StopFlag* stop = nullptr);
  bool laid() const { return layout_.has_value(); }
  bool ready() const { return laid() || refused_; }
  /// Gives the room back, with all that is known.
  void drop();
  /// What was refused may be asked for once more.
  void begin_frame() { refused_ = full_ = false; }

  enum class State {
    known,
    missing,  ///< samples have to be filled first; then finer ones may turn out to be missing
    mixed,    ///< between buried samples and open ones, or no room: rays have to answer the point itself
  };
  /// Hidden share of a point, 0..1, if known.
  struct Answer {
    State state;
    float occlusion;
  };
  /// Adds what the point lacks to `missing`.
  Answer find(const SurfacePoint& point, std::vector<std::uint64_t>& missing) const;
  /// By rays.
  float look(const SurfacePoint& point, const RayKernels& kernels) const {
    return rays_.look(point, kernels).occlusion;
  }

  /// Casts the rays of what is missing (ascending, unique). False if stopped.
  bool fill(std::span<const std::uint64_t> missing, const RayKernels& kernels,
            const std::function<void(double)>& progress, const StopFlag* stop);

  SurfaceSamples samples() const;
  /// Adds the samples of `others`, of the same shape and reach, to a body that is laid; of their divided
  /// cells at most half as many as may be divided, and as many as have room.
  void learn(const SurfaceSamples& others);

  double reach() const { return reach_; }
  std::size_t layout_samples() const { return values_.size(); }  ///< known or not
  std::uint64_t filled() const { return filled_; }               ///< samples that rays were cast for
  std::uint64_t known() const { return known_; }                 ///< samples in memory
  std::size_t cells() const { return cells_.keys().size(); }     ///< divided
  std::size_t bytes() const { return share_.bytes(); }           ///< taken of the budget
  std::size_t held_bytes() const;  ///< of all lists, with the room that they have left

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
  bool cast(const std::vector<std::uint32_t>& samples, const RayKernels& kernels,
            const std::function<void(double)>& progress, const StopFlag* stop);

  bool make_room(const StopFlag* stop);
  Value& value(std::uint32_t sample);
  /// What a cell is for: the frame, or what others knew.
  enum class Cell { needed, learned };
  bool add_cell(std::uint64_t key, Cell cell);
  bool grow_cells(Cell cell);
  void settle(std::uint64_t side, bool may_divide);
  SurfacePoint place(std::uint32_t sample) const;

  const ObjectShape& shape_;
  double reach_;
  SurfaceRays rays_;
  std::optional<SurfaceLayout> prepared_;
  std::size_t most_cells_;
  MemoryShare share_;
  std::size_t sides_needed_ = 0;
  std::size_t needed_bytes_ = 0;         ///< of what lay() makes; 0: not known yet
  bool refused_ = false;                 ///< no room for samples, in this frame
  bool full_ = false;                    ///< no room for more cells, in this frame
  std::optional<SurfaceLayout> layout_;  ///< none: no samples
  std::vector<Side> sides_;              ///< two per triangle; empty if all are large
  std::vector<Value> values_;            ///< of the layout's samples
  CellNumbers cells_;                    ///< divided ones
  std::vector<Value> cell_values_;       ///< of theirs, in the order of their numbers
  std::uint64_t filled_ = 0, known_ = 0;
};

}  // namespace tenebra::ao
