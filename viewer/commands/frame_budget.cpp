#include "commands/frame_budget.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tenebra::viewer {
namespace {

/// Each about the root of 2 times the one before.
constexpr std::array budget_errors{0.0, 0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0};
constexpr double least_ao_error = 0.5;
constexpr double kept_up_to = 1.1;    ///< of the budget
constexpr double quicker = 0.9;       ///< smaller errors may fit then
constexpr int frames_to_search = 24;  ///< after the last search
constexpr double never = std::numeric_limits<double>::infinity();
constexpr std::size_t most_searched = 5;  ///< tries that a search may end with; the others find the quickest

/// What the uncounted first frame may take: what is built once may take longer than any frame.
double first_limit_ms(double budget_ms) {
  return 10 * budget_ms + 2000;
}

/// All rungs but the coarsest, spread over the ladder: 0, then halves, quarters and so on.
std::vector<std::size_t> spread_rungs(std::size_t rungs) {
  std::vector<std::size_t> order;
  std::vector<bool> in_order(rungs);
  for (std::size_t step = rungs - 1; step > 0; step /= 2) {
    for (std::size_t rung = 0; rung + 1 < rungs; rung += step) {
      if (!in_order[rung]) order.push_back(rung);
      in_order[rung] = true;
    }
  }
  return order;
}

}  // namespace

BudgetChoice budget_choice(const render::RenderSettings& settings) {
  return {settings.shadows == render::ShadowMode::soft && settings.soft_points == 0,
          settings.ao.mode == AoMode::adaptive};
}

std::vector<BudgetErrors> budget_ladder(const MethodOptions& options) {
  const BudgetChoice choice = budget_choice(options.render);
  const bool asked = options.quality.has_value();
  const double least_soft = asked ? options.render.soft.error_255 : 0;
  const double least_ao = asked ? options.render.ao.error_255 : least_ao_error;
  std::vector<BudgetErrors> ladder;
  for (const double error : budget_errors) {
    BudgetErrors errors;
    if (choice.soft) errors.soft = std::max(error, least_soft);
    if (choice.ao) errors.ao = std::max(error, least_ao);
    if (ladder.empty() || ladder.back() != errors) ladder.push_back(errors);
  }
  return ladder;
}

void set_errors(BudgetChoice choice, const BudgetErrors& errors, render::RenderSettings& settings) {
  if (choice.soft) settings.soft.error_255 = errors.soft;
  if (choice.ao) settings.ao.error_255 = errors.ao;
}

Expected<double> FrameBudget::attempt(const DrawRung& draw, std::size_t rung, double limit_ms) {
  const auto took = draw(rung, limit_ms);
  if (!took) return took;
  const double ms = *took <= limit_ms ? *took : never;
  tries_.push_back({rung, ms});
  return ms;
}

void FrameBudget::take(std::size_t rung, double ms, const std::function<void()>& keep) {
  rung_ = rung, ms_ = ms;
  fits_ = ms <= kept_up_to * budget_ms_;
  keep();
}

/// Whether it fits; then it is taken.
Expected<bool> FrameBudget::fit(const DrawRung& draw, const std::function<void()>& keep, std::size_t rung) {
  const auto ms = attempt(draw, rung, budget_ms_);
  if (!ms) return tl::unexpected(ms.error());
  if (*ms == never) return false;
  take(rung, *ms, keep);
  return true;
}

/// The smallest error of `first` to `last` - 1 that fits, supposing that all larger ones fit too. False: none
/// was found.
Expected<bool> FrameBudget::halve(const DrawRung& draw, const std::function<void()>& keep, std::size_t first,
                                  std::size_t last) {
  bool found = false;
  while (first < last && tries_.size() < most_searched) {
    const std::size_t middle = first + (last - first) / 2;
    const auto fits = fit(draw, keep, middle);
    if (!fits) return fits;
    found = found || *fits;
    (*fits ? last : first) = *fits ? middle : middle + 1;
  }
  return found;
}

