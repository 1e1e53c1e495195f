// The traversal, compiled once per instruction set. The paper's breadth-first queue of (triangle, node) pairs
// is kept as one list of triangles for each node: the same pairs are tested in an order that needs memory for
// the lists of one path only, and no two threads ever write to the same node.
#include "shadow/cone_tree/traverse.h"

// AVX3_DL adds instructions that these kernels have no use for; SSSE3 is too rare to build for.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shadow/cone_tree/traverse.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "shadow/cone_tree/node_tests-inl.h"
#include "shadow/decision/decide.h"
#include "simd/dispatch.h"
#include "simd/pack-inl.h"
#include "simd/prefetch.h"

#include <algorithm>
#include <bit>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

// Triangles that the float filter could not decide for some rays of a packet.
constexpr int open_capacity = 64;
struct OpenPairs {
  std::uint32_t places[open_capacity];
  std::uint32_t rays[open_capacity];
  int size = 0;
};

struct PacketVerdict {
  std::uint32_t blocked;  // certain
  std::uint32_t open;     // neither certainly blocked nor certainly missed
};

// Sixteen rays of a packet against the four planes of a triangle. e0 is in double; with r >= |q| a float sum
// differs from the exact value by at most K = 10.1 u r + rho (R + reach), or cannot have the wrong sign at
// all (|e0| > 2r). Behind the own plane a point must lie farther by tau of the rays' own triangles.
SIMD_INLINE PacketVerdict test_packet(const RayPacket& packet, const TrianglePlanes& t, float tau) {
  double e0[4];
  four_planes(t.mx, t.my, t.mz, t.d, packet.base_x, packet.base_y, packet.base_z, e0);
  const double rho = HWY_MAX(HWY_MAX(t.rho[0], t.rho[1]), HWY_MAX(t.rho[2], t.rho[3]));
  const float k = static_cast<float>(
      (10.1 * 0x1p-24 * packet.radius + rho * (packet.reach + t.reach) + 2 * 0x1p-24 * tau) * (1 + 0x1p-20) +
      0x1p-122);
  const double lowest = HWY_MIN(HWY_MIN(e0[0], e0[1]), HWY_MIN(e0[2], e0[3]));
  if (lowest < -(static_cast<double>(packet.radius) + k)) return {0, 0};

  const Pack3<Float16> q{load<Float16>(packet.qx), load<Float16>(packet.qy), load<Float16>(packet.qz)};
  Float16 edges = broadcast<Float16>(std::numeric_limits<float>::infinity());
  Float16 own = edges;
  for (int i = 0; i < 4; ++i) {
    const Pack3<Float16> m = broadcast3<Float16>(static_cast<float>(t.mx[i]), static_cast<float>(t.my[i]),
                                                 static_cast<float>(t.mz[i]));
    const Float16 e = mul_add(
        m.z, q.z, mul_add(m.y, q.y, mul_add(m.x, q.x, broadcast<Float16>(static_cast<float>(e0[i])))));
    (i < 3 ? edges : own) = min(e, i < 3 ? edges : own);
  }
  const std::uint32_t blocked = lt_bits(broadcast<Float16>(k), min(edges, own - broadcast<Float16>(tau)));
  const std::uint32_t missed = lt_bits(min(edges, own), broadcast<Float16>(-k));
  return {blocked, 0xffffu & ~blocked & ~missed};
}

void settle_open(const Traversal& s, std::size_t index, RayPacket& packet, const OpenPairs& open,
                 TraceStats& stats) {
  for (int i = 0; i < open.size && !stop_requested(s.stop); ++i) {
    for (std::uint32_t rays = open.rays[i] & packet.live; rays != 0; rays &= rays - 1) {
      const int lane = std::countr_zero(rays);
      const std::size_t ray = index * packet_size + static_cast<std::size_t>(lane);
      const bool blocked = decide(s.set->planes[open.places[i]], s.positions[s.rays->pixels[ray]],
                                  s.rays->triangles[ray], *s.source, *s.triangles, s.contact, stats);
      if (blocked) packet.live &= ~(1u << lane);
    }
  }
}

// Those of `rays` whose own triangle is not `id`.
std::uint32_t without_own(const Traversal& s, std::size_t index, std::uint32_t rays, std::uint32_t id) {
  if (s.contact != ContactRule::triangle_ids) return rays;
  std::uint32_t kept = rays;
  for (std::uint32_t left = rays; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    if (s.rays->triangles[index * packet_size + static_cast<std::size_t>(lane)] == id) kept &= ~(1u << lane);
  }
  return kept;
}

void trace_packet(const Traversal& s, std::size_t index, TriangleList list, TraceStats& stats) {
  RayPacket& packet = s.tree->packets[index];
  OpenPairs open;
  for (std::size_t i = 0; i < list.size && packet.live != 0 && !stop_requested(s.stop); ++i) {
    const TrianglePlanes& planes = s.set->planes[list.places[i]];
    stats.leaf_tests += static_cast<std::uint64_t>(std::popcount(packet.live));
    const PacketVerdict verdict = test_packet(packet, planes, s.rays->tau_max);
    const std::uint32_t blocked = verdict.blocked & packet.live;
    if (blocked != 0) packet.live &= ~without_own(s, index, blocked, planes.triangle);
    const std::uint32_t undecided = verdict.open & packet.live;
    if (undecided == 0) continue;
    open.places[open.size] = list.places[i];
    open.rays[open.size++] = undecided;
    if (open.size == open_capacity) {
      settle_open(s, index, packet, open, stats);
      open.size = 0;
    }
  }
  settle_open(s, index, packet, open, stats);
}

