#include "window/files/session_log.h"

#include <fmt/format.h>

#include "base/machine.h"
#include "options/method_arguments.h"
#include "options/settings_names.h"
#include "parallel/parallel.h"

namespace tenebra::viewer {

std::string SessionLog::key_of(const ViewState& state) {
  const int slot = state.compare ? 0 : state.active;
  std::string key = fmt::format("{}|{}|{}", fmt::ptr(state.scene.get()), state.clip,
                                method_arguments(state.slots[static_cast<std::size_t>(slot)]));
  for (const EditOption& edit : edit_options(state.edits))
    key += fmt::format("|{} {}", edit.name, edit.value);
  return key;
}

Expected<SessionLog> SessionLog::start(const std::string& path, const ViewState& state,
                                       const Picture& picture, const RasterNames& raster) {
  const io::Image8& image = picture.a.result.image;
  const MethodOptions& method = state.slots[static_cast<std::size_t>(picture.slot)];
  const bool follows = state.camera_mode == CameraMode::scene;
  std::vector<render::LogSetting> settings{
      {"machine", base::machine_description()},
      {"renderer", raster.renderer},
      {"raster", raster.raster},
      {"shading", raster.shading},
      {"threads", method.render.threads == 0 ? fmt::format("{} (all cores)", thread_count())
                                             : fmt::format("{}", method.render.threads)},
      {"scene", state.options.file},
      {"clip", state.clip < 0 ? "none" : state.scene->scene.clips[static_cast<std::size_t>(state.clip)].name},
      {"camera", follows ? fmt::format("--camera {}", state.camera)
                         : camera_arguments(state.free, state.scene->scene.frame)},
      {"size", fmt::format("{}x{}", image.width, image.height)},
      {"method", method_arguments(method)},
      {"played", state.clock.fixed_step() ? "by fixed steps" : "by the clock, in the window"},
  };
  for (EditOption& edit : edit_options(state.edits))
    settings.push_back({setting_name(edit), std::move(edit.value)});
  auto log = render::FrameLog::create(path, settings);
  if (!log) return tl::unexpected(log.error());
  return SessionLog(std::move(*log), path, key_of(state));
}

}  // namespace tenebra::viewer
