#include "ao/cast/bvh_order.h"

#include "ao/cast/bvh_parts.h"
#include "parallel/parallel.h"

namespace tenebra::ao {
namespace {

std::uint8_t held(const TriangleBlock& block) {
  return static_cast<std::uint8_t>(std::count_if(std::begin(block.triangle), std::end(block.triangle),
                                                 [](std::uint32_t t) { return t != no_caster; }));
}

bool is_there(const BvhNode& node, std::size_t lane) {
  return node.plane[0][lane] <= node.plane[3][lane];
}

class Maker {
public:
  Maker(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, const BvhOrder& order)
      : positions_(positions), triangles_(triangles), order_(order) {}
  std::optional<TriangleBvh> make();

private:
  bool names_all();
  bool hang_node(int depth);
  void fill_blocks();
  void fill_nodes();

  std::span<const glm::vec3> positions_;
  std::span<const glm::uvec3> triangles_;
  const BvhOrder& order_;
  TriangleBvh tree_;
  std::vector<std::uint32_t> first_;  ///< of each block: where its triangles begin in the order
  std::vector<math::Box<float>> block_boxes_;
  float largest_coordinate_ = 0;
};

/// Whether the order has all triangles that belong in a tree, each once, and no others.
bool Maker::names_all() {
  std::vector<std::uint8_t> named(triangles_.size(), 0);
  for (const std::uint32_t t : order_.triangles) {
    if (t >= named.size() || named[t] != 0) return false;
    named[t] = 1;
  }
  constexpr std::size_t grain = 4096;
  struct Part {
    float largest_coordinate = 0;
    bool all = true;
  };
  std::vector<Part> parts((triangles_.size() + grain - 1) / grain);
  parallel::parallel_ranges(triangles_.size(), grain, [&](std::size_t first, std::size_t last) {
    Part& part = parts[first / grain];
    for (std::size_t t = first; t < last; ++t) {
      math::Box<float> box;
      const bool holds = bvh_holds(positions_, triangles_[t], box);
      part.all &= holds == (named[t] != 0);
      if (holds) part.largest_coordinate = std::max(part.largest_coordinate, box.largest_coordinate());
    }
  });
  for (const Part& part : parts) largest_coordinate_ = std::max(largest_coordinate_, part.largest_coordinate);
  return std::all_of(parts.begin(), parts.end(), [](const Part& part) { return part.all; });
}

/// The next node and all below it: nodes and blocks lie in the order of a walk from the first child to the
/// last. False if the order ends before, or has too many levels.
bool Maker::hang_node(int depth) {
  const std::size_t place = tree_.nodes.size();
  if (depth == bvh_depth || order_.children.size() < (place + 1) * bvh_width) return false;
  tree_.nodes.emplace_back();
  for (std::size_t lane = 0; lane < bvh_width; ++lane) {
    const std::uint8_t child = order_.children[place * bvh_width + lane];
    if (child == 0) {
      set_no_child(tree_.nodes[place], lane);
    } else if (child == BvhOrder::node) {
      set_child(tree_.nodes[place], lane, static_cast<std::uint32_t>(tree_.nodes.size()), {}, 0);
      if (!hang_node(depth + 1)) return false;
    } else {
      if (child > bvh_width || child > order_.triangles.size() - tree_.triangles) return false;
      set_child(tree_.nodes[place], lane, static_cast<std::uint32_t>(first_.size()) | bvh_leaf, {}, 0);
      first_.push_back(static_cast<std::uint32_t>(tree_.triangles));
      tree_.triangles += child;
    }
  }
  return true;
}

void Maker::fill_blocks() {
  tree_.blocks.resize(first_.size());
  block_boxes_.resize(first_.size());
  first_.push_back(static_cast<std::uint32_t>(tree_.triangles));
  parallel::parallel_ranges(tree_.blocks.size(), 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t b = first; b < last; ++b) {
      TriangleBlock& block = tree_.blocks[b] = empty_block();
      for (std::uint32_t at = first_[b]; at < first_[b + 1]; ++at) {
        const std::uint32_t t = order_.triangles[at];
        set_triangle(block, at - first_[b], t, positions_, triangles_);
        math::Box<float> box;
        bvh_holds(positions_, triangles_[t], box);
        block_boxes_[b].add(box);
      }
    }
  });
}

/// From the last to the first: children lie behind their node.
void Maker::fill_nodes() {
  const float margin = bvh_margin(largest_coordinate_);
  std::vector<math::Box<float>> boxes(tree_.nodes.size());
  for (std::size_t n = tree_.nodes.size(); n-- > 0;) {
    BvhNode& node = tree_.nodes[n];
    for (std::size_t lane = 0; lane < bvh_width; ++lane) {
      if (order_.children[n * bvh_width + lane] == 0) continue;
      const std::uint32_t child = node.child[lane];
      const math::Box<float>& box = (child & bvh_leaf) != 0 ? block_boxes_[child & ~bvh_leaf] : boxes[child];
      set_child(node, lane, child, box, margin);
      boxes[n].add(box);
    }
  }
}

std::optional<TriangleBvh> Maker::make() {
  if (!names_all()) return {};
  tree_.nodes.reserve(order_.children.size() / bvh_width);
  if (!order_.children.empty() && !hang_node(0)) return {};
  if (tree_.triangles != order_.triangles.size() || tree_.nodes.size() * bvh_width != order_.children.size())
    return {};
  fill_blocks();
  fill_nodes();
  return std::move(tree_);
}

}  // namespace

BvhOrder order_of(const TriangleBvh& bvh) {
  BvhOrder order;
  order.children.reserve(bvh.nodes.size() * bvh_width);
  for (const BvhNode& node : bvh.nodes) {
    for (std::size_t lane = 0; lane < bvh_width; ++lane) {
      const std::uint32_t child = node.child[lane];
      const bool leaf = (child & bvh_leaf) != 0;
      order.children.push_back(!is_there(node, lane) ? 0
                               : leaf                ? held(bvh.blocks[child & ~bvh_leaf])
                                                     : BvhOrder::node);
    }
  }
  order.triangles.reserve(bvh.triangles);
  for (const TriangleBlock& block : bvh.blocks)
    order.triangles.insert(order.triangles.end(), block.triangle, block.triangle + held(block));
  return order;
}

std::optional<TriangleBvh> order_triangles(std::span<const glm::vec3> positions,
                                           std::span<const glm::uvec3> triangles, const BvhOrder& order) {
  return Maker(positions, triangles, order).make();
}

}  // namespace tenebra::ao
