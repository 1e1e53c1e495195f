// The frame trace: stage times as slices in the JSON of Chrome's trace events, which Perfetto and
// chrome://tracing open. It is an array of events, whose last bracket both do without: so a trace that a
// killed program left opens too.
#pragma once

#include <filesystem>
#include <span>

#include <tenebra/expected.h>
#include "render/log/frame_log.h"

namespace tenebra::render {

/// A frame is one slice with its counts as arguments; its stages are slices within, in the order in which
/// they run. Only the frame's begin is measured: a stage is drawn where the one before it ends. A journal, as
/// the frame log is.
class FrameTrace {
public:
  /// `settings` become the arguments of a first event of that name.
  static Expected<FrameTrace> create(const std::filesystem::path& path, std::span<const LogSetting> settings);

  /// `begin_ms`: when the frame began, since the start of the run.
  Expected<void> add(const FrameRecord& record, double begin_ms);
  Expected<void> finish();

private:
  explicit FrameTrace(io::Journal file) : file_(std::move(file)) {}
  io::Journal file_;
};

}  // namespace tenebra::render
