#include "soft/solve/solvers.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "soft/solve/lit_solver.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include <algorithm>

#include "simd/dispatch.h"
#include "soft/solve/point_sight-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

class LitPoints final : public LitSolver {
public:
  void solve(const SoftFrame& frame, std::span<const std::span<const std::uint32_t>> groups,
             PixelWriter& writer) override {
    receiver_.forget();
    for (const auto& pixels : groups)
      for (const std::uint32_t pixel : pixels) solve_point(frame, pixel, writer);
    finish(frame, writer);
  }

private:
  void solve_point(const SoftFrame& frame, std::uint32_t pixel, PixelWriter& writer) {
    receiver_.take_up(frame, pixel);
    if (receiver_.above > 0 && !receiver_.plane.cuts_light) {
      whole_.add(pixel, frame.light.way_from(frame.points.positions[pixel]),
                 receiver_.normal_at(frame, pixel));
      if (whole_.full()) finish(frame, writer);
    } else {
      solve_cut(frame, pixel, writer);
    }
  }

  /// A horizon may cut the light, or all of it is behind one.
  HWY_NOINLINE void solve_cut(const SoftFrame& frame, std::uint32_t pixel, PixelWriter& writer) {
    receiver_.take_up(frame, pixel);
    const PointSight sight = sight_of(frame, receiver_, pixel);
    visible_.clear();
    if (sight.above > 0)
      for (std::size_t i = 0; i < receiver_.light.size(); ++i)
        visible_.fragments.push(loaded(receiver_.light[i]));
    visible_.integrate(frame, sight, writer);
    if (sight.above > 0) frame.classes[pixel] = static_cast<std::uint8_t>(SoftClass::lit);
  }

  void finish(const SoftFrame& frame, PixelWriter& writer) {
    const std::size_t count = whole_.count;
    std::uint32_t pixels[8];
    std::copy_n(whole_.pixels, count, pixels);
    const std::uint32_t seen = finish_whole(frame, whole_, writer);
    for (std::size_t k = 0; k < count; ++k) {
      if ((seen >> k & 1u) != 0) {
        frame.classes[pixels[k]] = static_cast<std::uint8_t>(SoftClass::lit);
      } else {
        solve_cut(frame, pixels[k], writer);
      }
    }
  }

  ReceiverSight<double> receiver_;
  VisibleLight<double> visible_;
  WholePoints whole_;  ///< points put aside until there are eight
};

std::unique_ptr<LitSolver> make_lit() {
  return std::make_unique<LitPoints>();
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::soft {

std::unique_ptr<LitSolver> make_lit_solver(SimdLevel level) {
  return TENEBRA_DISPATCH(level, make_lit)();
}

}  // namespace tenebra::soft
#endif
