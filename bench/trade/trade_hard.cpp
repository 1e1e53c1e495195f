// The trade of hard shadows: the default, the paper's variants, front-face culling, samples from the depth
// buffer, depth cubes and Embree's rays.
#include <fmt/format.h>

#include <functional>
#include <memory>

#include "bench/common/memory_meter.h"
#include "bench/hard/hard_embree.h"
#include "bench/trade/trade_contest.h"
#include "bench/trade/trade_session.h"
#include "bench/trade/trade_shadow_map.h"
#include "parallel/parallel.h"
#include "render/renderer.h"
#include "render/shadow_lights.h"

namespace tenebra::bench {
namespace {

/// One view with all settings on it.
class HardTrade {
public:
  HardTrade(TradeSession& session, TradeRaster& raster, const HardView& view)
      : session_(session), raster_(raster), view_(view) {}

  Expected<TradeTable> run();

private:
  Expected<void> see();
  void points_from_depth(VisiblePoints& out) const;
  void see_points(PointLayout layout = PointLayout::rows);
  void unpad();
  void add_tracers();
  Contestant& add(const std::string& family, const std::string& setting,
                  std::function<Expected<void>()> trace);
  void add_tracer(const std::string& family, const std::string& setting, HardShadowConfig config,
                  render::SampleSource samples = render::SampleSource::ids);
  Expected<void> add_shadow_maps();
  Expected<void> draw_map(int size, DepthMap& map);
  void add_shadow_map(DepthMap* map, ShadowMapBias bias, const std::string& setting);
  void add_embree();
  std::vector<double> errors() const;

  TradeSession& session_;
  TradeRaster& raster_;
  HardView view_;
  std::vector<float> depth_;
  VisiblePoints scratch_points_;
  std::vector<std::unique_ptr<ShadowTracer>> tracers_;
  std::vector<std::unique_ptr<DepthMap>> maps_;
  std::vector<std::unique_ptr<HardPeer>> peers_;
  ShadowMask padded_, mask_;
  PeerPoints peer_points_;
  std::vector<Contestant> contestants_;
  ShadowMask exact_;
  double rays_ = 0;
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
  // Neither the traversal nor the instructions of the default, which would be no judge of itself.
  const HardShadowConfig truth{.variant = Variant::precise_sorted, .simd = SimdLevel::scalar};
  ShadowTracer tracer;
  tracer.trace_shadow_mask(points, view_.frame.triangles(), view_.light, truth, exact_);
  rays_ = static_cast<double>(tracer.stats().rays);
  return {};
}

/// As the renderer does with SampleSource::depth.
void HardTrade::points_from_depth(VisiblePoints& out) const {
  const VisiblePoints& exact = view_.frame.points;
  out = {exact.width, exact.height, std::move(out.positions), exact.triangles};
  out.seen_from = exact.seen_from;
  out.positions.resize(exact.positions.size());
  const auto width = static_cast<std::size_t>(exact.width);
  parallel::parallel_ranges(out.positions.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (out.triangles[i] == no_triangle) continue;
      out.positions[i] =
          visibility::point_from_depth(view_.frame.view, raster_.transform(), static_cast<int>(i % width),
                                       static_cast<int>(i / width), depth_[i]);
    }
  });
}

/// Wrong pixels, and their share of those that have a ray, in percent.
std::vector<double> HardTrade::errors() const {
  const auto wrong = static_cast<double>(differing_pixels(mask_, exact_));
  return {wrong, rays_ > 0 ? 100 * wrong / rays_ : 0};
}

Contestant& HardTrade::add(const std::string& family, const std::string& setting,
                           std::function<Expected<void>()> trace) {
  contestants_.push_back({family, setting, clocked(std::move(trace)), [this] { return errors(); }});
  contestants_.back().forget = [this] { scratch_points_ = {}, mask_ = ShadowMask(), padded_ = ShadowMask(); };
  return contestants_.back();
}

