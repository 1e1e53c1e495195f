// The options of `tenebra render`.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gl/context.h"
#include "import/import_scene.h"
#include "option_values.h"
#include "output_pattern.h"
#include "render/renderer.h"

namespace tenebra::viewer {

struct RenderOptions {
  std::string scene;
  ImportOptions import;
  std::vector<std::string> no_cast;

  std::optional<FrameRange> frames;
  std::optional<double> time_s;
  double fps = 30.0;
  std::optional<std::string> clip;

  std::optional<std::string> camera;
  std::optional<glm::vec3> eye;
  glm::vec3 look_at{0.0f};
  glm::vec3 up{0, 1, 0};
  std::optional<double> fov_deg;
  std::optional<Size> size;

  RenderSettings render;
  std::optional<bool> cull_front;  ///< not given: as the samples need it
  gl::ContextKind context = gl::ContextKind::automatic;

  std::optional<OutputPattern> pictures;  ///< none: no pictures
  std::optional<OutputPattern> masks;
  std::string log;
  std::string trace;
  bool quiet = false;
};

/// Adds the options to `command`; they are read into `options`, which must live as long.
void add_render_options(CLI::App& command, RenderOptions& options);

/// What single options cannot check: combinations.
Expected<void> check_render_options(const RenderOptions& options);

}  // namespace tenebra::viewer
