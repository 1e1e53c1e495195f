// What the user has set: everything that the panel edits and the command line gives.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "options/method_options.h"
#include "session/staged_scene.h"
#include "window/files/user_settings.h"
#include "window/frames/frame_request.h"
#include "window/frames/sun_day.h"
#include "window/panels/open_dialog.h"
#include "window/panels/scene_tree.h"

namespace tenebra::viewer {

inline constexpr double default_preview_ms = 80, most_preview_ms = 1000;

enum class CompareView { a, b, side_by_side, wipe, difference };

struct ViewState {
  SceneOptions options;  ///< of the present scene
  std::shared_ptr<const session::StagedScene> scene;
  int clip = -1;
  AnimationClock clock;

  CameraMode camera_mode = CameraMode::scene;
  int camera = 0;
  FreeCamera free;
  FreeCamera start;                ///< where `reset` goes
  std::optional<glm::vec3> pivot;  ///< that orbits turn around; none: the camera's target
  bool pivot_asked = false;        ///< since the free camera began, or was reset
  float fly_speed = 1;             ///< metres per second

  std::array<MethodOptions, 2> slots;  ///< A and B
  int active = 0;                      ///< the slot that the panel edits
  bool compare = false;                ///< both slots are drawn
  CompareView show = CompareView::wipe;
  float wipe = 0.5f;
  int gain = 8;  ///< factor of the difference as it is shown

  stage::SceneEdits edits;
  int selected_light = -1;
  int selected_node = -1;
  int selected_material = -1;
  int shown_light = -1, shown_material = -1;  ///< the selections that the panel has opened
  SceneTree tree;
  std::optional<OpenDialog> open_dialog;  ///< while it is open
  UserSettings settings;
  bool light_handles = true;
  Overlay overlay = Overlay::none;
  float overlay_opacity = 0.85f;

  SunDay sun = sun_today();

  SceneDisplay display;             ///< the scene's, with exposures once they were asked for
  stage::SceneEdits metered_edits;  ///< that display's exposures are of
  float diagonal_m = 1;             ///< of the scene at its first frame
  glm::vec3 centre{0.0f};
  glm::vec3 half_size_m{0.5f};  ///< of the box around it

  double preview_ms = default_preview_ms;  ///< time for a preview; 0: none are drawn

  std::optional<Size> size;  ///< of the picture; none: that of its place in the window
  bool panel = true;
  bool help = false;
  bool recording = false;
  bool panel_has_keys = false;  ///< the panel was given the keyboard, when keys_in_panel was set
  bool keys_in_panel = false;   ///< arrows, Space and Enter work the panel

  void reset_camera() {
    camera_mode = options.eye ? CameraMode::orbit : CameraMode::scene;
    free = start;
    pivot.reset();
    pivot_asked = false;
  }
  /// Whether display has the exposures of the scene as edited.
  bool is_metered() const { return display.exposures && metered_edits == edits; }
  MethodOptions& method() { return slots[static_cast<std::size_t>(active)]; }
  stage::LightEdit& light_edit(int light) { return edits.light(light); }
  int light_count() const { return static_cast<int>(scene->scene.lights.size() + edits.added.size()); }
  /// `light` is less than light_count().
  LightType light_type(int light) const {
    const auto& own = scene->scene.lights;
    const auto index = static_cast<std::size_t>(light);
    return index < own.size() ? own[index].type : edits.added.at(index - own.size()).type;
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
  // Places in the picture that was drawn, 0 to 1 from its left and top.
  std::optional<glm::dvec2> focus;
  std::optional<glm::dvec2> explain;  ///< why is it dark?
  std::optional<glm::dvec2> pivot;    ///< what the camera turns around
  bool end_explanation = false;
  bool open_dialog = false;
  bool frame_all = false;
  bool record = false;  ///< begins or ends to record the animation
  bool undo = false;
  bool redo = false;
  bool trade = false;               ///< begins or ends to try settings
  bool meter = false;               ///< measures what an automatic exposure is
  std::optional<std::string> open;  ///< a scene file

  bool operator==(const Actions&) const = default;
};

}  // namespace tenebra::viewer
