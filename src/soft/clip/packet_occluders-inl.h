// Occluders as sixteen points of a group see them at once, one point in each lane, and their subtraction from
// the fragments of all these points together. Included once per target.
#if defined(TENEBRA_SOFT_PACKET_OCCLUDERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_PACKET_OCCLUDERS_INL_H_
#undef TENEBRA_SOFT_PACKET_OCCLUDERS_INL_H_
#else
#define TENEBRA_SOFT_PACKET_OCCLUDERS_INL_H_
#endif

#include <vector>

#include "soft/clip/packet_parts-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// Up to four lines in each lane that bound a convex shadow, positive inside.
struct alignas(64) PacketShadow {
  int line_count = 0;
  PacketLine lines[4];
  Float16 sides[4];  ///< of a box around it, as in BlockBoxes
};

/// The boxes around an occluder's shadow, grown corner by corner.
class PacketBox {
public:
  explicit PacketBox(const PacketPoints& at)
      : reach_(load<Wide>(at.reach)), from_{load<Wide>(at.in_light[0]), load<Wide>(at.in_light[1])} {}

  /// `way`: from the points to a corner.
  SIMD_INLINE void add(const Pack3<Wide>& way) {
    const Wide zero = wide(0);
    lowest_ = min(lowest_, way.z);
    const Wide t = reach_ / select(lt(zero, way.z), way.z, wide(1));
    const Wide seen[2] = {from_[0] + way.x * t, from_[1] + way.y * t};
    for (int axis = 0; axis < 2; ++axis) {
      low_[axis] = min(low_[axis], seen[axis]);
      high_[axis] = max(high_[axis], seen[axis]);
    }
  }
  SIMD_INLINE void store(Float16 (&sides)[4]) const {
    for (int axis = 0; axis < 2; ++axis) {
      const ShadowSides side = bounded_sides(lt(wide(0), lowest_), low_[axis], high_[axis]);
      sides[2 * axis] = narrowed<float>(side.low), sides[2 * axis + 1] = narrowed<float>(side.minus_high);
    }
  }

private:
  Wide reach_, from_[2];
  Wide lowest_ = wide(1e30);
  Wide low_[2] = {wide(1e30), wide(1e30)}, high_[2] = {wide(-1e30), wide(-1e30)};
};

class PacketOccluders : public OccluderList<float, PointRange> {
public:
  /// `at` must stay where it is until the next call.
  void move_to(PacketPoints& at) {
    at_ = &at;
    shadow_count_ = 0;
    shadow_of_.resize(HWY_MAX(shadow_of_.size(), 16 * block_count()));
    OccluderList<float, PointRange>::move_to(range_of(at));
  }

  /// Subtracts an occluder from `part`: false if it overlaps it at no point. Lanes where it does leave the
  /// part; what they keep goes to `out`, or to `rest` if others, the bits of `left`, are still to be
  /// subtracted.
  SIMD_INLINE bool subtract(std::size_t id, const PacketReach& reach, PacketPart& part,
                            const LaneIndex<float>*, std::uint64_t left, PacketParts& rest,
                            PacketParts& out) {
    const PacketShadow& shadow = shadow_of(id);
    std::uint32_t met = part.live & meeting(reach, shadow);
    for (int l = 0; l < shadow.line_count && met != 0; ++l) met &= reaching(part.polygon, shadow.lines[l]);
    return met != 0 && cut_out(shadow, met, part, left == 0 ? out : rest);
  }

private:
  /// Bits of the lanes where the boxes around fragment and shadow meet.
  static SIMD_INLINE std::uint32_t meeting(const PacketReach& reach, const PacketShadow& shadow) {
    const auto below = [&](int k) { return lt(shadow.sides[k], reach.side[k]); };
    return bits(below(0) & below(1) & below(2) & below(3));
  }

