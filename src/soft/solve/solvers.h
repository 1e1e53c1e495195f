// The ways to find what the points of a group see of the light, each in a translation unit of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "soft/solve/pixel_writer.h"
#include "soft/solve/prepared_group.h"

namespace tenebra::soft {

/// Solves the points of a group, with buffers of its own.
class Solver {
public:
  virtual ~Solver() = default;

  /// Takes up a group, perhaps not all of it if frame.stop was requested: then solve() answers nothing.
  virtual void begin(const SoftFrame& frame, const PreparedGroup& group) = 0;
  /// Answers pixels of that group; some of them if frame.stop was requested.
  virtual void solve(const SoftFrame& frame, const PreparedGroup& group,
                     std::span<const std::uint32_t> pixels, PixelWriter& writer) = 0;
};

/// Point by point: occluders are clipped from the light, and then what the silhouette of meshes hides.
std::unique_ptr<Solver> make_point_solver(SimdLevel level);
/// Sixteen points together, where few occluders stand before them.
std::unique_ptr<Solver> make_packet_solver(SimdLevel level);
/// The paper's BSP of line classes.
std::unique_ptr<Solver> make_bsp_solver(SimdLevel level);

/// What a tracer solves its groups with.
struct SolverMakers {
  using Make = std::unique_ptr<Solver> (*)(SimdLevel);
  Make points = make_point_solver;
  Make packets = make_packet_solver;  ///< null: the point solver takes their groups, too
  Make bsp = make_bsp_solver;
};
inline constexpr SolverMakers own_solvers;

/// Points that nothing stands in front of: only a horizon may cut the light.
class LitSolver {
public:
  virtual ~LitSolver() = default;
  virtual void solve(const SoftFrame& frame, std::span<const std::span<const std::uint32_t>> groups,
                     PixelWriter& writer) = 0;
};
std::unique_ptr<LitSolver> make_lit_solver(SimdLevel level);

}  // namespace tenebra::soft
