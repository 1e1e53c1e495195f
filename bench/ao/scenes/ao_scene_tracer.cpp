#include "bench/ao/scenes/ao_scene_tracer.h"

#include <algorithm>
#include <limits>

#include "bench/ao/ao_race.h"
#include "bench/ao/scenes/ao_scene_truth.h"
#include "bench/common/embree_packets.h"
#include "bench/common/ray_tile.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

using glm::vec3;

constexpr float lift = 4 * 1.7320508f * 0x1p-24f;  // as start_lift

std::vector<std::uint8_t> moves(const AoSceneView& view) {
  const auto& before = view.before.geometry.positions;
  const auto& now = view.now.geometry.positions;
  if (before.size() != now.size()) return std::vector<std::uint8_t>(now.size(), 1);
  return moved_vertices(before, now);
}

bool stands_still(const AoSceneView& view) {
  const std::vector<std::uint8_t> moved = moves(view);
  return std::find(moved.begin(), moved.end(), 1) == moved.end();
}

}  // namespace

AoSceneTracer::AoSceneTracer(const AoSceneView& view, TreeKind kind)
    : view_(view),
      still_(stands_still(view)),
      vertices_(view.now.geometry.positions),
      tree_(vertices_.data(), view.now.triangles(), moves(view),
            {kind, thread_count(), SimdLevel::automatic, true}),
      packet_(tree_.takes_packets_of(16)  ? 16
              : tree_.takes_packets_of(8) ? 8
                                          : 4),
      least_lift_(lift * largest_coordinate(view.now.triangles())) {
  const TileLanes lanes = TileLanes::of(TileShape::square);
  for (int i = 0; i < 16; ++i)
    lanes_.emplace_back(static_cast<int>(lanes.x[i]), static_cast<int>(lanes.y[i]));
}

double AoSceneTracer::follow_ms() {
  if (still_) return 0;
  const auto& before = view_.before.geometry.positions;
  if (before.size() == view_.now.geometry.positions.size()) {
    vertices_.put(before);
    tree_.follow();
  }
  vertices_.put(view_.now.geometry.positions);
  CostClock clock;
  tree_.follow();
  return clock.ms();
}

void AoSceneTracer::take(std::size_t pixel, int lane, AoPointPacket& points) const {
  const BenchFrame& frame = view_.now;
  const std::uint32_t id = frame.points.triangles[pixel];
  if (id == no_triangle) {
    points.valid[lane] = 0;
    return;
  }
  const vec3 p(frame.points.positions[pixel]), n = frame.normals[pixel];
  points.valid[lane] = -1;
  points.x[lane] = p.x, points.y[lane] = p.y, points.z[lane] = p.z;
  points.nx[lane] = n.x, points.ny[lane] = n.y, points.nz[lane] = n.z;
  const glm::uvec3 t = frame.geometry.triangles[id];
  const vec3 corner = frame.geometry.positions[t.x];
  const vec3 a = frame.geometry.positions[t.y] - corner, b = frame.geometry.positions[t.z] - corner;
  points.ax[lane] = a.x, points.ay[lane] = a.y, points.az[lane] = a.z;
  points.bx[lane] = b.x, points.by[lane] = b.y, points.bz[lane] = b.z;
}

void AoSceneTracer::begin(AoPointPacket& points) const {
  kernels_.frame(points, lift, least_lift_);
}

template <class Hits, class Code>
void AoSceneTracer::cast_all(const AoPointPacket& points, const PatternRow* rows, int rays, const Code& code,
                             float* sums) const {
  constexpr int size = static_cast<int>(std::size(Hits{}.ray.org_x));
  ao::EmbreeQuery query(order_);
  alignas(64) Hits hits{};
  std::fill(std::begin(hits.ray.mask), std::end(hits.ray.mask), meets_casters);
  for (int first = 0; first < 16; first += size) {
    code.begin(points, first, hits);
    for (int i = 0; i < rays; ++i) {
      code.spread(rows[i], points, first, view_.reach_m, hits);
      intersect(query, points.valid + first, tree_.get(), hits);
      code.gather(hits, first, sums);
    }
  }
}

