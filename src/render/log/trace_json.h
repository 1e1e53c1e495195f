// The frame trace: stage times as slices in the JSON of Chrome's trace events, which Perfetto and
// chrome://tracing open.
#pragma once

#include <filesystem>
#include <span>

#include <tenebra/expected.h>
#include "render/log/frame_log.h"

namespace tenebra::render {

/// A frame is one slice with its counts as arguments; its stages are slices within, in the order in which
/// they run. Only the frame's begin is measured: a stage is drawn where the one before it ends. Written as
/// the frame log is: progressively, and whole or absent.
class FrameTrace {
public:
  /// `settings` become the trace's metadata.
  static Expected<FrameTrace> create(const std::filesystem::path& path, std::span<const LogSetting> settings);

  /// `begin_ms`: when the frame began, since the start of the run.
  Expected<void> add(const FrameRecord& record, double begin_ms);
  Expected<void> finish();

private:
  explicit FrameTrace(base::OutputFile file) : file_(std::move(file)) {}
  base::OutputFile file_;
};

}  // namespace tenebra::render
