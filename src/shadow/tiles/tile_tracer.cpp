#include "shadow/tiles/tile_tracer.h"

#include <algorithm>
#include <bit>

#include "base/stopwatch.h"
#include "parallel/parallel.h"

namespace tenebra {

namespace {

constexpr std::uint64_t wide = 16;  // what one test of a node or tile looks at

std::uint64_t count_tests(const RayForest& forest) {
  std::uint64_t tests = 0;
  for (const auto& level : forest.levels) {
    for (const RayNode& node : level) tests += node.tests;
  }
  return tests;
}

}  // namespace

void TileTracer::descend(const Descent& descent, SimdLevel simd, TraceStats& stats) {
  const DescentKernels kernels = descent_kernels(simd);
  const std::size_t roots = forest_.levels[ray_levels - 1].size();
  scratch_.resize(std::max(scratch_.size(), static_cast<std::size_t>(thread_count())));
  std::vector<TraceStats> parts(roots);
  parallel_tasks(static_cast<int>(roots), [&](int root) {
    kernels.descend(descent, static_cast<std::uint32_t>(root),
                    scratch_[static_cast<std::size_t>(thread_index())],
                    parts[static_cast<std::size_t>(root)]);
  });
  for (const TraceStats& part : parts) stats += part;
}

bool TileTracer::trace(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
                       const ShadowLight& light, const HardShadowConfig& config, ShadowMask& mask,
                       TraceStats& stats, FrameTimings& timings) {
  const RaySource source = ray_source(light);
  if (source.directional) return false;
  Stopwatch watch;
  build_ray_forest(points, view, triangles, light, source, config, forest_scratch_, forest_);
  timings.rays_ms = watch.lap_ms();
  if (!forest_.in_range) return false;
  clusters_.update(triangles);
  timings.build_ms = watch.lap_ms();
  descend({clusters_, forest_, source, triangles, points, config.contact, config.cull_front}, config.simd,
          stats);
  timings.traverse_ms = watch.lap_ms();

  mask.assign(points.triangles.size(), 0);
  const TileCounts counts = write_live_rays(forest_, static_cast<std::size_t>(points.width), mask);
  for (const std::uint32_t pixel : forest_.at_light) mask[pixel] = 255;
  timings.writeback_ms = watch.lap_ms();

  stats.triangles = clusters_.casters();
  stats.nodes = (count_tests(forest_) + counts.tests) * wide;
  stats.rays = forest_.rays + forest_.at_light.size();
  stats.lit_pixels = counts.live + forest_.at_light.size();
  stats.shadowed_pixels = stats.rays - stats.lit_pixels;
  stats.tree_bytes = forest_.byte_count() + clusters_.byte_count();
  return true;
}

// From the leaves up: rays below each node; from the roots down: the shares of all nodes above a tile.
void TileTracer::spread_tests(int width, std::size_t pixels, std::vector<float>& out) const {
  out.assign(pixels, 0);
  std::array<std::vector<double>, ray_levels> rays, shares;
  const auto& levels = forest_.levels;
  for (std::size_t level = 0; level < ray_levels; ++level) {
    for (const RayNode& node : levels[level]) {
      double below = 0;
      for (std::uint32_t slots = node.filled; slots != 0; slots &= slots - 1) {
        const std::uint32_t child = node.child[std::countr_zero(slots)];
        below += level > 0 ? rays[level - 1][child] : std::popcount(forest_.tiles[child].rays);
      }
      rays[level].push_back(below);
    }
  }
  for (std::size_t level = ray_levels; level-- > 0;) {
    for (std::size_t i = 0; i < levels[level].size(); ++i) {
      const double above = level + 1 < ray_levels ? shares[level + 1][levels[level][i].parent] : 0.0;
      shares[level].push_back(above + static_cast<double>(levels[level][i].tests * wide) / rays[level][i]);
    }
  }
  for (std::size_t i = 0; i < levels[0].size(); ++i) {
    for (std::uint32_t slots = levels[0][i].filled; slots != 0; slots &= slots - 1) {
      const RayTile& tile = forest_.tiles[levels[0][i].child[std::countr_zero(slots)]];
      const double share = shares[0][i] + static_cast<double>(tile.tests * wide) / std::popcount(tile.rays);
      for (std::uint32_t lanes = tile.rays; lanes != 0; lanes &= lanes - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        out[tile.pixel + lane % 4 + lane / 4 * static_cast<std::size_t>(width)] = static_cast<float>(share);
      }
    }
  }
}

}  // namespace tenebra
