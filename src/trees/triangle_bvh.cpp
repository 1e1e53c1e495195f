#include "trees/triangle_bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/until_stopped.h"
#include "parallel/parallel.h"
#include "trees/bvh_parts.h"

namespace tenebra::trees {

namespace {

constexpr int bin_count = 16;
constexpr int depth_to_halve = bvh_depth - 32;  ///< from here on 32 levels hold whatever is left
constexpr std::uint32_t shared_size = 8192;  ///< items of a node whose children are made by several threads
constexpr float infinity = std::numeric_limits<float>::infinity();

struct Item {
  math::Box<float> box;
  glm::vec3 middle;
  std::uint32_t triangle;
};

/// Items first .. last - 1 and their box.
struct Range {
  std::uint32_t first, last;
  math::Box<float> box;
  std::uint32_t size() const { return last - first; }
};

struct Split {
  int axis = -1;
  int bin = 0;  ///< the last bin of the left side
  double cost = std::numeric_limits<double>::infinity();
};

/// Once a stop is requested, whatever is in the making is left as it is and of no use.
class Builder {
public:
  Builder(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, BvhHolds holds,
          const StopFlag* stop)
      : positions_(positions), triangles_(triangles), holds_(holds), stop_(stop) {
    collect();
  }
  TriangleBvh build();
  bool stopped() const { return stop_requested(stop_); }

private:
  struct Bins {
    math::Box<float> box;  ///< of the middles
    int bin(glm::vec3 middle, int axis) const {
      const double low = box.low[axis], high = box.high[axis];
      const double at = (static_cast<double>(middle[axis]) - low) / (high - low) * bin_count;
      return std::clamp(static_cast<int>(at), 0, bin_count - 1);
    }
  };

  /// Calls body(i) for first .. last - 1, in order, until a stop is requested.
  template <class Body>
  void each(std::size_t first, std::size_t last, const Body& body) const {
    base::each_until_stopped(first, last, stop_, body);
  }

  void collect();
  Range range(std::uint32_t first, std::uint32_t last) const;
  Bins bins(const Range& range) const;
  Split best_split(const Range& range, const Bins& bins) const;
  template <class Left>
  std::uint32_t part(const Range& range, const Left& left);
  std::pair<Range, Range> divide(const Range& range, int depth);
  std::vector<Range> children_of(const Range& range, int depth);
  std::uint32_t add_child(const Range& range, int depth, TriangleBvh& tree);
  std::uint32_t add_node(const Range& range, int depth, TriangleBvh& tree);
  std::uint32_t add_block(const Range& range, TriangleBvh& tree) const;

  std::span<const glm::vec3> positions_;
  std::span<const glm::uvec3> triangles_;
  BvhHolds holds_;
  const StopFlag* stop_;
  std::vector<Item> items_;
  float margin_ = 0;
};

void Builder::collect() {
  items_.reserve(triangles_.size());
  float largest_coordinate = 0;
  each(0, triangles_.size(), [&](std::size_t i) {
    math::Box<float> box;
    if (!bvh_holds(positions_, triangles_[i], holds_, box)) return;
    items_.push_back({box, 0.5f * box.low + 0.5f * box.high, static_cast<std::uint32_t>(i)});
    largest_coordinate = std::max(largest_coordinate, box.largest_coordinate());
  });
  margin_ = bvh_margin(largest_coordinate);
}

Range Builder::range(std::uint32_t first, std::uint32_t last) const {
  Range range{first, last, {}};
  each(first, last, [&](std::size_t i) { range.box.add(items_[i].box); });
  return range;
}

Builder::Bins Builder::bins(const Range& range) const {
  Bins bins;
  each(range.first, range.last, [&](std::size_t i) { bins.box.add(items_[i].middle); });
  return bins;
}

Split Builder::best_split(const Range& range, const Bins& bins) const {
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(bins.box.low[axis] < bins.box.high[axis])) continue;
    std::array<math::Box<float>, bin_count> boxes;
    std::array<std::uint32_t, bin_count> counts{};
    each(range.first, range.last, [&](std::size_t i) {
      const auto bin = static_cast<std::size_t>(bins.bin(items_[i].middle, axis));
      boxes[bin].add(items_[i].box);
      ++counts[bin];
    });
    std::array<double, bin_count> right{};  // cost of bins i ..
    math::Box<float> box;
    std::uint32_t count = 0;
    // Triangles are met eight at a time.
    const auto cost = [&] { return half_area(box) * ((count + bvh_width - 1) / bvh_width); };
    for (std::size_t i = bin_count; i-- > 1;) {
      box.add(boxes[i]);
      count += counts[i];
      right[i] = cost();
    }
    box = {};
    count = 0;
    for (std::size_t i = 0; i + 1 < bin_count; ++i) {
      box.add(boxes[i]);
      count += counts[i];
      if (count == 0 || count == range.size()) continue;
      if (const double c = cost() + right[i + 1]; c < best.cost) best = {axis, static_cast<int>(i), c};
    }
  }
  return best;
}

