// Occluders of a group, and where the shadows that points of a range may see lie on the light: which of them
// reach a part of it. Blocks of sixteen are looked at when they are first asked for. Included once per
// target.
#if defined(TENEBRA_SOFT_OCCLUDER_LIST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_OCCLUDER_LIST_INL_H_
#undef TENEBRA_SOFT_OCCLUDER_LIST_INL_H_
#else
#define TENEBRA_SOFT_OCCLUDER_LIST_INL_H_
#endif

#include <utility>

#include "soft/occluders/occluder_blocks-inl.h"
#include "soft/occluders/shadow_list-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// `Range`: GroupPoint or PointRange.
template <class T, class Range>
class OccluderList {
public:
  /// `heights` of the occluders that will be added.
  void clear(std::span<const PlaneHeight> heights) {
    heights_ = heights;
    count_ = 0;
  }
  /// Takes memory for so many, of which make_room() writes to what it makes room in.
  void reserve(std::size_t occluders) {
    const std::size_t blocks = (occluders + 15) / 16;
    boxes_.reserve(blocks), useful_.reserve(blocks), blocks_.reserve(blocks);
  }
  /// Makes room for so many; add() makes more where it needs it.
  void make_room(std::size_t occluders) {
    const std::size_t blocks = (occluders + 15) / 16;
    if (blocks_.size() >= blocks) return;
    boxes_.resize(blocks);
    useful_.resize(blocks);
    blocks_.resize(blocks);  // last, as its size tells the room: memory may run out before
  }
  void add(const Candidate& candidate) {
    if (count_ % 16 == 0) {
      const std::size_t blocks = count_ / 16 + 1;
      if (blocks_.size() < blocks) make_room(32 * blocks);
      OccluderBlock& block = blocks_[blocks - 1];
      block.lanes = block.indefinite = block.quads = 0;
      boxes_[blocks - 1].boxes_of = 0;
      useful_[blocks - 1] = 0;
    }
    put(candidate, blocks_[count_ / 16], count_ % 16);
    ++count_;
  }
  std::size_t count() const { return count_; }
  std::size_t block_count() const { return (count_ + 15) / 16; }
  /// Its lanes may be changed before move_to(), not after it.
  OccluderBlock& block(std::size_t b) { return blocks_[b]; }

  /// Forgets all lists; what follows is about points of `range`.
  void move_to(const Range& range) {
    range_ = range;
    ++number_;
    list.shrink(0);
  }

  /// Appends to the list what may reach into `box`.
  SIMD_INLINE void append_block(std::size_t b, const LightBox<T>& box) {
    const BlockBoxes<T>& there = boxes_of(b);
    list.append(there.sides, 16 * b, there.lanes, box);
  }
  /// The occluders of block 0, and bits of those that may reach into `box`.
  SIMD_INLINE ShadowBoxes<T> first_block(const LightBox<T>& box, std::uint64_t& met) {
    const BlockBoxes<T>& there = boxes_of(0);
    const auto& s = there.sides;
    const ShadowBoxes<T> boxes{{s[0], s[1], s[2], s[3]}, lane_numbers<T>};
    met = bits(meets(boxes, box)) & there.lanes;
    return boxes;
  }

  void mark_useful(std::size_t id) { useful_[id / 16] |= 1u << (id % 16); }
  /// Bits of the occluders of a block that took something from the light since they were last asked for.
  std::uint32_t take_useful(std::size_t b) { return std::exchange(useful_[b], 0u); }

  ShadowList<T> list;

protected:
  std::uint64_t number() const { return number_; }  ///< number of the range at hand, from 1; none comes twice
  std::span<const PlaneHeight> heights() const { return heights_; }

private:
  SIMD_INLINE const BlockBoxes<T>& boxes_of(std::size_t b) {
    BlockBoxes<T>& there = boxes_[b];
    if (there.boxes_of != number_) {
      find_boxes(blocks_[b], range_, there);
      there.boxes_of = number_;
    }
    return there;
  }

  std::span<const PlaneHeight> heights_;
  std::vector<OccluderBlock> blocks_;
  std::vector<BlockBoxes<T>> boxes_;
  std::vector<std::uint32_t> useful_;
  std::size_t count_ = 0;
  Range range_;
  std::uint64_t number_ = 0;
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
