// Sixteen rays against one field. Without fused operations, so that every instruction set gives the same
// bits.
#include "ao/field_chords.h"
#include "ao/field_lookup.h"
#include "ao/near_cells.h"

#define HWY_DISABLED_TARGETS (HWY_AVX3_DL | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ao/field_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "ao/bvh_trace-inl.h"
#include "ao/sphere_maps-inl.h"
#include "simd/pack-inl.h"

#include <algorithm>
#include <bit>

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

constexpr float half_diagonal = 0.70710678f;  // of a cell, in widths
constexpr float cast_cells = 1;               // how far close rays are cast, in cells

// The ray in unit space and its chord of the unit sphere.
struct Chords {
  Truth16 met;            // the line has a chord at all
  Pack3<Float16> origin;  // of the ray
  Pack3<Float16> unit;    // its direction
  Pack3<Float16> middle;  // of the chord: the point nearest to the centre; the centre where there is none
  Float16 half;           // length
  Float16 at;             // t of the middle
  Float16 per_unit;       // t of one unit of length
};

HWY_INLINE Float16 row_times(const float row[4], const Pack3<Float16>& v) {
  return (splat<Float16>(row[0]) * v.x + splat<Float16>(row[1]) * v.y) + splat<Float16>(row[2]) * v.z;
}
HWY_INLINE Pack3<Float16> moved(const float rows[3][4], const Pack3<Float16>& p) {
  return {row_times(rows[0], p) + splat<Float16>(rows[0][3]),
          row_times(rows[1], p) + splat<Float16>(rows[1][3]),
          row_times(rows[2], p) + splat<Float16>(rows[2][3])};
}