void AoSceneTracer::cast(const AoPointPacket& points, const PatternRow* rows, int rays, float* open) const {
  alignas(64) float sums[16] = {};
  if (packet_ == 16) {
    cast_all<RTCRayHit16>(points, rows, rays, kernels_.sixteen, sums);
  } else if (packet_ == 8) {
    cast_all<RTCRayHit8>(points, rows, rays, kernels_.eight, sums);
  } else {
    cast_all<RTCRayHit4>(points, rows, rays, kernels_.four, sums);
  }
  const float all = 1 / (view_.reach_m * static_cast<float>(rays));
  for (int i = 0; i < 16; ++i) open[i] = points.valid[i] != 0 ? std::min(1.0f, sums[i] * all) : 1.0f;
}

/// 4x4 pixels of the grid from (x, y) on.
void AoSceneTracer::trace_tile(const AoScenePattern& pattern, const PixelGrid& grid,
                               const PlaneLayout& layout, glm::ivec2 at, float* values) const {
  AoPointPacket points{};
  std::ptrdiff_t place[16];
  int seen = 0;
  for (int i = 0; i < 16; ++i) {
    const glm::ivec2 pixel = at + lanes_[static_cast<std::size_t>(i)];
    const bool inside = pixel.x < grid.width && pixel.y < grid.height;
    place[i] = inside ? layout.at(pixel.x, pixel.y) : -1;
    if (inside) take(grid.pixel(pixel.x, pixel.y, view_.now.points.width), i, points);
    seen |= points.valid[i];
  }
  float open[16];
  std::fill(std::begin(open), std::end(open), 1.0f);
  if (seen != 0) {
    begin(points);
    cast(points, pattern.rows(at.x, at.y), pattern.rays(), open);
  }
  for (int i = 0; i < 16; ++i)
    if (place[i] >= 0) values[place[i]] = open[i];
}

void AoSceneTracer::trace(const AoScenePattern& pattern, const PixelGrid& grid, const PlaneLayout& layout,
                          float* values) const {
  constexpr int square = 16, tile = 4;  // pixels
  const int columns = (grid.width + square - 1) / square, rows = (grid.height + square - 1) / square;
  parallel::parallel_tasks(columns * rows, [&](int number) {
    for (int t = 0; t < 16; ++t) {
      const glm::ivec2 at(number % columns * square + t % 4 * tile, number / columns * square + t / 4 * tile);
      if (at.x < grid.width && at.y < grid.height) trace_tile(pattern, grid, layout, at, values);
    }
  });
}

void AoSceneTracer::trace(const AoScenePattern& pattern, std::span<const std::size_t> pixels,
                          float* values) const {
  parallel::parallel_ranges(pixels.size(), 16, [&](std::size_t first, std::size_t last) {
    AoPointPacket points{};
    float open[16];
    for (std::size_t k = first; k < last; ++k) take(pixels[k], static_cast<int>(k - first), points);
    begin(points);
    cast(points, pattern.rows(0, 0), pattern.rays(), open);
    for (std::size_t k = first; k < last; ++k) values[pixels[k]] = open[k - first];
  });
}

std::unique_ptr<AoSceneTracer> best_tracer(const AoSceneView& view, TreeKind& chosen) {
  const std::vector<TreeKind> kinds =
      stands_still(view) ? std::vector<TreeKind>{TreeKind::high}
                         : std::vector<TreeKind>(std::begin(moving_trees), std::end(moving_trees));
  const AoScenePattern pattern(4);
  const PixelGrid grid = PixelGrid::of(view.now.points, 1, {0, 0});
  const PlaneLayout layout(grid.width, grid.height);
  std::vector<float> values(layout.size());
  std::unique_ptr<AoSceneTracer> best;
  double least = std::numeric_limits<double>::infinity();
  for (const TreeKind kind : kinds) {
    auto tracer = std::make_unique<AoSceneTracer>(view, kind);
    double ms = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 2; ++round) {
      const double follow = tracer->follow_ms();
      CostClock clock;
      tracer->trace(pattern, grid, layout, values.data());
      ms = std::min(ms, follow + clock.ms());
    }
    if (ms >= least) continue;
    least = ms, chosen = kind, best = std::move(tracer);
  }
  return best;
}

}  // namespace tenebra::bench
