// What the user has set: everything that the panel edits and the command line gives.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "options/method_options.h"
#include "shared/scene_plan.h"
#include "window/frame_request.h"

namespace tenebra::viewer {

inline constexpr double default_preview_ms = 80, most_preview_ms = 1000;

enum class CompareView { a, b, side_by_side, wipe, difference };

struct ViewState {
  SceneOptions options;  ///< of the present scene
  std::shared_ptr<const ScenePlan> scene;
  int clip = -1;
  AnimationClock clock;

  CameraMode camera_mode = CameraMode::scene;
  int camera = 0;
  FreeCamera free;
  FreeCamera start;     ///< where `reset` goes
  float fly_speed = 1;  ///< metres per second

  std::array<MethodOptions, 2> slots;  ///< A and B
  int active = 0;                      ///< the slot that the panel edits
  bool compare = false;                ///< both slots are drawn
  CompareView show = CompareView::wipe;
  float wipe = 0.5f;
  int gain = 8;  ///< factor of the difference as it is shown

  LightEdits lights;
  bool light_handles = true;
  Overlay overlay = Overlay::none;
  float overlay_opacity = 0.85f;

  float diagonal_m = 1;  ///< of the scene at its first frame
  glm::vec3 centre{0.0f};

  double preview_ms = default_preview_ms;  ///< time for a preview; 0: none are drawn

  std::optional<Size> size;  ///< of the picture; none: that of its place in the window
  bool panel = true;
  bool help = false;

  MethodOptions& method() { return slots[static_cast<std::size_t>(active)]; }
  LightEdit& light_edit(int light) {
    const auto index = static_cast<std::size_t>(light);
    if (lights.size() <= index) lights.resize(index + 1);
    return lights[index];
  }
};

/// What the user asked for in this frame of the window and the viewer has to do.
struct Actions {
  bool quit = false;
  bool cancel = false;
  bool retry = false;
  bool picture_shot = false;
  bool window_shot = false;
  bool toggle_log = false;
  bool copy_arguments = false;
  std::optional<glm::ivec2> focus;  ///< pixel of the picture
  std::optional<std::string> open;  ///< a scene file
};

}  // namespace tenebra::viewer
