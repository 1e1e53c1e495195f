#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "soft/groups/point_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include <cmath>
#include "simd/dispatch.h"

#include "simd/double8-inl.h"
#include "soft/groups/point_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

using glm::dvec3;

SIMD_INLINE Vector8 eight_at(const PointLanes& points, std::size_t i) {
  return {load<Double8>(&points.x[8 * i]), load<Double8>(&points.y[8 * i]), load<Double8>(&points.z[8 * i])};
}
SIMD_INLINE Mask<double, 8> lanes_of(PointSet set, std::size_t i) {
  return mask_of_bits<double, 8>(set[i]);
}
SIMD_INLINE dvec3 sum_of(const Vector8& a) {
  return {reduce_add_in_order(a.x), reduce_add_in_order(a.y), reduce_add_in_order(a.z)};
}

// Least and greatest coordinates, lane by lane.
struct Box8 {
  Vector8 low, high;

  SIMD_INLINE Box8() : low(broadcast8(dvec3(INFINITY))), high(broadcast8(dvec3(-INFINITY))) {}

  SIMD_INLINE void add(const Mask<double, 8>& there, const Vector8& p) {
    const Vector8 a = select3(there, p, low), b = select3(there, p, high);
    low = {min(low.x, a.x), min(low.y, a.y), min(low.z, a.z)};
    high = {max(high.x, b.x), max(high.y, b.y), max(high.z, b.z)};
  }
  SIMD_INLINE math::Box<double> box() const {
    math::Box<double> b;
    b.low = {reduce_min(low.x), reduce_min(low.y), reduce_min(low.z)};
    b.high = {reduce_max(high.x), reduce_max(high.y), reduce_max(high.z)};
    return b;
  }
};

void put_eight(const dvec3* from, PointLanes& to, std::size_t first) {
  const Vector8 p = load3<Double8>(&from->x);
  store(p.x, &to.x[first]), store(p.y, &to.y[first]), store(p.z, &to.z[first]);
}

std::uint64_t equal(const std::uint32_t* values, std::uint32_t value) {
  std::uint64_t set = 0;
  for (int i = 0; i < 64; i += 16) set |= std::uint64_t{eq_bits(values + i, value)} << i;
  return set;
}

std::uint64_t in_front(const PointLanes& points, const LightShape& light, std::size_t first) {
  const Vector8 origin = broadcast8(light.origin), normal = broadcast8(light.normal);
  const dvec3 o = glm::abs(light.origin);
  if (light.at_infinity()) return ~std::uint64_t{0};
  std::uint64_t set = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    const Vector8 p = eight_at(points, first / 8 + i);
    const Double8 size = l1_norm(p) + broadcast8(o.x + o.y + o.z);
    set |= std::uint64_t{lt_bits(broadcast8(-0x1p-48) * size, dot_unfused(p - origin, normal))} << (8 * i);
  }
  return set;
}

math::Box<double> box(const PointLanes& points, PointSet set) {
  Box8 around;
  for (std::size_t i = 0; i < set.size(); ++i) around.add(lanes_of(set, i), eight_at(points, i));
  return around.box();
}

SIMD_INLINE Double8 places(const PointLanes& points, const Slices& slices, std::size_t i) {
  const std::vector<double>& from = slices.axis == 0 ? points.x : slices.axis == 1 ? points.y : points.z;
  return (load<Double8>(&from[8 * i]) - broadcast8(slices.low)) * broadcast8(slices.scale);
}

std::uint32_t taken(const PointLanes& points, PointSet set, const Slices& slices) {
  using Int8 = Pack<std::int32_t, 8>;
  const auto one = broadcast<Int8>(1);
  Int8 found = broadcast<Int8>(0);
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Double8 place = select(lanes_of(set, i), places(points, slices, i), broadcast8(0));
    const auto slice = truncate(min(demoted(place), broadcast<Pack<float, 8>>(Slices::count - 1.0f)));
    found = found | shift_left(one, slice);
  }
  std::int32_t lanes[8];
  store(found, lanes);
  std::int32_t result = 0;
  for (const std::int32_t lane : lanes) result |= lane;
  return static_cast<std::uint32_t>(result);
}

