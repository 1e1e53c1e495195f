#include "soft/solve/solvers.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "soft/solve/bsp_solver.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"

#include "soft/solve/bsp_solver-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {

extern template class ClipSolver<OnePoint<float>>;  // point_solver.cpp

std::unique_ptr<Solver> make_bsp() {
  return std::make_unique<BspSolver<float>>();
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::soft {

std::unique_ptr<Solver> make_bsp_solver(SimdLevel level) {
  return TENEBRA_DISPATCH(level, make_bsp)();
}

}  // namespace tenebra::soft
#endif
