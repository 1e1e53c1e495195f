#include "tint/triangle_tree.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

#include "points/triangle_corners.h"

namespace tenebra::tint {
namespace {

constexpr float nothing = std::numeric_limits<float>::infinity();

void clear(EightBoxes& boxes) {
  for (int axis = 0; axis < 3; ++axis) {
    std::fill_n(boxes.rows[axis], box_lanes, nothing);
    std::fill_n(boxes.rows[3 + axis], box_lanes, -nothing);
  }
}

void widen(EightBoxes& boxes, std::size_t lane, const glm::vec3& low, const glm::vec3& high) {
  for (int axis = 0; axis < 3; ++axis) {
    boxes.rows[axis][lane] = std::min(boxes.rows[axis][lane], low[axis]);
    boxes.rows[3 + axis][lane] = std::max(boxes.rows[3 + axis][lane], high[axis]);
  }
}

/// Splits ranges of places along the longest side of the box of their centres, down to leaves.
void split(std::span<std::uint32_t> places, std::span<const glm::vec3> centres) {
  if (places.size() <= box_lanes) return;
  glm::vec3 low = centres[places[0]], high = low;
  for (const std::uint32_t p : places) low = glm::min(low, centres[p]), high = glm::max(high, centres[p]);
  const glm::vec3 side = high - low;
  const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
  std::size_t whole = box_lanes;  // full subtrees to the left
  while (whole * box_lanes < places.size()) whole *= box_lanes;
  const std::size_t half = std::max(whole, places.size() / 2 / whole * whole);
  std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(half), places.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     return centres[a][axis] != centres[b][axis] ? centres[a][axis] < centres[b][axis]
                                                                 : a < b;
                   });
  split(places.first(half), centres);
  split(places.subspan(half), centres);
}

}  // namespace

void TriangleTree::order(const TriangleView& triangles) {
  std::vector<glm::vec3> centres(ids_.size());
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    const points::Corners c = points::corners_of(triangles, ids_[i]);
    centres[i] = c.v[0] / 3.0f + c.v[1] / 3.0f + c.v[2] / 3.0f;
  }
  order_.resize(ids_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  split(order_, centres);
}

void TriangleTree::update(std::span<const std::uint32_t> ids, const TriangleView& triangles) {
  if (!std::equal(ids.begin(), ids.end(), ids_.begin(), ids_.end())) {
    ids_.assign(ids.begin(), ids.end());
    order(triangles);
  }
  levels_.clear();
  if (ids_.empty()) return;
  std::vector<EightBoxes>& leaves = levels_.emplace_back((order_.size() + box_lanes - 1) / box_lanes);
  for (EightBoxes& leaf : leaves) clear(leaf);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const points::Corners c = points::corners_of(triangles, ids_[order_[i]]);
    widen(leaves[i / box_lanes], i % box_lanes, glm::min(glm::min(c.v[0], c.v[1]), c.v[2]),
          glm::max(glm::max(c.v[0], c.v[1]), c.v[2]));
  }
  const auto box_of = [](const EightBoxes& boxes, glm::vec3& low, glm::vec3& high) {
    low = glm::vec3(nothing), high = -low;
    for (int k = 0; k < box_lanes; ++k) {
      low = glm::min(low, glm::vec3(boxes.rows[0][k], boxes.rows[1][k], boxes.rows[2][k]));
      high = glm::max(high, glm::vec3(boxes.rows[3][k], boxes.rows[4][k], boxes.rows[5][k]));
    }
  };
  glm::vec3 low, high;
  while (levels_.back().size() > 1) {
    std::vector<EightBoxes> above((levels_.back().size() + box_lanes - 1) / box_lanes);
    for (EightBoxes& node : above) clear(node);
    for (std::size_t i = 0; i < levels_.back().size(); ++i) {
      box_of(levels_.back()[i], low, high);
      widen(above[i / box_lanes], i % box_lanes, low, high);
    }
    levels_.push_back(std::move(above));
  }
  box_of(levels_.back()[0], low, high);
  box_ = {low, high};
  const glm::vec3 most = glm::max(glm::abs(low), glm::abs(high));
  reach_ = std::max({most.x, most.y, most.z});
}

void TriangleTree::find(const Shaft& shaft, std::vector<Found>& out) const {
  if (!levels_.empty()) find_below(levels_.size() - 1, 0, FloatShaft(shaft, reach_), out);
}

void TriangleTree::find_below(std::size_t level, std::uint32_t node, const FloatShaft& shaft,
                              std::vector<Found>& out) const {
  std::uint32_t met = boxes_met_(levels_[level][node], shaft);
  if (met == 0) return;
  if (level == 0) return out.push_back({node, met});
  for (std::uint32_t lane = 0; met != 0; ++lane, met >>= 1)
    if ((met & 1u) != 0) find_below(level - 1, node * box_lanes + lane, shaft, out);
}

void TriangleTree::numbers_of(std::span<const Found> found, std::vector<std::uint32_t>& out) const {
  out.clear();
  for (const Found& leaf : found)
    for (std::uint32_t met = leaf.met; met != 0; met &= met - 1)
      out.push_back(number(leaf.leaf, std::countr_zero(met)));
  std::sort(out.begin(), out.end());
}

bool TriangleTree::meets(const Shaft& shaft) const {
  return !levels_.empty() && meets_below(levels_.size() - 1, 0, FloatShaft(shaft, reach_));
}

bool TriangleTree::meets_below(std::size_t level, std::uint32_t node, const FloatShaft& shaft) const {
  std::uint32_t met = boxes_met_(levels_[level][node], shaft);
  if (met == 0 || level == 0) return met != 0;
  for (std::uint32_t lane = 0; met != 0; ++lane, met >>= 1)
    if ((met & 1u) != 0 && meets_below(level - 1, node * box_lanes + lane, shaft)) return true;
  return false;
}

}  // namespace tenebra::tint
