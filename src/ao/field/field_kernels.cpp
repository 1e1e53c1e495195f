// Sixteen rays against one field. Without fused operations, so that every instruction set gives the same
// bits.
#include "ao/field/field_chords.h"
#include "ao/field/field_lookup.h"
#include "ao/field/near_cells.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ao/field/field_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "ao/field/field_chords-inl.h"
#include "simd/dispatch.h"
#include "simd/prefetch.h"
#include "trees/bvh_trace-inl.h"

#include <algorithm>
#include <bit>

HWY_BEFORE_NAMESPACE();
namespace tenebra::ao::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;
using namespace trees::HWY_NAMESPACE;

namespace {

// Batches looked up at once, so that their table entries arrive while others are worked on.
constexpr std::size_t in_flight = 8;
constexpr float half_diagonal = 0.70710678f;  // of a cell, in widths
constexpr float cast_cells = 1;               // how far close rays are cast, in cells

// Bits of those rays `inside` that start close to the object.
SIMD_INLINE std::uint32_t close_rays(const DisplacementField& field, const Chords& c, Mask16 inside) {
  const Float16 half = broadcast<Float16>(0.5f * near_side), last = broadcast<Float16>(near_side - 1.0f);
  const auto cell = [&](Float16 x) {
    return truncate(min(max(select(inside, x, half) * half + half, broadcast<Float16>(0.0f)), last));
  };
  const Int16 side = broadcast<Int16>(near_side);
  const Int16 place = (cell(c.origin.z) * side + cell(c.origin.y)) * side + cell(c.origin.x);
  const Int16 word = gather<std::int32_t>(field.close.data(), shift_left<2>(shift_right<5>(place)));
  const Int16 bit = shift_right(word, place & broadcast<Int16>(31)) & broadcast<Int16>(1);
  return bits(inside & lt(broadcast<Float16>(0.0f), to_float(bit)));
}

// Casts the rays in `which` from t = from[i] to to[i]; to[i] becomes the distance of the hit if there is one.
void cast(const FieldInstance& instance, const trees::RayBatch& rays, std::uint32_t which, const float* from,
          float* to) {
  const auto& m = instance.object_from_world;
  for (; which != 0; which &= which - 1) {
    const int i = std::countr_zero(which);
    const glm::vec3 o = rays.origin(i), d = rays.direction(i);
    trees::CasterRay ray{.from = from[i], .to = to[i]};
    for (int k = 0; k < 3; ++k) {
      ray.origin[k] = m[k][0] * o.x + m[k][1] * o.y + m[k][2] * o.z + m[k][3];
      ray.direction[k] = m[k][0] * d.x + m[k][1] * d.y + m[k][2] * d.z;
    }
    to[i] = std::min(to[i], trace_ray<false>(*instance.near, ray).distance);
  }
}

// The answer for rays from outside, and what is known of the others.
struct Answer {
  Mask16 live;     // rays that may still meet the object
  Float16 start;   // from here on: 0, where the sphere begins, or as far as the ray was cast
  Float16 before;  // what was found before or by casting
};

// Rays that start close to the object are cast for one cell's width.
SIMD_INLINE int cast_close(const FieldInstance& instance, const trees::RayBatch& rays, const Chords& c,
                           Mask16 inside, Answer& answer) {
  const std::uint32_t close = close_rays(*instance.field, c, inside);
  if (close == 0) return 0;
  float from[trees::batch_size] = {}, start[trees::batch_size], reach[trees::batch_size],
        before[trees::batch_size];
  store(answer.start, start);
  store(answer.before, before);
  store(broadcast<Float16>(cast_cells * instance.field->cell()) * c.per_unit, reach);
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
  answer.live = answer.live & lt(answer.start, answer.before);
  return std::popcount(close);
}

// A ray that is in the open at t = start, between the first and the last hit of its chord. Next to one of
// them, it is taken to lie before the first or behind the last. Else something may come before the last: it
// is cast, or the last stands for it.
SIMD_INLINE int between(const FieldInstance& instance, const trees::RayBatch& rays, const Answer& answer,
                        Mask16 behind, Float16 first, Float16 last, Float16 tolerance, Float16& found) {
  const Float16 none = broadcast<Float16>(no_distance);
  const Float16 behind_first = answer.start - first, before_last = last - answer.start;
  const Mask16 at_first = behind & lt(behind_first, min(tolerance, before_last));
  const Mask16 deep = behind & le(tolerance, before_last) & le(tolerance, behind_first);
  found = select(at_first, answer.start, select(behind, select(deep, last, none), found));
  if (instance.near == nullptr) return 0;
  const std::uint32_t which = bits(deep);
  if (which == 0) return 0;
  float from[trees::batch_size], to[trees::batch_size], limit[trees::batch_size];
  store(answer.start, from);
  store(answer.before, limit);
  std::copy(limit, limit + trees::batch_size, to);
  cast(instance, rays, which, from, to);
  for (int i = 0; i < trees::batch_size; ++i)
    if (to[i] == limit[i]) to[i] = no_distance;
  found = select(deep, load<Float16>(to), found);
  return std::popcount(which);
}

// Sixteen rays that wait for the table.
struct Query {
  Chords chords;
  Answer answer;
  Mask16 inside;  // live rays that start in the unit sphere
  bool any;       // whether a ray is live; else `inside` and `looks` are not set
  Float16 exit;   // t where it ends
  Looks looks;
};

SIMD_INLINE void prefetch(const DisplacementField& field, Int16 entry) {
  std::int32_t at[trees::batch_size];
  store(byte_of(field, entry), at);
  for (const std::int32_t byte : at) simd::prefetch(field.table.data() + byte);
}

// Prefetches the table entries that the rays will need.
SIMD_INLINE void begin(const FieldInstance& instance, const trees::RayBatch& rays, const float* distance,
                       Query& q) {
  const Float16 zero = broadcast<Float16>(0.0f);
  const Chords c = q.chords = chords_of(instance, rays);
  const Float16 reach = c.half * c.per_unit, enter = c.at - reach;
  q.exit = c.at + reach;
  q.answer.start = max(enter, zero);
  q.answer.before = load<Float16>(distance);
  q.answer.live = c.met & lt(zero, q.exit) & lt(enter, q.answer.before);
  q.any = any(q.answer.live);
  if (!q.any) return;
  q.inside = q.answer.live & lt(enter, zero);
  q.looks.begin(*instance.field, c);
  prefetch(*instance.field, q.looks.from_enter().entry);
}

SIMD_INLINE int finish(const FieldInstance& instance, const trees::RayBatch& rays, Query& q,
                       float* distance) {
  const DisplacementField& field = *instance.field;
  const Chords& c = q.chords;
  if (!q.any) return 0;
  int casts = 0;
  if (instance.near != nullptr && any(q.inside)) {
    casts = cast_close(instance, rays, c, q.inside, q.answer);
    q.answer.live = q.answer.live & lt(q.answer.start, q.exit);
    q.inside = q.inside & q.answer.live;
  }
  const Float16 none = broadcast<Float16>(no_distance);
  const Float16 first = first_hit(field, c, q.looks.from_enter(), none);
  const Mask16 behind = q.inside & lt(first, q.answer.start);
  Float16 found = select(behind, none, max(first, q.answer.start));
  if (instance.ends == FieldEnds::both && any(behind)) {
    const Float16 tolerance = broadcast<Float16>(half_diagonal * field.cell()) * c.per_unit;
    const Float16 last = last_hit(field, c, q.looks.from_exit(field, c), first);
    casts += between(instance, rays, q.answer, behind, first, last, tolerance, found);
  }
  store(select(q.answer.live, min(found, q.answer.before), q.answer.before), distance);
  return casts;
}

int nearest_hits(const FieldInstance& instance, std::span<const trees::RayBatch> rays, float* distances) {
  Query queries[in_flight];
  int casts = 0;
  for (; !rays.empty(); rays = rays.subspan(std::min(in_flight, rays.size()))) {
    const std::size_t count = std::min(in_flight, rays.size());
    for (std::size_t i = 0; i < count; ++i)
      begin(instance, rays[i], distances + i * trees::batch_size, queries[i]);
    for (std::size_t i = 0; i < count; ++i)
      casts += finish(instance, rays[i], queries[i], distances + i * trees::batch_size);
    distances += count * trees::batch_size;
  }
  return casts;
}

}  // namespace

FieldKernels field_kernels() {
  return {nearest_hits};
}

}  // namespace tenebra::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::ao {

FieldKernels field_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, field_kernels)();
}

}  // namespace tenebra::ao
#endif
