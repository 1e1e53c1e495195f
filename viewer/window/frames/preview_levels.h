// Previews: what may be left out of a picture so that it is there sooner, finest first. Pure arithmetic.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tenebra/frame_geometry.h>
#include "options/settings_names.h"
#include "render/renderer.h"

namespace tenebra::viewer {

/// From the requested picture to the cheapest. Each draws the same scene, lights and camera.
enum class PreviewMethod {
  as_asked,
  single,  ///< one sample per pixel, as all that follow
  fewer,   ///< at least the errors, and at most the rays, of --quality fast
  cast,    ///< a point for each light, ambient occlusion by a few rays that are cast
  plain,   ///< a point for each light, no ambient occlusion
};

struct PreviewLevel {
  PreviewMethod method = PreviewMethod::as_asked;
  int divisor = 1;  ///< of width and height

  bool operator==(const PreviewLevel&) const = default;
};

/// What decides which previews there are and what they cost; equal subjects share their times.
struct PreviewSubject {
  const void* scene = nullptr;
  Size size;
  render::ShadowMode shadows = render::ShadowMode::hard;
  int soft_points = 0;
  double soft_error = 0;
  AoMode ao = AoMode::none;
  double ao_error = 0;
  int ao_rays = 0;
  int ao_downscale = 1;
  int antialias = 1;
  bool compares = false;  ///< draws a second method: no preview may take a method's place
  bool explains = false;  ///< has an overlay, which only the method that was asked for can fill

  bool operator==(const PreviewSubject&) const = default;
};
PreviewSubject preview_subject(const void* scene, const render::RenderSettings& asked, bool compares,
                               bool explains);

/// All levels, finest first; the first is the whole picture, which is no preview.
std::vector<PreviewLevel> preview_levels(const PreviewSubject& subject);

render::RenderSettings preview_settings(const render::RenderSettings& asked, PreviewLevel level);

/// The same field of view in `now` pixels instead of `before`: a preview is `before` seen at fewer places.
ViewRays view_in_pixels(ViewRays view, Size before, Size now);

/// What the level leaves out of what was asked for: "1/2 size, 8 light points"; empty for the whole picture.
std::string preview_text(const render::RenderSettings& asked, PreviewLevel level);

}  // namespace tenebra::viewer
