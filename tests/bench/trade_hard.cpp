// The trade of hard shadows: the default, the paper's variants, front-face culling, samples from the depth
// buffer, depth cubes and Embree's rays.
#include <array>
#include <cmath>
#include <memory>

#include "ao_race.h"
#include "hard_embree.h"
#include "parallel/parallel.h"
#include "trade_session.h"
#include "trade_shadow_map.h"

namespace tenebra::bench {
namespace {

/// One setting: a name, what makes its mask, and what was found.
struct Contestant {
  std::string family, setting;
  std::function<Expected<void>(ShadowMask&)> trace;
  int rounds = 1;
  std::function<void()> prepare{};            // before each run, not timed
  std::function<void(ShadowMask&)> finish{};  // after it, not timed
  std::vector<double> ms{};
  double wrong = 0;
};

/// One view with all settings on it.
class HardTrade {
public:
  HardTrade(TradeSession& session, TradeRaster& raster, const HardView& view)
      : session_(session), raster_(raster), view_(view) {}

  Expected<TradeTable> run();

private:
  Expected<void> see();
  void points_from_depth(VisiblePoints& out) const;
  void add_tracers();
  void add_tracer(const std::string& family, const std::string& setting, HardShadowConfig config, int rounds);
  void add_depth_samples();
  Expected<void> add_shadow_maps();
  void add_shadow_map(CubeMap* map, float near_m, ShadowMapBias bias, const std::string& setting);
  void add_embree();
  Expected<void> measure();

  TradeSession& session_;
  TradeRaster& raster_;
  HardView view_;
  std::vector<float> depth_;
  VisiblePoints scratch_points_;
  std::vector<std::unique_ptr<ShadowTracer>> tracers_;
  std::vector<std::unique_ptr<CubeMap>> maps_;
  std::vector<std::unique_ptr<HardPeer>> peers_;
  ShadowMask padded_;
  PeerPoints peer_points_;
  std::vector<Contestant> contestants_;
  ShadowMask exact_;
  std::string remark_;
};

/// What the rasteriser sees takes the place of Embree's ids, so that depth and ids belong together.
Expected<void> HardTrade::see() {
  VisiblePoints& points = view_.frame.points;
  std::vector<std::uint32_t> ids;
  if (auto drawn =
          raster_.draw(view_.frame.geometry, view_.frame.view, points.width, points.height, ids, depth_);
      !drawn)
    return drawn;
  compute_visible_points(ids, points.width, points.height, view_.frame.view, view_.frame.triangles(), points);
  ShadowTracer tracer;
  tracer.trace_shadow_mask(points, view_.frame.view, view_.frame.triangles(), view_.light, {}, exact_);
  return {};
}

/// As the renderer does with SampleSource::depth.
void HardTrade::points_from_depth(VisiblePoints& out) const {
  const VisiblePoints& exact = view_.frame.points;
  out = {exact.width, exact.height, std::move(out.positions), exact.triangles};
  out.positions.resize(exact.positions.size());
  const auto width = static_cast<std::size_t>(exact.width);
  parallel_ranges(out.positions.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (out.triangles[i] == no_triangle) continue;
      out.positions[i] = point_from_depth(view_.frame.view, raster_.transform(), static_cast<int>(i % width),
                                          static_cast<int>(i / width), depth_[i]);
    }
  });
}

void HardTrade::add_tracer(const std::string& family, const std::string& setting, HardShadowConfig config,
                           int rounds) {
  ShadowTracer* tracer = tracers_.emplace_back(std::make_unique<ShadowTracer>()).get();
  contestants_.push_back({family, setting,
                          [this, tracer, config](ShadowMask& mask) -> Expected<void> {
                            compute_visible_points(view_.frame.points.triangles, view_.frame.points.width,
                                                   view_.frame.points.height, view_.frame.view,
                                                   view_.frame.triangles(), scratch_points_);
                            tracer->trace_shadow_mask(scratch_points_, view_.frame.view,
                                                      view_.frame.triangles(), view_.light, config, mask);
                            return {};
                          },
                          rounds});
}

