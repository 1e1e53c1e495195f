// Functions of a record at the sixteen pixels of a block. Included once per target.
#if defined(TENEBRA_VISIBILITY_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_VISIBILITY_LANES_INL_H_
#undef TENEBRA_VISIBILITY_LANES_INL_H_
#else
#define TENEBRA_VISIBILITY_LANES_INL_H_
#endif

#include "simd/float16-inl.h"
#include "visibility/records.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::visibility::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

constexpr float column_of_lane[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
constexpr float row_of_lane[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

/// A record's functions at the pixels of a block, but for where the block is.
///
/// Roundings of an edge's float value, where it may be near 0: |value| <= 134, slopes <= 1, offsets <= 66. In
/// units of 2^-24: value 134, slopes and their products with the block's place 66 each, their sum 132, with
/// the value 266, the lanes' products 3 each and sum 6, the last sum 272: 1080. With most_doubt, 512, and
/// what the double values lose to their last rounding that is 1592; a place beside the pixel's centre adds
/// 140. That is below the 2048 of edge_band.
struct Lanes {
  SIMD_INLINE explicit Lanes(const TileRecord& record) : r(record) {
    const Float16 column = load<Float16>(column_of_lane), row = load<Float16>(row_of_lane);
    for (int k = 0; k < 4; ++k)
      within[k] = broadcast<Float16>(r.along_x[k]) * column + broadcast<Float16>(r.along_y[k]) * row;
  }
  /// Value of function k at the first pixel of a block.
  SIMD_INLINE float corner(int k, int block_x, int block_y) const {
    const float x = static_cast<float>(block_side * block_x - r.x0),
                y = static_cast<float>(block_side * block_y - r.y0);
    return r.value[k] + (r.along_x[k] * x + r.along_y[k] * y);
  }
  SIMD_INLINE Float16 at(int k, int block_x, int block_y) const {
    return broadcast<Float16>(corner(k, block_x, block_y)) + within[k];
  }

  const TileRecord& r;
  Float16 within[4];
};

/// A block's depths and ids with a record's lanes `covered`, of depth `value`: the nearest is kept, the
/// smaller id where depths are equal. Returns the depths.
SIMD_INLINE Float16 keep_nearest(const TileRecord& r, Mask<float, 16> covered, Float16 value, float* depths,
                                 std::int32_t* ids) {
  const Float16 depth = min(max(value, broadcast<Float16>(r.far_depth)), broadcast<Float16>(r.near_depth));
  const auto shown = covered & le(depth, broadcast<Float16>(1.0f));  // cut by the near plane
  const Float16 offered = select(shown, depth, broadcast<Float16>(-1.0f));
  const Float16 old = load<Float16>(depths);
  const Int16 old_id = load<Int16>(ids),
              id = broadcast<Int16>(static_cast<std::int32_t>(r.id & ~doubtful_bit));
  const Int16 rival = select(eq(offered, old), old_id, broadcast<Int16>(std::int32_t{-1}));
  const Int16 kept = select(gt(rival, id), id, old_id);
  const Float16 nearest = max(offered, old);
  store(nearest, depths);
  store(select(lt(old, offered), id, kept), ids);
  return nearest;
}

/// Bits of a block's pixels that the record's box holds.
inline std::uint32_t box_bits(const TileRecord& r, int block_x, int block_y) {
  std::uint32_t set = 0;
  for (int lane = 0; lane < 16; ++lane) {
    const int x = block_side * block_x + lane % block_side, y = block_side * block_y + lane / block_side;
    if (x >= r.x0 && x <= r.x1 && y >= r.y0 && y <= r.y1) set |= 1u << lane;
  }
  return set;
}

}  // namespace tenebra::visibility::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
