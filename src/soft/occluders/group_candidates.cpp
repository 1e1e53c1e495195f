#include "soft/occluders/group_candidates.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "soft/occluders/group_candidates.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include <algorithm>
#include <bit>
#include <cmath>
#include "points/contact_rule.h"
#include "simd/dispatch.h"

#include "math/l1_norm.h"
#include "points/triangle_corners.h"
#include "simd/double8-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;
namespace {

/// Eight triangles in relation to a group and its light.
struct LaneResults {
  double corners[3][3][8];
  double plane[3][8];
  double normal[3][8], height[8], length[8], tau[8], solid_angle[8];
  std::uint32_t never = 0, in_front = 0, behind = 0;   ///< it blocks no point; all are in front of it, behind
  std::uint32_t light_in_front = 0, light_behind = 0;  ///< all of the light is
  std::uint32_t stands_between = 0;
};

class CandidateLanes {
public:
  /// Fills `out` with those of `ids` that may block between the group's points and the light.
  void find(const LightFrame& light, const TriangleView& triangles, const GroupFrame& group,
            std::span<const std::uint32_t> ids, GroupCandidates& out, const StopFlag* stop) {
    constexpr std::size_t look_after = 8192;
    out.clear();
    out.axes = light_axes(light, group.centre);
    for (std::size_t from = 0; from < ids.size(); from += 8) {
      if (from % look_after == 0 && stop_requested(stop)) return;
      const std::size_t count = std::min<std::size_t>(8, ids.size() - from);
      load_corners(triangles, ids.subspan(from, count));
      find_lanes(light, group, out.axes);
      for (std::size_t i = 0; i < count; ++i) add(group, ids[from + i], i, out);
    }
  }

private:
  void load_corners(const TriangleView& triangles, std::span<const std::uint32_t> ids) {
    for (std::size_t i = 0; i < 8; ++i) {
      const points::Corners c = points::corners_of(triangles, ids[i < ids.size() ? i : 0]);
      for (int k = 0; k < 3; ++k)
        for (int axis = 0; axis < 3; ++axis) v_[k][axis][i] = c.v[k][axis];
    }
  }

  SIMD_INLINE Vector8 corner(int k) const {
    return {load_widened<Double8>(v_[k][0]), load_widened<Double8>(v_[k][1]),
            load_widened<Double8>(v_[k][2])};
  }

  HWY_NOINLINE void find_lanes(const LightFrame& light, const GroupFrame& group, const LightAxes& axes) {
    const Vector8 v[3] = {corner(0), corner(1), corner(2)};
    const Vector8 centre = broadcast3<Double8>(group.centre.x, group.centre.y, group.centre.z);
    const Vector8 n = cross(v[1] - v[0], v[2] - v[0]);
    const Double8 length = sqrt(dot_unfused(n, n));
    const Vector8 from[3] = {v[0] - centre, v[1] - centre, v[2] - centre};
    find_sides(group, v, n, length, from[0]);
    find_light_sides(light, v[0], n, length);
    find_size(from, n);
    find_corners(light, group, axes, v, from);

    const auto along = [&](const glm::dvec3& a) {
      return n.x * broadcast8(a.x) + n.y * broadcast8(a.y) + n.z * broadcast8(a.z);
    };
    const glm::dvec3& o = light.origin;
    const Vector8 to_origin = broadcast3<Double8>(o.x, o.y, o.z) - broadcast8(light.weight) * v[0];
    const double unit = std::sqrt(glm::dot(light.ex, light.ex));
    const Double8 size = length * broadcast8(unit);
    const Double8 scale = broadcast8(axes.turn) / select(lt(broadcast8(0), size), size, broadcast8(1));
    store(along(light.ex) * scale, lanes_.plane[0]);
    store(along(light.ey) * scale, lanes_.plane[1]);
    store(dot_unfused(n, to_origin) * scale, lanes_.plane[2]);
  }