void HardTrade::add_tracers() {
  const int many = session_.by_effort(1, 5, 15), few = session_.by_effort(1, 1, 3);
  add_tracer("default (Tiles)", "", {}, many);
  // An animation's tracer has met the frame before, and follows what moved.
  contestants_.back().prepare = [this, tracer = tracers_.back().get()] {
    ShadowMask unused;
    tracer->trace_shadow_mask(view_.frame.points, view_.frame.view, triangle_view(view_.before), view_.light,
                              {}, unused);
  };
  for (const Variant variant :
       {Variant::precise_sorted, Variant::spheres_sorted, Variant::precise_sea, Variant::precise_seatp,
        Variant::precise_eatp, Variant::precise, Variant::spheres}) {
    const std::string name(variant_name(variant));
    const bool sorted = name.find("Sorted") != std::string::npos || name.find("SE") != std::string::npos;
    add_tracer("variants of the paper", name, {.variant = variant}, sorted ? many : few);
  }
  add_tracer("front faces culled", "exact samples", {.cull_front = true}, many);
}

void HardTrade::add_depth_samples() {
  for (const bool cull : {true, false}) {
    ShadowTracer* tracer = tracers_.emplace_back(std::make_unique<ShadowTracer>()).get();
    const HardShadowConfig config{.cull_front = cull, .contact = ContactRule::none};
    contestants_.push_back({"samples from depth", cull ? "front faces culled" : "all cast, no bias",
                            [this, tracer, config](ShadowMask& mask) -> Expected<void> {
                              points_from_depth(scratch_points_);
                              tracer->trace_shadow_mask(scratch_points_, view_.frame.view,
                                                        view_.frame.triangles(), view_.light, config, mask);
                              return {};
                            },
                            session_.by_effort(1, 5, 15)});
  }
}

Expected<void> HardTrade::add_shadow_maps() {
  const float near_m = 1e-4f * view_.frame.diagonal_m;
  std::vector<std::string> told;
  for (const int size :
       session_.by_effort<std::vector<int>>({64}, {512, 1024, 2048, 4096}, {512, 1024, 2048, 4096})) {
    CubeMap* map = maps_.emplace_back(std::make_unique<CubeMap>()).get();
    if (auto drawn = raster_.draw_cube(view_.frame.geometry, view_.light.position, near_m, size, *map);
        !drawn)
      return drawn;
    const ShadowMapBias tuned = best_bias(*map, view_, exact_);
    told.push_back(fmt::format("{} at {}", short_number(tuned.texels), size));
    session_.report.add({"trade hard", view_.name, "shadow map", fmt::format("{}", size), "best bias",
                         tuned.texels, "texels"});
    add_shadow_map(map, near_m, tuned, fmt::format("{}", size));
    if (size == 4096) add_shadow_map(map, near_m, {}, fmt::format("{}, no bias", size));
  }
  remark_ = fmt::format("best bias of the shadow maps, in texels: {}.", fmt::join(told, ", "));
  return {};
}

void HardTrade::add_shadow_map(CubeMap* map, float near_m, ShadowMapBias bias, const std::string& setting) {
  contestants_.push_back({"shadow map", setting,
                          [this, map, size = map->size, near_m, bias](ShadowMask& mask) -> Expected<void> {
                            auto drawn = raster_.draw_cube(view_.frame.geometry, view_.light.position, near_m,
                                                           size, *map);
                            if (drawn) shadow_from_map(*map, view_, bias, mask);
                            return drawn;
                          },
                          session_.by_effort(1, 1, 3)});
}

