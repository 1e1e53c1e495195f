// Pictures of frames by the program's renderer, with any number of samples a pixel.
#pragma once

#include <string>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/scene.h>
#include "base/image.h"
#include "render/renderer.h"

namespace tenebra::bench {

struct PictureTask {
  const Scene& scene;  ///< as the program prepares it
  int width = 0;
  int height = 0;
  int threads = 0;  ///< 0: all
};

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
  static Expected<PictureMaker> create(const PictureTask& task);

  /// The first clip's frame `frame`, as the frames that follow count.
  void evaluate(int frame);
  /// The picture of the frame evaluated last, its camera moved by `shift` pixels to the right and down.
  /// Stands until the next call.
  Expected<const base::Image8*> draw(const Sampling& sampling, const glm::dvec2& shift = {0, 0});
  /// Of the last picture, but for evaluating the scene, in milliseconds.
  double total_ms() const { return result_.timings.total_ms; }
  /// Of the last picture: pixels that got more than one sample.
  std::uint64_t refined() const { return result_.antialias.pixels; }

private:
  PictureMaker(const PictureTask& task, render::Renderer renderer)
      : task_(task), renderer_(std::move(renderer)) {}

  PictureTask task_;
  render::Renderer renderer_;
  render::FrameInput input_;
  render::FrameResult result_;
};

/// A scene as the program prepares it for pictures.
Expected<Scene> load_picture_scene(const std::filesystem::path& file,
                                   const std::vector<std::string>& no_cast);

}  // namespace tenebra::bench
