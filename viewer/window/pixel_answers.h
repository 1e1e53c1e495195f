// Why is it dark? The questions about pixels of pictures, and the answer that is shown.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "window/work/explainer.h"

namespace tenebra::viewer {

class PixelAnswers {
public:
  /// `wake` is called on another thread when there is an answer.
  explicit PixelAnswers(std::function<void()> wake) : explainer_(std::move(wake)) {}

  /// Nothing where `picture` has no such pixel.
  void ask(QuestionKind kind, const std::shared_ptr<const Picture>& picture, glm::ivec2 pixel);
  std::vector<PictureAnswer> take() { return explainer_.take_answers(); }

  const PictureAnswer* shown() const { return shown_ ? &*shown_ : nullptr; }
  void show(PictureAnswer answer) { shown_ = std::move(answer); }
  void close() { shown_.reset(); }
  /// A picture from the same place, perhaps of another size, answers the same question anew; from another
  /// place there is none.
  void follow(const std::shared_ptr<const Picture>& picture);

private:
  std::optional<PictureAnswer> shown_;
  Explainer explainer_;
};

}  // namespace tenebra::viewer
