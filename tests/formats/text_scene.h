// Scenes written as the text or bytes of one file and read by its extension.
#pragma once

#include <gtest/gtest.h>

#include "formats/import_scene.h"
#include "support/temporary_folder.h"

namespace tenebra::testing {

class TextScene : public ::testing::Test {
protected:
  explicit TextScene(std::string name) : name_(std::move(name)) {}

  Expected<Scene> import(const std::string& text, const formats::ImportOptions& options = {}) const {
    write_text(folder_ / name_, text);
    return formats::import_scene(folder_ / name_, options);
  }
  Scene read(const std::string& text) const {
    auto scene = import(text);
    EXPECT_TRUE(scene.has_value()) << scene.error().message;
    return scene ? std::move(*scene) : Scene{};
  }
  /// The sentence of a file that must not be read.
  std::string refusal(const std::string& text) const {
    const auto scene = import(text);
    EXPECT_FALSE(scene.has_value());
    return scene ? "" : scene.error().message;
  }

  TemporaryFolder folder_;

private:
  std::string name_;
};

}  // namespace tenebra::testing
