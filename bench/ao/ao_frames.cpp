// Whole frames of ambient occlusion: a crowd of moving objects, fields against Embree at equal error, at full
// and at half resolution, on one thread and on all.
#include <fmt/core.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <tenebra/ambient_occlusion.h>
#include "bench/ao/ao_crowd.h"
#include "bench/ao/ao_frame_peer.h"
#include "bench/ao/ao_race.h"
#include "bench/ao/ao_session.h"
#include "bench/common/bench_plot.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

constexpr float reach_m = 1.0f;  // about the objects' radius
constexpr double instant_s = 3.7;
constexpr std::array mode_names{"single rays", "packets"};

/// A field setting and the Embree that equals it; times by slot: one thread, all threads.
struct Pairing {
  int rays;
  int downscale;
  double rms = 0;
  double ms[2] = {0, 0};
  int embree_downscale = 1;  ///< 1 too where Embree at half resolution cannot be as exact
  double embree_rays = 0;    ///< at equal error
  double embree_ms[2] = {0, 0};
  int embree_mode[2] = {0, 0};  ///< the faster: index into mode_names
};

/// Embree's error at one count of rays.
struct PeerError {
  int rays;
  double rms;
};

/// Embree's time for a frame: linear in the rays, from two counts.
struct PeerCost {
  double few_ms = 0, many_ms = 0;
  static constexpr int few = 16, many = 64;
  double at(double rays) const { return few_ms + (many_ms - few_ms) * (rays - few) / (many - few); }
};

/// One view with all that is measured in it.
class ViewBench {
public:
  ViewBench(AoSession& session, const CrowdView& view, const std::vector<Object>& meshes);
  Expected<void> run();

private:
  AoConfig config(const Pairing& pairing) const {
    AoConfig config = session_.field_config(pairing.rays, reach_m);
    config.downscale = pairing.downscale;
    return config;
  }
  Expected<void> find_errors();
  Expected<void> measure_times(int slot);
  Expected<double> field_ms(const Pairing& pairing);
  void match(Pairing& pairing) const;
  void tell();

  AoSession& session_;
  const CrowdView& view_;
  Scene scene_;
  BenchFrame frame_;
  std::unique_ptr<FramePeer> peer_;
  SampledTruth truth_;
  AmbientOcclusion ao_;
  double build_ms_ = 0;
  std::uint64_t field_bytes_ = 0;
  std::vector<Pairing> pairings_{{16, 1}, {64, 1}, {16, 2}, {64, 2}};
  std::vector<PeerError> errors_[2];  // by downscale - 1
};

ViewBench::ViewBench(AoSession& session, const CrowdView& view, const std::vector<Object>& meshes)
    : session_(session),
      view_(view),
      scene_(make_crowd(meshes, session.by_effort(3, 50, 50), view.spacing_m)) {
  const int size = session.by_effort(64, 1024, 1024);
  see_crowd(scene_, view, instant_s, size, frame_);
  peer_ = std::make_unique<FramePeer>(scene_, frame_, reach_m);
  truth_ = peer_->truth(session.by_effort(64, 1024, 4096), session.by_effort(4, 8, 8));
}

/// Of the fields and of Embree, over its counts of rays. Builds the fields.
Expected<void> ViewBench::find_errors() {
  std::vector<float> values;
  for (Pairing& pairing : pairings_) {
    if (auto done =
            ao_.compute(scene_, frame_.geometry, frame_.points, frame_.normals, config(pairing), values);
        !done) {
      return done;
    }
    build_ms_ += ao_.timings().ao_build_ms;
    field_bytes_ = std::max(field_bytes_, ao_.stats().field_bytes);
    pairing.rms = truth_.rms_255(values);
    const auto bad = std::count_if(values.begin(), values.end(), [](float v) { return !(v >= 0 && v <= 1); });
    if (bad != 0) session_.notes.push_back(fmt::format("{}: {} values are not within 0..1", view_.name, bad));
  }
  for (const int rays : {16, 32, 64, 128, 256, 512})
    errors_[0].push_back({rays, truth_.rms_255(peer_->at(truth_.pixels, rays))});
  for (const int rays : {16, 32, 64}) {
    if (rays == 32 && session_.effort == Effort::quick) continue;
    errors_[1].push_back({rays, truth_.rms_255(peer_->frame(rays, 2))});
  }
  for (Pairing& pairing : pairings_) match(pairing);
  return {};
}

