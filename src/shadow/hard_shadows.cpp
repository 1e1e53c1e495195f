#include <tenebra/hard_shadows.h>

#include <bit>
#include <numeric>

#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "points/positions.h"
#include "shadow/cone_tree/cone_tree.h"
#include "shadow/cone_tree/traverse.h"
#include "shadow/decision/triangle_planes.h"
#include "shadow/rays/shadow_rays.h"
#include "shadow/tiles/tile_tracer.h"

namespace tenebra {

namespace {

constexpr std::uint8_t lit = 255;
// Section 3.4: triangles that can cover a node four levels below the root go first; the tree is updated if
// they blocked at least one ray in `update_share`.
constexpr float blocker_share = 1.0f / 256;
constexpr std::uint64_t update_share = 16;

/// What each variant uses: Table 1 of the paper.
struct VariantParts {
  bool spheres, sorted, early_accept, two_pass;
};
VariantParts parts_of(Variant variant) {
  switch (variant) {
    case Variant::precise:
      return {false, false, false, false};
    case Variant::tiles:  // for what TileTracer::trace declines
    case Variant::precise_sorted:
      return {false, true, false, false};
    case Variant::spheres:
      return {true, false, false, false};
    case Variant::spheres_sorted:
      return {true, true, false, false};
    case Variant::precise_sea:
      return {false, true, true, false};
    case Variant::precise_eatp:
      return {false, false, true, true};
    case Variant::precise_seatp:
      return {false, true, true, true};
  }
  return {};
}

std::uint64_t live_rays(const shadow::ConeTree& tree) {
  std::uint64_t live = 0;
  for (const shadow::RayPacket& packet : tree.packets)
    live += static_cast<std::uint64_t>(std::popcount(packet.live));
  return live;
}

}  // namespace

struct ShadowTracer::State {
  shadow::TileTracer tiles;
  VisiblePoints positions;  ///< found here if the caller's points have none
  shadow::TriangleSet set;
  shadow::ShadowRays rays;
  shadow::RayKeys keys;
  shadow::ConeTree tree;
  std::vector<std::uint32_t> at_light;
  std::vector<std::uint32_t> places;
  std::vector<std::uint32_t> blockers;
  std::vector<shadow::TraversalScratch> scratch;
  shadow::NodeTests node_tests;
  std::vector<float> pixel_nodes;
  Variant ran = Variant::tiles;
  TraceStats stats;
  FrameTimings timings;

  void begin_node_tests();
  void spread_node_tests(std::size_t pixels);
  void trace_one_pass(const shadow::Traversal& traversal, const shadow::TraversalKernels& kernels);
  void trace_two_passes(const shadow::Traversal& traversal, const shadow::TraversalKernels& kernels);
  void write_mask(ShadowMask& mask) const;
};

void ShadowTracer::State::trace_one_pass(const shadow::Traversal& traversal,
                                         const shadow::TraversalKernels& kernels) {
  places.resize(set.planes.size());
  std::iota(places.begin(), places.end(), 0u);
  shadow::traverse(traversal, kernels, places, scratch, stats);
}

void ShadowTracer::State::trace_two_passes(const shadow::Traversal& traversal,
                                           const shadow::TraversalKernels& kernels) {
  const float least = shadow::root_extent(tree) * blocker_share;
  places.clear();
  blockers.clear();
  for (std::uint32_t i = 0; i < set.extent.size(); ++i)
    (set.extent[i] >= least ? blockers : places).push_back(i);
  shadow::traverse(traversal, kernels, blockers, scratch, stats);
  if ((rays.pixels.size() - live_rays(tree)) * update_share >= rays.pixels.size()) {
    shadow::update_cone_tree(*traversal.source, tree);
  }
  shadow::traverse(traversal, kernels, places, scratch, stats);
}

void ShadowTracer::State::write_mask(ShadowMask& mask) const {
  parallel::parallel_ranges(rays.pixels.size(), 1 << 15, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const bool live = (tree.packets[i / shadow::packet_size].live >> (i % shadow::packet_size)) & 1u;
      mask[rays.pixels[i]] = live ? lit : 0;
    }
  });
  for (const std::uint32_t pixel : at_light) mask[pixel] = lit;
}

void ShadowTracer::State::begin_node_tests() {
  node_tests.resize(tree.levels.size());
  for (std::size_t k = 0; k < tree.levels.size(); ++k)
    node_tests[k].assign(tree.levels[k].size() * shadow::branching, 0);
}

