// What the viewer writes: screenshots, the log of frames, recordings, the settings that it keeps.
#include <fmt/format.h>

#include "window/files/file_names.h"
#include "window/viewer.h"

namespace tenebra::viewer {

void Viewer::save_shot(const char* what, const io::Image8& image) {
  const auto file = next_unused(*options_.shots, shots_);
  const auto written = io::write_png(file, image);
  report_.note(written ? "shot" : "failure", written ? file.string() : written.error().message);
  say(written ? fmt::format("{} saved to {}", what, file.string()) : written.error().message, !written);
}

void Viewer::save_picture() {
  if (!picture_) return;
  if (!picture_->preview.empty()) {
    shot_waits_ = true;
    return say("This is a preview: the picture is saved when it is whole.");
  }
  save_shot("Picture", picture_->a.result.image);
}

void Viewer::after_draw(int framebuffer_width, int framebuffer_height) {
  if (std::exchange(window_shot_, false))
    save_shot("Window", gl_.read_window(framebuffer_width, framebuffer_height));
}

void Viewer::toggle_log() {
  if (log_) {
    const std::string path = log_->path();
    const auto finished = log_->finish();
    log_.reset();
    return say(finished ? fmt::format("Log written to {}", path) : finished.error().message, !finished);
  }
  if (!picture_) return;
  if (!picture_->preview.empty()) return say("The log starts with a whole picture; this is a preview.");
  const std::string path =
      options_.log.empty() ? unused_name("tenebra_frames.csv") : std::exchange(options_.log, "");
  auto log = SessionLog::start(path, state_, *picture_, worker_.raster());
  if (!log) return say(log.error().message, true);
  log_.emplace(std::move(*log));
  say(fmt::format("Logging frames to {}", path));
}

void Viewer::log_picture(const Picture& picture) {
  const bool belongs = log_->belongs(state_);
  const auto added = belongs ? log_->add(picture) : Expected<void>();
  if (!added) {
    say(added.error().message, true);
    log_.reset();
  } else if (!belongs) {
    toggle_log();
    say("The log ended where the settings changed.");
  }
}

void Viewer::toggle_recording() {
  if (recording_.is_on()) {
    state_.clock.pause(now());
    return end_recording("Recording ended; the pictures are in");
  }
  const auto folder = recording_.begin(state_, now());
  if (!folder) return say(folder.error().message, true);
  say(fmt::format("Recording {} frames to {}", state_.clock.frames(), *folder));
}

void Viewer::end_recording(const std::string& how) {
  say(fmt::format("{} {}", how, recording_.end(state_, now())));
}

void Viewer::use_settings(const SettingsKeeper& kept) {
  const std::vector<std::string> opened =
      std::move(state_.settings.recent);  // a scene that was there already
  state_.settings = kept.settings();
  for (const std::string& file : opened) state_.settings.remember(file);
  if (!options_.panel_given) state_.panel = state_.settings.panel;
  if (!kept.problem().empty()) say(kept.problem(), true);
}

void Viewer::keep_settings(const SettingsKeeper& kept, Size window) {
  if (window.width > 0 && window.height > 0) state_.settings.window = window;
  state_.settings.panel = state_.panel;
  if (const auto done = kept.keep(state_.settings); !done) report_.note("failure", done.error().message);
}

}  // namespace tenebra::viewer
