#include "bench/ao/scenes/ao_scene_contest.h"

#include <algorithm>

#include "bench/common/bench_report.h"

namespace tenebra::bench {
namespace {

constexpr int ray_counts[] = {1, 2, 4, 8, 16, 64, 256, 1024};
constexpr int quick_rays = 16;    // timed in every round
constexpr int ordered_rays = 64;  // beyond, the order of packets is that of fewer

}  // namespace

AoSceneContest::AoSceneContest(const AoSceneView& view, const AoSceneTruth& truth)
    : truth_(truth), peer_(view) {}

void AoSceneContest::measure(Count& count, int step, bool errors) {
  peer_.set_order(count.order);
  count.trace_ms[step - 1].push_back(peer_.trace_ms(count.rays, step));
  for (std::size_t v = 0; v < peer_variants.size(); ++v) {
    if (peer_variants[v].step != step) continue;
    count.variants[v].finish_ms.push_back(peer_.finish_ms(peer_variants[v]));
    if (errors) count.variants[v].rms = scene_errors(peer_.picture(), truth_).rms;
  }
}

void AoSceneContest::find_errors(std::span<const double> rms, int most_rays) {
  follow_ms_.push_back(peer_.follow_ms());
  int enough = 0;  // rays that reach all errors
  for (const int rays : ray_counts) {
    if (rays > most_rays || (enough != 0 && rays > 4 * enough)) break;
    Count count{.rays = rays};
    count.order = rays <= ordered_rays ? peer_.faster_order(rays) : counts_.back().order;
    count.variants.resize(peer_variants.size());
    if (enough == 0) measure(count, 1, true);
    measure(count, 2, true);
    counts_.push_back(std::move(count));
    const auto known = curves();
    const bool all = std::all_of(rms.begin(), rms.end(), [&](double error) { return reaches(known, error); });
    if (all && enough == 0) enough = rays;
  }
}

void AoSceneContest::run_round() {
  follow_ms_.push_back(peer_.follow_ms());
  for (Count& count : counts_) {
    for (const int step : {1, 2}) {
      if (count.rays <= quick_rays && !count.trace_ms[step - 1].empty()) measure(count, step, false);
    }
  }
}

std::vector<CostCurve> AoSceneContest::curves() const {
  std::vector<CostCurve> curves;
  const double follow = median(follow_ms_);
  for (std::size_t v = 0; v < peer_variants.size(); ++v) {
    CostCurve curve{peer_variant_name(peer_variants[v]), peer_variants[v].converges(), {}};
    for (const Count& count : counts_) {
      const Measured& measured = count.variants[v];
      if (measured.finish_ms.empty()) continue;
      const double trace = median(count.trace_ms[peer_variants[v].step - 1]);
      curve.costs.push_back({count.rays, measured.rms, follow + trace + median(measured.finish_ms)});
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace tenebra::bench