/// Items of the left side to the front, all in their order. Returns the first of the right side.
template <class Left>
std::uint32_t Builder::part(const Range& range, const Left& left) {
  std::vector<Item> right;
  right.reserve(range.size());
  std::size_t middle = range.first;
  each(range.first, range.last, [&](std::size_t i) {
    if (left(items_[i])) {
      items_[middle++] = items_[i];
    } else {
      right.push_back(items_[i]);
    }
  });
  each(0, right.size(), [&](std::size_t i) { items_[middle + i] = right[i]; });
  return static_cast<std::uint32_t>(middle);
}

std::pair<Range, Range> Builder::divide(const Range& whole, int depth) {
  const Bins bins = this->bins(whole);
  const Split split = depth < depth_to_halve ? best_split(whole, bins) : Split{};
  std::uint32_t middle = whole.first + whole.size() / 2;  // all middles alike, or too deep: by order
  if (split.axis >= 0) {
    middle = part(whole, [&](const Item& item) { return bins.bin(item.middle, split.axis) <= split.bin; });
  }
  return {range(whole.first, middle), range(middle, whole.last)};
}

std::uint32_t Builder::add_block(const Range& range, TriangleBvh& tree) const {
  BvhTriangles block = empty_block();
  for (std::uint32_t i = range.first; i < range.last; ++i)
    set_triangle(block, i - range.first, items_[i].triangle, positions_, triangles_);
  tree.blocks.push_back(block);
  return static_cast<std::uint32_t>(tree.blocks.size() - 1) | bvh_leaf;
}

std::vector<Range> Builder::children_of(const Range& whole, int depth) {
  std::vector<Range> children{whole};
  while (children.size() < bvh_width) {
    auto widest = children.end();
    for (auto child = children.begin(); child != children.end(); ++child)
      if (child->size() > bvh_width &&
          (widest == children.end() || half_area(child->box) > half_area(widest->box)))
        widest = child;
    if (widest == children.end()) break;
    const auto [left, right] = divide(*widest, depth);
    *widest = left;
    children.push_back(right);
  }
  return children;
}

std::uint32_t Builder::add_child(const Range& range, int depth, TriangleBvh& tree) {
  if (stopped()) return 0;
  return range.size() <= bvh_width ? add_block(range, tree) : add_node(range, depth, tree);
}

/// Moves a part of a tree, of which `root` is the first node or block, behind what is in `tree`.
std::uint32_t append(const TriangleBvh& part, std::uint32_t root, TriangleBvh& tree) {
  const auto nodes = static_cast<std::uint32_t>(tree.nodes.size()),
             blocks = static_cast<std::uint32_t>(tree.blocks.size());
  const auto moved = [&](std::uint32_t child) { return child + (child & bvh_leaf ? blocks : nodes); };
  for (BvhNode node : part.nodes) {
    for (int lane = 0; lane < bvh_width; ++lane)
      if (node.child[lane] != bvh_no_child) node.child[lane] = moved(node.child[lane]);
    tree.nodes.push_back(node);
  }
  tree.blocks.insert(tree.blocks.end(), part.blocks.begin(), part.blocks.end());
  return moved(root);
}

