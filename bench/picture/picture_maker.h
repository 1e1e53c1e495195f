// Pictures of frames by the program's renderer, with any number of samples per pixel.
#pragma once

#include <string>
#include <vector>

#include "bench/common/scene_renderer.h"
#include "io/image.h"

namespace tenebra::bench {

/// Samples of a pixel: adaptive, or of all pixels.
struct Sampling {
  int samples = 1;
  bool everywhere = false;
};
/// What pictures are compared with.
inline constexpr Sampling reference_sampling{256, true};

/// Hard shadows, with the terminator that `tenebra render` chooses for pictures.
class PictureMaker {
public:
  static Expected<PictureMaker> create(const DrawTask& task);

  /// Frame `frame` of the first clip, for the pictures that follow.
  void evaluate(int frame) { renderer_.evaluate(frame); }
  /// The picture of the frame evaluated last, its camera moved by `shift` pixels to the right and down. Valid
  /// until the next call.
  Expected<const io::Image8*> draw(const Sampling& sampling, const glm::dvec2& shift = {0, 0});
  /// Of the last picture, but for evaluating the scene, in milliseconds.
  double total_ms() const { return renderer_.result().timings.total_ms; }
  /// Of the last picture: pixels that got more than one sample.
  std::uint64_t refined() const { return renderer_.result().antialias.pixels; }

private:
  explicit PictureMaker(SceneRenderer renderer) : renderer_(std::move(renderer)) {}

  SceneRenderer renderer_;
};

/// A scene as the program prepares it for pictures.
Expected<Scene> load_picture_scene(const std::filesystem::path& file,
                                   const std::vector<std::string>& no_cast);

}  // namespace tenebra::bench
