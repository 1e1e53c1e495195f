// Sixteen rays, their chords of one field's unit sphere, and the table's entries for them. Without fused
// operations, so that every instruction set gives the same bits.
#if defined(TENEBRA_AO_FIELD_CHORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_AO_FIELD_CHORDS_INL_H_
#undef TENEBRA_AO_FIELD_CHORDS_INL_H_
#else
#define TENEBRA_AO_FIELD_CHORDS_INL_H_
#endif

#include "ao/cast/sphere_maps-inl.h"
#include "ao/field/field_chords.h"
#include "ao/field/field_lookup.h"
#include "simd/float16-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::ao::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

using Mask16 = Mask<float, 16>;

SIMD_INLINE Pack3<Float16> along(const Pack3<Float16>& a, Float16 s, const Pack3<Float16>& b) {
  return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

// The ray in unit space and its chord of the unit sphere.
struct Chords {
  Mask16 met;             // the line has a chord at all
  Pack3<Float16> origin;  // of the ray
  Pack3<Float16> unit;    // its direction
  Pack3<Float16> middle;  // of the chord: the point nearest to the centre; the centre where there is none
  Float16 half;           // length
  Float16 at;             // t of the middle
  Float16 per_unit;       // t of one unit of length
};

SIMD_INLINE Float16 row_times(const float row[4], const Pack3<Float16>& v) {
  return (broadcast<Float16>(row[0]) * v.x + broadcast<Float16>(row[1]) * v.y) +
         broadcast<Float16>(row[2]) * v.z;
}
SIMD_INLINE Pack3<Float16> moved(const float rows[3][4], const Pack3<Float16>& p) {
  return {row_times(rows[0], p) + broadcast<Float16>(rows[0][3]),
          row_times(rows[1], p) + broadcast<Float16>(rows[1][3]),
          row_times(rows[2], p) + broadcast<Float16>(rows[2][3])};
}

SIMD_INLINE Chords chords_of(const FieldInstance& f, const trees::RayBatch& rays) {
  const Float16 one = broadcast<Float16>(1.0f), zero = broadcast<Float16>(0.0f);
  const Pack3<Float16> d{load<Float16>(rays.dx), load<Float16>(rays.dy), load<Float16>(rays.dz)};
  const Pack3<Float16> direction{row_times(f.unit_from_world[0], d), row_times(f.unit_from_world[1], d),
                                 row_times(f.unit_from_world[2], d)};
  Chords c;
  c.origin =
      moved(f.unit_from_world, {load<Float16>(rays.ox), load<Float16>(rays.oy), load<Float16>(rays.oz)});
  const Float16 square = dot_unfused(direction, direction);
  c.per_unit = one / sqrt(square);
  c.unit = {direction.x * c.per_unit, direction.y * c.per_unit, direction.z * c.per_unit};
  const Float16 ahead = zero - dot_unfused(c.origin, c.unit);
  c.at = ahead * c.per_unit;
  const Pack3<Float16> middle = along(c.origin, ahead, c.unit);
  const Float16 half_square = one - dot_unfused(middle, middle);
  c.met =
      lt(zero, half_square) & lt(broadcast<Float16>(1e-30f), square) & lt(square, broadcast<Float16>(1e30f));
  c.half = sqrt(max(half_square, zero));
  c.middle = {select(c.met, middle.x, zero), select(c.met, middle.y, zero), select(c.met, middle.z, zero)};
  return c;
}

// Where in the table an entry stands, in bytes.
SIMD_INLINE Int16 byte_of(const DisplacementField& field, Int16 entry) {
  return field.bits == 32 ? shift_left<2>(entry) : field.bits == 8 ? entry : shift_right<3>(entry);
}

// s of an entry, which belongs to `position`; no_hit where there is none.
SIMD_INLINE Float16 sample(const DisplacementField& field, Int16 position, Int16 entry) {
  const Int16 at = byte_of(field, entry);
  if (field.bits == 32) return gather<float>(field.table.data(), at);
  const Float16 none = broadcast<Float16>(no_hit);
  const Int16 word = gather<std::int32_t>(field.table.data(), at);
  if (field.bits == 8) {
    const Float16 s =
        to_float(word & broadcast<Int16>(255)) * broadcast<Float16>(1 / 127.0f) - broadcast<Float16>(1.0f);
    return select_le(broadcast<Float16>(1.0f + 0.5f / 127), s, none, s);
  }
  const Int16 bit = shift_right(word, entry & broadcast<Int16>(7)) & broadcast<Int16>(1);
  return select_le(broadcast<Float16>(1.0f), to_float(bit),
                   gather<float>(field.mean.data(), shift_left<2>(position)), none);
}

// The paper's second discretisation: the direction to the chord's middle, seen from the position sample.
SIMD_INLINE Int16 direction_cell(const FieldShape& shape, const Cell16& position,
                                 const Pack3<Float16>& middle) {
  const Float16 zero = broadcast<Float16>(0.0f), one = broadcast<Float16>(1.0f);
  const Pack3<Float16> a = direction_from_square(cell_point(position, shape.position_side));
  const Pack3<Float16> n{zero - a.x, zero - a.y, zero - a.z};  // inwards
  const Pack3<Float16> to{middle.x + n.x, middle.y + n.y, middle.z + n.z};
  const Float16 scale = one / sqrt(dot_unfused(to, to));
  // frame_around(n)
  const Float16 sign = copy_sign(one, n.z);
  const Float16 k = broadcast<Float16>(-1.0f) / (sign + n.z), b = n.x * n.y * k;
  const Pack3<Float16> x{one + sign * (n.x * n.x * k), sign * b, (zero - sign) * n.x};
  const Pack3<Float16> y{b, sign + n.y * n.y * k, zero - n.y};
  const Square16 square = square_from_disk(dot_unfused(to, x) * scale, dot_unfused(to, y) * scale);
  return cell_index(cell_of(square, shape.direction_side), shape.direction_side);
}

// A look at a chord from one of its ends.
struct Look {
  Int16 position;  // of that end
  Int16 entry;     // of the table
};

// Both looks, once `begin` has been called.
class Looks {
public:
  SIMD_INLINE void begin(const DisplacementField& field, const Chords& c) {
    paper_ = field.layout == FieldLayout::positions_directions;
    const Cell16 enter = end_cell(field, c, broadcast<Float16>(0.0f) - c.half);
    from_enter_.position = cell_index(enter, field.shape.position_side);
    if (paper_) {
      from_enter_.entry = entry(field, from_enter_.position, direction_cell(field.shape, enter, c.middle));
    } else {
      exit_ = cell_index(end_cell(field, c, c.half), field.shape.position_side);
      from_enter_.entry = entry(field, from_enter_.position, exit_);
    }
  }
  SIMD_INLINE const Look& from_enter() const { return from_enter_; }
  SIMD_INLINE Look from_exit(const DisplacementField& field, const Chords& c) const {
    if (!paper_) return {exit_, entry(field, exit_, from_enter_.position)};
    const Cell16 exit = end_cell(field, c, c.half);
    const Int16 position = cell_index(exit, field.shape.position_side);
    return {position, entry(field, position, direction_cell(field.shape, exit, c.middle))};
  }

private:
  // The cell of the point of the chord that lies s beyond its middle.
  SIMD_INLINE static Cell16 end_cell(const DisplacementField& field, const Chords& c, Float16 s) {
    return cell_of(square_from_direction(along(c.middle, s, c.unit)), field.shape.position_side);
  }
  SIMD_INLINE static Int16 entry(const DisplacementField& field, Int16 position, Int16 direction) {
    const int directions = field.shape.direction_side * field.shape.direction_side;
    return position * broadcast<Int16>(directions) + direction;
  }

  bool paper_;
  Look from_enter_;
  Int16 exit_;  // position; chords only
};

// t of the first hit seen from the entry, and of the first seen from the exit, which is the last along the
// ray. `none` where there is no hit.
SIMD_INLINE Float16 first_hit(const DisplacementField& field, const Chords& c, const Look& from_enter,
                              Float16 none) {
  const Float16 s = sample(field, from_enter.position, from_enter.entry);
  return select(lt(s, broadcast<Float16>(no_hit)), c.at + s * c.per_unit, none);
}
SIMD_INLINE Float16 last_hit(const DisplacementField& field, const Chords& c, const Look& from_exit,
                             Float16 none) {
  const Float16 s = sample(field, from_exit.position, from_exit.entry);
  return select(lt(s, broadcast<Float16>(no_hit)), c.at - s * c.per_unit, none);
}

}  // namespace tenebra::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
