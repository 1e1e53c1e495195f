// The BSP solver in double throughout.
#include "support/soft_precision.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "support/precise_bsp.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"

#include "soft/solve/bsp_solver-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {

extern template class ClipSolver<OnePoint<double>>;  // precise_points.cpp

std::unique_ptr<Solver> make_precise_bsp() {
  return std::make_unique<BspSolver<double>>();
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::soft {

std::unique_ptr<Solver> make_precise_bsp_solver(SimdLevel level) {
  return TENEBRA_DISPATCH(level, make_precise_bsp)();
}

}  // namespace tenebra::soft
#endif
