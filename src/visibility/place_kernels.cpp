#include "visibility/place_kernels.h"

#include <algorithm>
#include <bit>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/place_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/float16-inl.h"
#include "visibility/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::visibility::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

/// Blocks of a record's box, first and last.
struct BlockBox {
  explicit BlockBox(const TileRecord& r)
      : x0(r.x0 / block_side), y0(r.y0 / block_side), x1(r.x1 / block_side), y1(r.y1 / block_side) {}
  /// Which of a region's sixteen blocks lie within.
  std::uint32_t bits_of(int region_x, int region_y) const {
    const auto span = [](int first, int last) {  // of four
      return (0xfu << std::clamp(first, 0, 4) & 0xfu) & ~(0xfu << std::clamp(last + 1, 0, 4));
    };
    const std::uint32_t columns = span(x0 - 4 * region_x, x1 - 4 * region_x);
    std::uint32_t all = 0;
    for (int row = 0; row < 4; ++row)
      if (4 * region_y + row >= y0 && 4 * region_y + row <= y1) all |= columns << (4 * row);
    return all;
  }
  int x0, y0, x1, y1;
};

/// The least or the largest values of a record's functions at any place of the blocks of a region.
///
/// They round as those of Lanes do, edges a little less often; depths are off by sixteen roundings at most of
/// numbers as large as `size`.
template <bool largest>
class RegionValues {
public:
  SIMD_INLINE RegionValues(const Lanes& lanes, float around_px) : lanes_(lanes) {
    const TileRecord& r = lanes.r;
    constexpr float last_pixel = block_side - 1, side = block_side;
    for (int k = 0; k < 4; ++k) {
      const float around = around_px * (std::abs(r.along_x[k]) + std::abs(r.along_y[k]));
      const float x = largest ? std::max(r.along_x[k], 0.0f) : std::min(r.along_x[k], 0.0f),
                  y = largest ? std::max(r.along_y[k], 0.0f) : std::min(r.along_y[k], 0.0f);
      const float most = (x * last_pixel + y * last_pixel) + (largest ? around : -around);
      within_[k] = lanes.within[k] * broadcast<Float16>(side) + broadcast<Float16>(most);
    }
    const float size = std::abs(r.value[3]) + 66 * (std::abs(r.along_x[3]) + std::abs(r.along_y[3]));
    within_[3] = within_[3] + broadcast<Float16>((largest ? size : -size) * 0x1p-20f);
  }
  SIMD_INLINE Float16 inside(int region_x, int region_y) const {
    return min(min(at(0, region_x, region_y), at(1, region_x, region_y)), at(2, region_x, region_y));
  }
  SIMD_INLINE Float16 depth(int region_x, int region_y) const {
    return min(max(at(3, region_x, region_y), broadcast<Float16>(lanes_.r.far_depth)),
               broadcast<Float16>(lanes_.r.near_depth));
  }

private:
  SIMD_INLINE Float16 at(int k, int region_x, int region_y) const {
    return within_[k] + broadcast<Float16>(lanes_.corner(k, 4 * region_x, 4 * region_y));
  }

  const Lanes& lanes_;
  Float16 within_[4];
};

/// Whether the record can cover all places of a block.
bool spans_a_block(const TileRecord& r) {
  return r.x1 - r.x0 >= block_side - 1 && r.y1 - r.y0 >= block_side - 1 && (r.id & doubtful_bit) == 0;
}

SIMD_INLINE void cover_with(const PlaceTask& task, std::size_t number, Covers& out) {
  const TileRecord& r = *task.records[number];
  const Lanes lanes(r);
  const RegionValues<false> least(lanes, task.around_px);
  const RegionValues<true> most(lanes, task.around_px);
  const BlockBox box(r);
  for (int region_y = box.y0 / 4; region_y <= box.y1 / 4; ++region_y) {
    for (int region_x = box.x0 / 4; region_x <= box.x1 / 4; ++region_x) {
      const int block = block_index(4 * region_x, 4 * region_y);
      const Float16 depth = least.depth(region_x, region_y), old = load<Float16>(out.far_depth + block);
      const auto covered = lt(broadcast<Float16>(2 * edge_band), least.inside(region_x, region_y)) &
                           le(most.depth(region_x, region_y), broadcast<Float16>(1.0f)) & lt(old, depth);
      if (!any(covered)) continue;
      store(select(covered, depth, old), out.far_depth + block);
      for (std::uint32_t open = bits(covered); open != 0; open &= open - 1)
        out.record[block + std::countr_zero(open)] = static_cast<std::uint32_t>(number);
    }
  }
}