/// Embree's rays for the field's error: on a straight line in logarithms between two measured counts, or
/// beyond them; at least one. More rays do not mend what half resolution blurs: where the most of them leave
/// a larger error than the field's, Embree has to trace at full resolution.
void ViewBench::match(Pairing& pairing) const {
  const bool half = pairing.downscale == 2 && errors_[1].back().rms <= pairing.rms;
  pairing.embree_downscale = half ? 2 : 1;
  const std::vector<PeerError>& e = errors_[pairing.embree_downscale - 1];
  std::size_t i = 1;
  while (i + 1 < e.size() && e[i].rms > pairing.rms) ++i;
  pairing.embree_rays = e.back().rays;
  if (!(pairing.rms > 0 && e[i].rms > 0 && e[i - 1].rms > e[i].rms)) return;  // nothing in view to differ by
  const double slope = std::log(e[i].rms / e[i - 1].rms) / std::log(double(e[i].rays) / e[i - 1].rays);
  pairing.embree_rays = std::max(1.0, e[i].rays * std::pow(pairing.rms / e[i].rms, 1 / slope));
}

Expected<double> ViewBench::field_ms(const Pairing& pairing) {
  std::vector<float> values;
  CostClock clock;
  if (auto done =
          ao_.compute(scene_, frame_.geometry, frame_.points, frame_.normals, config(pairing), values);
      !done) {
    return tl::unexpected(done.error());
  }
  return clock.ms();
}

/// All contestants in turn, round by round.
Expected<void> ViewBench::measure_times(int slot) {
  const int rounds = session_.by_effort(1, 3, 5), part = session_.by_effort(1, 16, 4);
  std::vector<std::vector<double>> field(pairings_.size()), peer(8);
  std::vector<double> spread;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < pairings_.size(); ++i) {
      const auto ms = field_ms(pairings_[i]);
      if (!ms) return tl::unexpected(ms.error());
      field[i].push_back(*ms);
      // One Embree setting after each of the field's, two modes each: counts and resolutions in turn.
      const int rays = i % 2 == 0 ? PeerCost::few : PeerCost::many, downscale = i < 2 ? 1 : 2;
      for (const PeerMode mode : {PeerMode::single_rays, PeerMode::packets})
        peer[2 * i + (mode == PeerMode::packets)].push_back(peer_->trace_ms(rays, downscale, mode, part));
    }
    spread.push_back(peer_->spread_ms());
  }
  for (std::size_t i = 0; i < pairings_.size(); ++i) {
    Pairing& pairing = pairings_[i];
    pairing.ms[slot] = median(field[i]);
    const std::size_t first = pairing.embree_downscale == 1 ? 0 : 4;
    const double extra = pairing.embree_downscale == 1 ? 0 : median(spread);
    for (const std::size_t mode : {0u, 1u}) {
      const PeerCost cost{median(peer[first + mode]), median(peer[first + 2 + mode])};
      const double ms = extra + std::max(0.0, cost.at(pairing.embree_rays));
      if (mode == 1 && ms >= pairing.embree_ms[slot]) continue;
      pairing.embree_ms[slot] = ms;
      pairing.embree_mode[slot] = static_cast<int>(mode);
    }
  }
  return {};
}

