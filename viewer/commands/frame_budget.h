// --budget: the smallest error whose frame fits.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "options/method_options.h"

namespace tenebra::viewer {

/// Errors that are tried together, in 1/255, as --soft-error and --ao-error have them.
struct BudgetErrors {
  double soft = 0, ao = 0;
  bool operator==(const BudgetErrors&) const = default;
};

/// Which of the chosen methods have an error to choose.
struct BudgetChoice {
  bool soft = false, ao = false;
  bool any() const { return soft || ao; }
};
BudgetChoice budget_choice(const render::RenderSettings& settings);

/// From the smallest errors on: none smaller than what --quality asks for, where it was given.
std::vector<BudgetErrors> budget_ladder(const MethodOptions& options);
void set_errors(BudgetChoice choice, const BudgetErrors& errors, render::RenderSettings& settings);

/// Draws with those errors of the ladder. Returns milliseconds; infinite: it was given up, as it took longer
/// than `limit_ms`, and what was drawn is gone.
using DrawRung = std::function<Expected<double>(std::size_t rung, double limit_ms)>;

/// Chooses the errors of one frame after the other by how long they took.
///
/// The first frame is drawn at the coarsest errors, for what later frames find there already, and given up
/// after ten budgets and two seconds. A search then tries the smallest errors, which may be exact and quick,
/// and halves the others, as if time fell with growing errors, until the errors next below are known not to
/// fit. Later frames begin with the last one's errors. These are kept up to a tenth above the budget; above,
/// the coarser ones are searched, then the smaller ones. Where a frame is a tenth quicker than when smaller
/// errors were tried last, or that was 24 frames ago, they are searched again. Where nothing that was tried
/// fits, the coarsest and others from all over the ladder are drawn for the quickest; it is kept until the
/// next search. A frame has at most `most_tries`.
class FrameBudget {
public:
  static constexpr std::size_t most_tries = 8;

  FrameBudget(double budget_ms, std::size_t rungs) : budget_ms_(budget_ms), rungs_(rungs) {}

  /// `keep` is called to keep what was drawn last and not given up.
  Expected<void> draw(const DrawRung& draw, const std::function<void()>& keep);

  std::size_t rung() const { return *rung_; }  ///< of the frame that was drawn last
  double ms() const { return ms_; }            ///< that it took
  bool fits() const { return fits_; }          ///< false: nothing that was tried does, this is the quickest
  /// What was tried for it, in order, the uncounted first one left out.
  struct Try {
    std::size_t rung;
    double ms;  ///< infinite: given up
  };
  const std::vector<Try>& tries() const { return tries_; }

private:
  Expected<double> attempt(const DrawRung& draw, std::size_t rung, double limit_ms);
  Expected<bool> fit(const DrawRung& draw, const std::function<void()>& keep, std::size_t rung);
  Expected<bool> halve(const DrawRung& draw, const std::function<void()>& keep, std::size_t first,
                       std::size_t last);
  Expected<bool> search(const DrawRung& draw, const std::function<void()>& keep, std::size_t first,
                        std::size_t last);
  Expected<bool> go_on(const DrawRung& draw, const std::function<void()>& keep);
  Expected<void> take_quickest(const DrawRung& draw, const std::function<void()>& keep);
  void take(std::size_t rung, double ms, const std::function<void()>& keep);

  double budget_ms_;
  std::size_t rungs_;
  std::optional<std::size_t> rung_;
  double ms_ = 0;
  bool fits_ = true;
  std::vector<Try> tries_;
  double searched_ms_ = 0;  ///< what the frame took for which smaller errors were tried last
  int since_search_ = 0;    ///< frames
};

/// "--soft-error 0 given up, --soft-error 0.25 81.2 ms", with the errors of `choice`.
std::string tries_text(const FrameBudget& budget, const std::vector<BudgetErrors>& ladder,
                       BudgetChoice choice);
/// "--soft-error 0.5 --ao-error 0.5".
std::string errors_text(const BudgetErrors& errors, BudgetChoice choice);

}  // namespace tenebra::viewer
