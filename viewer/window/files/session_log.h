// The frame log of a session: the columns of `tenebra render --log`, started and ended from the window.
#pragma once

#include <string>

#include "options/raster_options.h"
#include "render/log/frame_log.h"
#include "window/frames/frame_request.h"
#include "window/view_state.h"

namespace tenebra::viewer {

/// Holds one method's frames: it ends, whole, where the settings change.
class SessionLog {
public:
  /// `settings`: what the frames have in common, as the comment lines above the rows.
  static Expected<SessionLog> start(const std::string& path, const ViewState& state, const Picture& picture,
                                    const RasterNames& raster);

  /// False if the picture was made with other settings: it does not belong here.
  bool belongs(const ViewState& state) const { return key_of(state) == key_; }
  Expected<void> add(const Picture& picture) { return log_.add(picture.a.record); }
  Expected<void> finish() { return log_.finish(); }
  const std::string& path() const { return path_; }

private:
  SessionLog(render::FrameLog log, std::string path, std::string key)
      : log_(std::move(log)), path_(std::move(path)), key_(std::move(key)) {}
  static std::string key_of(const ViewState& state);

  render::FrameLog log_;
  std::string path_;
  std::string key_;
};

}  // namespace tenebra::viewer
