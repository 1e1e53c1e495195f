// Everything that a render writes: pictures, masks, the log, the trace, the list of what is done.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tenebra/stop_flag.h>
#include "commands/done_list.h"
#include "render/log/trace_json.h"
#include "shared/render_plan.h"

namespace tenebra::viewer {

class RenderOutput {
public:
  /// All must live as long.
  /// With `stop` requested a pipe that nobody reads is given up: `write` then fails with "stopped".
  RenderOutput(const RenderPlan& plan, const RenderOptions& options, const StopFlag& stop)
      : plan_(plan), options_(options), stop_(stop) {}

  /// Opens what grows with the frames; `settings` stand above the log. With --resume it fails if a setting
  /// that pictures follow from is another one than before.
  Expected<void> open(std::vector<render::LogSetting> settings);
  /// The frames that are to be drawn, once it is open.
  const std::vector<PlannedFrame>& frames_left() const { return left_; }

  /// The frame's files, then its row of the log and of the trace, then that it is done. `begin_ms`: when the
  /// frame began, since the start of the run.
  Expected<void> write(const render::FrameRecord& record, double begin_ms, const render::FrameResult& result);
  Expected<void> finish();
  /// Frames whose files are there. To be asked where no other thread writes.
  std::size_t frames_written() const { return frames_written_; }

private:
  Expected<void> open_done_list(std::span<const render::LogSetting> identity);
  Expected<void> open_log(std::span<const render::LogSetting> settings,
                          std::span<const render::LogSetting> identity);
  bool is_done(int frame) const;
  std::vector<PlannedFrame> find_frames_left() const;
  Expected<void> write_pictures(const PlannedFrame& frame, const render::FrameResult& result) const;
  Expected<void> write_to_pipe(const io::Image8& image) const;
  Expected<void> write_masks(int frame, const render::LightMask& mask) const;
  Expected<void> write_sample_masks(int frame, const std::string& light, const render::LightMask& mask) const;
  Expected<void> add_row(const render::FrameRecord& record, const std::vector<std::string>& notes);

  const RenderPlan& plan_;
  const RenderOptions& options_;
  const StopFlag& stop_;
  std::vector<render::LogSetting> identity_;  ///< what pictures follow from
  std::size_t frames_written_ = 0;
  std::optional<render::FrameLog> log_;
  std::optional<render::FrameTrace> trace_;
  std::optional<DoneList> done_;
  std::vector<int> logged_;  ///< the frames that the log had, sorted
  std::vector<PlannedFrame> left_;
  bool goes_on_ = false;  ///< the log has rows of an earlier process
};

}  // namespace tenebra::viewer