void HardTrade::add_tracer(const std::string& family, const std::string& setting, HardShadowConfig config,
                           render::SampleSource samples) {
  ShadowTracer* tracer = tracers_.emplace_back(std::make_unique<ShadowTracer>()).get();
  const auto trace = [this, tracer, config, samples]() -> Expected<void> {
    if (samples == render::SampleSource::depth) {
      points_from_depth(scratch_points_);
    } else {  // as the renderer asks for them
      see_points(config.variant == Variant::tiles ? PointLayout::rows_and_tiles : PointLayout::rows);
    }
    tracer->trace_shadow_mask(scratch_points_, view_.frame.triangles(), view_.light, config, mask_);
    return {};
  };
  Contestant& added = add(family, setting, trace);
  if (config.variant != Variant::tiles) return;
  // An animation's tracer has met the frame before, and follows what moved; the others keep nothing.
  added.prepare = [this, tracer, config] {
    tracer->trace_shadow_mask(view_.frame.points, triangle_view(view_.before), view_.light, config, mask_);
  };
}

void HardTrade::see_points(PointLayout layout) {
  const VisiblePoints& points = view_.frame.points;
  compute_visible_points(points.triangles, points.width, points.height, view_.frame.view,
                         view_.frame.triangles(), scratch_points_, layout);
}

void HardTrade::add_tracers() {
  add_tracer("default (Tiles)", "", {});
  for (const Variant variant :
       {Variant::precise_sorted, Variant::spheres_sorted, Variant::precise_sea, Variant::precise_seatp,
        Variant::precise_eatp, Variant::precise, Variant::spheres})
    add_tracer("variants of the paper", std::string(variant_name(variant)), {.variant = variant});
  add_tracer("front faces culled", "exact samples", {.cull_front = true});
  add_tracer("samples from depth", "front faces culled", {.cull_front = true, .contact = ContactRule::none},
             render::SampleSource::depth);
  add_tracer("samples from depth", "all cast, no bias", {.contact = ContactRule::none},
             render::SampleSource::depth);
}

Expected<void> HardTrade::draw_map(int size, DepthMap& map) {
  const FrameGeometry& geometry = view_.frame.geometry;
  if (view_.light.directional) return raster_.draw_sun(geometry, view_.light.to_light, size, map);
  return raster_.draw_cube(geometry, view_.light.position, 1e-4f * view_.frame.diagonal_m, size, map);
}

Expected<void> HardTrade::add_shadow_maps() {
  std::vector<std::string> told;
  for (const int size :
       session_.by_effort<std::vector<int>>({64}, {512, 1024, 2048, 4096}, {512, 1024, 2048, 4096})) {
    DepthMap* map = maps_.emplace_back(std::make_unique<DepthMap>()).get();
    if (auto drawn = draw_map(size, *map); !drawn) return drawn;
    const ShadowMapBias tuned = best_bias(*map, view_, exact_);
    told.push_back(fmt::format("{} at {}", short_number(tuned.texels), size));
    session_.report.add({"trade hard", view_.name, "shadow map", fmt::format("{}", size), "best bias",
                         tuned.texels, "texels"});
    add_shadow_map(map, tuned, fmt::format("{}", size));
    if (size == 4096) add_shadow_map(map, {}, fmt::format("{}, no bias", size));
  }
  remark_ = fmt::format("best bias of the shadow maps, in texels: {}.", fmt::join(told, ", "));
  return {};
}

void HardTrade::add_shadow_map(DepthMap* map, ShadowMapBias bias, const std::string& setting) {
  const auto trace = [this, map, size = map->size, bias]() -> Expected<void> {
    see_points();
    auto drawn = draw_map(size, *map);
    if (drawn) shadow_from_map(*map, view_, bias, mask_);
    return drawn;
  };
  add("shadow map", setting, trace).forget = [this, map] {
    scratch_points_ = {}, mask_ = ShadowMask();
    *map = {};
  };
}

