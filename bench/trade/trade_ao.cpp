// The trade of ambient occlusion: errors asked for, rays, tables (positions x directions x bits), resolution,
// against Embree's rays with and without a filter.
#include <fmt/core.h>
#include <algorithm>
#include <array>
#include <cmath>

#include <tenebra/ambient_occlusion.h>
#include "bench/ao/ao_race.h"
#include "bench/ao/scenes/ao_scene_peer.h"
#include "bench/common/bench_scenes.h"
#include "bench/common/memory_meter.h"
#include "bench/trade/trade_contest.h"
#include "bench/trade/trade_crops.h"
#include "bench/trade/trade_session.h"
#include "support/seeded_random.h"

namespace tenebra::bench {
namespace {

/// What one setting is called and is.
struct AoSetting {
  std::string family, name;
  AoConfig config;
};

std::string table_name(const AoConfig& c) {
  return fmt::format("{}x{}, {} bit{}, {} rays", c.positions, c.directions, c.bits, c.bits == 1 ? "" : "s",
                     c.rays);
}

/// One view with all settings on it.
class AoTrade {
public:
  /// `tables`: tables of other sizes too.
  AoTrade(TradeSession& session, const AoSceneView& view, bool tables)
      : session_(session), view_(view), tables_(tables) {}
  Expected<TradeTable> run();

private:
  AoConfig config(AoMode mode, int rays) const;
  Expected<void> find_truth();
  Expected<std::vector<float>> by_many_rays(const std::vector<std::uint8_t>& kept) const;
  Expected<TradeCrops> crops(const std::vector<TradePoint>& points);
  void add_errors();
  void add_rays();
  void add_tables(FieldLayout layout, const char* family);
  Expected<double> compute(const AoConfig& config);
  Expected<std::vector<TradePoint>> measure(std::span<const AoSetting> same_tables);
  PeerVariant best_variant(AoScenePeer& peer, int rays, int step) const;
  Expected<std::vector<TradePoint>> measure_peer() const;
  std::vector<double> errors_of(std::span<const float> open) const;

  TradeSession& session_;
  const AoSceneView& view_;
  bool tables_;
  AmbientOcclusion ao_;
  std::vector<std::size_t> pixels_;  // where the truth is known
  std::vector<float> truth_, open_;
  std::vector<AoSetting> settings_;
};

AoConfig AoTrade::config(AoMode mode, int rays) const {
  AoConfig config{.mode = mode, .rays = rays, .distance_m = static_cast<double>(view_.reach_m)};
  if (session_.effort == Effort::tiny) config.positions = config.directions = 64;
  return config;
}

/// By many rays at one pixel in each square of 8 x 8, at a place of its own.
Expected<void> AoTrade::find_truth() {
  const int stride = session_.by_effort(4, 8, 8);
  const auto side = static_cast<std::uint32_t>(stride);
  const VisiblePoints& all = view_.now.points;
  std::vector<std::uint8_t> kept(all.triangles.size(), 0);
  testing::Random random(13);
  const auto width = static_cast<std::size_t>(all.width);
  for (int y = 0; y + stride <= all.height; y += stride) {
    for (int x = 0; x + stride <= all.width; x += stride) {
      const std::size_t i = (static_cast<std::size_t>(y) + random.index(side)) * width +
                            static_cast<std::size_t>(x) + random.index(side);
      if (all.triangles[i] == no_triangle) continue;
      kept[i] = 1;
      pixels_.push_back(i);
    }
  }
  const auto open = by_many_rays(kept);
  if (!open) return tl::unexpected(open.error());
  for (const std::size_t i : pixels_) truth_.push_back((*open)[i]);
  return {};
}

/// At the pixels that are kept; 1 elsewhere.
Expected<std::vector<float>> AoTrade::by_many_rays(const std::vector<std::uint8_t>& kept) const {
  VisiblePoints few = view_.now.points;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] == 0) few.triangles[i] = no_triangle;
  }
  AmbientOcclusion rays;
  std::vector<float> open;
  if (auto done = rays.compute(view_.scene, view_.now.geometry, few, view_.now.normals,
                               config(AoMode::rays, session_.by_effort(64, 1024, 4096)), open);
      !done)
    return tl::unexpected(done.error());
  return open;
}