  SIMD_INLINE void find_sides(const GroupFrame& group, const Vector8* v, const Vector8& n, Double8 length,
                              const Vector8& from) {
    const Double8 zero = broadcast8(0);
    Double8 largest = zero;
    for (int k = 0; k < 3; ++k) largest = max(largest, max(abs(v[k].x), max(abs(v[k].y), abs(v[k].z))));
    const Double8 tau = largest * broadcast8(points::contact_tau);
    const Double8 height = zero - dot_unfused(n, from), far = abs(height);
    const Double8 spread = abs(n.x) * broadcast8(group.half.x) + abs(n.y) * broadcast8(group.half.y) +
                           abs(n.z) * broadcast8(group.half.z);
    const Double8 margin =
        broadcast8(product_rounding) * length *
        (broadcast8(math::l1_norm(group.centre) + math::l1_norm(group.half)) + l1_norm(v[0]));
    const Double8 threshold = (tau + broadcast8(group.receiver_tau)) * length;
    const std::uint32_t sure = lt_bits(threshold + margin, far - spread);
    const std::uint32_t above = lt_bits(zero, height);
    lanes_.in_front = sure & above;
    lanes_.behind = sure & ~above;
    lanes_.never = ~lt_bits(zero, length) | lt_bits(far + spread, tau * length - margin);
    store(n.x, lanes_.normal[0]), store(n.y, lanes_.normal[1]), store(n.z, lanes_.normal[2]);
    store(height, lanes_.height), store(length, lanes_.length), store(tau, lanes_.tau);
  }

  SIMD_INLINE void find_light_sides(const LightFrame& light, const Vector8& v, const Vector8& n,
                                    Double8 length) {
    const Double8 zero = broadcast<Double8>(0.0);
    const Double8 slack = broadcast<Double8>(product_rounding) * length;
    const Vector8 from = broadcast<Double8>(light.weight) * v;
    const Double8 size = l1_norm(from);
    std::uint32_t positive = ~0u, negative = ~0u;
    for (const glm::dvec2& at : light.polygon) {
      const glm::dvec3 vertex = light.point(at);
      const Double8 value = dot_unfused(n, broadcast3<Double8>(vertex.x, vertex.y, vertex.z) - from);
      const Double8 margin = slack * (broadcast<Double8>(math::l1_norm(vertex)) + size);
      positive &= lt_bits(margin, value);
      negative &= lt_bits(value, zero - margin);
    }
    lanes_.light_in_front = positive;
    lanes_.light_behind = negative;
  }

  SIMD_INLINE void find_size(const Vector8* from, const Vector8& n) {
    const Double8 third = broadcast<Double8>(1.0 / 3);
    const Vector8 sum{from[0].x + from[1].x + from[2].x, from[0].y + from[1].y + from[2].y,
                      from[0].z + from[1].z + from[2].z};
    const Vector8 middle{sum.x * third, sum.y * third, sum.z * third};
    const Double8 square = dot_unfused(middle, middle), cube = square * sqrt(square);
    const auto near = lt(broadcast<Double8>(0.0), cube);
    store(select(near, abs(dot_unfused(n, from[0])) / select(near, cube, third), broadcast<Double8>(0.0)),
          lanes_.solid_angle);
  }

  /// Corners in the light's axes, and which triangles stand between: below the light's plane, and so far
  /// above the points that the division by the height loses no more than 16 bits.
  SIMD_INLINE void find_corners(const LightFrame& light, const GroupFrame& group, const LightAxes& axes,
                                const Vector8* v, const Vector8* from) {
    const auto along = [&](const glm::dvec3& a, const Vector8& b) {
      return broadcast8(a.x) * b.x + broadcast8(a.y) * b.y + broadcast8(a.z) * b.z;
    };
    const double unit = 1 / std::sqrt(glm::dot(light.ex, light.ex));
    const Double8 reach = broadcast8(math::l1_norm(axes.height * group.half)),
                  top = broadcast8(axes.centre_uv.z);
    const double around =
        math::l1_norm(group.centre) + math::l1_norm(group.half) + light.weight * math::l1_norm(light.origin);
    std::uint32_t between = ~0u;
    for (int k = 0; k < 3; ++k) {
      const Double8 height = along(axes.height, from[k]);
      const Double8 size = (l1_norm(v[k]) + broadcast8(around)) * broadcast8(unit);
      between &= lt_bits(broadcast8(0x1p-16) * size, height - reach);
      between &= lt_bits(broadcast8(light.weight * product_rounding) * size,
                         top - broadcast8(light.weight) * height);
      store(along(axes.u, from[k]), lanes_.corners[k][0]);
      store(along(axes.v, from[k]), lanes_.corners[k][1]);
      store(height, lanes_.corners[k][2]);
    }
    lanes_.stands_between = between;
  }