HWY_INLINE Chords chords_of(const FieldInstance& f, const RayBatch& rays) {
  const Float16 one = splat<Float16>(1.0f), zero = splat<Float16>(0.0f);
  const Pack3<Float16> d{load<Float16>(rays.dx), load<Float16>(rays.dy), load<Float16>(rays.dz)};
  const Pack3<Float16> direction{row_times(f.unit_from_world[0], d), row_times(f.unit_from_world[1], d),
                                 row_times(f.unit_from_world[2], d)};
  Chords c;
  c.origin =
      moved(f.unit_from_world, {load<Float16>(rays.ox), load<Float16>(rays.oy), load<Float16>(rays.oz)});
  const Float16 square = inner(direction, direction);
  c.per_unit = one / square_root(square);
  c.unit = {direction.x * c.per_unit, direction.y * c.per_unit, direction.z * c.per_unit};
  const Float16 ahead = zero - inner(c.origin, c.unit);
  c.at = ahead * c.per_unit;
  const Pack3<Float16> middle = along(c.origin, ahead, c.unit);
  const Float16 half_square = one - inner(middle, middle);
  c.met =
      less(zero, half_square) & less(splat<Float16>(1e-30f), square) & less(square, splat<Float16>(1e30f));
  c.half = square_root(max(half_square, zero));
  c.middle = {where(c.met, middle.x, zero), where(c.met, middle.y, zero), where(c.met, middle.z, zero)};
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

// The paper's second discretisation: the direction to the chord's middle, seen from the position sample.
HWY_INLINE Int16 direction_cell(const FieldShape& shape, const Cell16& position,
                                const Pack3<Float16>& middle) {
  const Float16 zero = splat<Float16>(0.0f), one = splat<Float16>(1.0f);
  const Pack3<Float16> a = direction_from_square(cell_point(position, shape.position_side));
  const Pack3<Float16> n{zero - a.x, zero - a.y, zero - a.z};  // inwards
  const Pack3<Float16> to{middle.x + n.x, middle.y + n.y, middle.z + n.z};
  const Float16 scale = one / square_root(inner(to, to));
  // frame_around(n)
  const Float16 sign = copy_sign(one, n.z);
  const Float16 k = splat<Float16>(-1.0f) / (sign + n.z), b = n.x * n.y * k;
  const Pack3<Float16> x{one + sign * (n.x * n.x * k), sign * b, (zero - sign) * n.x};
  const Pack3<Float16> y{b, sign + n.y * n.y * k, zero - n.y};
  const Square16 square = square_from_disk(inner(to, x) * scale, inner(to, y) * scale);
  return cell_index(cell_of(square, shape.direction_side), shape.direction_side);
}

// The two looks at a chord: t of the first hit seen from the entry, and of the first seen from the exit,
// which is the last along the ray. `none` where there is no hit.
class Looks {
public:
  HWY_INLINE Looks(const DisplacementField& field, const Chords& chords)
      : field_(field),
        c_(chords),
        paper_(field.layout == FieldLayout::positions_directions),
        entry_(end_cell(splat<Float16>(0.0f) - c_.half)),
        exit_(paper_ ? entry_ : end_cell(c_.half)) {}

  HWY_INLINE Float16 first(Float16 none) const {
    const Float16 s = look(entry_, exit_);
    return where(less(s, splat<Float16>(no_hit)), c_.at + s * c_.per_unit, none);
  }
  HWY_INLINE Float16 last(Float16 none) const {
    const Float16 s = look(paper_ ? end_cell(c_.half) : exit_, entry_);
    return where(less(s, splat<Float16>(no_hit)), c_.at - s * c_.per_unit, none);
  }

private:
  // The cell of the point of the chord that lies s beyond its middle.
  HWY_INLINE Cell16 end_cell(Float16 s) const {
    return cell_of(square_from_direction(along(c_.middle, s, c_.unit)), field_.shape.position_side);
  }
  HWY_INLINE Float16 look(const Cell16& from, const Cell16& to) const {
    const FieldShape& shape = field_.shape;
    return sample(field_, cell_index(from, shape.position_side),
                  paper_ ? direction_cell(shape, from, c_.middle) : cell_index(to, shape.direction_side));
  }

  const DisplacementField& field_;
  const Chords& c_;
  bool paper_;
  Cell16 entry_, exit_;
};

// Bits of those rays `inside` that start close to the object.
HWY_INLINE std::uint32_t close_rays(const DisplacementField& field, const Chords& c, Truth16 inside) {
  const Float16 half = splat<Float16>(0.5f * near_side), last = splat<Float16>(near_side - 1.0f);
  const auto cell = [&](Float16 x) {
    return truncate(min(max(where(inside, x, half) * half + half, splat<Float16>(0.0f)), last));
  };
  const Int16 side = splat<Int16>(near_side);
  const Int16 place = (cell(c.origin.z) * side + cell(c.origin.y)) * side + cell(c.origin.x);
  const Int16 word = gather<std::int32_t>(field.close.data(), shift_left<2>(shift_right<5>(place)));
  const Int16 bit = shift_right(word, place & splat<Int16>(31)) & splat<Int16>(1);
  return bits(inside & less(splat<Float16>(0.0f), to_float(bit)));
}

// Casts the rays in `which` from t = from[i] to to[i]; to[i] becomes the distance of the hit if there is one.
void cast(const FieldInstance& instance, const RayBatch& rays, std::uint32_t which, const float* from,
          float* to) {
  const auto& m = instance.object_from_world;
  for (; which != 0; which &= which - 1) {
    const int i = std::countr_zero(which);
    const glm::vec3 o = rays.origin(i), d = rays.direction(i);
    CasterRay ray{.from = from[i], .to = to[i]};
    for (int k = 0; k < 3; ++k) {
      ray.origin[k] = m[k][0] * o.x + m[k][1] * o.y + m[k][2] * o.z + m[k][3];
      ray.direction[k] = m[k][0] * d.x + m[k][1] * d.y + m[k][2] * d.z;
    }
    to[i] = std::min(to[i], trace_ray<false>(*instance.near, ray).distance);
  }
}

// The answer for rays from outside, and what is known of the others.
struct Answer {
  Truth16 live;    // rays that may still meet the object
  Float16 start;   // from here on: 0, where the sphere begins, or as far as the ray was cast
  Float16 before;  // what was found before or by casting
};

// Rays that start close to the object are cast for one cell's width.
HWY_INLINE int cast_close(const FieldInstance& instance, const RayBatch& rays, const Chords& c,
                          Truth16 inside, Answer& answer) {
  const std::uint32_t close = close_rays(*instance.field, c, inside);
  if (close == 0) return 0;
  float from[batch_size] = {}, start[batch_size], reach[batch_size], before[batch_size];
  store(answer.start, start);
  store(answer.before, before);
  store(splat<Float16>(cast_cells * instance.field->cell()) * c.per_unit, reach);
  for (std::uint32_t rest = close; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    start[i] = reach[i];
    reach[i] = std::min(reach[i], before[i]);
  }
  cast(instance, rays, close, from, reach);
  for (std::uint32_t rest = close; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    if (reach[i] < start[i]) before[i] = std::min(before[i], reach[i]);
  }
  answer.start = load<Float16>(start);
  answer.before = load<Float16>(before);
  answer.live = answer.live & less(answer.start, answer.before);
  return std::popcount(close);
}

// A ray that is in the open at t = start, between the first and the last hit of its chord. Next to one of
// them, it is taken to lie before the first or behind the last. Else something may come before the last: it
// is cast, or the last stands for it.
HWY_INLINE int between(const FieldInstance& instance, const RayBatch& rays, const Answer& answer,
                       Truth16 behind, Float16 first, Float16 last, Float16 tolerance, Float16& found) {
  const Float16 none = splat<Float16>(no_distance);
  const Float16 behind_first = answer.start - first, before_last = last - answer.start;
  const Truth16 at_first = behind & less(behind_first, min(tolerance, before_last));
  const Truth16 deep = behind & not_above(tolerance, before_last) & not_above(tolerance, behind_first);
  found = where(at_first, answer.start, where(behind, where(deep, last, none), found));
  if (instance.near == nullptr) return 0;
  const std::uint32_t which = bits(deep);
  if (which == 0) return 0;
  float from[batch_size], to[batch_size], limit[batch_size];
  store(answer.start, from);
  store(answer.before, limit);
  std::copy(limit, limit + batch_size, to);
  cast(instance, rays, which, from, to);
  for (int i = 0; i < batch_size; ++i)
    if (to[i] == limit[i]) to[i] = no_distance;
  found = where(deep, load<Float16>(to), found);
  return std::popcount(which);
}

int nearest_hits(const FieldInstance& instance, const RayBatch& rays, float* distance) {
  const DisplacementField& field = *instance.field;
  const Chords c = chords_of(instance, rays);
  const Float16 zero = splat<Float16>(0.0f), none = splat<Float16>(no_distance);
  const Float16 reach = c.half * c.per_unit, enter = c.at - reach, exit = c.at + reach;
  Answer answer{.start = max(enter, zero), .before = load<Float16>(distance)};
  answer.live = c.met & less(zero, exit) & less(enter, answer.before);
  if (!any(answer.live)) return 0;
  Truth16 inside = answer.live & less(enter, zero);
  int casts = 0;
  if (instance.near != nullptr && any(inside)) {
    casts = cast_close(instance, rays, c, inside, answer);
    answer.live = answer.live & less(answer.start, exit);
    inside = inside & answer.live;
  }
  const Looks looks(field, c);
  const Float16 first = looks.first(none);
  const Truth16 behind = inside & less(first, answer.start);
  Float16 found = where(behind, none, max(first, answer.start));
  if (instance.ends == FieldEnds::both && any(behind)) {
    const Float16 tolerance = splat<Float16>(half_diagonal * field.cell()) * c.per_unit;
    casts += between(instance, rays, answer, behind, first, looks.last(first), tolerance, found);
  }
  store(where(answer.live, min(found, answer.before), answer.before), distance);
  return casts;
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