/// Built anew as a moving scene needs it, or traced alone in the better tree of one that stands.
void HardTrade::add_embree() {
  peer_points_ = peer_points(view_);
  for (const bool moving : {true, false}) {
    HardPeer* peer = peers_
                         .emplace_back(std::make_unique<HardPeer>(
                             view_.frame.triangles(),
                             moving ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM, thread_count()))
                         .get();
    const auto trace = [this, peer, moving](ShadowMask&) -> Expected<void> {
      if (moving) peer->build();
      compute_visible_points(view_.frame.points.triangles, view_.frame.points.width,
                             view_.frame.points.height, view_.frame.view, view_.frame.triangles(),
                             scratch_points_);
      peer->trace(peer_points_, view_.light, PacketTile::square, padded_);
      return {};
    };
    const auto unpad = [this](ShadowMask& mask) {
      const auto width = static_cast<std::size_t>(view_.frame.points.width);
      mask.resize(view_.frame.pixel_count());
      for (std::size_t i = 0; i < mask.size(); ++i)
        mask[i] = padded_[i / width * static_cast<std::size_t>(peer_points_.width) + i % width];
    };
    contestants_.push_back({"Embree",
                            moving ? "built and traced" : "traced alone",
                            trace,
                            session_.by_effort(1, 5, 15),
                            {},
                            unpad});
  }
}

/// All in turn, round by round.
Expected<void> HardTrade::measure() {
  ShadowMask mask;
  int rounds = 0;
  for (const Contestant& c : contestants_) rounds = std::max(rounds, c.rounds);
  for (int round = 0; round < rounds; ++round) {
    for (Contestant& c : contestants_) {
      if (round >= c.rounds) continue;
      if (c.prepare) c.prepare();
      CostClock clock;
      if (auto done = c.trace(mask); !done) return done;
      c.ms.push_back(clock.ms());
      if (c.finish) c.finish(mask);
      c.wrong = std::max(c.wrong, static_cast<double>(differing_pixels(mask, exact_)));
    }
  }
  return {};
}

Expected<TradeTable> HardTrade::run() {
  if (auto seen = see(); !seen) return tl::unexpected(seen.error());
  add_tracers();
  add_depth_samples();
  if (auto added = add_shadow_maps(); !added) return tl::unexpected(added.error());
  add_embree();
  if (auto done = measure(); !done) return tl::unexpected(done.error());
  TradeTable table{"hard", view_.name, {{"wrong pixels", ""}, {"of those with a ray", "%"}}, {}};
  table.remark = remark_;
  const auto rays = static_cast<double>(tracers_.front()->stats().rays);
  for (const Contestant& c : contestants_)
    table.points.push_back(
        {c.family, c.setting, median(c.ms), {c.wrong, rays > 0 ? 100 * c.wrong / rays : 0}});
  return table;
}

void keep_headline(TradeSession& session, const TradeTable& table) {
  session.keep_largest("hard_default_wrong_pixels", table.find("default (Tiles)")->errors[0]);
  for (const TradePoint& p : table.points) {
    if (p.family == "variants of the paper") session.keep_largest("hard_variants_wrong_pixels", p.errors[0]);
  }
  if (const TradePoint* map = table.find("shadow map, 4096"))
    session.keep_largest("hard_shadow_map_4096_wrong_pixels", map->errors[0]);
}

}  // namespace

Expected<void> measure_trade_hard(TradeSession& session) {
  auto raster = TradeRaster::create();
  if (!raster) return tl::unexpected(raster.error());
  const std::vector<HardFrames> frames =
      session.effort == Effort::full
          ? std::vector<HardFrames>{{"robots", {100}},  {"museum5", {20}}, {"museum5x64", {20}},
                                    {"kitchen", {100}}, {"city", {150}},   {"gallery", {100}},
                                    {"court", {60}}}
          : std::vector<HardFrames>{
                {"robots", {100}}, {"museum5", {20}}, {"kitchen", {100}}, {"city", {150}}, {"court", {60}}};
  const PictureSize size = session.by_effort<PictureSize>({64, 64}, {}, {});
  return for_each_view(session.options, frames, size, session.skipped,
                       [&](const Scene&, const HardView& view) -> Expected<void> {
                         progress(view.name + ": hard shadows, what they cost");
                         auto table = HardTrade(session, *raster, view).run();
                         if (!table) return tl::unexpected(table.error());
                         keep_headline(session, *table);
                         session.finish(std::move(*table));
                         return {};
                       });
}

}  // namespace tenebra::bench
