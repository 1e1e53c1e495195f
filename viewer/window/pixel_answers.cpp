#include "window/pixel_answers.h"

namespace tenebra::viewer {
namespace {

/// Where the ray through the right lower corner of the picture leads, as ViewRays::d0 has it of the left
/// upper one.
glm::vec3 lower_right_corner(const Picture& picture) {
  const io::Image8& image = picture.a.result.image;
  const ViewRays& view = picture.view;
  return view.d0 + static_cast<float>(image.width) * view.dx + static_cast<float>(image.height) * view.dy;
}

}  // namespace

bool same_place(const Picture& a, const Picture& b) {
  const auto near = [](glm::vec3 p, glm::vec3 q) { return glm::distance(p, q) <= 1e-4f * glm::length(p); };
  return a.scene == b.scene && a.view.eye == b.view.eye && near(a.view.d0, b.view.d0) &&
         near(lower_right_corner(a), lower_right_corner(b));
}

void PixelAnswers::ask(QuestionKind kind, const std::shared_ptr<const Picture>& picture, glm::dvec2 place) {
  const io::Image8& image = picture->a.result.image;
  const glm::ivec2 pixel = pixel_at(place, {image.width, image.height});
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= image.width || pixel.y >= image.height) return;
  if (kind == QuestionKind::explain) asked_ = picture, place_ = place;
  explainer_.ask({kind, picture, place, pixel, suns_, std::chrono::steady_clock::now()});
}

void PixelAnswers::follow(const std::shared_ptr<const Picture>& picture) {
  if (!asked_ || asked_ == picture) return;
  if (!same_place(*picture, *asked_)) return close();
  ask(QuestionKind::explain, picture, place_);
}

void PixelAnswers::explain_suns(std::shared_ptr<const sun::Suns> suns) {
  if (suns == suns_) return;
  suns_ = std::move(suns);
  if (asked_) ask(QuestionKind::explain, asked_, place_);
}

void PixelAnswers::show(PictureAnswer answer) {
  if (asked_ && answer.question.place == place_) shown_ = std::move(answer);
}

void PixelAnswers::close() {
  asked_.reset();
  shown_.reset();
}

}  // namespace tenebra::viewer
