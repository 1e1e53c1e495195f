#include "trees/bvh_order.h"

#include "parallel/parallel.h"
#include "trees/bvh_parts.h"

namespace tenebra::trees {
namespace {

std::uint8_t held(const BvhTriangles& block) {
  return static_cast<std::uint8_t>(std::count_if(std::begin(block.triangle), std::end(block.triangle),
                                                 [](std::uint32_t t) { return t != no_caster; }));
}

class Maker {
public:
  Maker(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, const BvhOrder& order)
      : positions_(positions), triangles_(triangles), order_(order) {}
  std::optional<TriangleBvh> make();

private:
  bool names_all();
  bool hang_node(int depth);

  std::span<const glm::vec3> positions_;
  std::span<const glm::uvec3> triangles_;
  const BvhOrder& order_;
  TriangleBvh tree_;
};

/// Whether the order has all triangles that belong in a tree, each once, and no others.
bool Maker::names_all() {
  std::vector<std::uint8_t> named(triangles_.size(), 0);
  for (const std::uint32_t t : order_.triangles) {
    if (t >= named.size() || named[t] != 0) return false;
    named[t] = 1;
  }
  constexpr std::size_t grain = 4096;
  std::vector<std::uint8_t> all((triangles_.size() + grain - 1) / grain, 1);
  parallel::parallel_ranges(triangles_.size(), grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t t = first; t < last; ++t) {
      math::Box<float> box;
      if (bvh_holds(positions_, triangles_[t], BvhHolds::with_area, box) != (named[t] != 0))
        all[first / grain] = 0;
    }
  });
  return std::find(all.begin(), all.end(), 0) == all.end();
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
      tree_.nodes[place].child[lane] = static_cast<std::uint32_t>(tree_.nodes.size());
      if (!hang_node(depth + 1)) return false;
    } else {
      if (child > bvh_width || child > order_.triangles.size() - tree_.triangles) return false;
      tree_.nodes[place].child[lane] = static_cast<std::uint32_t>(tree_.blocks.size()) | bvh_leaf;
      const std::uint32_t* of_block = order_.triangles.data() + tree_.triangles;
      std::copy_n(of_block, child, tree_.blocks.emplace_back(empty_block()).triangle);
      tree_.triangles += child;
    }
  }
  return true;
}

std::optional<TriangleBvh> Maker::make() {
  if (!names_all()) return {};
  tree_.nodes.reserve(order_.children.size() / bvh_width);
  if (!order_.children.empty() && !hang_node(0)) return {};
  if (tree_.triangles != order_.triangles.size() || tree_.nodes.size() * bvh_width != order_.children.size())
    return {};
  refit_triangle_bvh(positions_, triangles_, tree_);
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
      order.children.push_back(child == bvh_no_child ? 0
                               : leaf                ? held(bvh.blocks[child & ~bvh_leaf])
                                                     : BvhOrder::node);
    }
  }
  order.triangles.reserve(bvh.triangles);
  for (const BvhTriangles& block : bvh.blocks)
    order.triangles.insert(order.triangles.end(), block.triangle, block.triangle + held(block));
  return order;
}

std::optional<TriangleBvh> order_triangles(std::span<const glm::vec3> positions,
                                           std::span<const glm::uvec3> triangles, const BvhOrder& order) {
  return Maker(positions, triangles, order).make();
}

}  // namespace tenebra::trees
