// The see-through triangles of a group, eight at a time: those whose shadow a point sees on the light.
// Included once per target.
#if defined(TENEBRA_TINT_SHADOWS_ON_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_TINT_SHADOWS_ON_LIGHT_INL_H_
#undef TENEBRA_TINT_SHADOWS_ON_LIGHT_INL_H_
#else
#define TENEBRA_TINT_SHADOWS_ON_LIGHT_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "points/contact_rule.h"
#include "points/triangle_corners.h"
#include "simd/double8-inl.h"
#include "tint/soft_tint.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::tint::HWY_NAMESPACE {
using simd::HWY_NAMESPACE::abs;
using simd::HWY_NAMESPACE::bits;
using simd::HWY_NAMESPACE::broadcast8;
using simd::HWY_NAMESPACE::Double8;
using simd::HWY_NAMESPACE::Vector8;

/// The shadow of a see-through triangle on the light: the places that are positive for all four lines.
struct TintShadow {
  glm::dvec3 lines[4];
  glm::dvec2 low, high;  ///< a box that holds it, as its corners fall on the light's plane; may be infinite
  std::uint32_t number = 0;
};

/// Buffers kept from group to group.
class ShadowsOnLight {
public:
  /// Triangles by their numbers in Panes, ascending.
  void reset(const SoftTintFrame& frame, std::span<const std::uint32_t> numbers) {
    light_ = &frame.soft.light;
    all_ = numbers;
    if (all_.size() <= most_set_up) take_up(frame, all_);
  }

  /// Fills `out` with what falls on the light from a point of triangle `own`, whose tolerance is `own_tau`,
  /// in the order of numbers. The rule of SoftShadowTracer::trace.
  void find(const SoftTintFrame& frame, const glm::dvec3& point, std::uint32_t own, double own_tau,
            std::vector<TintShadow>& out) {
    out.clear();
    const View view{broadcast8(point), broadcast8(light_->way_from(point)), broadcast8(own_tau)};
    for (std::size_t first = 0; first < all_.size(); first += most_set_up) {
      if (all_.size() > most_set_up)
        take_up(frame, all_.subspan(first, std::min(most_set_up, all_.size() - first)));
      find_among(frame, view, own, out);
    }
  }

private:
  struct Triangles {
    double corners[3][3][8];  ///< corner, axis
    double normal[3][8];      ///< (B - A) x (C - A)
    double length[8];         ///< of the normal; infinite: it throws no shadow
    double tau[8];
    double plane[3][8];  ///< the line on the light's plane where the triangle's plane meets it
  };
  struct View {
    Vector8 point, to_light;
    Double8 own_tau;
  };
  struct Eight {
    double lines[4][3][8];
    double box[4][8];  ///< lowest x and y, highest x and y
  };

  void take_up(const SoftTintFrame& frame, std::span<const std::uint32_t> numbers) {
    numbers_ = numbers;
    eights_.resize((numbers.size() + 7) / 8);
    for (std::size_t i = 0; i < eights_.size(); ++i) take_up_eight(frame, i);
  }

  void find_among(const SoftTintFrame& frame, const View& view, std::uint32_t own,
                  std::vector<TintShadow>& out) const {
    for (std::size_t i = 0; i < eights_.size(); ++i) {
      Eight shadows;
      for (std::uint32_t lanes = fall(eights_[i], view, shadows); lanes != 0; lanes &= lanes - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        const std::uint32_t number = numbers_[8 * i + lane];
        if (frame.panes.ids()[number] != own) out.push_back(shadow(shadows, lane, number));
      }
    }
  }

  static Vector8 load3(const double (&rows)[3][8]) {
    using simd::HWY_NAMESPACE::load;
    return {load<Double8>(rows[0]), load<Double8>(rows[1]), load<Double8>(rows[2])};
  }
  static void store3(const Vector8& v, double (&rows)[3][8]) {
    using simd::HWY_NAMESPACE::store;
    store(v.x, rows[0]), store(v.y, rows[1]), store(v.z, rows[2]);
  }
  /// soft::line_of_plane
  Vector8 line_of(const Vector8& n, const Vector8& to_origin) const {
    using simd::HWY_NAMESPACE::dot_unfused;
    return {dot_unfused(n, broadcast8(light_->ex)), dot_unfused(n, broadcast8(light_->ey)),
            dot_unfused(n, to_origin)};
  }