/// The same, and `first` before all others.
Expected<bool> FrameBudget::search(const DrawRung& draw, const std::function<void()>& keep, std::size_t first,
                                   std::size_t last) {
  if (first >= last || tries_.size() >= most_searched) return false;
  const auto fits = fit(draw, keep, first);
  if (!fits || *fits) return fits;
  return halve(draw, keep, first + 1, last);
}

/// Of as many errors as may be tried the first that fits up to a tenth above the budget; else the quickest,
/// of two that take as long the smaller errors. Time need not fall as errors grow; that of the coarsest
/// bounds the others'.
Expected<void> FrameBudget::take_quickest(const DrawRung& draw, const std::function<void()>& keep) {
  const auto coarsest = attempt(draw, rungs_ - 1, never);
  if (!coarsest) return tl::unexpected(coarsest.error());
  take(rungs_ - 1, *coarsest, keep);
  for (const std::size_t rung : spread_rungs(rungs_)) {
    if (tries_.size() >= most_tries) break;
    const auto ms = attempt(draw, rung, std::max(ms_, kept_up_to * budget_ms_));
    if (!ms) return tl::unexpected(ms.error());
    if (*ms <= kept_up_to * budget_ms_) {
      take(rung, *ms, keep);
      return {};
    }
    if (*ms < ms_ || (*ms == ms_ && rung < *rung_)) take(rung, *ms, keep);
  }
  return {};
}

/// With the errors of the last frame first. False: they do not fit any more, nor do coarser ones.
Expected<bool> FrameBudget::go_on(const DrawRung& draw, const std::function<void()>& keep) {
  const std::size_t last = *rung_;
  const auto ms = attempt(draw, last, kept_up_to * budget_ms_);
  if (!ms) return tl::unexpected(ms.error());
  // Once more, as it may have been chance; coarser ones follow.
  if (*ms == never) return search(draw, keep, last, rungs_);
  take(last, *ms, keep);
  if (*ms > quicker * searched_ms_ && since_search_ < frames_to_search) return true;
  const auto smaller = search(draw, keep, 0, last);
  if (!smaller) return smaller;
  searched_ms_ = ms_, since_search_ = 0;
  return true;
}

Expected<void> FrameBudget::draw(const DrawRung& draw, const std::function<void()>& keep) {
  const bool first = !rung_;
  tries_.clear();
  if (first) {
    if (const auto warm = draw(rungs_ - 1, first_limit_ms(budget_ms_)); !warm)
      return tl::unexpected(warm.error());
  }
  ++since_search_;
  if (!first && !fits_ && since_search_ < frames_to_search) {
    const auto ms = attempt(draw, *rung_, never);
    if (!ms) return tl::unexpected(ms.error());
    take(*rung_, *ms, keep);
    return {};
  }
  const bool goes_on = !first && fits_;
  if (goes_on) {
    const auto kept = go_on(draw, keep);
    if (!kept) return tl::unexpected(kept.error());
    if (*kept) return {};
  }
  const auto found = search(draw, keep, 0, goes_on ? *rung_ : rungs_);
  if (!found) return tl::unexpected(found.error());
  if (!*found)
    if (auto taken = take_quickest(draw, keep); !taken) return taken;
  searched_ms_ = ms_, since_search_ = 0;
  return {};
}

std::string errors_text(const BudgetErrors& errors, BudgetChoice choice) {
  std::string text = choice.soft ? fmt::format("--soft-error {}", errors.soft) : "";
  if (choice.ao) text += fmt::format("{}--ao-error {}", choice.soft ? " " : "", errors.ao);
  return text;
}

std::string tries_text(const FrameBudget& budget, const std::vector<BudgetErrors>& ladder,
                       BudgetChoice choice) {
  std::string text;
  for (const FrameBudget::Try& tried : budget.tries()) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", errors_text(ladder[tried.rung], choice));
    text += std::isinf(tried.ms) ? " given up" : fmt::format(" {:.1f} ms", tried.ms);
  }
  return text;
}

}  // namespace tenebra::viewer
