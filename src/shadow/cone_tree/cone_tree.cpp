#include "shadow/cone_tree/cone_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "parallel/parallel.h"
#include "shadow/cone_tree/cone_kernel.h"

namespace tenebra::shadow {

namespace {

using glm::dvec3;
using glm::vec3;

constexpr float u = 0x1p-24f;
constexpr float infinity = std::numeric_limits<float>::infinity();

float round_up(double x) {
  return std::nextafter(static_cast<float>(x), infinity);
}
float round_down(double x) {
  return std::nextafter(static_cast<float>(x), -infinity);
}

ConeNode node_at(const NodeBlock& block, int lane) {
  return {{block.wx[lane], block.wy[lane], block.wz[lane]}, block.c[lane], block.near[lane], block.far[lane]};
}

void set_node(NodeBlock& block, int lane, const ConeNode& node) {
  block.wx[lane] = node.w.x;
  block.wy[lane] = node.w.y;
  block.wz[lane] = node.w.z;
  block.c[lane] = node.c;
  block.near[lane] = node.near;
  block.far[lane] = node.far;
  // sin = c sqrt(1 - c^2 / 4) and cos = 1 - c^2 / 2 for unit directions within c of an axis of length 1 +-
  // 2u; 16u covers that length and the roundings here.
  const float c2 = node.c * node.c;
  block.sine[lane] = node.c < hemisphere_chord ? node.c * std::sqrt(1 - c2 / 4) * (1 + 16 * u) : 2.0f;
  block.slope[lane] = node.c < narrow_chord ? (block.sine[lane] + 16 * u) / (1 - 16 * u - c2 / 2) : 0.0f;
}

vec3 unit_or_x(const vec3& v) {
  const float length = std::sqrt(glm::dot(v, v));
  return length > 1e-6f ? v / length : vec3(1, 0, 0);
}

// What the node tests see of a point: its direction (point lights) or its position across the light's travel,
// and its distance or its position along the travel.
struct RaySpan {
  vec3 w;
  double along;
};

RaySpan span_of(const dvec3& p, const RaySource& source) {
  if (source.directional) {
    const double along = glm::dot(p, source.travel);
    return {vec3(p - along * source.travel), along};
  }
  // Scaled by the largest component so that |p|^2 neither over- nor underflows.
  const double largest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  if (largest == 0) return {vec3(1, 0, 0), 0};
  const dvec3 q = p / largest;
  const double length = std::sqrt(glm::dot(q, q));
  return {vec3(q / length), length * largest};
}

// Lengths in double: squares of tiny scenes must not underflow.
float distance(const vec3& a, const vec3& b) {
  return static_cast<float>(glm::length(dvec3(a) - dvec3(b)));
}

// How far base + q may be from the point it stands for: q is rounded, below the normal range to a multiple of
// 2^-149.
double displacement(const RayPacket& packet) {
  return 2 * double(u) * packet.radius + 0x1p-149;
}

// c = (1 + 8u) max fl|d - w| + slack. Unit directions are rounded by 7u at most and turned by the
// displacement. Across a directional light the coordinates are rounded relative to their size.
double leaf_slack(const RaySource& source, const RayPacket& packet, double size, double near) {
  return source.directional ? 4 * u * size + displacement(packet) : 7 * u + 2 * displacement(packet) / near;
}
constexpr float widest_chord = 4;  // more than any chord of the unit sphere: bounds nothing, but is finite

ConeNode leaf_node(const RayPacket& packet, const RaySource& source) {
  ConeNode node;
  RaySpan spans[packet_size];
  vec3 low(infinity), high(-infinity);
  float size = 0;
  double near = infinity, far = -infinity;
  for (std::uint32_t live = packet.live; live != 0; live &= live - 1) {
    const int i = std::countr_zero(live);
    const dvec3 p =
        dvec3(packet.base_x, packet.base_y, packet.base_z) + dvec3(packet.qx[i], packet.qy[i], packet.qz[i]);
    spans[i] = span_of(p, source);
    low = glm::min(low, spans[i].w);
    high = glm::max(high, spans[i].w);
    near = std::min(near, spans[i].along);
    far = std::max(far, spans[i].along);
    size = std::max(
        {size, std::abs(spans[i].w.x), std::abs(spans[i].w.y), std::abs(spans[i].w.z), packet.radius});
  }
  if (packet.live == 0) return node;
  const vec3 centre = 0.5f * low + 0.5f * high;
  node.w = source.directional ? centre : unit_or_x(centre);
  float widest = 0;
  for (std::uint32_t live = packet.live; live != 0; live &= live - 1) {
    widest = std::max(widest, distance(spans[std::countr_zero(live)].w, node.w));
  }
  node.c = round_up((1 + 8 * u) * widest + leaf_slack(source, packet, size, near) + 1e-36);
  if (!source.directional) node.c = std::min(node.c, widest_chord);
  node.near = round_down(near - displacement(packet));
  node.far = round_up(far + displacement(packet));
  return node;
}

ConeNode parent_of(const NodeBlock& children, const RaySource& source) {
  ConeNode node;
  vec3 low(infinity), high(-infinity);
  for (int lane = 0; lane < branching; ++lane) {
    if (children.c[lane] < 0) continue;
    const ConeNode child = node_at(children, lane);
    low = glm::min(low, child.w - child.c);
    high = glm::max(high, child.w + child.c);
    node.near = std::min(node.near, child.near);
    node.far = std::max(node.far, child.far);
  }
  if (node.near > node.far) return node;
  const vec3 centre = 0.5f * low + 0.5f * high;
  node.w = source.directional ? centre : unit_or_x(centre);
  for (int lane = 0; lane < branching; ++lane) {
    if (children.c[lane] < 0) continue;
    const ConeNode child = node_at(children, lane);
    node.c = std::max(node.c, distance(child.w, node.w) + child.c);
  }
  node.c = (1 + 8 * u) * node.c + (source.directional ? 1e-36f : 2 * u);
  if (!source.directional) node.c = std::min(node.c, widest_chord);
  return node;
}

// Three doubles to floats one by one: the rounding must survive (see CMakeLists on -fno-tree-slp-vectorize).
void fill_packet(std::span<const std::uint32_t> pixels, std::span<const dvec3> positions, const dvec3& origin,
                 RayPacket& packet) {
  dvec3 points[packet_size];
  dvec3 low(INFINITY), high(-INFINITY);
  const int count = static_cast<int>(pixels.size());
  for (int i = 0; i < count; ++i) {
    points[i] = positions[pixels[i]] - origin;
    low = glm::min(low, points[i]);
    high = glm::max(high, points[i]);
  }
  const dvec3 base = 0.5 * (low + high);
  packet.base_x = base.x, packet.base_y = base.y, packet.base_z = base.z;
  double radius2 = 0, reach2 = 0;
  for (int i = 0; i < packet_size; ++i) {
    const dvec3& p = points[std::min(i, count - 1)];
    packet.qx[i] = static_cast<float>(p.x - base.x);
    packet.qy[i] = static_cast<float>(p.y - base.y);
    packet.qz[i] = static_cast<float>(p.z - base.z);
    radius2 = std::max(radius2, glm::dot(p - base, p - base));
    reach2 = std::max(reach2, glm::dot(p, p));
  }
  packet.radius = round_up(std::sqrt(radius2) * (1 + 0x1p-20));
  packet.reach = round_up(std::sqrt(reach2) * (1 + 0x1p-20));
  packet.live = count == packet_size ? 0xffffu : (1u << count) - 1u;
}

// Fills the blocks of one level; node_of(i) makes node i of `nodes`.
template <class NodeOf>
void build_level(std::size_t nodes, std::vector<NodeBlock>& blocks, const NodeOf& node_of) {
  blocks.resize((nodes + branching - 1) / branching);
  parallel::parallel_ranges(blocks.size(), 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t b = first; b < last; ++b) {
      for (int lane = 0; lane < branching; ++lane) {
        const std::size_t i = b * branching + static_cast<std::size_t>(lane);
        set_node(blocks[b], lane, i < nodes ? node_of(i) : ConeNode{});
      }
    }
  });
}

