// The point solver in double throughout: what answers are checked against.
#include "support/soft_precision.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "support/precise_points.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"

#include "soft/solve/point_solver-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {

template class ClipSolver<OnePoint<double>>;  // the BSP solver's, too

std::unique_ptr<Solver> make_precise_points() {
  return std::make_unique<PointSolver<double>>();
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::soft {

std::unique_ptr<Solver> make_precise_point_solver(SimdLevel level) {
  return TENEBRA_DISPATCH(level, make_precise_points)();
}

}  // namespace tenebra::soft
#endif
