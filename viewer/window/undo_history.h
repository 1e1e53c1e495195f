// What the user did to the scene, step by step, to be taken back and done again.
#pragma once

#include <vector>

#include "stage/edits/scene_edits.h"

namespace tenebra::viewer {

/// Steps are the moments at which the user let go: a whole drag is one.
class UndoHistory {
public:
  static constexpr std::size_t most_steps = 200;

  /// Forgets everything: a new scene with these edits.
  void begin(const stage::SceneEdits& edits) {
    before_.clear();
    after_.clear();
    now_ = edits;
  }
  /// Called once per turn of the window's loop. All changes until the hand rests are one step.
  void follow(const stage::SceneEdits& edits, bool hand_rests) {
    if (!hand_rests || edits == now_) return;
    before_.push_back(std::move(now_));
    if (before_.size() > most_steps) before_.erase(before_.begin());
    after_.clear();
    now_ = edits;
  }
  bool can_undo() const { return !before_.empty(); }
  bool can_redo() const { return !after_.empty(); }
  /// False where there is nothing to take back, and to do again.
  bool undo(stage::SceneEdits& edits) { return step(before_, after_, edits); }
  bool redo(stage::SceneEdits& edits) { return step(after_, before_, edits); }

private:
  bool step(std::vector<stage::SceneEdits>& from, std::vector<stage::SceneEdits>& to,
            stage::SceneEdits& edits) {
    if (from.empty()) return false;
    to.push_back(std::move(now_));
    edits = now_ = std::move(from.back());
    from.pop_back();
    return true;
  }

  std::vector<stage::SceneEdits> before_, after_;
  stage::SceneEdits now_;
};

}  // namespace tenebra::viewer
