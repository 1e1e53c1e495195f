// Occluders of a group at one point: which of them reach a part of the light, and their lines. Blocks of
// sixteen are moved to the point when they are first asked for. Included once per target.
#if defined(TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_
#undef TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_
#else
#define TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_
#endif

#include <utility>

#include "soft/occluder_blocks-inl.h"
#include "soft/shadow_list-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

template <class T>
class ClipCandidates {
public:
  /// `heights` of the occluders that will be added.
  void clear(std::span<const PlaneHeight> heights) {
    heights_ = heights;
    count_ = 0;
    point_ = 0;
  }
  void add(const Candidate& candidate) {
    if (count_ % 16 == 0) {
      const std::size_t blocks = count_ / 16 + 1;
      if (blocks_.size() < blocks) {
        blocks_.resize(2 * blocks);
        at_point_.resize(2 * blocks);
        useful_.resize(2 * blocks);
      }
      OccluderBlock& block = blocks_[blocks - 1];
      block.lanes = block.indefinite = block.quads = 0;
      at_point_[blocks - 1].boxes_of = at_point_[blocks - 1].lines_of = 0;
      useful_[blocks - 1] = 0;
    }
    put(candidate, blocks_[count_ / 16], count_ % 16);
    ++count_;
  }
  std::size_t count() const { return count_; }
  std::size_t block_count() const { return (count_ + 15) / 16; }
  OccluderBlock& block(std::size_t b) { return blocks_[b]; }

  /// Forgets all lists. `at` stays where it is until the next.
  void move_to(const GroupPoint& at) {
    at_ = &at;
    ++point_;
    list.shrink(0);
  }

  /// Appends to the list what may reach into `box`.
  HWY_INLINE void append_block(std::size_t b, const LightBox<T>& box) {
    const BlockAtPoint<T>& there = with_boxes(b);
    list.append(there.box, 16 * b, there.lanes & blocks_[b].lanes, box);
  }
  /// The occluders of block 0, and bits of those that may reach into `box`.
  HWY_INLINE ShadowBoxes<T> first_block(const LightBox<T>& box, std::uint64_t& met) {
    const BlockAtPoint<T>& there = with_boxes(0);
    const ShadowBoxes<T> boxes{{there.box[0], there.box[1], there.box[2], there.box[3]}, lane_numbers<T>};
    met = bits(meets(boxes, box)) & there.lanes & blocks_[0].lanes;
    return boxes;
  }

  /// The lines around an occluder's shadow.
  HWY_INLINE ShadowLines<T> lines_of(std::size_t id) {
    const std::size_t b = id / 16, k = id % 16;
    BlockAtPoint<T>& there = at_point_[b];
    if (there.lines_of != point_) {
      find_lines(blocks_[b], *at_, there);
      there.lines_of = point_;
    }
    return {there.u[k], there.v[k], there.w[k]};
  }

  void mark_useful(std::size_t id) { useful_[id / 16] |= 1u << (id % 16); }
  /// Bits of the occluders of a block that took something from the light since they were last asked for.
  std::uint32_t take_useful(std::size_t b) { return std::exchange(useful_[b], 0u); }

  ShadowList<T> list;

private:
  HWY_INLINE const BlockAtPoint<T>& with_boxes(std::size_t b) {
    BlockAtPoint<T>& there = at_point_[b];
    if (there.boxes_of != point_) {
      find_boxes(blocks_[b], heights_, *at_, there);
      there.boxes_of = point_;
    }
    return there;
  }

  std::span<const PlaneHeight> heights_;
  std::vector<OccluderBlock> blocks_;
  std::vector<BlockAtPoint<T>> at_point_;
  std::vector<std::uint32_t> useful_;
  std::size_t count_ = 0;
  const GroupPoint* at_ = nullptr;
  std::uint32_t point_ = 0;  ///< number of the point at hand, from 1
};

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
