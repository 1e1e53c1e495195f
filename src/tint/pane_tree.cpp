#include "tint/pane_tree.h"

#include <algorithm>
#include <bit>

namespace tenebra::tint {

void PaneTree::update(std::span<const std::uint32_t> ids, const TriangleView& triangles) {
  std::vector<glm::uvec3> chosen;
  chosen.reserve(ids.size());
  box_ = {};
  for (const std::uint32_t id : ids) {
    chosen.push_back(triangles.triangles[id]);
    for (int k = 0; k < 3; ++k) box_.add(glm::dvec3(triangles.positions[chosen.back()[k]]));
  }
  if (std::equal(ids.begin(), ids.end(), ids_.begin(), ids_.end()))
    return trees::refit_triangle_bvh(triangles.positions, chosen, tree_);
  ids_.assign(ids.begin(), ids.end());
  tree_ = *trees::build_triangle_bvh(triangles.positions, chosen, nullptr, trees::BvhHolds::all);
}

void PaneTree::numbers_of(std::span<const trees::BlockTriangles> found,
                          std::vector<std::uint32_t>& out) const {
  out.clear();
  for (const trees::BlockTriangles& some : found)
    for (std::uint32_t lanes = some.lanes; lanes != 0; lanes &= lanes - 1)
      out.push_back(number(some.block, std::countr_zero(lanes)));
  std::sort(out.begin(), out.end());
}

}  // namespace tenebra::tint
