// Boxes around parts of the light, sorted by halves as in the building of a tree of boxes. Included once per
// target.
#if defined(TENEBRA_SOFT_PART_BOXES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_PART_BOXES_INL_H_
#undef TENEBRA_SOFT_PART_BOXES_INL_H_
#else
#define TENEBRA_SOFT_PART_BOXES_INL_H_
#endif

#include <algorithm>
#include <vector>

#include "soft/occluders/shadow_list-inl.h"
#include "soft/polygon/light_fragments-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

template <class T>
class PartBoxes {
public:
  void reset(const auto& parts) {
    sides_.clear();
    parts_.clear();
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
      const LightBox<T> box = box_of(loaded(parts[i]));
      sides_.push_back({{box.cu - box.hu, -box.cu - box.hu, box.cv - box.hv, -box.cv - box.hv}});
      parts_.push_back(i);
    }
  }

  /// Index of the part in a place.
  std::uint32_t part(std::size_t place) const { return parts_[place]; }

  /// The box around the parts in places [begin, end), begin < end.
  LightBox<T> around(std::size_t begin, std::size_t end) const {
    Pack<T, 4> all = load<Pack<T, 4>>(sides_[parts_[begin]].side);
    for (std::size_t i = begin + 1; i < end; ++i) all = min(all, load<Pack<T, 4>>(sides_[parts_[i]].side));
    T b[4];
    store(all, b);
    return {(b[0] - b[1]) / 2, (b[2] - b[3]) / 2, (-b[1] - b[0]) / 2, (-b[3] - b[2]) / 2};
  }

  /// Sorts the parts in places [begin, end), which lie in `box`, by the half of it that their middles lie in;
  /// returns where the second half begins.
  std::size_t halve(std::size_t begin, std::size_t end, const LightBox<T>& box) {
    const std::size_t axis = box.hu >= box.hv ? 0 : 2;
    const T middle = 2 * (axis == 0 ? box.cu : box.cv);
    const auto low = [&](std::uint32_t i) {
      return sides_[i].side[axis] - sides_[i].side[axis + 1] < middle;
    };
    const auto at = [&](std::size_t i) { return parts_.begin() + static_cast<std::ptrdiff_t>(i); };
    return static_cast<std::size_t>(std::partition(at(begin), at(end), low) - parts_.begin());
  }

private:
  struct Sides {
    T side[4];  ///< least u, -greatest u, least v, -greatest v: around several is the least of each
  };
  std::vector<Sides> sides_;          ///< of each part
  std::vector<std::uint32_t> parts_;  ///< in places
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
