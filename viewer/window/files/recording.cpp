#include "window/files/recording.h"

#include <cmath>
#include <utility>

#include "window/files/file_names.h"

namespace tenebra::viewer {

Expected<std::string> Recording::begin(ViewState& state, AnimationClock::Wall now) {
  const std::string folder = unused_name("tenebra_frames");
  auto files = OutputPattern::parse(folder + "/%04d.png");
  if (!files) return tl::unexpected(files.error());
  if (auto prepared = files->prepare_folder(); !prepared) return tl::unexpected(prepared.error());
  before_ = state.clock;
  files_ = std::move(*files);
  state.recording = true;
  state.clock.set_loop(now, false);
  state.clock.set_fixed_step(now, true);
  state.clock.set_speed(now, std::abs(state.clock.speed()));
  state.clock.seek(now, state.clock.start_s());
  state.clock.play(now);
  return folder;
}

std::string Recording::end(ViewState& state, AnimationClock::Wall now) {
  const std::string names = files_->text();
  files_.reset();
  if (!std::exchange(state.recording, false)) return names;
  state.clock.set_loop(now, before_.loop());
  state.clock.set_fixed_step(now, before_.fixed_step());
  state.clock.set_speed(now, before_.speed());
  return names;
}

}  // namespace tenebra::viewer