  /// Numbers 8 i to 8 i + 7.
  void take_up_eight(const SoftTintFrame& frame, std::size_t i) {
    using namespace simd::HWY_NAMESPACE;
    Triangles& t = eights_[i];
    const std::size_t count = std::min<std::size_t>(8, numbers_.size() - 8 * i);
    for (std::size_t lane = 0; lane < 8; ++lane) {
      const std::uint32_t number = numbers_[8 * i + std::min(lane, count - 1)];
      const points::Corners c = points::corners_of(frame.soft.triangles, frame.panes.ids()[number]);
      t.tau[lane] = points::rounding_tolerance(c.v);
      for (int k = 0; k < 3; ++k)
        for (int axis = 0; axis < 3; ++axis) t.corners[k][axis][lane] = static_cast<double>(c.v[k][axis]);
    }
    const Vector8 a = load3(t.corners[0]), n = cross(load3(t.corners[1]) - a, load3(t.corners[2]) - a),
                  origin = broadcast8(light_->origin);
    const Double8 zero = broadcast8(0.0);
    Double8 off = zero;
    for (const auto& corner : t.corners)
      off = max(off, abs(dot_unfused(broadcast8(light_->normal), load3(corner) - origin)));
    // The face of the lamp itself; a sun has none.
    const double face = frame.reach.at_infinity ? -HUGE_VAL : frame.plane_tolerance;
    const auto of_lamp = le(off, broadcast8(face) + load<Double8>(t.tau));
    store(select(of_lamp, broadcast8(HUGE_VAL), sqrt(dot_unfused(n, n))), t.length);
    for (std::size_t lane = count; lane < 8; ++lane) t.length[lane] = HUGE_VAL;
    store3(n, t.normal);
    store3(line_of(n, origin - broadcast8(light_->weight) * a), t.plane);
  }

  /// Which of them throw a shadow, and where.
  std::uint32_t fall(const Triangles& t, const View& view, Eight& out) const {
    using namespace simd::HWY_NAMESPACE;
    const Double8 zero = broadcast8(0.0);
    const Vector8 from[3] = {load3(t.corners[0]) - view.point, load3(t.corners[1]) - view.point,
                             load3(t.corners[2]) - view.point};
    const Double8 height = dot_unfused(load3(t.normal), view.point - load3(t.corners[0]));
    auto falls = lt((load<Double8>(t.tau) + view.own_tau) * load<Double8>(t.length), abs(height));
    if (!any(falls)) return 0;
    const Double8 side = select(lt(zero, height), broadcast8(-1.0), broadcast8(1.0));
    for (int k = 0; k < 4; ++k) {
      const Vector8 line =
          side * (k < 3 ? line_of(cross(from[k], from[(k + 1) % 3]), view.to_light) : load3(t.plane));
      auto positive = lt(zero, zero);
      for (const glm::dvec2& at : light_->polygon)
        positive = positive | lt(zero, line.x * broadcast8(at.x) + line.y * broadcast8(at.y) + line.z);
      falls = falls & positive;
      if (!any(falls)) return 0;
      store3(line, out.lines[k]);
    }
    return bits(falls & find_boxes(from, view, out));
  }

  /// Around the places where the ways to the corners meet the light's plane; infinite where one does not, or
  /// as good as in the infinite. Returns which of them meet the light's own box.
  simd::HWY_NAMESPACE::Mask<double, 8> find_boxes(const Vector8 (&from)[3], const View& view,
                                                  Eight& out) const {
    using namespace simd::HWY_NAMESPACE;
    const Vector8 ex = broadcast8(light_->ex), ey = broadcast8(light_->ey),
                  normal = broadcast8(light_->normal);
    const Double8 height = dot_unfused(normal, view.to_light), zero = broadcast8(0.0),
                  most = broadcast8(HUGE_VAL), square = broadcast8(glm::dot(light_->ex, light_->ex));
    Double8 low_x = most, low_y = most, high_x = zero - most, high_y = zero - most;
    auto finite = le(zero, zero);
    for (const Vector8& way : from) {
      const Double8 times = height / dot_unfused(normal, way);
      finite = finite & lt(zero, times) & lt(times, broadcast8(0x1p50));
      const Vector8 off = times * way - view.to_light;
      const Double8 x = dot_unfused(off, ex) / square, y = dot_unfused(off, ey) / square;
      low_x = min(low_x, x), low_y = min(low_y, y), high_x = max(high_x, x), high_y = max(high_y, y);
    }
    low_x = select(finite, low_x, zero - most), low_y = select(finite, low_y, zero - most);
    high_x = select(finite, high_x, most), high_y = select(finite, high_y, most);
    store(low_x, out.box[0]), store(low_y, out.box[1]), store(high_x, out.box[2]), store(high_y, out.box[3]);
    const Double8 side = broadcast8(1 + box_slack);
    return le(low_x, side) & le(low_y, side) & le(zero - side, high_x) & le(zero - side, high_y);
  }

  static TintShadow shadow(const Eight& from, std::size_t lane, std::uint32_t number) {
    TintShadow s;
    for (int k = 0; k < 4; ++k)
      s.lines[k] = {from.lines[k][0][lane], from.lines[k][1][lane], from.lines[k][2][lane]};
    s.low = {from.box[0][lane], from.box[1][lane]}, s.high = {from.box[2][lane], from.box[3][lane]};
    s.number = number;
    return s;
  }

  const soft::LightFrame* light_ = nullptr;
  std::span<const std::uint32_t> all_, numbers_;  ///< numbers_: of eights_
  std::vector<Triangles> eights_;
};

}  // namespace tenebra::tint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
