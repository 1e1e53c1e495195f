#include "shadow/tiles/triangle_clusters.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "base/until_stopped.h"
#include "parallel/parallel.h"
#include "points/triangle_corners.h"
#include "shadow/tiles/cluster_kernels.h"
#include "shadow/tiles/cluster_order.h"

namespace tenebra::shadow {

namespace {

using glm::vec3;

constexpr std::size_t block = 256;  // vertices or triangles that are compared together

template <class T>
bool same_elements(std::span<const T> a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

/// Copies the blocks that differ. changed[b]: how many of them lie before block b.
template <class T>
void copy_changes(std::span<const T> from, std::vector<T>& to, std::vector<std::uint32_t>& changed) {
  const std::size_t blocks = (from.size() + block - 1) / block;
  changed.resize(blocks + 1);
  parallel::parallel_ranges(blocks, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t b = first; b < last; ++b) {
      const std::size_t begin = b * block, size = std::min(block, from.size() - begin);
      const bool differs = std::memcmp(&from[begin], &to[begin], size * sizeof(T)) != 0;
      if (differs) std::memcpy(&to[begin], &from[begin], size * sizeof(T));
      changed[b + 1] = differs ? 1 : 0;
    }
  });
  changed[0] = 0;
  for (std::size_t b = 0; b < blocks; ++b) changed[b + 1] += changed[b];
}

void clear_box(BoxNode& node, std::size_t lane) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    node.low[axis][lane] = infinity;
    node.high[axis][lane] = -infinity;
  }
}

void set_parent_box(const BoxNode& child, BoxNode& node, std::size_t lane) {
  for (int axis = 0; axis < 3; ++axis) {
    node.low[axis][lane] = *std::min_element(child.low[axis], child.low[axis] + cluster_size);
    node.high[axis][lane] = *std::max_element(child.high[axis], child.high[axis] + cluster_size);
  }
}

}  // namespace

std::size_t ClusterTree::byte_count() const {
  std::size_t bytes = clusters_.size() * (sizeof(TriangleCluster) + sizeof(ClusterCorners) + sizeof(Origin));
  for (const auto& level : levels_) bytes += level.size() * sizeof(BoxNode);
  return bytes + positions_.size() * sizeof(vec3) + triangles_.size() * sizeof(glm::uvec3);
}

bool ClusterTree::same_order(const TriangleView& t) const {
  return t.positions.size() + 1 == positions_.size() && t.triangles.size() == triangles_.size() &&
         same_elements(t.casts_shadow, casts_) && same_elements(t.parts, parts_);
}

void ClusterTree::find_order(const TriangleView& t, const StopFlag* stop) {
  positions_.reserve(t.positions.size() + 1);
  base::copy_until_stopped(t.positions, positions_, stop);
  positions_.emplace_back(0.0f);
  base::copy_until_stopped(t.triangles, triangles_, stop);
  base::copy_until_stopped(t.casts_shadow, casts_, stop);
  parts_.assign(t.parts.begin(), t.parts.end());
  casters_ = casts_.empty() ? t.triangles.size()
                            : static_cast<std::uint64_t>(std::count_if(
                                  casts_.begin(), casts_.end(), [](auto casts) { return casts != 0; }));
  if (!stop_requested(stop)) cluster_order(t, order_, stop);
  clusters_.clear();
  used_ = 0;
  const std::size_t count = order_.size() / cluster_size;
  base::resize_until_stopped(clusters_, count, stop);
  base::resize_until_stopped(corners_, count, stop);
  base::resize_until_stopped(origins_, count, stop);
  if (stop_requested(stop)) return;
  levels_.clear();
  for (std::size_t size = clusters_.size(); size > 0; size = levels_.back().size()) {
    levels_.emplace_back((size + cluster_size - 1) / cluster_size);
    if (levels_.back().size() == 1) break;
  }
  for (auto& level : levels_) {
    for (std::size_t lane = 0; lane < cluster_size; ++lane) clear_box(level.back(), lane);
  }
}

