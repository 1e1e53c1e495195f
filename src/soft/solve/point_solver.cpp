#include "soft/solve/solvers.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "soft/solve/point_solver.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"

#include "soft/solve/point_solver-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {

template class ClipSolver<OnePoint<float>>;  // the BSP solver's, too

std::unique_ptr<Solver> make_points() {
  return std::make_unique<PointSolver<float>>();
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::soft {

std::unique_ptr<Solver> make_point_solver(SimdLevel level) {
  return TENEBRA_DISPATCH(level, make_points)();
}

}  // namespace tenebra::soft
#endif