std::uint64_t below(const PointLanes& points, const Slices& slices, int end) {
  std::uint64_t set = 0;
  for (std::size_t i = 0; i < 8; ++i)
    set |= std::uint64_t{lt_bits(places(points, slices, i), broadcast8(end))} << (8 * i);
  return set;
}

// Slopes of the position along rows and columns, up to a factor: sum of (x - mean x) p.
struct Slopes {
  dvec3 row, column;
};
SIMD_INLINE Slopes slopes_of(const PointLanes& points, PointSet set, const Vector8& base) {
  const Vector8 zero = broadcast8(dvec3(0));
  const Double8 none = broadcast8(0), one = broadcast8(1);
  Vector8 x_p = zero, y_p = zero, sum = zero;
  Double8 x_sum = none, y_sum = none, count = none;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const auto there = lanes_of(set, i);
    const Vector8 p = select3(there, eight_at(points, i) - base, zero);
    const Double8 x = load_widened<Double8>(&points.column[8 * i]);
    const Double8 y = load_widened<Double8>(&points.row[8 * i]);
    x_p = x_p + x * p, y_p = y_p + y * p, sum = sum + p;
    x_sum = x_sum + select(there, x, none), y_sum = y_sum + select(there, y, none);
    count = count + select(there, one, none);
  }
  const dvec3 mean = sum_of(sum) / reduce_add_in_order(count);
  return {sum_of(x_p) - reduce_add_in_order(x_sum) * mean, sum_of(y_p) - reduce_add_in_order(y_sum) * mean};
}

Cell fitted_cell(const PointLanes& points, PointSet set, const math::Box<double>& box,
                 const LightShape& light) {
  const dvec3 base = 0.5 * (box.low + box.high);
  auto [r, c] = slopes_of(points, set, broadcast8(base));
  r /= std::sqrt(glm::dot(r, r)), c /= std::sqrt(glm::dot(c, c));
  dvec3 n = glm::cross(r, c);
  const double sine = std::sqrt(glm::dot(n, n));
  if (!(sine > 0x1p-4)) return box_cell(box.low, box.high, light);
  n /= sine;
  // p = (p.dual_r) r + (p.dual_c) c + (p.n) n up to 2^-42 |p|: units within 4u, the normal within 2^-45.
  const Vector8 dual_r = broadcast8(glm::cross(c, n) / sine), dual_c = broadcast8(glm::cross(n, r) / sine);
  const Vector8 normal = broadcast8(n), from = broadcast8(base);
  Box8 around;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Vector8 p = eight_at(points, i) - from;
    around.add(lanes_of(set, i), {dot_unfused(dual_r, p), dot_unfused(dual_c, p), dot_unfused(normal, p)});
  }
  const math::Box<double> places = around.box();
  const dvec3 middle = 0.5 * (places.low + places.high), half = 0.5 * (places.high - places.low);
  const dvec3 size = box.high - box.low;
  Cell cell;
  cell.centre = (base - light.origin) + middle.x * r + middle.y * c + middle.z * n;
  cell.axis = {half.x * r, half.y * c, half.z * n};
  cell.slack = 0x1p-40 * (size.x + size.y + size.z) + 0x1p-49 * (largest(base) + largest(light.origin));
  cell.reach = largest(cell.centre) + half.x + half.y + half.z + cell.slack;
  return cell;
}

double lowest(const PointLanes& points, PointSet set, const dvec3& m, const LightShape& light) {
  const Vector8 along = broadcast8(m), origin = broadcast8(light.origin);
  Double8 low = broadcast8(INFINITY);
  for (std::size_t i = 0; i < set.size(); ++i)
    low = min(low, select(lanes_of(set, i), dot_unfused(along, eight_at(points, i) - origin), low));
  return reduce_min(low);
}

}  // namespace

PointKernels point_kernels() {
  return {put_eight, equal, in_front, box, taken, below, fitted_cell, lowest};
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::soft {

PointKernels point_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, point_kernels)();
}

}  // namespace tenebra::soft
#endif