  /// Cuts the shadow out of the lanes `met` of `part`: what they keep goes to `out`. False, and nothing done,
  /// if each of them lies outside of one of the lines.
  HWY_NOINLINE bool cut_out(const PacketShadow& shadow, std::uint32_t met, PacketPart& part,
                            PacketParts& out) {
    const std::size_t before = out.size();
    PacketPolygon *rest = &rest_, *inside = &inside_;
    rest->assign(part.polygon);
    std::uint32_t missed = 0;
    for (int l = 0; l < shadow.line_count; ++l) {
      PacketValues values = evaluate(*rest, shadow.lines[l]);
      missed |= met & ~values.positive;
      met &= values.positive;
      const std::uint32_t cut = met & values.negative;
      if (cut == 0) continue;
      PacketPart& outside = out.add();
      outside.live = cut;
      if (!split(*rest, values, cut, *inside, outside.polygon)) return give_up(before, part, out);
      compact_large(outside.polygon, cut);
      compact_large(*inside, met);
      std::swap(rest, inside);
    }
    if (met == 0) out.shrink(before);
    for (std::size_t i = before; missed != 0 && i < out.size(); ++i) out[i].live &= ~missed;
    part.live &= ~met;
    at_->touched |= met;
    return met != 0;
  }
  bool give_up(std::size_t before, PacketPart& part, PacketParts& out) {
    at_->failed = true;
    part.live = 0;
    out.shrink(before);
    return true;
  }

  const PacketShadow& shadow_of(std::size_t id) {
    Place& place = shadow_of_[id];
    if (place.range != number()) {
      if (shadow_count_ == shadows_.size()) shadows_.resize(2 * shadow_count_ + 16);
      place = {number(), shadow_count_};
      move(block(id / 16), id % 16, shadows_[shadow_count_++]);
    }
    return shadows_[place.shadow];
  }

  /// The occluder's lines at all points, as in find_eight_lines.
  HWY_NOINLINE void move(const OccluderBlock& block, std::size_t i, PacketShadow& shadow) const {
    const PacketPoints& at = *at_;
    double signs[packet_size];
    for (std::size_t k = 0; k < packet_size; ++k) signs[k] = block.sign[i];
    if ((block.indefinite >> i & 1u) != 0) {
      for (std::size_t k = 0; k < at.count; ++k)
        signs[k] = sign_at(block.triangle[i], heights()[block.height[i]], at.point(k));
    }
    const Wide sign = load<Wide>(signs), reach = load<Wide>(at.reach);
    const Wide x = load<Wide>(at.in_axes[0]), y = load<Wide>(at.in_axes[1]), z = load<Wide>(at.in_axes[2]);
    const Wide pu = load<Wide>(at.in_light[0]), pv = load<Wide>(at.in_light[1]);
    const auto corner = [&](int k) {
      const auto& c = block.corners[k];
      return Pack3<Wide>{wide(c[0][i]) - x, wide(c[1][i]) - y, wide(c[2][i]) - z};
    };
    const bool is_quad = (block.quads >> i & 1u) != 0;
    shadow.line_count = is_quad ? 4 : 3;
    Pack3<Wide> from = corner(0);
    PacketBox box(at);
    for (int k = 0; k < shadow.line_count; ++k) {
      box.add(from);
      const Pack3<Wide> to = corner(k + 1 < shadow.line_count ? k + 1 : 0);
      const Pack3<Wide> n = cross(from, to - from);
      shadow.lines[k] = {narrowed<float>(n.x * sign), narrowed<float>(n.y * sign),
                         narrowed<float>((n.z * reach - n.x * pu - n.y * pv) * sign)};
      from = to;
    }
    box.store(shadow.sides);
    const double plane[3] = {block.plane[0][i], block.plane[1][i], block.plane[2][i]};
    const bool positive_everywhere = plane[0] == 0 && plane[1] == 0 && plane[2] * block.sign[i] > 0;
    if (is_quad || positive_everywhere) return;
    const auto times_sign = [&](int k) { return narrowed<float>(wide(plane[k]) * sign); };
    shadow.lines[shadow.line_count++] = {times_sign(0), times_sign(1), times_sign(2)};
  }

  struct Place {
    std::uint64_t range = 0;  ///< number of the range that it is for
    std::size_t shadow = 0;
  };
  PacketPoints* at_ = nullptr;
  std::vector<Place> shadow_of_;       ///< by id: which shadow, if it is of the range at hand
  std::vector<PacketShadow> shadows_;  ///< those that were asked for
  std::size_t shadow_count_ = 0;
  PacketPolygon rest_, inside_;
};

/// The light as the points of a packet see it, for ClipSolver.
struct ManyPoints {
  using Number = float;
  using At = PacketPoints;
  using Range = PointRange;
  using Part = PacketPart;
  using OwnPart = Part;
  using Bounds = PacketReach;
  using Parts = PacketParts;
  using Occluders = PacketOccluders;
  static constexpr bool takes_all = false;  ///< lanes that an occluder does not overlap stay in the part
  static constexpr int any_order = 0;       ///< most occluders whose order does not matter
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
