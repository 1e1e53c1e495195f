// Files that block, and outputs that would overwrite their input: refused before anything is done.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "io/image.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

namespace fs = std::filesystem;

struct Refusal {
  std::vector<std::string> arguments;  ///< after "render moving.gltf"
  std::string named;                   ///< what the sentence must name
};

/// Each ends in one sentence that names `named`, long before the time is up, and writes nothing.
void expect_refused(const std::vector<Refusal>& refusals, const TemporaryFolder& folder) {
  const std::vector<std::string> before = folder.names();
  for (const Refusal& refusal : refusals) {
    std::vector<std::string> arguments{TENEBRA_PROGRAM, "render", "moving.gltf",
                                       "--size",        "32x24",  "--quiet"};
    arguments.insert(arguments.end(), refusal.arguments.begin(), refusal.arguments.end());
    ChildProgram program(arguments, [&] {
      if (::chdir(folder.path().c_str()) != 0) ::_exit(99);
    });
    const ProgramResult result = program.wait(20);
    EXPECT_EQ(result.exit_code, 1) << refusal.named;
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
    EXPECT_NE(result.errors.find(refusal.named), std::string::npos) << result.errors;
    EXPECT_EQ(folder.names(), before) << refusal.named;
  }
}

TEST(FilesApart, PipesFoldersAndDisksAreRefusedWithoutWaiting) {
  const TemporaryFolder folder;
  write_moving_scene(folder);
  ASSERT_EQ(::mkfifo((folder / "pipe.png").c_str(), 0600), 0);
  fs::create_directory(folder / "folder");
  expect_refused({{{"-o", "pipe.png"}, "pipe.png: found a named pipe"},
                  {{"-o", "none", "--mask", "pipe.png"}, "a named pipe"},
                  {{"-o", "none", "--log", "pipe.png"}, "a named pipe"},
                  {{"-o", "none", "--trace", "pipe.png"}, "a named pipe"},
                  {{"-o", "none", "--log", "folder"}, "cannot write folder"},
                  {{"--config", "pipe.png"}, "--config: pipe.png"},
                  {{"--config", "folder"}, "--config: folder"},
                  {{"--config", "/dev/zero"}, "--config: /dev/zero"},
                  {{"--environment", "pipe.png"}, "--environment"},
                  {{"--texture-path", "nowhere"}, "--texture-path: found no folder nowhere"},
                  {{"--texture-path", "moving.bin"}, "--texture-path: found no folder moving.bin"}},
                 folder);
}

TEST(FilesApart, NoOutputIsAnInputOrAnotherOutput) {
  const TemporaryFolder folder;
  write_moving_scene(folder);
  fs::create_symlink("moving.bin", folder / "link.png");
  fs::create_hard_link(folder / "moving.gltf", folder / "hard.png");
  fs::create_directory(folder / "sub");
  write_text(folder / "same.png", "earlier");
  fs::create_symlink("../same.png", folder / "sub/other.png");
  write_text(folder / "a.cfg", "quiet = true\n");
  expect_refused({{{"-o", "none", "--log", "moving.gltf"}, "--log moving.gltf is the file"},
                  {{"-o", "none", "--trace", "sub/../moving.bin"}, "is read"},
                  {{"-o", "none", "--config", "a.cfg", "--log", "./a.cfg"}, "a.cfg that is read"},
                  {{"-o", "link.png"}, "-o link.png is the file"},
                  {{"-o", "none", "--mask", "hard.png"}, "--mask hard.png is the file"},
                  {{"-o", "a.png", "--mask", "sub/../a.png"}, "the same file"},
                  {{"-o", "same.png", "--mask", "sub/other.png"}, "the same file"},
                  {{"-o", "%d.png", "--mask", "1%d.png", "--frames", "0:12"}, "the same file"},
                  {{"-o", "none", "--log", "a.csv", "--trace", "./a.csv"}, "the same file"}},
                 folder);
}

TEST(FilesApart, DevicesMayBeNamedTwice) {
  const TemporaryFolder folder;
  const auto result = tenebra({"render", write_moving_scene(folder), "--size", "32x24", "--quiet", "-o",
                               "none", "--log", "/dev/null", "--trace", "/dev/null"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
}

TEST(FilesApart, ConvertAndCompareKeepWhatTheyRead) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  ASSERT_EQ(tenebra({"convert", scene, folder / "a.glb"}).exit_code, 0);
  const std::string before = read_text(folder / "a.glb");
  const auto converted = tenebra({"convert", folder / "a.glb", folder / "a.glb"});
  EXPECT_EQ(converted.exit_code, 1);
  EXPECT_TRUE(is_one_sentence(converted.errors)) << converted.errors;
  EXPECT_EQ(read_text(folder / "a.glb"), before);
  ASSERT_TRUE(io::write_png(folder / "a.png", {1, 1, 1, {7}}));
  const auto compared = tenebra({"compare", folder / "a.png", folder / "a.png", "-o", folder / "a.png"});
  EXPECT_EQ(compared.exit_code, 2);
  EXPECT_TRUE(is_one_sentence(compared.errors)) << compared.errors;
}

}  // namespace
}  // namespace tenebra::testing