/// Where the errors of the most inexact of them stand out, as far as the truth is known.
Expected<TradeCrops> AoTrade::crops(const std::vector<TradePoint>& points) {
  constexpr std::array families{"adaptive", "field", "field, half resolution"};
  std::vector<CropPicture> pictures;
  for (const TradePoint* chosen : crop_settings(points, families)) {
    const auto setting = std::find_if(settings_.begin(), settings_.end(), [&](const AoSetting& s) {
      return s.family == chosen->family && s.name == chosen->setting;
    });
    if (auto done = compute(setting->config); !done) return tl::unexpected(done.error());
    pictures.push_back({chosen, open_});
  }
  std::vector<float> errors(view_.now.pixel_count());
  for (std::size_t k = 0; k < pixels_.size() && !pictures.empty(); ++k)
    errors[pixels_[k]] = pictures.back().values[pixels_[k]] - truth_[k];
  const std::vector<float>& picture = pictures.empty() ? open_ : pictures.front().values;
  const CropPlace place = plainest_place(errors, picture, static_cast<std::size_t>(view_.now.points.width));
  std::vector<std::uint8_t> kept(errors.size(), 0);
  for (std::size_t y = 0; y < place.side; ++y)
    for (std::size_t x = 0; x < place.side; ++x) kept[place.pixel(x, y)] = 1;
  const auto exact = by_many_rays(kept);
  if (!exact) return tl::unexpected(exact.error());
  return make_crops(place, *exact, pictures);
}

std::vector<double> AoTrade::errors_of(std::span<const float> open) const {
  double sum = 0, worst = 0;
  for (std::size_t k = 0; k < pixels_.size(); ++k) {
    const double error = std::abs(static_cast<double>(open[pixels_[k]]) - static_cast<double>(truth_[k]));
    sum += error * error;
    worst = std::max(worst, error);
  }
  return {pixels_.empty() ? 0 : 255 * std::sqrt(sum / static_cast<double>(pixels_.size())), 255 * worst};
}

/// What the presets of --quality ask for.
void AoTrade::add_errors() {
  for (const double error : {8.0, 5.0, 2.5, 1.0}) {
    AoConfig c = config(AoMode::adaptive, 64);
    c.error_255 = error;
    settings_.push_back({"adaptive", fmt::format("error {}", error), c});
  }
}

/// How many rays, at full and half resolution.
void AoTrade::add_rays() {
  const auto counts = session_.by_effort<std::vector<int>>({16}, {8, 16, 64, 256}, {8, 16, 32, 64, 128, 256});
  for (const int downscale : {1, 2}) {
    for (const int rays : counts) {
      AoConfig c = config(AoMode::field, rays);
      c.downscale = downscale;
      settings_.push_back(
          {downscale == 1 ? "field" : "field, half resolution", fmt::format("{} rays", rays), c});
    }
  }
}

/// What the tables' size and the bits of a distance do; in a quick run one at a time.
void AoTrade::add_tables(FieldLayout layout, const char* family) {
  const bool all = session_.effort == Effort::full && tables_;
  for (const int positions : {289, 1089, 4225}) {
    for (const int directions : {256, 1024, 4096}) {
      for (const int bits : {1, 8, 32}) {
        for (const int rays : {16, 64, 256}) {
          const bool diagonal =
              layout == FieldLayout::chords && bits == 8 && (positions == 289) == (directions == 256);
          const bool usual = positions == 4225 && directions == 1024;
          if (!all && (rays != 64 || !(usual || diagonal))) continue;
          if (layout == FieldLayout::chords && usual && bits == 8) continue;  // the default
          AoConfig c = config(AoMode::field, rays);
          c.layout = layout, c.positions = positions, c.directions = directions, c.bits = bits;
          settings_.push_back({family, table_name(c), c});
        }
      }
    }
  }
}

/// Once; its time.
Expected<double> AoTrade::compute(const AoConfig& config) {
  const BenchFrame& frame = view_.now;
  CostClock clock;
  if (auto done = ao_.compute(view_.scene, frame.geometry, frame.points, frame.normals, config, open_); !done)
    return tl::unexpected(done.error());
  return clock.ms();
}

/// Settings that share tables, in turn; fields are built and samples cast before, which takes
/// the most memory.
Expected<std::vector<TradePoint>> AoTrade::measure(std::span<const AoSetting> same_tables) {
  ao_ = {}, open_ = std::vector<float>();
  const MemoryMeter meter;
  if (const auto built = compute(same_tables[0].config); !built) return tl::unexpected(built.error());
  std::vector<Contestant> contestants;
  for (const AoSetting& setting : same_tables) {
    contestants.push_back({setting.family, setting.name, [this, &setting] { return compute(setting.config); },
                           [this] { return errors_of(open_); }});
    contestants.back().made_mb = meter.mb();
  }
  return take_turns(contestants, session_.turns());
}

/// Of one to three passes of the filter (at half resolution none, too), those that err least.
PeerVariant AoTrade::best_variant(AoScenePeer& peer, int rays, int step) const {
  peer.trace_ms(rays, step);
  PeerVariant best;
  double least = 0;
  for (int passes = 2 - step; passes <= 3; ++passes) {
    peer.finish_ms({step, passes});
    const double rms = errors_of(peer.picture())[0];
    if (least == 0 || rms < least) least = rms, best = {step, passes};
  }
  return best;
}