/// Room for parts: a list that grows copies what it has.
void make_room(const std::array<TriangleBvh, bvh_width>& parts, TriangleBvh& tree) {
  std::size_t nodes = tree.nodes.size(), blocks = tree.blocks.size();
  for (const TriangleBvh& part : parts) nodes += part.nodes.size(), blocks += part.blocks.size();
  tree.nodes.reserve(nodes), tree.blocks.reserve(blocks);
}

/// Nodes and blocks come to lie in the order of a walk from the first child to the last, whoever makes them.
std::uint32_t Builder::add_node(const Range& whole, int depth, TriangleBvh& tree) {
  const std::vector<Range> children = children_of(whole, depth);
  const auto place = static_cast<std::uint32_t>(tree.nodes.size());
  tree.nodes.emplace_back();
  std::array<TriangleBvh, bvh_width> parts;
  std::array<std::uint32_t, bvh_width> roots{};
  const bool shared = whole.size() >= shared_size;
  if (shared) {
    parallel::parallel_tasks(static_cast<int>(children.size()), [&](int child) {
      const auto i = static_cast<std::size_t>(child);
      roots[i] = add_child(children[i], depth + 1, parts[i]);
    });
    make_room(parts, tree);
  }
  for (std::size_t lane = 0; lane < bvh_width; ++lane) {
    if (lane >= children.size()) {
      set_no_child(tree.nodes[place], lane);
      continue;
    }
    if (stopped()) break;
    const std::uint32_t child =
        shared ? append(parts[lane], roots[lane], tree) : add_child(children[lane], depth + 1, tree);
    set_child(tree.nodes[place], lane, child, children[lane].box, margin_);
  }
  return place;
}

TriangleBvh Builder::build() {
  TriangleBvh tree;
  tree.triangles = items_.size();
  if (!items_.empty()) add_node(range(0, static_cast<std::uint32_t>(items_.size())), 0, tree);
  return tree;
}

}  // namespace

math::Box<float> TriangleBvh::box() const {
  math::Box<float> box;
  if (nodes.empty()) return box;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < bvh_width; ++i) {
      if (!std::isfinite(nodes[0].plane[axis][i])) continue;  // an empty place
      box.low[axis] = std::min(box.low[axis], nodes[0].plane[axis][i]);
      box.high[axis] = std::max(box.high[axis], nodes[0].plane[3 + axis][i]);
    }
  }
  return box;
}

std::optional<TriangleBvh> build_triangle_bvh(std::span<const glm::vec3> positions,
                                              std::span<const glm::uvec3> triangles, const StopFlag* stop,
                                              BvhHolds holds) {
  Builder builder(positions, triangles, holds, stop);
  TriangleBvh tree = builder.build();
  if (builder.stopped()) return {};
  return tree;
}

TriangleBvh build_triangle_bvh(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles) {
  return Builder(positions, triangles, BvhHolds::with_area, nullptr).build();
}

void refit_triangle_bvh(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                        TriangleBvh& bvh) {
  std::vector<math::Box<float>> of_blocks(bvh.blocks.size());
  parallel::parallel_ranges(bvh.blocks.size(), 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t b = first; b < last; ++b) {
      BvhTriangles& block = bvh.blocks[b];
      for (std::size_t lane = 0; lane < bvh_width && block.triangle[lane] != no_caster; ++lane) {
        set_triangle(block, lane, block.triangle[lane], positions, triangles);
        for (int k = 0; k < 3; ++k) of_blocks[b].add(positions[triangles[block.triangle[lane]][k]]);
      }
    }
  });
  math::Box<float> all;
  for (const math::Box<float>& box : of_blocks) all.add(box);
  const float margin = bvh_margin(all.largest_coordinate());
  std::vector<math::Box<float>> of_nodes(bvh.nodes.size());
  for (std::size_t n = bvh.nodes.size(); n-- > 0;) {  // children lie behind their node
    BvhNode& node = bvh.nodes[n];
    for (std::size_t lane = 0; lane < bvh_width; ++lane) {
      const std::uint32_t child = node.child[lane];
      if (child == bvh_no_child) continue;
      const math::Box<float>& box = (child & bvh_leaf) != 0 ? of_blocks[child & ~bvh_leaf] : of_nodes[child];
      set_child(node, lane, child, box, margin);
      of_nodes[n].add(box);
    }
  }
}

}  // namespace tenebra::trees
