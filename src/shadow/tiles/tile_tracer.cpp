#include "shadow/tiles/tile_tracer.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "base/stopwatch.h"
#include "parallel/parallel.h"

namespace tenebra::shadow {

namespace {

constexpr std::uint64_t wide = 16;  // boxes, triangles or points that one test looks at

}  // namespace

const points::PointTiles& TileTracer::tiles_of(const VisiblePoints& points, const TriangleView& triangles) {
  if (!points.tiles.empty()) return *points.tiles;
  points::make_point_tiles(points, triangles, own_tiles_);
  return own_tiles_;
}

// The roots that took most tests in the last call go first: roots are few, and no thread should be left with
// a long one at the end. Roots lie along a curve: the same share of the way along it is about the same part
// of the picture in both calls.
void TileTracer::order_roots(std::size_t roots) {
  root_order_.resize(roots);
  std::iota(root_order_.begin(), root_order_.end(), 0u);
  if (root_tests_.empty()) return;
  const auto tests = [&](std::uint32_t root) { return root_tests_[root * root_tests_.size() / roots]; };
  std::sort(root_order_.begin(), root_order_.end(), [&](std::uint32_t a, std::uint32_t b) {
    return tests(a) != tests(b) ? tests(a) > tests(b) : a < b;
  });
}

void TileTracer::descend(const Descent& descent, SimdLevel simd, TraceStats& stats) {
  const DescentKernels kernels = descent_kernels(simd);
  const std::size_t roots = forest_.levels[ray_levels - 1].size();
  scratch_.resize(std::max(scratch_.size(), static_cast<std::size_t>(thread_count())));
  for (DescentScratch& scratch : scratch_) scratch.begin_trace();
  root_stats_.assign(roots, {});
  order_roots(roots);
  parallel::parallel_in_order(static_cast<int>(roots), [&](int i) {
    const std::uint32_t root = root_order_[static_cast<std::size_t>(i)];
    kernels.descend(descent, root, scratch_[static_cast<std::size_t>(parallel::thread_index())],
                    root_stats_[root]);
  });
  root_tests_.clear();
  for (const TraceStats& part : root_stats_) root_tests_.push_back(part.nodes);
  for (const TraceStats& part : root_stats_) stats += part;
  // Several roots may have met the same triangle, which counts once.
  std::vector<std::uint32_t>& edge_on = scratch_.front().edge_on;
  for (std::size_t i = 1; i < scratch_.size(); ++i)
    edge_on.insert(edge_on.end(), scratch_[i].edge_on.begin(), scratch_[i].edge_on.end());
  std::sort(edge_on.begin(), edge_on.end());
  const auto different = std::unique(edge_on.begin(), edge_on.end()) - edge_on.begin();
  stats.degenerate_triangles = clusters_->without_area() + static_cast<std::uint64_t>(different);
}

bool TileTracer::trace(const VisiblePoints& points, const TriangleView& triangles, const ShadowLight& light,
                       const HardShadowConfig& config, ShadowMask& mask, TraceStats& stats,
                       FrameTimings& timings, const StopFlag* stop) {
  if (triangles.positions.size() > most_vertices) return false;
  base::Stopwatch watch;
  const points::PointTiles& tiles = tiles_of(points, triangles);
  forest_.distant = distant_face(light, tiles);
  if (light.directional && !forest_.distant) return false;
  const RaySource source =
      forest_.distant ? distant_source(ray_source(light), *forest_.distant) : ray_source(light);
  build_ray_forest(points, tiles, triangles, light, source, config, forest_scratch_, forest_);
  timings.rays_ms = watch.lap_ms();
  if (!forest_.in_range) return false;
  if (!clusters_->update(triangles, config.simd, stop)) return false;
  timings.build_ms = watch.lap_ms();
  tile_tests_.assign(config.count_pixel_nodes ? forest_.levels[0].size() : 0, {});
  descend({*clusters_, forest_, source, triangles, points, tiles, config.contact, config.cull_front,
           config.count_pixel_nodes ? &tile_tests_ : nullptr, stop},
          config.simd, stats);
  if (stop_requested(stop)) return false;
  timings.traverse_ms = watch.lap_ms();

  mask.assign(points.triangles.size(), 0);
  const std::uint64_t live = write_live_rays(forest_, points.width, points.height, live_parts_, mask);
  for (const std::uint32_t pixel : forest_.at_light) mask[pixel] = 255;
  timings.writeback_ms = watch.lap_ms();

  stats.triangles = clusters_->casters();
  stats.nodes *= wide;
  stats.rays = forest_.rays + forest_.at_light.size();
  stats.lit_pixels = live + forest_.at_light.size();
  stats.shadowed_pixels = stats.rays - stats.lit_pixels;
  stats.tree_bytes = forest_.byte_count() + clusters_->byte_count();
  return true;
}

// From the leaves up: the rays below each node. From the roots down: each ray's share of the tests of all
// nodes above it.
void TileTracer::spread_tests(int width, int height, std::vector<float>& out) const {
  out.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  const points::TilePixels pixel_of(width, height);
  std::array<std::vector<double>, ray_levels> rays, shares;
  const auto& levels = forest_.levels;
  for (std::size_t level = 0; level < ray_levels; ++level) {
    for (const RayNode& node : levels[level]) {
      double below = 0;
      for (std::uint32_t slots = node.filled; slots != 0; slots &= slots - 1) {
        const int slot = std::countr_zero(slots);
        below += level > 0 ? rays[level - 1][node.child[slot]] : std::popcount(node.all_rays[slot]);
      }
      rays[level].push_back(below);
    }
  }
  for (std::size_t level = ray_levels; level-- > 0;) {
    for (std::size_t i = 0; i < levels[level].size(); ++i) {
      if (levels[level][i].filled == 0) {
        shares[level].push_back(0);
        continue;
      }
      const double above = level + 1 < ray_levels ? shares[level + 1][levels[level][i].parent] : 0.0;
      shares[level].push_back(above + static_cast<double>(levels[level][i].tests * wide) / rays[level][i]);
    }
  }
  for (std::size_t i = 0; i < levels[0].size(); ++i) {
    const RayNode& node = levels[0][i];
    for (std::uint32_t slots = node.filled; slots != 0; slots &= slots - 1) {
      const auto slot = static_cast<std::size_t>(std::countr_zero(slots));
      const std::uint32_t lanes = node.all_rays[slot];
      const double share =
          shares[0][i] + static_cast<double>(tile_tests_[i][slot] * wide) / std::popcount(lanes);
      const std::size_t first = pixel_of(node.child[slot]);
      for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(left));
        out[first + lane % 4 + lane / 4 * static_cast<std::size_t>(width)] = static_cast<float>(share);
      }
    }
  }
}

}  // namespace tenebra::shadow