/// What one would write instead: rays alone, filtered, and filtered at one of four pixels.
Expected<std::vector<TradePoint>> AoTrade::measure_peer() const {
  const MemoryMeter meter;
  AoScenePeer peer(view_);
  const double made_mb = meter.mb();
  std::vector<Contestant> contestants;
  for (const int rays : session_.by_effort<std::vector<int>>({4}, {1, 4, 16, 64, 256}, {1, 4, 16, 64, 256})) {
    const auto order = peer.faster_order(std::min(rays, 16));  // of many rays the same one
    const auto add = [&](const char* family, const PeerVariant& variant) {
      const auto run = [&peer, rays, variant, order]() -> Expected<double> {
        peer.set_order(order);
        return peer.follow_ms() + peer.trace_ms(rays, variant.step) + peer.finish_ms(variant);
      };
      contestants.push_back({family, fmt::format("{} ray{}", rays, rays == 1 ? "" : "s"), run,
                             [this, &peer] { return errors_of(peer.picture()); }});
      contestants.back().made_mb = made_mb;
    };
    add("Embree rays", {1, 0});
    if (rays > 64 && session_.effort != Effort::full) continue;  // the filter errs more than they do
    add("Embree rays, filtered", best_variant(peer, rays, 1));
    add("Embree rays, filtered, half resolution", best_variant(peer, rays, 2));
  }
  return take_turns(contestants, session_.turns());
}

bool same_tables(const AoConfig& a, const AoConfig& b) {
  return a.mode == b.mode && a.layout == b.layout && a.positions == b.positions &&
         a.directions == b.directions && a.bits == b.bits;
}

Expected<TradeTable> AoTrade::run() {
  if (auto found = find_truth(); !found) return tl::unexpected(found.error());
  add_errors();
  add_rays();
  if (session_.effort != Effort::tiny && tables_) {
    add_tables(FieldLayout::chords, "other tables");
    add_tables(FieldLayout::positions_directions, "tables of the paper");
  }
  TradeTable table{"ao", view_.name, {{"RMS", "1/255"}, {"worst pixel", "1/255"}}, {}};
  for (std::size_t first = 0, last = 0; first < settings_.size(); first = last) {
    while (last < settings_.size() && same_tables(settings_[first].config, settings_[last].config)) ++last;
    const auto points = measure(std::span(settings_).subspan(first, last - first));
    if (!points) return tl::unexpected(points.error());
    table.points.insert(table.points.end(), points->begin(), points->end());
  }
  auto crops = this->crops(table.points);
  if (!crops) return tl::unexpected(crops.error());
  table.crops = std::move(*crops);
  const auto peer = measure_peer();
  if (!peer) return tl::unexpected(peer.error());
  table.points.insert(table.points.end(), peer->begin(), peer->end());
  const auto hidden = std::count_if(truth_.begin(), truth_.end(), [](float open) { return open < 1; });
  table.remark = fmt::format("{}x{} pixels; of {} that were compared, ambient light is hidden in part at {}.",
                             view_.now.points.width, view_.now.points.height, pixels_.size(), hidden);
  return table;
}

void keep_ao_headline(TradeSession& session, const TradeTable& table) {
  if (const TradePoint* p = table.find("adaptive, error 2.5"))
    session.keep_largest("ao_default_rms_255", p->errors[0]);
  if (const TradePoint* p = table.find("adaptive, error 5"))
    session.keep_largest("ao_fast_rms_255", p->errors[0]);
}

Expected<void> try_view(TradeSession& session, const std::string& name) {
  const int size = session.by_effort(64, 512, 1024), walkers = session.by_effort(3, 50, 50);
  const auto view = load_ao_scene(name, size, walkers, session.options.data, session.notes);
  if (!view) return tl::unexpected(view.error());
  if (*view == nullptr) {
    session.notes.pop_back();
    session.skipped.push_back(skipped_sentence(name.substr(0, name.find(' '))));
    return {};
  }
  progress(name + ": ambient occlusion, what it costs");
  auto table = AoTrade(session, **view, name.starts_with("crowd")).run();
  if (!table) return tl::unexpected(table.error());
  keep_ao_headline(session, *table);
  session.finish(std::move(*table));
  return {};
}

}  // namespace

Expected<void> measure_trade_ao(TradeSession& session) {
  for (const char* name : {"crowd near", "crowd far", "robots 100", "city 150", "kitchen 100"}) {
    if (session.effort == Effort::quick && name == std::string("crowd far")) continue;
    if (auto done = try_view(session, name); !done) return done;
  }
  return {};
}

}  // namespace tenebra::bench
