#include "bench/ao/ao_frame_peer.h"

#include <algorithm>
#include <cmath>

#include "bench/ao/ao_race.h"
#include "parallel/parallel.h"
#include "support/seeded_random.h"

namespace tenebra::bench {
namespace {

constexpr float start = 1e-4f;  // of the reach: rays start beyond the rounding of points to float

}  // namespace

/// One pixel of step x step, as PixelReceivers chooses it, in tiles.
struct FramePeer::Grid {
  static constexpr int tile = 16;
  Grid(const VisiblePoints& points, int by)
      : step(by), width((points.width + by - 1) / by), height((points.height + by - 1) / by) {
    columns = (width + tile - 1) / tile;
  }
  int step, width, height, columns;
  int tiles() const { return columns * ((height + tile - 1) / tile); }
  std::size_t size() const { return static_cast<std::size_t>(width * height); }
  std::size_t pixel(const VisiblePoints& points, int x, int y) const {
    const int px = std::min(x * step + step / 2, points.width - 1);
    const int py = std::min(y * step + step / 2, points.height - 1);
    return static_cast<std::size_t>(py * points.width + px);
  }
};

double SampledTruth::rms_255(std::span<const float> frame) const {
  std::vector<float> found;
  for (const std::size_t i : pixels) found.push_back(frame[i]);
  return bench::rms_255(found, open);
}

FramePeer::FramePeer(const Scene& scene, const BenchFrame& frame, float reach_m)
    : frame_(frame),
      reach_(reach_m),
      objects_(ao::find_objects(scene, frame.geometry)),
      input_{frame.geometry, frame.points, frame.normals, objects_},
      peer_(frame.triangles()) {}

Tracer FramePeer::tracer(PeerMode mode) const {
  return mode == PeerMode::packets ? peer_.packets(false, start * reach_) : peer_.single_rays(start * reach_);
}

SampledTruth FramePeer::truth(int rays, int stride) const {
  testing::Random random(13);
  SampledTruth truth;
  const auto step = static_cast<std::uint32_t>(stride);
  for (int y = 0; y < frame_.points.height; y += stride) {
    for (int x = 0; x < frame_.points.width; x += stride) {
      const std::size_t px = static_cast<std::size_t>(x) + random.index(step);
      const std::size_t py = static_cast<std::size_t>(y) + random.index(step);
      const std::size_t i = py * static_cast<std::size_t>(frame_.points.width) + px;
      if (i < frame_.pixel_count() && frame_.points.triangles[i] != no_triangle) truth.pixels.push_back(i);
    }
  }
  const std::vector<float> values = at(truth.pixels, rays);
  for (const std::size_t i : truth.pixels) truth.open.push_back(values[i]);
  return truth;
}

std::vector<float> FramePeer::at(std::span<const std::size_t> pixels, int rays) const {
  std::vector<Receiver> receivers;
  for (const std::size_t i : pixels)
    receivers.push_back({glm::vec3(frame_.points.positions[i]), frame_.normals[i]});
  const auto hidden = occlusion(receivers, CosineRays(rays, 17), reach_, tracer(PeerMode::packets));
  std::vector<float> open(frame_.pixel_count(), 1.0f);
  for (std::size_t k = 0; k < pixels.size(); ++k) open[pixels[k]] = 1 - hidden[k];
  return open;
}

void FramePeer::tile(const Grid& grid, int number, const CosineRays& rays, const Tracer& tracer,
                     std::span<float> values) const {
  std::vector<trees::RayBatch> batches(static_cast<std::size_t>(rays.count() / trees::batch_size));
  std::vector<float> t(static_cast<std::size_t>(rays.count()));
  const int x0 = number % grid.columns * Grid::tile, y0 = number / grid.columns * Grid::tile;
  for (int y = y0; y < std::min(y0 + Grid::tile, grid.height); ++y) {
    for (int x = x0; x < std::min(x0 + Grid::tile, grid.width); ++x) {
      const std::size_t i = grid.pixel(frame_.points, x, y);
      if (frame_.points.triangles[i] == no_triangle) continue;
      rays.batches({glm::vec3(frame_.points.positions[i]), frame_.normals[i]}, i, batches);
      std::fill(t.begin(), t.end(), reach_);
      tracer(batches, t.data());
      float sum = 0;
      for (const float hit : t) sum += 1 - hit / reach_;
      values[static_cast<std::size_t>(y * grid.width + x)] = 1 - sum / static_cast<float>(rays.count());
    }
  }
}

std::vector<float> FramePeer::frame(int rays, int downscale, PeerMode mode) const {
  const Grid grid(frame_.points, downscale);
  const CosineRays pattern(rays, 19);
  const Tracer trace = tracer(mode);
  std::vector<float> values(grid.size(), 1.0f), pixels(frame_.pixel_count(), 1.0f);
  parallel::parallel_tasks(grid.tiles(), [&](int number) { tile(grid, number, pattern, trace, values); });
  ao::PixelReceivers(input_, downscale, reach_).spread(values, pixels);
  return pixels;
}

double FramePeer::trace_ms(int rays, int downscale, PeerMode mode, int part) const {
  const Grid grid(frame_.points, downscale);
  const CosineRays pattern(rays, 19);
  const Tracer trace = tracer(mode);
  std::vector<float> values(grid.size(), 1.0f);
  CostClock clock;
  // Tiles of a row in turn, the row's first shifted, so that all places of the picture are in it.
  parallel::parallel_tasks(grid.tiles() / part,
                           [&](int i) { tile(grid, i * part + i / part % part, pattern, trace, values); });
  return clock.ms() * part;
}

double FramePeer::spread_ms() const {
  const ao::PixelReceivers set(input_, 2, reach_);
  const std::vector<float> values(set.values(), 1.0f);
  std::vector<float> pixels(frame_.pixel_count(), 1.0f);
  CostClock clock;
  set.spread(values, pixels);
  return clock.ms();
}

}  // namespace tenebra::bench
