#include "soft/occluders/candidate_order.h"

#include <algorithm>

namespace tenebra::soft {

namespace {

constexpr std::size_t many = 512;  // candidates
constexpr std::uint32_t size_ranks = 128, coarse_ranks = 16;
constexpr int largest_size = 32;
constexpr int column_bits = 5;
constexpr std::uint32_t columns = 1u << column_bits, cells = columns * columns;

std::size_t rank_count(std::size_t places) {
  return places > many ? coarse_ranks * cells : size_ranks;
}

std::uint32_t size_rank(const Candidate& c, int width, std::uint32_t ranks) {
  return static_cast<std::uint32_t>(
      std::clamp((largest_size - c.size) / width, 0, static_cast<int>(ranks) - 1));
}

// Where the middle of the triangle's shadow lies on the light, seen from the group's centre, as a place along
// a Morton curve.
std::uint32_t cell_of(const Candidate& c, const LightAxes& axes) {
  double sum[3] = {};
  for (const auto& corner : c.corners)
    for (int k = 0; k < 3; ++k) sum[k] += corner[k];
  std::uint32_t cell = 0;
  for (int k = 0; k < 2; ++k) {
    const double from_edge = axes.centre_uv[k] + sum[k] / sum[2] * axes.centre_uv.z + 1;
    const double column =
        sum[2] > 0 && from_edge > 0 ? std::min(from_edge * (columns / 2), columns - 1.0) : 0.0;
    for (int bit = 0; bit < column_bits; ++bit)
      cell |= (static_cast<std::uint32_t>(column) >> bit & 1u) << (2 * bit + k);
  }
  return cell;
}

}  // namespace

std::span<const std::uint32_t> CandidateOrder::sorted(const GroupCandidates& candidates,
                                                      std::span<const std::uint32_t> places) {
  const bool by_place = places.size() > many;
  ranks_.clear();
  for (const std::uint32_t place : places) {
    const Candidate& c = candidates.all[place];
    ranks_.push_back(by_place ? size_rank(c, 4, coarse_ranks) * cells + cell_of(c, candidates.axes)
                              : size_rank(c, 1, size_ranks));
  }
  ends_.assign(rank_count(places.size()) + 1, 0);
  for (const std::uint32_t rank : ranks_) ++ends_[rank + 1];
  for (std::size_t k = 1; k < ends_.size(); ++k) ends_[k] += ends_[k - 1];
  order_.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) order_[ends_[ranks_[i]]++] = places[i];
  return order_;
}

}  // namespace tenebra::soft
