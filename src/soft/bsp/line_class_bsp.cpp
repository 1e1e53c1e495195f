#include "soft/bsp/line_class_bsp.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "math/l1_norm.h"
#include "points/triangle_corners.h"

namespace tenebra::soft {

namespace {

using glm::dvec3;

constexpr std::size_t bytes_an_occluder = 3 * sizeof(dvec3) + sizeof(std::uint32_t);  // corners, and the list

}  // namespace

bool LineClassBsp::reset(const GroupOccluders& occluders, const TriangleView& triangles,
                         const GroupFrame& group, OccluderChoice choice, std::size_t largest_bytes) {
  nodes_.clear();
  waiting_.clear();
  lists_.clear();
  corners_.clear();
  root_ = visible_leaf;
  largest_bytes_ = largest_bytes;
  if (!may_take(sizeof(Range) + occluders.occluders.size() * bytes_an_occluder)) return false;
  occluders_ = occluders.occluders;
  planes_ = occluders.planes;
  half_ = group.half;
  choice_ = choice;
  random_ = 1;
  for (const Occluder& occluder : occluders_) {
    const points::Corners c = points::corners_of(triangles, occluder.triangle);
    for (const glm::vec3& v : c.v) corners_.push_back(dvec3(v) - group.centre);
  }
  std::vector<std::uint32_t>& all = outside_[0];
  all.resize(occluders_.size());
  std::iota(all.begin(), all.end(), 0u);
  root_ = add_leaf(all);
  return true;
}

// Theorem 1: the lines from the group's box through the occluder have one orientation to the edge if those
// from the box's corners through the occluder's have.
LineClassBsp::Orientation LineClassBsp::orientation(std::uint32_t line, std::uint32_t occluder) const {
  const EdgePlane& plane = planes_[line];
  if (plane.along == dvec3(0.0)) return Orientation::mixed;
  bool positive = true, negative = true;
  for (std::size_t k = 3 * std::size_t{occluder}; k < 3 * std::size_t{occluder} + 3; ++k) {
    const dvec3 from = corners_[k] - plane.a;
    const dvec3 change = glm::cross(plane.along, from);
    const double value = glm::dot(plane.normal, from);
    const double spread =
        std::abs(change.x) * half_.x + std::abs(change.y) * half_.y + std::abs(change.z) * half_.z;
    const double margin =
        spread + product_rounding * (math::l1_norm(plane.normal) * math::l1_norm(from) +
                                     math::l1_norm(plane.along) * math::l1_norm(from) * math::l1_norm(half_));
    positive &= value > margin;
    negative &= value < -margin;
  }
  return positive ? Orientation::positive : negative ? Orientation::negative : Orientation::mixed;
}

std::uint32_t LineClassBsp::pick(Range waiting) {
  if (choice_ == OccluderChoice::largest) return 0;
  random_ = random_ * 1664525u + 1013904223u;  // linear congruential: the same tree in every run
  return static_cast<std::uint32_t>((std::uint64_t{random_} * waiting.count) >> 32);
}

BspChild LineClassBsp::add_leaf(std::span<const std::uint32_t> occluders) {
  if (occluders.empty()) return visible_leaf;
  lists_.push_back(
      {static_cast<std::uint32_t>(waiting_.size()), static_cast<std::uint32_t>(occluders.size())});
  waiting_.insert(waiting_.end(), occluders.begin(), occluders.end());
  return -2 - static_cast<BspChild>(lists_.size());
}

// Finds the leaves outside of the merged occluder's lines that the lines through `occluder` may belong to.
void LineClassBsp::insert_below(std::uint32_t occluder, const Occluder& merged) {
  for (std::uint32_t k = 0; k < merged.line_count; ++k) {
    const Orientation found = orientation(merged.first_line + k, occluder);
    if (found != Orientation::positive) outside_[k].push_back(occluder);
    if (found == Orientation::negative) return;
  }
}

BspChild LineClassBsp::grow(std::int32_t parent, int side) {
  const BspChild leaf = parent < 0 ? root_ : nodes_[static_cast<std::size_t>(parent)].child[side];
  const Range waiting = lists_[static_cast<std::size_t>(-3 - leaf)];
  const std::uint32_t picked = pick(waiting);
  const Occluder& merged = occluders_[waiting_[waiting.first + picked]];
  // Each of the others may come to wait outside of every line.
  const std::size_t most_added =
      merged.line_count * (sizeof(BspNode) + sizeof(Range) + (waiting.count - 1) * sizeof(std::uint32_t));
  if (!may_take(bytes() + most_added)) return leaf;
  for (auto& list : outside_) list.clear();
  for (std::uint32_t i = 0; i < waiting.count; ++i) {
    if (i != picked) insert_below(waiting_[waiting.first + i], merged);
  }
  const auto first = static_cast<BspChild>(nodes_.size());
  for (std::uint32_t k = 0; k < merged.line_count; ++k) {
    const bool last = k + 1 == merged.line_count;
    const BspChild outside = add_leaf(outside_[k]);
    nodes_.push_back(
        {merged.first_line + k, {outside, last ? invisible_leaf : first + static_cast<BspChild>(k) + 1}});
  }
  const BspChild grown = merged.line_count == 0 ? invisible_leaf : first;
  (parent < 0 ? root_ : nodes_[static_cast<std::size_t>(parent)].child[side]) = grown;
  return grown;
}

std::size_t LineClassBsp::bytes() const {
  return nodes_.size() * sizeof(BspNode) + waiting_.size() * sizeof(std::uint32_t) +
         lists_.size() * sizeof(Range) + corners_.size() * sizeof(dvec3);
}

}  // namespace tenebra::soft
