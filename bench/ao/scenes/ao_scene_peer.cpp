#include "bench/ao/scenes/ao_scene_peer.h"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>

#include "bench/ao/ao_race.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

constexpr int least_rays = 16;  // of a pixel that no filter cleans

constexpr glm::ivec2 traced_of_four{1, 1};
constexpr std::array<glm::ivec2, 3> left_out{glm::ivec2{0, 1}, glm::ivec2{1, 0}, glm::ivec2{0, 0}};

}  // namespace

std::string peer_variant_name(const PeerVariant& variant) {
  return fmt::format("{}, {}", variant.step == 1 ? "full" : "half",
                     variant.passes == 0   ? "no filter"
                     : variant.passes == 1 ? "1 pass"
                                           : fmt::format("{} passes", variant.passes));
}

AoScenePeer::Level::Level(const BenchFrame& frame, int step, glm::ivec2 first)
    : grid(PixelGrid::of(frame.points, step, first)), planes(frame, grid) {
  for (auto* values : {&traced, &filtered[0], &filtered[1], &filtered[2]})
    values->assign(planes.layout().size(), 1.0f);
}

AoScenePeer::AoScenePeer(const AoSceneView& view, const PeerFilter& filter)
    : view_(view),
      tracer_(best_tracer(view, kind_)),
      full_(view.now, 1, {0, 0}),
      half_(view.now, 2, traced_of_four),
      enough_(least_rays),
      open_(view.now.pixel_count(), 1.0f) {
  assert(view.now.points.width % 2 == 0 && view.now.points.height % 2 == 0);
  for (const glm::ivec2 first : left_out) {
    rest_.emplace_back(view.now, PixelGrid::of(view.now.points, 2, first));
    joined_.emplace_back(rest_.back().layout().size(), 1.0f);
  }
  alone_.resize(static_cast<std::size_t>(half_.grid.height));
  set_filter(filter);
}

void AoScenePeer::set_filter(const PeerFilter& filter) {
  const float distance = filter.distance * view_.reach_m;
  weights_ = {{filter.tap[0], filter.tap[1], filter.tap[2]},
              1 / (filter.plane * view_.reach_m),
              1 / (distance * distance),
              1 / filter.bend};
}

double AoScenePeer::trace_ms(int rays, int step) {
  if (!pattern_ || pattern_->rays() != rays) pattern_ = std::make_unique<AoScenePattern>(rays);
  Level& level = step == 1 ? full_ : half_;
  CostClock clock;
  tracer_->trace(*pattern_, level.grid, level.planes.layout(), level.values());
  return clock.ms();
}

ao::EmbreeQuery::Rays AoScenePeer::faster_order(int rays) {
  double best = 0;
  ao::EmbreeQuery::Rays faster = ao::EmbreeQuery::coherent;
  for (const auto order : {ao::EmbreeQuery::coherent, ao::EmbreeQuery::incoherent}) {
    tracer_->set_order(order);
    const double ms = std::min(trace_ms(rays, 2), trace_ms(rays, 2));
    if (best == 0 || ms < best) best = ms, faster = order;
  }
  return faster;
}

const float* AoScenePeer::filter(Level& level, int passes) {
  const float* from = level.traced.data();
  const PlaneLayout& layout = level.planes.layout();
  const AoPixelPlanes pixels = level.planes.view();
  for (int pass = 0; pass < passes; ++pass) {
    float* to = level.filtered[pass].data();
    parallel::parallel_ranges(
        static_cast<std::size_t>(level.grid.height), 8, [&](std::size_t first, std::size_t last) {
          for (auto y = static_cast<int>(first); y < static_cast<int>(last); ++y) {
            for (int x = 0; x < level.grid.width; x += 16)
              kernels_.filter(pixels, from, to, layout.at(x, y), layout.pitch(), 1 << pass, weights_);
          }
        });
    from = to;
  }
  return from;
}

/// Pixels of one of the three kinds from the two or four traced ones around them.
void AoScenePeer::join_class(int number, const float* half) {
  const auto k = static_cast<std::size_t>(number);
  const PlaneLayout& layout = half_.planes.layout();
  const std::ptrdiff_t up = -layout.pitch();
  const std::ptrdiff_t offsets[3][4] = {{0, -1, 0, 0}, {0, up, 0, 0}, {0, -1, up, up - 1}};
  const PixelGrid grid = PixelGrid::of(view_.now.points, 2, left_out[k]);
  const int width = view_.now.points.width;
  parallel::parallel_ranges(
      static_cast<std::size_t>(half_.grid.height), 8, [&](std::size_t first, std::size_t last) {
        for (auto y = static_cast<int>(first); y < static_cast<int>(last); ++y) {
          for (int x = 0; x < half_.grid.width; x += 16) {
            std::uint32_t lonely =
                kernels_.join(rest_[k].view(), half_.planes.view(), half, joined_[k].data(), layout.at(x, y),
                              offsets[number], number == 2 ? 4 : 2, weights_);
            for (int i = 0; lonely != 0; ++i, lonely >>= 1) {
              if ((lonely & 1u) == 0 || x + i >= grid.width) continue;
              const std::size_t pixel = grid.pixel(x + i, y, width);
              if (view_.now.points.triangles[pixel] != no_triangle)
                alone_[static_cast<std::size_t>(y)].push_back(pixel);
            }
          }
          const float* from = &joined_[k][static_cast<std::size_t>(layout.at(0, y))];
          for (int x = 0; x < grid.width; ++x) open_[grid.pixel(x, y, width)] = from[x];
        }
      });
}

void AoScenePeer::join(const float* half) {
  for (auto& row : alone_) row.clear();
  for (int number = 0; number < 3; ++number) {
    rest_[static_cast<std::size_t>(number)].take();
    join_class(number, half);
  }
  parallel::parallel_ranges(static_cast<std::size_t>(half_.grid.height), 32,
                            [&](std::size_t first, std::size_t last) {
                              for (auto y = static_cast<int>(first); y < static_cast<int>(last); ++y) {
                                const float* from = half + half_.planes.layout().at(0, y);
                                for (int x = 0; x < half_.grid.width; ++x)
                                  open_[half_.grid.pixel(x, y, view_.now.points.width)] = from[x];
                              }
                            });
  std::vector<std::size_t> pixels;
  for (const auto& row : alone_) pixels.insert(pixels.end(), row.begin(), row.end());
  tracer_->trace(pattern_->rays() < least_rays ? enough_ : *pattern_, pixels, open_.data());
}

double AoScenePeer::finish_ms(const PeerVariant& variant) {
  CostClock clock;
  Level& level = variant.step == 1 ? full_ : half_;
  if (variant.passes > 0 || variant.step == 2) level.planes.take();
  const float* filtered = filter(level, variant.passes);
  finished_ = variant.step == 1 ? filtered : nullptr;
  if (variant.step == 2) join(filtered);
  return clock.ms();
}

std::vector<float> AoScenePeer::picture() const {
  if (finished_ == nullptr) return open_;
  std::vector<float> open;
  open.reserve(open_.size());
  for (int y = 0; y < full_.grid.height; ++y) {
    const float* row = finished_ + full_.planes.layout().at(0, y);
    open.insert(open.end(), row, row + full_.grid.width);
  }
  for (std::size_t i = 0; i < open.size(); ++i)
    if (view_.now.points.triangles[i] == no_triangle) open[i] = 1;
  return open;
}

}  // namespace tenebra::bench
