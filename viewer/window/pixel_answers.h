// Why is it dark? The questions about pixels of pictures, and the answer that is shown.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "window/frames/explainer.h"

namespace tenebra::viewer {

/// Both see the same part of the same scene, perhaps in other sizes.
bool same_place(const Picture& a, const Picture& b);

class PixelAnswers {
public:
  /// `wake` is called on another thread when there is an answer.
  explicit PixelAnswers(std::function<void()> wake) : explainer_(std::move(wake)) {}

  /// About what is seen at a place of `picture`, 0 to 1; beyond it nothing is asked.
  void ask(QuestionKind kind, const std::shared_ptr<const Picture>& picture, glm::dvec2 place);
  /// A picture from the same place, perhaps of another size, is asked the same again; a picture from another
  /// place ends the question.
  void follow(const std::shared_ptr<const Picture>& picture);
  /// The suns of a day, which answers explain as well, from now on; null: none. What is shown is asked again.
  void explain_suns(std::shared_ptr<const sun::Suns> suns);
  std::vector<Expected<PictureAnswer>> take() { return explainer_.take_answers(); }

  /// Why a pixel is dark; null: nobody has asked, or the answer has not come.
  const PictureAnswer* shown() const { return shown_ ? &*shown_ : nullptr; }
  /// Shows an answer to the last question; others are out of date.
  void show(PictureAnswer answer);
  void close();

private:
  std::shared_ptr<const Picture> asked_;  // why a pixel is dark; null: nobody asks
  glm::dvec2 place_{0.0};                 // of that pixel
  std::optional<PictureAnswer> shown_;
  std::shared_ptr<const sun::Suns> suns_;
  Explainer explainer_;
};

}  // namespace tenebra::viewer
