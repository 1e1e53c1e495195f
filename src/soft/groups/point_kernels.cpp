#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "soft/groups/point_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include <cmath>
#include "simd/dispatch.h"

#include "soft/groups/point_lanes.h"
#include "soft/polygon/vector_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

using glm::dvec3;

SIMD_INLINE Vector8 eight_at(const PointLanes& points, std::size_t i) {
  return {load<Double8>(&points.x[8 * i]), load<Double8>(&points.y[8 * i]), load<Double8>(&points.z[8 * i])};
}
SIMD_INLINE Truth<double, 8> lanes_of(PointSet set, std::size_t i) {
  return truth_of<double, 8>(set[i]);
}
SIMD_INLINE dvec3 sum_of(const Vector8& a) {
  return {ordered_total(a.x), ordered_total(a.y), ordered_total(a.z)};
}

// Least and greatest coordinates, lane by lane.
struct Box8 {
  Vector8 low, high;

  SIMD_INLINE Box8() : low(all(dvec3(INFINITY))), high(all(dvec3(-INFINITY))) {}

  SIMD_INLINE void add(const Truth<double, 8>& there, const Vector8& p) {
    const Vector8 a = choose3(there, p, low), b = choose3(there, p, high);
    low = {min(low.x, a.x), min(low.y, a.y), min(low.z, a.z)};
    high = {max(high.x, b.x), max(high.y, b.y), max(high.z, b.z)};
  }
  SIMD_INLINE PointBox box() const {
    PointBox b;
    b.low = {least(low.x), least(low.y), least(low.z)};
    b.high = {greatest(high.x), greatest(high.y), greatest(high.z)};
    return b;
  }
};

void put_eight(const dvec3* from, PointLanes& to, std::size_t first) {
  const Vector8 p = load3<Double8>(&from->x);
  store(p.x, &to.x[first]), store(p.y, &to.y[first]), store(p.z, &to.z[first]);
}

std::uint64_t equal(const std::uint32_t* values, std::uint32_t value) {
  std::uint64_t set = 0;
  for (int i = 0; i < 64; i += 16) set |= std::uint64_t{equal_bits(values + i, value)} << i;
  return set;
}

std::uint64_t in_front(const PointLanes& points, const LightShape& light, std::size_t first) {
  const Vector8 origin = all(light.origin), normal = all(light.normal);
  const dvec3 o = glm::abs(light.origin);
  std::uint64_t set = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    const Vector8 p = eight_at(points, first / 8 + i);
    const Double8 size = absolute(p.x) + absolute(p.y) + absolute(p.z) + all(o.x + o.y + o.z);
    set |= std::uint64_t{less_bits(all(-0x1p-48) * size, product(p - origin, normal))} << (8 * i);
  }
  return set;
}

PointBox box(const PointLanes& points, PointSet set) {
  Box8 around;
  for (std::size_t i = 0; i < set.size(); ++i) around.add(lanes_of(set, i), eight_at(points, i));
  return around.box();
}

SIMD_INLINE Double8 places(const PointLanes& points, const Slices& slices, std::size_t i) {
  const std::vector<double>& from = slices.axis == 0 ? points.x : slices.axis == 1 ? points.y : points.z;
  return (load<Double8>(&from[8 * i]) - all(slices.low)) * all(slices.scale);
}

std::uint32_t taken(const PointLanes& points, PointSet set, const Slices& slices) {
  using Int8 = Pack<std::int32_t, 8>;
  const auto one = splat<Int8>(1);
  Int8 found = splat<Int8>(0);
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Double8 place = choose(lanes_of(set, i), places(points, slices, i), all(0));
    const auto slice = truncate(min(demoted(place), splat<Pack<float, 8>>(Slices::count - 1.0f)));
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
    set |= std::uint64_t{less_bits(places(points, slices, i), all(end))} << (8 * i);
  return set;
}

// Slopes of the position along rows and columns, up to a factor: sum of (x - mean x) p.
struct Slopes {
  dvec3 row, column;
};
SIMD_INLINE Slopes slopes_of(const PointLanes& points, PointSet set, const Vector8& base) {
  const Vector8 zero = all(dvec3(0));
  const Double8 none = all(0), one = all(1);
  Vector8 x_p = zero, y_p = zero, sum = zero;
  Double8 x_sum = none, y_sum = none, count = none;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const auto there = lanes_of(set, i);
    const Vector8 p = choose3(there, eight_at(points, i) - base, zero);
    const Double8 x = load_widened<Double8>(&points.column[8 * i]);
    const Double8 y = load_widened<Double8>(&points.row[8 * i]);
    x_p = x_p + x * p, y_p = y_p + y * p, sum = sum + p;
    x_sum = x_sum + choose(there, x, none), y_sum = y_sum + choose(there, y, none);
    count = count + choose(there, one, none);
  }
  const dvec3 mean = sum_of(sum) / ordered_total(count);
  return {sum_of(x_p) - ordered_total(x_sum) * mean, sum_of(y_p) - ordered_total(y_sum) * mean};
}

Cell fitted_cell(const PointLanes& points, PointSet set, const PointBox& box, const LightShape& light) {
  const dvec3 base = 0.5 * (box.low + box.high);
  auto [r, c] = slopes_of(points, set, all(base));
  r /= std::sqrt(glm::dot(r, r)), c /= std::sqrt(glm::dot(c, c));
  dvec3 n = glm::cross(r, c);
  const double sine = std::sqrt(glm::dot(n, n));
  if (!(sine > 0x1p-4)) return box_cell(box.low, box.high, light);
  n /= sine;
  // p = (p.dual_r) r + (p.dual_c) c + (p.n) n up to 2^-42 |p|: units within 4u, the normal within 2^-45.
  const Vector8 dual_r = all(glm::cross(c, n) / sine), dual_c = all(glm::cross(n, r) / sine);
  const Vector8 normal = all(n), from = all(base);
  Box8 around;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Vector8 p = eight_at(points, i) - from;
    around.add(lanes_of(set, i), {product(dual_r, p), product(dual_c, p), product(normal, p)});
  }
  const PointBox places = around.box();
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
  const Vector8 along = all(m), origin = all(light.origin);
  Double8 low = all(INFINITY);
  for (std::size_t i = 0; i < set.size(); ++i)
    low = min(low, choose(lanes_of(set, i), product(along, eight_at(points, i) - origin), low));
  return least(low);
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
