#include "soft/solve/solvers.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "soft/solve/packet_solver.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"

#include "soft/clip/packet_solver-inl.h"
#include "soft/solve/point_sight-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

class PacketGroupSolver final : public Solver {
public:
  explicit PacketGroupSolver(std::unique_ptr<Solver> alone) : alone_(std::move(alone)) {}

  void begin(const SoftFrame& frame, const PreparedGroup& group) override {
    receiver_.forget();
    packet_.reset(group.candidates, group.clipped, frame.stop);
    alone_is_ready_ = false;
  }

  void solve(const SoftFrame& frame, const PreparedGroup& group, std::span<const std::uint32_t> pixels,
             PixelWriter& writer) override {
    for (const std::uint32_t pixel : pixels) {
      receiver_.take_up(frame, pixel);
      const glm::dvec3& position = frame.points.positions[pixel];
      const bool in_front = glm::dot(frame.light.way_from(position), frame.light.normal) < 0;
      if (!(receiver_.above > 0) || !in_front) {
        writer.write(pixel, 0, 0, 0);
        continue;
      }
      pixels_[packet_.count()] = pixel;
      above_[packet_.count()] = receiver_.above;
      packet_.add(position, receiver_.normal_at(frame, pixel), receiver_.plane);
      if (packet_.full()) finish_packet(frame, group, writer);
    }
    finish_packet(frame, group, writer);
    finish_whole(frame, whole_, writer);
  }

private:
  void finish_packet(const SoftFrame& frame, const PreparedGroup& group, PixelWriter& writer) {
    if (packet_.count() == 0) return;
    if (stop_requested(frame.stop)) return packet_.clear();
    if (packet_.solve(frame.light, group.candidates.axes)) {
      for (std::size_t k = 0; k < packet_.count(); ++k) write(frame, k, writer);
      writer.stats().fragments += packet_.fragments();
    } else {
      if (!std::exchange(alone_is_ready_, true)) alone_->begin(frame, group);
      alone_->solve(frame, group, {pixels_, packet_.count()}, writer);
    }
    packet_.clear();
  }

  void write(const SoftFrame& frame, std::size_t k, PixelWriter& writer) {
    if (!packet_.sees_all(k))
      return writer.write(pixels_[k], packet_.area(k), packet_.irradiance(k), above_[k]);
    writer.count_solver(pixels_[k]);
    whole_.add(pixels_[k], packet_.to_origin(k), packet_.normal(k));
    if (whole_.full()) finish_whole(frame, whole_, writer);
  }

  PacketSolver packet_;
  std::uint32_t pixels_[packet_size] = {};
  double above_[packet_size] = {};  ///< area of the light above the receivers' planes
  std::unique_ptr<Solver> alone_;
  bool alone_is_ready_ = false;  ///< has taken up the group
  ReceiverSight<float> receiver_;
  WholePoints whole_;  ///< points put aside until there are eight
};

std::unique_ptr<Solver> make_packets(std::unique_ptr<Solver> alone) {
  return std::make_unique<PacketGroupSolver>(std::move(alone));
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::soft {

std::unique_ptr<Solver> make_packet_solver(SimdLevel level) {
  return TENEBRA_DISPATCH(level, make_packets)(make_point_solver(level));
}

}  // namespace tenebra::soft
#endif