void ViewBench::tell() {
  std::vector<std::vector<std::string>> rows{{"resolution", "threads", "field rays", "RMS", "field ms",
                                              "embree", "embree rays", "embree ms", "by", "faster x"}};
  const int all = thread_count();
  for (const Pairing& p : pairings_) {
    for (int slot = 0; slot < (all == 1 ? 1 : 2); ++slot) {
      const double faster = p.embree_ms[slot] / p.ms[slot];
      const char* resolution = p.downscale == 1 ? "full" : "half";
      const int threads = slot == 0 ? 1 : all;
      rows.push_back(
          {resolution, fmt::format("{}", threads), fmt::format("{}", p.rays), fmt::format("{:.2f}", p.rms),
           fmt::format("{:.1f}", p.ms[slot]), p.embree_downscale == 1 ? "full" : "half",
           fmt::format("{:.1f}", p.embree_rays), fmt::format("{:.0f}", p.embree_ms[slot]),
           mode_names[static_cast<std::size_t>(p.embree_mode[slot])], fmt::format("{:.1f}", faster)});
      const std::string parameter =
          fmt::format("{} resolution, rays={}, threads={}", resolution, p.rays, threads);
      session_.report.add({"frames", view_.name, "field", parameter, "rms", p.rms, "1/255"});
      session_.report.add({"frames", view_.name, "field", parameter, "time", p.ms[slot], "ms"});
      session_.report.add(
          {"frames", view_.name, "embree", parameter, "rays at equal rms", p.embree_rays, ""});
      session_.report.add(
          {"frames", view_.name, "embree", parameter, "time at equal rms", p.embree_ms[slot], "ms"});
      session_.report.add({"frames", view_.name, "field", parameter, "speedup", faster, ""});
      keep_least(p.downscale == 1 ? session_.headline.frame_speedup : session_.headline.frame_speedup_half,
                 faster);
    }
  }
  for (const int downscale : {1, 2}) {
    for (const PeerError& e : errors_[downscale - 1]) {
      session_.report.add({"frames", view_.name, "embree",
                           fmt::format("downscale={}, rays={}", downscale, e.rays), "rms", e.rms, "1/255"});
    }
  }
  const std::size_t triangles = frame_.geometry.triangles.size();
  print_table(
      fmt::format("Whole frames, {}: {}x{}, {} objects, {} triangles, reach {} m; built once: fields {:.1f} s"
                  " ({:.1f} MB), Embree {:.1f} s",
                  view_.name, frame_.points.width, frame_.points.height, scene_.nodes.size() - 1, triangles,
                  reach_m, build_ms_ / 1e3, static_cast<double>(field_bytes_) / 1e6, peer_->build_ms() / 1e3),
      rows);
  std::vector<std::string> settings;
  Bars field{"field", {}}, embree{"embree", {}};
  for (const Pairing& p : pairings_) {
    settings.push_back(fmt::format("{}, RMS {:.1f}", p.downscale == 1 ? "full" : "half", p.rms));
    field.values.push_back(p.ms[0]);
    embree.values.push_back(p.embree_ms[0]);
  }
  session_.report.add_plot(view_.plot,
                           bar_plot(fmt::format("A frame at equal error, one thread, {}", view_.name),
                                    {"time (ms)", true}, settings, {field, embree}));
  session_.report.add({"frames", view_.name, "field", "", "build", build_ms_, "ms"});
  session_.report.add({"frames", view_.name, "embree", "", "build", peer_->build_ms(), "ms"});
}

Expected<void> ViewBench::run() {
  if (auto done = find_errors(); !done) return done;
  const int all = thread_count();
  Expected<void> done;
  with_threads(1, [&] { done = measure_times(0); });
  if (done && all > 1) done = measure_times(1);
  if (done) tell();
  return done;
}

}  // namespace

Expected<void> measure_frames(AoSession& session) {
  auto meshes = crowd_objects(session.options.data, session.notes);
  if (session.effort == Effort::tiny) meshes.resize(1);
  for (const CrowdView& view : {far_view, near_view}) {
    progress(fmt::format("frames: {}", view.name));
    ViewBench bench(session, view, meshes);
    if (auto done = bench.run(); !done) return done;
  }
  return {};
}

}  // namespace tenebra::bench
