// docs/options.md is what the program says of its options.
#include <gtest/gtest.h>

#include "options/options_page.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

TEST(OptionsPage, IsTheOneOfTheDocumentation) {
  const std::filesystem::path root = std::filesystem::path(TENEBRA_SCENES_DIR).parent_path();
  EXPECT_EQ(viewer::options_page(), read_text(root / "docs" / "options.md"))
      << "write it anew: build/bin/tenebra --options-page > docs/options.md";
}

}  // namespace
}  // namespace tenebra::testing