bool ClusterTree::triangles_changed(std::size_t cluster) const {
  const Origin& o = origins_[cluster];
  return changed_triangles_[o.last_triangle + 1] != changed_triangles_[o.first_triangle];
}
bool ClusterTree::vertices_changed(std::size_t cluster) const {
  const Origin& o = origins_[cluster];
  return changed_vertices_[o.last_vertex + 1] != changed_vertices_[o.first_vertex];
}

void ClusterTree::find_corners(const TriangleView& t, std::size_t cluster) {
  TriangleCluster& c = clusters_[cluster];
  ClusterCorners& corners = corners_[cluster] = {};
  std::uint32_t low_vertex = no_triangle, high_vertex = 0, low_id = no_triangle, high_id = 0;
  for (std::uint32_t i = 0; i < cluster_size; ++i) {
    const std::uint32_t id = c.ids[i] = order_[cluster * cluster_size + i];
    if (id == no_triangle) continue;
    const glm::uvec3 v = t.triangles[id];
    low_id = std::min(low_id, id), high_id = std::max(high_id, id);
    low_vertex = std::min({low_vertex, v.x, v.y, v.z}), high_vertex = std::max({high_vertex, v.x, v.y, v.z});
    // Two equal corners span no area.
    if (v.x != v.y && v.y != v.z && v.z != v.x) corners.possible |= 1u << i;
  }
  const bool empty = low_id == no_triangle;
  corners.first = empty ? 0 : low_vertex;
  for (std::uint32_t left = corners.possible; left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    for (int k = 0; k < 3; ++k)
      corners.offset[k][i] =
          static_cast<std::int32_t>((t.triangles[c.ids[i]][k] - corners.first) * sizeof(vec3));
  }
  constexpr auto b = static_cast<std::uint32_t>(block);
  origins_[cluster] = empty ? Origin{} : Origin{low_vertex / b, high_vertex / b, low_id / b, high_id / b};
}

void ClusterTree::refit(const TriangleView& t, SimdLevel simd, bool all, const StopFlag* stop) {
  if (levels_.empty()) return;
  const ClusterKernels kernels = cluster_kernels(simd);
  more_used_.assign(levels_[0].size(), 0);
  parallel::parallel_ranges(levels_[0].size(), 16, [&](std::size_t first, std::size_t last) {
    if (stop_requested(stop)) return;
    for (std::size_t node = first; node < last; ++node) {
      const std::size_t end = std::min(clusters_.size(), (node + 1) * cluster_size);
      for (std::size_t c = node * cluster_size; c < end; ++c) {
        const bool other = all || triangles_changed(c);
        if (!other && !vertices_changed(c)) continue;
        if (other) find_corners(t, c);
        more_used_[node] -= std::popcount(clusters_[c].used);
        kernels.follow(positions_.data(), corners_[c], clusters_[c], levels_[0][node], c % cluster_size);
        more_used_[node] += std::popcount(clusters_[c].used);
      }
    }
  });
  for (const int more : more_used_) used_ += static_cast<std::uint64_t>(more);
  for (std::size_t k = 1; k < levels_.size(); ++k) {
    const auto& children = levels_[k - 1];
    for (std::size_t i = 0; i < children.size(); ++i)
      set_parent_box(children[i], levels_[k][i / cluster_size], i % cluster_size);
  }
}

void ClusterTree::follow(const TriangleView& t, SimdLevel simd, const StopFlag* stop) {
  if (!same_order(t)) {
    find_order(t, stop);
    if (!stop_requested(stop)) refit(t, simd, true, stop);
    return;
  }
  copy_changes(t.positions, positions_, changed_vertices_);
  copy_changes(t.triangles, triangles_, changed_triangles_);
  if (changed_vertices_.back() + changed_triangles_.back() > 0) refit(t, simd, false, stop);
}

bool ClusterTree::update(const TriangleView& t, SimdLevel simd, const StopFlag* stop) {
  if (t.version != 0 && t.version == version_) return true;
  version_ = 0;                                     // until all of it is there
  const auto forget = [&] { positions_.clear(); };  // equal to no frame's: the next call finds the order anew
  try {
    follow(t, simd, stop);
  } catch (...) {  // no memory
    forget();
    throw;
  }
  if (stop_requested(stop)) {
    forget();
    return false;
  }
  version_ = t.version;
  return true;
}

}  // namespace tenebra::shadow
