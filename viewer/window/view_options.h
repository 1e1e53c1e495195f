// The options of `tenebra view`: scene and method as every command has them, and what its window can be set
// to.
#pragma once

#include <optional>
#include <string>

#include "options/method_options.h"
#include "options/scene_options.h"
#include "options/settings_names.h"
#include "window/view_state.h"

namespace tenebra::viewer {

struct ViewOptions {
  SceneOptions scene;
  MethodOptions method;
  render::RasterChoice raster;
  std::optional<int> memory_mb;  ///< of the whole program

  std::optional<Size> window;  ///< none: as it was left
  std::string settings;        ///< a file, or none; "": default_settings_file()
  bool panel = true;
  bool panel_given = false;  ///< --panel or --no-panel: it is not as it was left
  bool play = false;
  double speed = 1;
  bool loop = true;
  double preview_ms = default_preview_ms;
  bool fixed_step = false;
  CameraMode navigate = CameraMode::scene;
  std::shared_ptr<const session::StagedScene> staged;  ///< of `scene`, if it is there already
  std::optional<std::string> compare_text;
  std::optional<MethodOptions> compare;  ///< slot B, of compare_text
  CompareView show = CompareView::wipe;
  float wipe = 0.5f;
  Overlay overlay = Overlay::none;

  std::optional<OutputPattern> shots;  ///< names of screenshots
  std::optional<OutputPattern> record;
  std::string log;
  int exit_after = 0;  ///< pictures; 0: stay
  std::string report;
  bool gl_debug = false;
};

/// Adds the options to `command`; they are read into `options`, which must live as long.
void add_view_options(CLI::App& command, ViewOptions& options);

/// What single options cannot check, and what follows from combinations of them.
Expected<void> settle_view_options(ViewOptions& options);

}  // namespace tenebra::viewer