bool any_own(const Traversal& s, std::array<std::size_t, 2> packets, std::uint32_t id) {
  if (s.contact != ContactRule::triangle_ids) return false;
  const std::size_t first = packets[0] * packet_size;
  const std::size_t last = std::min(packets[1] * packet_size, s.rays->triangles.size());
  return std::find(s.rays->triangles.begin() + static_cast<std::ptrdiff_t>(first),
                   s.rays->triangles.begin() + static_cast<std::ptrdiff_t>(last),
                   id) != s.rays->triangles.begin() + static_cast<std::ptrdiff_t>(last);
}

// Section 3.3: all rays below the node are blocked; the node is invalid from now on. A triangle that is some
// ray's own is not accepted for the node.
bool accept_early(const Traversal& s, std::size_t level, std::size_t node, std::uint32_t id,
                  TraceStats& stats) {
  const auto range = s.tree->packet_range(level, node);
  if (any_own(s, range, id)) return false;
  for (std::size_t i = range[0]; i < range[1]; ++i) s.tree->packets[i].live = 0;
  s.tree->levels[level][node / branching].c[node % branching] = -1;
  ++stats.early_accepts;
  return true;
}

// Adds what `filter` did at a block: `tested` triangles at each node that was never covered, else `until` of
// them.
void count_tests(NodeTests& tests, std::size_t level, std::size_t block, std::uint32_t empty,
                 std::size_t tested, const std::uint32_t until[4]) {
  for (std::size_t lane = 0; lane < branching; ++lane) {
    tests[level][block * branching + lane] +=
        (empty >> lane) & 1u ? until[lane] : static_cast<std::uint32_t>(tested);
  }
}

void filter(const Traversal& s, std::size_t level, std::size_t block, TriangleList list,
            std::uint32_t* const out[4], std::size_t out_size[4], TraceStats& stats) {
  Nodes nodes = load_nodes(s.tree->levels[level][block]);
  std::size_t size[4] = {0, 0, 0, 0};
  std::uint32_t until[4] = {0, 0, 0, 0};
  std::size_t i = 0;
  for (; i < list.size && nodes.empty != 15; ++i) {
    const std::uint32_t place = list.places[i];
    if (i + 4 < list.size) simd::prefetch_all(s.set->bounds[list.places[i + 4]]);
    const TriangleBounds& bounds = s.set->bounds[place];
    stats.nodes += static_cast<std::uint64_t>(std::popcount(15u & ~nodes.empty));
    const NodeVerdict verdict = test_nodes(bounds, nodes, s.flags.spheres, s.flags.directional,
                                           s.rays->tau_max, s.flags.early_accept);
    for (int lane = 0; lane < branching; ++lane) {
      out[lane][size[lane]] = place;
      size[lane] += ~(verdict.rejected >> lane) & 1u;
    }
    for (std::uint32_t covered = verdict.covered; covered != 0; covered &= covered - 1) {
      const int lane = std::countr_zero(covered);
      if (accept_early(s, level, block * branching + static_cast<std::size_t>(lane),
                       s.set->planes[place].triangle, stats)) {
        nodes.empty |= 1u << lane;
        until[lane] = static_cast<std::uint32_t>(i + 1);
      }
    }
  }
  if (s.node_tests) count_tests(*s.node_tests, level, block, nodes.empty, i, until);
  // A covered node keeps no triangles: its subtree is finished.
  for (int lane = 0; lane < branching; ++lane) out_size[lane] = (nodes.empty >> lane) & 1u ? 0 : size[lane];
}

void descend(const Traversal& s, std::size_t level, std::size_t node, TriangleList list,
             TraversalScratch& scratch, TraceStats& stats) {
  if (list.size == 0 || stop_requested(s.stop)) return;
  if (level == 0) return trace_packet(s, node, list, stats);
  std::uint32_t* out[4];
  std::size_t size[4];
  for (int lane = 0; lane < branching; ++lane) {
    std::vector<std::uint32_t>& storage =
        scratch.lists[(level - 1) * branching + static_cast<std::size_t>(lane)];
    if (storage.size() < list.size + 1) storage.resize(list.size + 1);
    out[lane] = storage.data();
  }
  filter(s, level - 1, node, list, out, size, stats);
  for (int lane = 0; lane < branching; ++lane) {
    descend(s, level - 1, node * branching + static_cast<std::size_t>(lane), {out[lane], size[lane]}, scratch,
            stats);
  }
}

}  // namespace

TraversalKernels kernels() {
  return {filter, descend};
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::shadow {

TraversalKernels traversal_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, kernels)();
}

}  // namespace tenebra::shadow
#endif
