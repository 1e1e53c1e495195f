// Input files are read whole, or refused without waiting.
#include "io/input_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "support/temporary_folder.h"

namespace tenebra {
namespace {

using testing::TemporaryFolder;

std::string refusal(const std::filesystem::path& path, std::size_t most = 100) {
  const auto read = io::read_file(path, most);
  return read ? "" : read.error().message;
}

TEST(InputFile, IsReadWholeUpToABound) {
  const TemporaryFolder folder;
  testing::write_text(folder / "a.txt", "twelve bytes");
  EXPECT_EQ(io::read_file(folder / "a.txt", 12).value(), "twelve bytes");
  EXPECT_NE(refusal(folder / "a.txt", 11).find("expected at most 11"), std::string::npos);
}

TEST(InputFile, PipesFoldersAndDevicesAreRefusedAtOnce) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const std::filesystem::path& path :
       {folder / "pipe", folder.path(), std::filesystem::path("/dev/zero")})
    EXPECT_NE(refusal(path).find("expected one"), std::string::npos) << path;
  EXPECT_NE(refusal(folder / "none").find("none: No such file"), std::string::npos);
}

}  // namespace
}  // namespace tenebra
