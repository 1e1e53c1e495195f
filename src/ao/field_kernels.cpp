// Sixteen rays against one field. Without fused operations, so that every instruction set gives the same
// bits.
#include "ao/field_chords.h"
#include "ao/field_lookup.h"

#define HWY_DISABLED_TARGETS (HWY_AVX3_DL | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ao/field_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "ao/sphere_maps-inl.h"
#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

namespace {

using Truth16 = Truth<float, 16>;

HWY_INLINE Float16 inner(const Pack3<Float16>& a, const Pack3<Float16>& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
HWY_INLINE Pack3<Float16> along(const Pack3<Float16>& a, Float16 s, const Pack3<Float16>& b) {
  return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

// The ray in unit space and its chord of the unit sphere.
struct Chords {
  Truth16 met;            // the line has a chord at all
  Pack3<Float16> unit;    // direction
  Pack3<Float16> middle;  // of the chord: the point nearest to the centre
  Float16 half;           // length
  Float16 at;             // t of the middle
  Float16 per_unit;       // t of one radius
};

HWY_INLINE Float16 row_times(const float row[4], const Pack3<Float16>& v) {
  return (splat<Float16>(row[0]) * v.x + splat<Float16>(row[1]) * v.y) + splat<Float16>(row[2]) * v.z;
}

HWY_INLINE Chords chords_of(const FieldInstance& f, const RayBatch& rays) {
  const Pack3<Float16> o{load<Float16>(rays.ox), load<Float16>(rays.oy), load<Float16>(rays.oz)};
  const Pack3<Float16> d{load<Float16>(rays.dx), load<Float16>(rays.dy), load<Float16>(rays.dz)};
  const Pack3<Float16> origin{row_times(f.unit_from_world[0], o) + splat<Float16>(f.unit_from_world[0][3]),
                              row_times(f.unit_from_world[1], o) + splat<Float16>(f.unit_from_world[1][3]),
                              row_times(f.unit_from_world[2], o) + splat<Float16>(f.unit_from_world[2][3])};
  const Pack3<Float16> direction{row_times(f.unit_from_world[0], d), row_times(f.unit_from_world[1], d),
                                 row_times(f.unit_from_world[2], d)};
  Chords c;
  const Float16 one = splat<Float16>(1.0f), zero = splat<Float16>(0.0f);
  const Float16 square = inner(direction, direction);
  c.per_unit = one / square_root(square);
  c.unit = {direction.x * c.per_unit, direction.y * c.per_unit, direction.z * c.per_unit};
  const Float16 back = zero - inner(origin, c.unit);
  c.middle = along(origin, back, c.unit);
  c.at = back * c.per_unit;
  const Float16 half_square = one - inner(c.middle, c.middle);
  c.met =
      less(zero, half_square) & less(splat<Float16>(1e-30f), square) & less(square, splat<Float16>(1e30f));
  c.half = square_root(max(half_square, zero));
  return c;
}

// s of entry (position, direction); no_hit where there is none.
HWY_INLINE Float16 sample(const DisplacementField& field, Int16 position, Int16 direction) {
  const int directions = field.shape.direction_side * field.shape.direction_side;
  const Int16 entry = position * splat<Int16>(directions) + direction;
  if (field.bits == 32) return gather<float>(field.table.data(), shift_left<2>(entry));
  const Float16 none = splat<Float16>(no_hit);
  if (field.bits == 8) {
    const Int16 byte = gather<std::int32_t>(field.table.data(), entry) & splat<Int16>(255);
    const Float16 s = to_float(byte) * splat<Float16>(1 / 127.0f) - splat<Float16>(1.0f);
    return where_not_above(splat<Float16>(1.0f + 0.5f / 127), s, none, s);
  }
  const Int16 word = gather<std::int32_t>(field.table.data(), shift_right<3>(entry));
  const Int16 bit = shift_right(word, entry & splat<Int16>(7)) & splat<Int16>(1);
  return where_not_above(splat<Float16>(1.0f), to_float(bit),
                         gather<float>(field.mean.data(), shift_left<2>(position)), none);
}

// The paper's second discretisation: seen from position sample a, the direction to the chord's middle.
HWY_INLINE Int16 direction_cell(const DisplacementField& field, Int16 position,
                                const Pack3<Float16>& middle) {
  const Float16 one = splat<Float16>(1.0f);
  const Int16 offset = position * splat<Int16>(sizeof(glm::vec3));
  const float* points = &field.points[0].x;
  const Pack3<Float16> a{gather<float>(points, offset), gather<float>(points + 1, offset),
                         gather<float>(points + 2, offset)};
  const Pack3<Float16> to{middle.x - a.x, middle.y - a.y, middle.z - a.z};
  const Float16 scale = one / square_root(inner(to, to));
  // frame_around(-a)
  const Pack3<Float16> n{splat<Float16>(0.0f) - a.x, splat<Float16>(0.0f) - a.y, splat<Float16>(0.0f) - a.z};
  const Float16 sign = copy_sign(one, n.z);
  const Float16 k = splat<Float16>(-1.0f) / (sign + n.z), b = n.x * n.y * k;
  const Pack3<Float16> x{one + sign * (n.x * n.x * k), sign * b, (splat<Float16>(0.0f) - sign) * n.x};
  const Pack3<Float16> y{b, sign + n.y * n.y * k, splat<Float16>(0.0f) - n.y};
  return cell_index(square_from_disk(inner(to, x) * scale, inner(to, y) * scale), field.shape.direction_side);
}

void nearest_hits(const FieldInstance& instance, const RayBatch& rays, float* distance) {
  const DisplacementField& field = *instance.field;
  const Chords c = chords_of(instance, rays);
  const Float16 zero = splat<Float16>(0.0f), one = splat<Float16>(1.0f);
  const Float16 before = load<Float16>(distance);
  const Float16 enter = c.at - c.half * c.per_unit, exit = c.at + c.half * c.per_unit;
  const Truth16 near = c.met & less(zero, exit) & less(enter, before);
  if (!any(near)) return;
  const auto end_cell = [&](Float16 s) {  // lanes without a chord look somewhere, to no effect
    const Pack3<Float16> p = along(c.middle, s, c.unit);
    return cell_index(
        square_from_direction({where(c.met, p.x, zero), where(c.met, p.y, zero), where(c.met, p.z, one)}),
        field.shape.position_side);
  };
  const Int16 entry = end_cell(zero - c.half), out = end_cell(c.half);
  const bool chords = field.layout == FieldLayout::chords;
  const Pack3<Float16> middle{where(c.met, c.middle.x, zero), where(c.met, c.middle.y, zero),
                              where(c.met, c.middle.z, zero)};
  const Float16 s = sample(field, entry, chords ? out : direction_cell(field, entry, middle));
  const Float16 t = c.at + s * c.per_unit;
  const Truth16 hit = near & less(s, splat<Float16>(no_hit));
  const Truth16 outside = not_above(zero, enter), ahead = not_above(zero, t);
  Float16 found = where(hit & (outside | ahead), max(t, max(enter, zero)), before);
  if (instance.ends == FieldEnds::both) {
    const Truth16 behind = hit & less(t, zero) & less(enter, zero);
    if (any(behind)) {
      const Float16 s2 = sample(field, out, chords ? entry : direction_cell(field, out, middle));
      const Float16 t2 = c.at - s2 * c.per_unit;
      const Truth16 second = behind & less(s2, splat<Float16>(no_hit)) & not_above(zero, t2);
      found = where(second, t2, found);
    }
  }
  store(min(found, before), distance);
}

}  // namespace

FieldKernels field_kernels() {
  return {nearest_hits};
}

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra {

FieldKernels field_kernels(SimdLevel level) {
  switch (level == SimdLevel::automatic ? best_simd_level() : level) {
#if HWY_TARGETS & HWY_AVX3
    case SimdLevel::avx512:
      return N_AVX3::field_kernels();
#endif
#if HWY_TARGETS & HWY_AVX2
    case SimdLevel::avx2:
      return N_AVX2::field_kernels();
#endif
#if HWY_TARGETS & HWY_SSE4
    case SimdLevel::sse4:
      return N_SSE4::field_kernels();
#endif
    default:
      return HWY_STATIC_DISPATCH(field_kernels)();
  }
}

}  // namespace tenebra
#endif