/// Built anew as a moving scene needs it, or traced alone in the better tree of one that stands.
void HardTrade::add_embree() {
  peer_points_ = peer_points(view_);
  for (const bool moving : {true, false}) {
    const MemoryMeter meter;
    HardPeer* peer = peers_
                         .emplace_back(std::make_unique<HardPeer>(
                             view_.frame.triangles(),
                             moving ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM, thread_count()))
                         .get();
    const auto trace = [this, peer, moving]() -> Expected<void> {
      if (moving) peer->build();
      see_points();
      peer->trace(peer_points_, view_.light, PacketTile::square, padded_);
      return {};
    };
    Contestant& added = add("Embree", moving ? "built and traced" : "traced alone", trace);
    added.made_mb = meter.mb();
    added.errors = [this] {
      unpad();
      return errors();
    };
  }
}

/// Embree's mask without the pixels that fill its packets.
void HardTrade::unpad() {
  const auto width = static_cast<std::size_t>(view_.frame.points.width);
  mask_.resize(view_.frame.pixel_count());
  for (std::size_t i = 0; i < mask_.size(); ++i)
    mask_[i] = padded_[i / width * static_cast<std::size_t>(peer_points_.width) + i % width];
}

Expected<TradeTable> HardTrade::run() {
  if (auto seen = see(); !seen) return tl::unexpected(seen.error());
  add_tracers();
  if (auto added = add_shadow_maps(); !added) return tl::unexpected(added.error());
  add_embree();
  auto points = take_turns(contestants_, session_.turns());
  if (!points) return tl::unexpected(points.error());
  TradeTable table{
      "hard", view_.name, {{"wrong pixels", ""}, {"of those with a ray", "%"}}, std::move(*points)};
  table.remark = remark_;
  return table;
}

void keep_hard_headline(TradeSession& session, const TradeTable& table) {
  session.keep_largest("hard_default_wrong_pixels", table.find("default (Tiles)")->errors[0]);
  for (const TradePoint& p : table.points) {
    if (p.family == "variants of the paper") session.keep_largest("hard_variants_wrong_pixels", p.errors[0]);
  }
  if (const TradePoint* map = table.find("shadow map, 4096"))
    session.keep_largest("hard_shadow_map_4096_wrong_pixels", map->errors[0]);
}

/// The same view with the first directional light of the scene; none if it has none.
std::optional<HardView> under_the_sun(const Scene& scene, const HardView& view) {
  for (const WorldLight& placed : view.frame.lights) {
    const ShadowLight light =
        render::shadow_light(scene.lights[static_cast<std::size_t>(placed.light)], placed);
    if (!light.directional) continue;
    HardView sunny = view;
    sunny.name += ", sun";
    sunny.light = light;
    return sunny;
  }
  return std::nullopt;
}

Expected<void> try_view(TradeSession& session, TradeRaster& raster, const HardView& view) {
  progress(view.name + ": hard shadows, what they cost");
  auto table = HardTrade(session, raster, view).run();
  if (!table) return tl::unexpected(table.error());
  keep_hard_headline(session, *table);
  session.finish(std::move(*table));
  return {};
}

}  // namespace

Expected<void> measure_trade_hard(TradeSession& session) {
  auto raster = TradeRaster::create();
  if (!raster) return tl::unexpected(raster.error());
  std::vector<HardFrames> frames{{"robots", {100}},  {"museum5", {20}}, {"museum5x64", {20}},
                                 {"kitchen", {100}}, {"city", {150}},   {"court", {60}}};
  if (session.effort == Effort::full) frames.push_back({"gallery", {100}});
  const PictureSize size = session.by_effort<PictureSize>({64, 64}, {}, {});
  return for_each_view(session.options, frames, size, session.skipped,
                       [&](const Scene& scene, const HardView& view) -> Expected<void> {
                         if (auto done = try_view(session, *raster, view); !done) return done;
                         const auto sunny = under_the_sun(scene, view);
                         return sunny ? try_view(session, *raster, *sunny) : Expected<void>();
                       });
}

}  // namespace tenebra::bench
