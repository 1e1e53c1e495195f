#include "ao/adaptive/adaptive_pass.h"

#include <algorithm>
#include <cmath>

#include "ao/adaptive/audit.h"
#include "ao/adaptive/lattice_filter.h"
#include "ao/adaptive/pixel_looks.h"
#include "base/fail.h"
#include "parallel/parallel.h"

namespace tenebra::ao {

struct AdaptiveOcclusion::State {
  KeptRaySets sets;
  PixelSurfaces surfaces;
  LookRoom looks;
  AuditRoom audit;
  std::vector<Settled> settled;
  PixelValues pixels;
  std::vector<float> smooth, nearness, spread;
  std::vector<float> mean_of;  ///< weight of all that went into smooth

  void begin(const AdaptiveScene& scene) {
    find_surfaces(scene.frame, scene.reach, surfaces);
    const std::size_t count = surfaces.pixels.size();
    settled.assign(count, Settled::none);
    for (auto* ones : {&pixels.open, &pixels.weight, &smooth, &nearness, &mean_of}) ones->assign(count, 1.0f);
    spread.assign(count, 0.0f);
  }
};

namespace {

/// The noise of a lattice of rays over that of as many independent ones, roughly, where edges cross it.
constexpr float lattice_noise = 0.4f;

class AdaptivePass {
public:
  /// `state`: begun.
  AdaptivePass(const AdaptiveScene& scene, const AdaptiveSettings& settings, const StopFlag* stop,
               AdaptiveOcclusion::State& state)
      : settings_(settings),
        state_(state),
        surfaces_(state.surfaces),
        looks_(scene, surfaces_, stop, state.looks),
        stop_(stop),
        settled_(state.settled),
        pixels_(state.pixels),
        smooth_(state.smooth),
        nearness_(state.nearness),
        spread_(state.spread),
        mean_of_(state.mean_of) {}

  void settle();
  double meet_error();
  bool stopped() const { return stop_requested(stop_); }
  std::span<const float> values() const { return smooth_; }
  const PixelLooks& looks() const { return looks_; }

private:
  void settle(int step);
  void smooth(int step);
  void look_again(float noise, int round);
  bool speak_for(const Said& said) const;
  float noise() const { return trust_ * lattice_noise / std::sqrt(static_cast<float>(settings_.rays)); }

