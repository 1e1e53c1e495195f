#include "soft/solve/solvers.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "soft/solve/reference_solver.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"

#include "soft/solve/point_solver-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {

template class ClipSolver<OnePoint<double>>;  // the BSP solver's, too

std::unique_ptr<Solver> make_reference_points() {
  return std::make_unique<PointSolver<double>>();
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::soft {

std::unique_ptr<Solver> make_reference_solver(SimdLevel level) {
  return TENEBRA_DISPATCH(level, make_reference_points)();
}

}  // namespace tenebra::soft
#endif
