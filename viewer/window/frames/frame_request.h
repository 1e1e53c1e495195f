// What the window asks its render worker for, and what comes back.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "options/scene_options.h"
#include "options/settings_names.h"
#include "render/frame_lights.h"
#include "render/log/frame_columns.h"
#include "render/renderer.h"
#include "session/staged_scene.h"
#include "shared/picture_difference.h"
#include "stage/edits/scene_edits.h"
#include "window/motion/animation_clock.h"
#include "window/motion/camera_control.h"

namespace tenebra::viewer {

/// Drawn over the picture: how many nodes were visited for each pixel, or how soft shadows found its answer.
enum class Overlay { none, nodes, classes };

/// Everything that decides a picture. While its clock plays it stands for picture after picture.
struct FrameRequest {
  std::uint64_t number = 0;  ///< counts the requests of the session, from 1
  AnimationClock::Wall asked{};
  std::shared_ptr<const session::StagedScene> scene;
  int clip = -1;
  AnimationClock clock;
  int camera = 0;                  ///< of the scene
  std::optional<FreeCamera> free;  ///< instead of the scene's camera
  stage::SceneEdits edits;
  render::RenderSettings a;
  int slot = 0;                             ///< of `a`: 0 for A, 1 for B (then b is empty)
  std::optional<render::RenderSettings> b;  ///< to compare with
  Overlay overlay = Overlay::none;
  std::optional<OutputPattern> record;  ///< each picture (a) is written, numbered by its frame
  double preview_ms = 0;                ///< time for a preview; 0: whole pictures alone
};

/// What a picture was made of, for questions about its pixels (render/explanation.h).
struct PictureEvidence {
  std::vector<std::uint32_t> ids;  ///< of its size
  std::vector<render::DrawnLight> lights;
  std::vector<render::LightMask> fractions;  ///< of lights with an area, their visible fractions alone
  render::RenderSettings settings;           ///< of `a`
  int clip = -1;
  double time_s = 0;
  stage::SceneEdits edits;
};

/// One method's frame of a picture.
struct Drawn {
  render::FrameResult result;
  render::FrameRecord record;
};

/// An image of the size of the picture that explains it.
struct OverlayImage {
  Overlay kind = Overlay::none;
  io::Image8 image;                          ///< RGB
  float highest = 0;                         ///< nodes: what the brightest colour stands for
  float peak = 0;                            ///< nodes: the most of any pixel
  double mean = 0;                           ///< nodes: of the pixels with a triangle
  std::array<std::size_t, 8> class_sizes{};  ///< classes: pixels of each SoftClass
};

struct Picture {
  std::uint64_t request = 0;  ///< number of the request that it answers
  std::shared_ptr<const session::StagedScene> scene;
  int slot = 0;         ///< that `a` was drawn with
  std::string preview;  ///< what it leaves out of what was asked for; empty: nothing, it is whole
  Size whole;           ///< of the whole picture; `a` has fewer pixels in some previews
  Drawn a;
  std::optional<Drawn> b;
  PictureDifference difference;  ///< of a and b
  OverlayImage overlay;          ///< of a
  ViewRays view;
  std::vector<WorldLight> lights;  ///< before their edits
  PictureEvidence evidence;        ///< of a
  AnimationClock clock;            ///< as it was when the picture was begun
  double delay_ms = 0;  ///< from the request, or while it plays from the picture before, to this one
};

}  // namespace tenebra::viewer
