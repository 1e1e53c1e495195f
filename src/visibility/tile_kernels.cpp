#include "visibility/tile_kernels.h"

#include <algorithm>
#include <bit>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/tile_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/float16-inl.h"
#include "simd/prefetch.h"
#include "visibility/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::visibility::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

class TileDrawing {
public:
  TileDrawing(int left, int top, const CloseCalls& close, Tile& tile)
      : left_(left), top_(top), close_(close), tile_(tile) {}

  SIMD_INLINE void draw(const TileRecord& r) {
    const Lanes lanes(r);
    const int first_x = r.x0 / block_side, last_x = r.x1 / block_side, first_y = r.y0 / block_side,
              last_y = r.y1 / block_side;
    if ((last_x - first_x + 1) * (last_y - first_y + 1) > few_blocks && !(r.id & doubtful_bit))
      return draw_regions(lanes, first_x, last_x, first_y, last_y);
    for (int y = first_y; y <= last_y; ++y)
      for (int x = first_x; x <= last_x; ++x) draw_block(lanes, x, y);
  }

private:
  static constexpr int few_blocks = 6;

  /// The pixels that the triangle covers: those of which `inside` is certain, and exact answers for the
  /// others.
  SIMD_INLINE Mask<float, 16> decided(const Lanes& lanes, Float16 inside, int x, int y) const {
    const Float16 band = broadcast<Float16>(edge_band);
    const auto covered = lt(band, inside);
    const bool doubtful = (lanes.r.id & doubtful_bit) != 0;
    if (!doubtful && !any(le(abs(inside), band))) return covered;
    std::uint32_t set = doubtful ? 0 : bits(covered);
    std::uint32_t open = doubtful ? box_bits(lanes.r, x, y) : bits(le(abs(inside), band));
    for (; open != 0; open &= open - 1) {
      const int lane = std::countr_zero(open);
      if (close_.covers(lanes.r.id & ~doubtful_bit, left_ + block_side * x + lane % block_side,
                        top_ + block_side * y + lane / block_side))
        set |= 1u << lane;
    }
    return mask_of_bits<float, 16>(set);
  }

  SIMD_INLINE void draw_block(const Lanes& lanes, int x, int y) {
    const TileRecord& r = lanes.r;
    const int block = block_index(x, y);
    if (r.near_depth < tile_.far_depth[block]) return;
    const Float16 inside = min(min(lanes.at(0, x, y), lanes.at(1, x, y)), lanes.at(2, x, y));
    const auto covered = decided(lanes, inside, x, y);
    if (!any(covered)) return;
    const Float16 nearest =
        keep_nearest(r, covered, lanes.at(3, x, y), tile_.depth + 16 * block, tile_.ids + 16 * block);
    tile_.far_depth[block] = reduce_min(nearest);
  }

  /// Regions of sixteen blocks: which of these the triangle can reach and be seen in, all at once.
  SIMD_INLINE void draw_regions(const Lanes& lanes, int first_x, int last_x, int first_y, int last_y) {
    const TileRecord& r = lanes.r;
    Float16 best[4];  // largest value in a block, but for where the region is
    const float last_pixel = block_side - 1, side = block_side;
    for (int k = 0; k < 4; ++k) {
      const float most =
          std::max(r.along_x[k], 0.0f) * last_pixel + std::max(r.along_y[k], 0.0f) * last_pixel;
      best[k] = lanes.within[k] * broadcast<Float16>(side) + broadcast<Float16>(most);
    }
    // Values of edges and depths of pixels are not above these, but for roundings: of edges fewer than those
    // of Lanes, of depths sixteen at most of numbers as large as `size`.
    const float size = std::abs(r.value[3]) + 66 * (std::abs(r.along_x[3]) + std::abs(r.along_y[3]));
    best[3] = best[3] + broadcast<Float16>(size * 0x1p-20f);
    for (int region_y = first_y / 4; region_y <= last_y / 4; ++region_y) {
      for (int region_x = first_x / 4; region_x <= last_x / 4; ++region_x) {
        const auto corner = [&](int k) {
          return broadcast<Float16>(lanes.corner(k, 4 * region_x, 4 * region_y));
        };
        const Float16 inside = min(min(best[0] + corner(0), best[1] + corner(1)), best[2] + corner(2));
        const Float16 depth =
            min(max(best[3] + corner(3), broadcast<Float16>(r.far_depth)), broadcast<Float16>(r.near_depth));
        const Float16 seen = load<Float16>(tile_.far_depth + block_index(4 * region_x, 4 * region_y));
        const auto reached = le(broadcast<Float16>(-2 * edge_band), inside) & le(seen, depth);
        for (std::uint32_t open = bits(reached); open != 0; open &= open - 1) {
          const int lane = std::countr_zero(open), x = 4 * region_x + lane % 4, y = 4 * region_y + lane / 4;
          if (x >= first_x && x <= last_x && y >= first_y && y <= last_y) draw_block(lanes, x, y);
        }
      }
    }
  }

  int left_, top_;
  const CloseCalls& close_;
  Tile& tile_;
};

}  // namespace

void draw(const TileRecord* records, const std::uint32_t* order, std::size_t count, int left, int top,
          const CloseCalls& close, Tile& tile) {
  constexpr std::size_t ahead = 8;
  TileDrawing drawing(left, top, close, tile);
  for (std::size_t i = 0; i < count; ++i) {
    if (i + ahead < count) simd::prefetch(&records[order[i + ahead]]);
    drawing.draw(records[order[i]]);
  }
}

TileKernels own_tile_kernels() {
  return {draw};
}

}  // namespace tenebra::visibility::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tenebra::visibility {

TileKernels tile_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, own_tile_kernels)();
}

}  // namespace tenebra::visibility
#endif
