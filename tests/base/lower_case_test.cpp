#include "base/lower_case.h"

#include <gtest/gtest.h>

namespace tenebra::base {
namespace {

TEST(LowerCase, ChangesAsciiLettersAlone) {
  EXPECT_EQ(lower_case("AZaz@[09 \xC3\x84"), "azaz@[09 \xC3\x84");
  EXPECT_EQ(extension_of("Folder.X/City.GLB"), ".glb");
  EXPECT_EQ(extension_of("CITY"), "");
}

}  // namespace
}  // namespace tenebra::base