  AdaptiveSettings settings_;
  float trust_ = 0.3f;  ///< in neighbours: those that differ by less than four times noise() are evened out
  AdaptiveOcclusion::State& state_;
  const PixelSurfaces& surfaces_;
  PixelLooks looks_;
  const StopFlag* stop_;
  std::span<Settled> settled_;
  PixelValues& pixels_;
  std::span<float> smooth_, nearness_, spread_, mean_of_;
};

bool AdaptivePass::speak_for(const Said& said) const {
  constexpr float enough = 0.75f;
  return said.share >= enough && said.most - said.least <= settings_.difference &&
         said.farthest <= settings_.closeness * said.nearness;
}

/// Settles the pixels of the lattice of `step` that no wider one has, unless they are settled by rays
/// already.
void AdaptivePass::settle(int step) {
  const RaySets& sets = state_.sets.at(settings_.rays);
  const bool first = step == settings_.coarsest;
  looks_.look(
      step, sets,
      [&](int tile, std::vector<std::uint32_t>& pixels) {
        looks_.tiles().each(tile, step, [&](int x, int y) {
          const std::size_t i = surfaces_.index(x, y);
          if (!surfaces_.pixels[i].there() || settled_[i] == Settled::by_rays) return;
          if (!first && x % (2 * step) == 0 && y % (2 * step) == 0) return;
          if (!first) {
            const Said said = ask_lattice(surfaces_, smooth_, nearness_, x, y, 2 * step);
            if (speak_for(said)) {
              pixels_.open[i] = smooth_[i] = said.value, nearness_[i] = said.nearness;
              settled_[i] = Settled::by_neighbours;
              return;
            }
          }
          pixels.push_back(static_cast<std::uint32_t>(i));
        });
      },
      [&](std::uint32_t i, const Openness& found) {
        pixels_.open[i] = smooth_[i] = found.open, pixels_.weight[i] = 1;
        nearness_[i] = found.nearness, spread_[i] = found.spread;
        settled_[i] = Settled::by_rays;
      });
}

/// Evens out the results of rays over the lattice of `step`.
void AdaptivePass::smooth(int step) {
  parallel::parallel_tasks(looks_.tiles().count(), [&](int tile) {
    if (stopped()) return;
    looks_.tiles().each(tile, step, [&](int x, int y) {
      const std::size_t i = surfaces_.index(x, y);
      if (settled_[i] != Settled::by_rays) return;
      const Smoothed found = smoothed(surfaces_, pixels_, x, y, step, noise());
      smooth_[i] = found.value, mean_of_[i] = found.weight;
    });
  });
}

void AdaptivePass::settle() {
  for (int step = settings_.coarsest; step >= 1; step /= 2) {
    settle(step);
    smooth(step);
  }
}

/// Casts more rays from pixels with few similar neighbours whose rays do not agree: where more noise than
/// `noise` (a standard deviation) is expected. Each round has rays of its own.
void AdaptivePass::look_again(float noise, int round) {
  constexpr int times = 2;  // 4, with a trust of 0.5, took more rays on court, city 150 and the near crowd
  const RaySets& sets = state_.sets.at(times * settings_.rays, round);
  const float alone = lattice_noise / std::sqrt(static_cast<float>(settings_.rays));
  looks_.look(
      1, sets,
      [&](int tile, std::vector<std::uint32_t>& pixels) {
        looks_.tiles().each(tile, 1, [&](int x, int y) {
          const std::size_t i = surfaces_.index(x, y);
          if (settled_[i] == Settled::by_rays && alone * spread_[i] > noise * std::sqrt(mean_of_[i]))
            pixels.push_back(static_cast<std::uint32_t>(i));
        });
      },
      [&](std::uint32_t i, const Openness& found) {
        const float before = pixels_.weight[i], after = before + times;
        pixels_.open[i] = (before * pixels_.open[i] + times * found.open) / after;
        pixels_.weight[i] = after;
      });
  smooth(1);
}

/// Returns the estimate of the error.
double AdaptivePass::meet_error() {
  constexpr int most_rounds = 8;
  constexpr int least_rays = 256, most_rays = 2048;
  const RaySets& sets = state_.sets.at(std::clamp(8 * settings_.rays, least_rays, most_rays));
  const Audit audit(looks_, surfaces_, settled_, sets, state_.audit);
  auto noise = static_cast<float>(settings_.error_255 / 255);
  for (int round = 1;; ++round) {
    const Audit::Errors errors = audit.errors(smooth_, settled_);
    if (errors.rms_255() <= settings_.error_255 || round > most_rounds || stopped()) return errors.rms_255();
    if (errors.by_neighbours > errors.by_rays) {
      settings_.difference *= 0.5f, settings_.closeness *= 0.5f;
      settle();
    } else {
      look_again(noise, round);
      noise *= 0.7f, trust_ *= 0.8f;
    }
  }
}

}  // namespace

AdaptiveSettings adaptive_settings(double error_255) {
  if (error_255 >= 4) return {error_255, 16, 4, 0.15f, 1};
  if (error_255 >= 2) return {error_255, 64, 4, 0.08f, 0.7f};
  if (error_255 > 1) return {error_255, 64, 2, 0.06f, 0.5f};
  if (error_255 > 0.5) return {error_255, 128, 1};
  return {error_255, 256, 1};
}

AdaptiveOcclusion::AdaptiveOcclusion() : state_(std::make_unique<State>()) {}
AdaptiveOcclusion::AdaptiveOcclusion(AdaptiveOcclusion&&) noexcept = default;
AdaptiveOcclusion& AdaptiveOcclusion::operator=(AdaptiveOcclusion&&) noexcept = default;
AdaptiveOcclusion::~AdaptiveOcclusion() = default;

Expected<double> AdaptiveOcclusion::compute(const AdaptiveScene& scene, const AdaptiveSettings& settings,
                                            std::span<float> out, AoStats& stats, const StopFlag* stop) {
  state_->begin(scene);
  AdaptivePass pass(scene, settings, stop, *state_);
  pass.settle();
  const double error = pass.meet_error();
  if (pass.stopped()) return base::stopped();
  std::copy(pass.values().begin(), pass.values().end(), out.begin());
  stats.rays_cast += pass.looks().rays_cast();
  stats.points += pass.looks().looks();
  return error;
}

}  // namespace tenebra::ao