SIMD_INLINE void list_one(const PlaceTask& task, std::size_t number, const Covers& covers, BlockLists& out) {
  const TileRecord& r = *task.records[number];
  const Lanes lanes(r);
  const RegionValues<true> most(lanes, task.around_px);
  const BlockBox box(r);
  const bool doubtful = (r.id & doubtful_bit) != 0;
  for (int region_y = box.y0 / 4; region_y <= box.y1 / 4; ++region_y) {
    for (int region_x = box.x0 / 4; region_x <= box.x1 / 4; ++region_x) {
      const int block = block_index(4 * region_x, 4 * region_y);
      const Float16 seen = load<Float16>(covers.far_depth + block);
      const auto reached = doubtful
                               ? le(seen, broadcast<Float16>(r.near_depth))
                               : le(broadcast<Float16>(-2 * edge_band), most.inside(region_x, region_y)) &
                                     le(seen, most.depth(region_x, region_y));
      for (std::uint32_t open = bits(reached) & box.bits_of(region_x, region_y); open != 0; open &= open - 1)
        out.add(block + std::countr_zero(open), number);
    }
  }
}

class BlockDrawing {
public:
  BlockDrawing(const PlaceTask& task, int block_x, int block_y, PlaceBlock& out)
      : task_(task), x_(block_x), y_(block_y), out_(out) {}

  SIMD_INLINE void draw(const TileRecord& r) {
    const Lanes lanes(r);
    Float16 centre[4];
    for (int k = 0; k < 4; ++k) centre[k] = lanes.at(k, x_, y_);
    for (std::size_t place = 0; place < task_.places.size(); ++place) {
      const glm::vec2 offset = task_.places[place];
      const auto at = [&](int k) {
        return centre[k] + broadcast<Float16>(r.along_x[k] * offset.x + r.along_y[k] * offset.y);
      };
      const auto covered = decided(r, min(min(at(0), at(1)), at(2)), offset);
      if (any(covered)) keep_nearest(r, covered, at(3), out_.depth[place], out_.ids[place]);
    }
  }

private:
  SIMD_INLINE Mask<float, 16> decided(const TileRecord& r, Float16 inside, glm::vec2 offset) const {
    const Float16 band = broadcast<Float16>(edge_band);
    const auto covered = lt(band, inside);
    const bool doubtful = (r.id & doubtful_bit) != 0;
    if (!doubtful && !any(le(abs(inside), band))) return covered;
    std::uint32_t set = doubtful ? 0 : bits(covered);
    std::uint32_t open = doubtful ? box_bits(r, x_, y_) : bits(le(abs(inside), band));
    const glm::dvec2 first(task_.left + block_side * x_ + 0.5, task_.top + block_side * y_ + 0.5);
    for (; open != 0; open &= open - 1) {
      const int lane = std::countr_zero(open);
      const glm::dvec2 pixel(lane % block_side, lane / block_side);
      if (task_.close.covers(r.id & ~doubtful_bit, first + pixel + glm::dvec2(offset))) set |= 1u << lane;
    }
    return mask_of_bits<float, 16>(set);
  }

  const PlaceTask& task_;
  int x_, y_;
  PlaceBlock& out_;
};

}  // namespace

void cover(const PlaceTask& task, Covers& out) {
  std::fill_n(out.far_depth, tile_blocks, 0.0f);
  std::fill_n(out.record, tile_blocks, no_record);
  for (std::size_t i = 0; i < task.records.size(); ++i)
    if (spans_a_block(*task.records[i])) cover_with(task, i, out);
}

void list(const PlaceTask& task, const Covers& covers, BlockLists& out) {
  out.clear();
  for (std::size_t i = 0; i < task.records.size(); ++i) list_one(task, i, covers, out);
}

void draw_block(const PlaceTask& task, const BlockLists& lists, int block_x, int block_y, PlaceBlock& out) {
  BlockDrawing drawing(task, block_x, block_y, out);
  for (std::uint32_t i = lists.first[block_index(block_x, block_y)]; i != no_record;
       i = lists.entries[i].next)
    drawing.draw(*task.records[lists.entries[i].record]);
}

PlaceKernels own_place_kernels() {
  return {cover, list, draw_block};
}

}  // namespace tenebra::visibility::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tenebra::visibility {

PlaceKernels place_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, own_place_kernels)();
}

}  // namespace tenebra::visibility
#endif
