// Every frame of the animation as a file: for the whole session by --record, or begun and ended at the
// window.
#pragma once

#include <optional>
#include <string>

#include <tenebra/expected.h>
#include "window/view_state.h"

namespace tenebra::viewer {

class Recording {
public:
  /// `files` of --record, if it is given.
  explicit Recording(std::optional<OutputPattern> files) : files_(std::move(files)) {}

  bool is_on() const { return files_.has_value(); }
  /// What pictures are written to; none: it is not on.
  const std::optional<OutputPattern>& files() const { return files_; }

  /// From the first frame on, as --record does, to a new folder, which is returned.
  Expected<std::string> begin(ViewState& state, AnimationClock::Wall now);
  /// The clock goes on as before `begin`. Returns the names of the pictures.
  std::string end(ViewState& state, AnimationClock::Wall now);

private:
  std::optional<OutputPattern> files_;
  AnimationClock before_;
};

}  // namespace tenebra::viewer
