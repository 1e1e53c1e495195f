// From a request to a picture: the viewer's use of a session, the same as that of `tenebra render`. It
// needs neither the window nor threads: everything of one FrameMaker happens on one thread.
#pragma once

#include <memory>
#include <optional>

#include "session/session.h"
#include "window/frames/frame_request.h"
#include "window/frames/preview_levels.h"

namespace tenebra::viewer {

/// What the request's camera sees at one instant, in a picture of `size`.
ViewRays view_of_request(const FrameRequest& request, double time_s, Size size);

class FrameMaker {
public:
  explicit FrameMaker(const render::RasterChoice& raster) : raster_(raster) {}

  /// Draws the request at `time_s` of its animation, whole or as a preview. A stop ends in the error
  /// "stopped"; the next call starts afresh. What was drawn before changes no bit.
  Expected<std::shared_ptr<Picture>> make(const FrameRequest& request, PreviewLevel level, double time_s,
                                          const AoProgress& progress, const StopFlag& stop);

  /// Lets go of all that was built: the next picture starts from the scene.
  void forget();

  /// What is seen at a place of what was drawn last, 0 to 1 from its left and top; none: background, or no
  /// picture yet.
  std::optional<glm::vec3> visible_point(glm::dvec2 place);

  /// Null before the first picture.
  const render::FrameRaster* raster() const { return session_ ? &session_->renderer().raster() : nullptr; }
  std::vector<std::string> take_debug_messages();

private:
  Expected<void> take_scene(const FrameRequest& request);
  void keep_evidence(const FrameRequest& request, const render::RenderSettings& settings, double time_s,
                     Picture& picture) const;
  Expected<Drawn> draw(const FrameRequest& request, const render::RenderSettings& settings, double time_s,
                       const AoProgress& progress, const StopFlag& stop);

  render::RasterChoice raster_;
  std::shared_ptr<const session::StagedScene> scene_;
  std::optional<session::Session> session_;  ///< of scene_
  Size drawn_;                               ///< pixels of what was drawn last
};

}  // namespace tenebra::viewer