  void add(const GroupFrame& group, std::uint32_t id, std::size_t i, GroupCandidates& out) const {
    const auto is = [i](std::uint32_t set) { return ((set >> i) & 1u) != 0; };
    const LaneResults& l = lanes_;
    if (is(l.never)) return;
    Candidate c;
    c.triangle = id;
    const int points = is(l.in_front) ? 1 : is(l.behind) ? -1 : 0;
    if (points == 0 || std::binary_search(group.receivers.begin(), group.receivers.end(), id)) {
      c.height = static_cast<std::uint32_t>(out.heights.size());
      c.has_plane = true;
      out.heights.push_back({l.height[i],
                             {l.normal[0][i], l.normal[1][i], l.normal[2][i]},
                             l.tau[i] * l.length[i],
                             l.length[i]});
    } else {
      if (is(points > 0 ? l.light_in_front : l.light_behind)) return;
      c.sign = -points * out.axes.turn;
      c.has_plane = !is(l.light_in_front | l.light_behind);
    }
    for (int k = 0; k < 4; ++k)
      for (int axis = 0; axis < 3; ++axis) c.corners[k][axis] = l.corners[k % 3][axis][i];
    for (int k = 0; k < 3; ++k) c.plane[k] = c.has_plane ? l.plane[k][i] : k == 2 ? c.sign : 0.0;
    // The exponent is the logarithm, rounded down (all tiny ones are one class).
    c.size = static_cast<std::int32_t>(std::bit_cast<std::uint64_t>(l.solid_angle[i]) >> 52) - 1023;
    c.stands_between = is(l.stands_between);
    out.all.push_back(c);
  }

  float v_[3][3][8];
  LaneResults lanes_;
};

void find_candidates(const LightFrame& light, const TriangleView& triangles, const GroupFrame& group,
                     std::span<const std::uint32_t> ids, GroupCandidates& out, const StopFlag* stop) {
  CandidateLanes lanes;
  lanes.find(light, triangles, group, ids, out, stop);
}

}  // namespace

FindCandidates find_candidates_kernel() {
  return find_candidates;
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::soft {

LightAxes light_axes(const LightFrame& light, const glm::dvec3& centre) {
  const double square = glm::dot(light.ex, light.ex), unit = std::sqrt(square);
  LightAxes axes;
  axes.u = light.ex / square;
  axes.v = light.ey / square;
  axes.height = -light.normal / unit;
  axes.centre = centre;
  axes.weight = light.weight;
  const glm::dvec3 from = light.weight * centre - light.origin;
  axes.centre_uv = {glm::dot(from, axes.u), glm::dot(from, axes.v), glm::dot(from, light.normal) / unit};
  axes.turn = glm::dot(glm::cross(light.ex, light.ey), axes.height) > 0 ? 1.0 : -1.0;
  return axes;
}

int certain_sign(const PlaneHeight& plane, const glm::dvec3& centre, const GroupFrame& group) {
  const glm::dvec3 d = group.centre - centre, slope = glm::abs(plane.slope);
  const double height = plane.height + glm::dot(d, plane.slope);
  const double rounding =
      product_rounding *
      (std::abs(plane.height) + math::l1_norm(slope) * (math::l1_norm(group.centre) + math::l1_norm(centre) +
                                                        math::l1_norm(group.half)));
  const double least =
      plane.threshold + group.receiver_tau * plane.length + glm::dot(slope, group.half) + rounding;
  return height < -least ? 1 : height > least ? -1 : 0;
}

FindCandidates find_candidates_kernel(SimdLevel level) {
  return TENEBRA_DISPATCH(level, find_candidates_kernel)();
}

}  // namespace tenebra::soft
#endif