void ShadowTracer::State::spread_node_tests(std::size_t pixels) {
  pixel_nodes.assign(pixels, 0);
  const std::size_t count = rays.pixels.size();
  for (std::size_t packet = 0; packet * shadow::packet_size < count; ++packet) {
    double shares = 0;
    std::size_t node = packet,
                most = shadow::packet_size;  // rays of a node of this level; the last may hold fewer
    for (const std::vector<std::uint32_t>& level : node_tests) {
      shares += static_cast<double>(level[node]) / static_cast<double>(std::min(most, count - node * most));
      node /= shadow::branching;
      most *= shadow::branching;
    }
    const std::size_t last = std::min(count, (packet + 1) * shadow::packet_size);
    for (std::size_t i = packet * shadow::packet_size; i < last; ++i)
      pixel_nodes[rays.pixels[i]] = static_cast<float>(shares);
  }
}

ShadowTracer::ShadowTracer() : state_(std::make_unique<State>()) {}
ShadowTracer::ShadowTracer(ShadowTracer&&) noexcept = default;
ShadowTracer& ShadowTracer::operator=(ShadowTracer&&) noexcept = default;
ShadowTracer::~ShadowTracer() = default;

const TraceStats& ShadowTracer::stats() const {
  return state_->stats;
}
Variant ShadowTracer::ran() const {
  return state_->ran;
}
const FrameTimings& ShadowTracer::timings() const {
  return state_->timings;
}
std::span<const float> ShadowTracer::pixel_nodes() const {
  return state_->pixel_nodes;
}

void ShadowTracer::share_triangles(ShadowTracer& other) {
  state_->tiles.share_triangles(other.state_->tiles);
}
bool ShadowTracer::follow(const TriangleView& triangles, SimdLevel simd, const StopFlag* stop) {
  const parallel::FloatEnvironment ieee;
  return state_->tiles.follow(triangles, simd, stop);
}

bool ShadowTracer::trace_shadow_mask(const VisiblePoints& seen, const TriangleView& triangles,
                                     const ShadowLight& light, const HardShadowConfig& config,
                                     ShadowMask& mask, const StopFlag* stop) {
  const parallel::FloatEnvironment ieee;
  State& s = *state_;
  s.stats = {};
  s.timings = {};
  s.pixel_nodes.clear();
  if (config.variant == Variant::tiles &&
      s.tiles.trace(seen, triangles, light, config, mask, s.stats, s.timings, stop)) {
    if (config.count_pixel_nodes) s.tiles.spread_tests(seen.width, seen.height, s.pixel_nodes);
    s.ran = Variant::tiles;
    s.stats.lights_tiles = 1;
    return true;
  }
  if (stop_requested(stop)) return false;
  s.ran = config.variant == Variant::tiles ? Variant::precise_sorted : config.variant;
  s.stats = {.lights_cones = 1};
  const shadow::RaySource source = shadow::ray_source(light);
  const VariantParts parts = parts_of(config.variant);
  base::Stopwatch watch;

  const VisiblePoints& points = points::with_positions(seen, triangles, s.positions);
  shadow::build_triangle_set(triangles, source, config, s.set);
  shadow::generate_shadow_rays(points, triangles, light, source, s.set, s.keys, s.rays, s.at_light);
  s.timings.rays_ms = watch.lap_ms();

  if (parts.sorted) {
    shadow::sort_shadow_rays(points, source, config.simd, s.keys, s.rays);
    s.timings.sort_ms = watch.lap_ms();
  }

  s.tree.packets.clear();
  s.stats.triangles = s.set.casting;
  s.stats.degenerate_triangles = s.set.degenerate;
  if (!s.rays.pixels.empty()) {
    shadow::build_cone_tree(s.rays, points.positions, source, config.simd, s.tree);
    s.timings.build_ms = watch.lap_ms();
    const shadow::Traversal traversal{{parts.spheres, parts.early_accept, source.directional},
                                      &s.set,
                                      &s.rays,
                                      &s.tree,
                                      &source,
                                      &triangles,
                                      points.positions,
                                      config.contact,
                                      config.count_pixel_nodes ? &s.node_tests : nullptr,
                                      stop};
    if (config.count_pixel_nodes) s.begin_node_tests();
    const shadow::TraversalKernels kernels = shadow::traversal_kernels(config.simd);
    parts.two_pass ? s.trace_two_passes(traversal, kernels) : s.trace_one_pass(traversal, kernels);
    s.stats.tree_bytes = s.tree.byte_count();
  }
  if (stop_requested(stop)) return false;
  s.timings.traverse_ms = watch.lap_ms();
  s.pixel_nodes.clear();
  if (config.count_pixel_nodes) s.spread_node_tests(points.triangles.size());
  watch.lap_ms();

  mask.assign(points.triangles.size(), 0);
  s.write_mask(mask);
  s.stats.rays = s.rays.pixels.size() + s.at_light.size();
  s.stats.lit_pixels = live_rays(s.tree) + s.at_light.size();
  s.stats.shadowed_pixels = s.stats.rays - s.stats.lit_pixels;
  s.timings.writeback_ms = watch.lap_ms();
  return true;
}

}  // namespace tenebra
