// Exact soft shadows in double throughout, for tests and measurements that need more than the library's own
// 0.1/255.
#pragma once

#include <tenebra/soft_shadows.h>
#include "soft/solve/solvers.h"

namespace tenebra::soft {

std::unique_ptr<Solver> make_precise_point_solver(SimdLevel level);
std::unique_ptr<Solver> make_precise_bsp_solver(SimdLevel level);

/// Their fractions err by at most 1e-6, or 2^-48 of the distance over the light's size if that is more.
inline constexpr SolverMakers precise_solvers{make_precise_point_solver, nullptr, make_precise_bsp_solver};

}  // namespace tenebra::soft

namespace tenebra::testing {

/// fast: as the library cuts polygons on the light, in float. reference: in double.
enum class SoftPrecision { fast, reference };

inline SoftShadowTracer soft_tracer(SoftPrecision precision) {
  return SoftShadowTracer(precision == SoftPrecision::fast ? soft::own_solvers : soft::precise_solvers);
}

}  // namespace tenebra::testing