template <class LeafOf>
void build_levels(const RaySource& source, ConeTree& tree, const LeafOf& leaf_of) {
  std::size_t nodes = tree.packets.size();
  std::size_t depth = 1;
  for (std::size_t n = nodes; n > 1; n = (n + branching - 1) / branching) ++depth;
  tree.levels.resize(depth);
  build_level(nodes, tree.levels[0], leaf_of);
  for (std::size_t level = 1; level < depth; ++level) {
    const std::vector<NodeBlock>& children = tree.levels[level - 1];
    nodes = children.size();
    build_level(nodes, tree.levels[level], [&](std::size_t i) { return parent_of(children[i], source); });
  }
}

}  // namespace

std::size_t ConeTree::byte_count() const {
  std::size_t bytes = packets.size() * sizeof(RayPacket);
  for (const auto& level : levels) bytes += level.size() * sizeof(NodeBlock);
  return bytes;
}

std::array<std::size_t, 2> ConeTree::packet_range(std::size_t level, std::size_t node) const {
  const std::size_t width = std::size_t{1} << (2 * level);
  return {std::min(packets.size(), node * width), std::min(packets.size(), (node + 1) * width)};
}

void build_cone_tree(const ShadowRays& rays, std::span<const dvec3> positions, const RaySource& source,
                     SimdLevel simd, ConeTree& out) {
  const ConeAround cone_around = cone_around_kernel(simd);
  out.directional = source.directional;
  out.packets.resize((rays.pixels.size() + packet_size - 1) / packet_size);
  const std::span<const std::uint32_t> pixels(rays.pixels);
  build_levels(source, out, [&](std::size_t i) {
    RayPacket& packet = out.packets[i];
    const std::size_t begin = i * packet_size;
    const std::size_t count = std::min<std::size_t>(packet_size, pixels.size() - begin);
    fill_packet(pixels.subspan(begin, count), positions, source.origin, packet);
    const bool ordinary = !source.directional && packet.reach > 1e-15f && packet.reach < 1e15f;
    return ordinary ? cone_around(packet) : leaf_node(packet, source);
  });
}

void update_cone_tree(const RaySource& source, ConeTree& tree) {
  build_levels(source, tree, [&](std::size_t i) { return leaf_node(tree.packets[i], source); });
}

float root_extent(const ConeTree& tree) {
  const float c = std::min(tree.levels.back()[0].c[0], 2.0f);
  return static_cast<float>(M_PI) *
         (tree.directional ? tree.levels.back()[0].c[0] * tree.levels.back()[0].c[0] : c * c);
}

}  // namespace tenebra::shadow
