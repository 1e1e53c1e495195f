// The occluders of a group in arrays of sixteen, their lines at one point, and which of them reach a part of
// the light. Included once per target.
#if defined(TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_
#undef TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_
#else
#define TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_
#endif

#include <bit>
#include <vector>

#include "soft/group_occluders.h"
#include "soft/light_polygon-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

/// A part of the light: |u - cu| <= hu, |v - cv| <= hv.
template <class T>
struct LightBox {
  T cu = 0, cv = 0, hu = 1, hv = 1;
};

/// Lines of sixteen occluders at one point, up to four each; missing ones are positive everywhere.
template <class T>
struct CandidateBlock {
  T u[4][16], v[4][16], w[4][16];
};

template <class T>
class ClipCandidates {
public:
  /// Rearranges a group's lines.
  void reset(const GroupOccluders<T>& group) {
    count_ = group.occluders.size();
    blocks_.assign((count_ + 15) / 16, {});
    for (auto& block : blocks_) {
      for (auto& slot : block.c) {
        for (auto& w : slot[0][2]) w = 1;
      }
    }
    slots_ = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Occluder& occluder = group.occluders[i];
      slots_ = HWY_MAX(slots_, static_cast<int>(occluder.line_count));
      for (std::uint32_t slot = 0; slot < occluder.line_count; ++slot) {
        const MovingLine<T>& line = group.lines[occluder.first_line + slot];
        for (int k = 0; k < 4; ++k) {
          for (int c = 0; c < 3; ++c) blocks_[i / 16].c[slot][k][c][i % 16] = line.c[k][c];
        }
      }
    }
    at_point_.resize(blocks_.size());
  }

  /// Lines of all occluders at the point centre + d.
  HWY_INLINE void move_to(T dx, T dy, T dz) {
    using Lanes = Pack<T, 16>;
    const Lanes x = splat<Lanes>(dx), y = splat<Lanes>(dy), z = splat<Lanes>(dz);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      for (int slot = 0; slot < slots_; ++slot) {
        const auto& c = blocks_[b].c[slot];
        T* to[3] = {at_point_[b].u[slot], at_point_[b].v[slot], at_point_[b].w[slot]};
        for (int i = 0; i < 3; ++i) {
          store(load<Lanes>(c[0][i]) + x * load<Lanes>(c[1][i]) + y * load<Lanes>(c[2][i]) +
                    z * load<Lanes>(c[3][i]),
                to[i]);
        }
      }
    }
  }

  /// Appends the occluders whose shadow may reach into `box` to `out`, in order; true if one of them covers
  /// it.
  HWY_INLINE bool find_all(const LightBox<T>& box, std::vector<std::uint32_t>& out) const {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const Reach reach = reach_of(at_point_[b], box);
      const std::size_t valid = HWY_MIN(std::size_t{16}, count_ - 16 * b);
      const std::uint32_t all = (1u << valid) - 1u;
      if ((reach.covering & all) != 0) return true;
      for (std::uint32_t bits = reach.meeting & all; bits != 0; bits &= bits - 1) {
        out.push_back(static_cast<std::uint32_t>(16 * b) +
                      static_cast<std::uint32_t>(std::countr_zero(bits)));
      }
    }
    return false;
  }

  /// Those of `from[first..]` whose shadow may reach into `box`, appended to the same list; true if one
  /// covers it.
  HWY_INLINE bool find_among(std::size_t first, std::size_t last, const LightBox<T>& box,
                             std::vector<std::uint32_t>& list) {
    for (std::size_t i = first; i < last; i += 16) {
      const std::size_t valid = HWY_MIN(std::size_t{16}, last - i);
      for (std::size_t k = 0; k < valid; ++k) {
        const std::uint32_t id = list[i + k];
        const CandidateBlock<T>& from = at_point_[id / 16];
        for (int slot = 0; slot < slots_; ++slot) {
          gathered_.u[slot][k] = from.u[slot][id % 16];
          gathered_.v[slot][k] = from.v[slot][id % 16];
          gathered_.w[slot][k] = from.w[slot][id % 16];
        }
      }
      const Reach reach = reach_of(gathered_, box);
      const std::uint32_t all = (1u << valid) - 1u;
      if ((reach.covering & all) != 0) return true;
      for (std::uint32_t bits = reach.meeting & all; bits != 0; bits &= bits - 1) {
        list.push_back(list[i + static_cast<std::size_t>(std::countr_zero(bits))]);
      }
    }
    return false;
  }

  /// The lines of one occluder at the point; returns their number.
  HWY_INLINE int lines_of(std::uint32_t id, LightLine<T>* lines) const {
    const CandidateBlock<T>& from = at_point_[id / 16];
    for (int slot = 0; slot < slots_; ++slot) {
      lines[slot] = {from.u[slot][id % 16], from.v[slot][id % 16], from.w[slot][id % 16]};
    }
    return slots_;
  }

private:
  struct MovingBlock {
    T c[4][4][3][16];  ///< line, power of the point, coefficient, occluder
  };
  struct Reach {
    std::uint32_t meeting, covering;
  };

  HWY_INLINE Reach reach_of(const CandidateBlock<T>& lines, const LightBox<T>& box) const {
    using Lanes = Pack<T, 16>;
    const Lanes zero = splat<Lanes>(T(0));
    const Lanes cu = splat<Lanes>(box.cu), cv = splat<Lanes>(box.cv);
    const Lanes hu = splat<Lanes>(box.hu), hv = splat<Lanes>(box.hv);
    Lanes highest = splat<Lanes>(T(1)),
          lowest = highest;  // least over the lines of the greatest, least value
    for (int slot = 0; slot < slots_; ++slot) {
      const Lanes u = load<Lanes>(lines.u[slot]), v = load<Lanes>(lines.v[slot]);
      const Lanes value = u * cu + v * cv + load<Lanes>(lines.w[slot]);
      const Lanes radius = absolute(u) * hu + absolute(v) * hv;
      highest = min(highest, value + radius);
      lowest = min(lowest, value - radius);
    }
    return {less_bits(zero, highest), less_bits(zero, lowest)};
  }

  std::vector<MovingBlock> blocks_;
  std::vector<CandidateBlock<T>> at_point_;
  CandidateBlock<T> gathered_{};
  std::size_t count_ = 0;
  int slots_ = 0;
};

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
