// Answers questions about pixels of pictures that are shown, on a thread of its own: a frame that takes long
// does not keep them waiting.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "render/explanation.h"
#include "sun/suns.h"
#include "window/frames/frame_request.h"

namespace tenebra::viewer {

/// What is asked: why it is dark, or just which point is seen (for the camera to turn around).
enum class QuestionKind { explain, pivot };

struct PictureQuestion {
  QuestionKind kind = QuestionKind::explain;
  std::shared_ptr<const Picture> picture;
  glm::dvec2 place{0.0};                  ///< in the picture, 0 to 1 from its left and top
  glm::ivec2 pixel{0};                    ///< of `picture` at `place`
  std::shared_ptr<const sun::Suns> suns;  ///< of a day, to explain as well; null: none
  AnimationClock::Wall asked{};
};

using TriangleCorners = std::array<glm::vec3, 3>;

struct PictureAnswer {
  PictureQuestion question;
  render::PixelExplanation pixel;
  TriangleCorners seen{};                     ///< of the triangle that the pixel sees, world space
  std::vector<TriangleCorners> occluders;     ///< of each light's; meaningless where it has none
  std::vector<render::LightExplanation> day;  ///< one for each of the question's suns
  double ms = 0;                              ///< from the question
};

/// The pixel at a place of a picture.
inline glm::ivec2 pixel_at(glm::dvec2 place, Size size) {
  return glm::ivec2(glm::floor(place * glm::dvec2(size.width, size.height)));
}

class Explainer {
public:
  /// `wake` is called on the explainer's thread whenever there is an answer.
  explicit Explainer(std::function<void()> wake);
  ~Explainer();
  Explainer(const Explainer&) = delete;
  Explainer& operator=(const Explainer&) = delete;

  /// Replaces an earlier question of the same kind that has not been begun.
  void ask(PictureQuestion question);
  std::vector<Expected<PictureAnswer>> take_answers();

private:
  void run();

  const std::function<void()> wake_;
  std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  std::vector<PictureQuestion> questions_;
  std::vector<Expected<PictureAnswer>> answers_;
  bool quit_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace tenebra::viewer
