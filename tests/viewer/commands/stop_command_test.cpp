// A render that is told to stop ends in time, whatever it is doing: signals, a second one, --timeout.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

namespace fs = std::filesystem;

void sleep_ms(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

void wait_for(const fs::path& file) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!fs::exists(file) && std::chrono::steady_clock::now() < end) sleep_ms(1);
}

/// A render whose log goes into a pipe that nobody reads: it blocks once the pipe is full.
std::vector<std::string> blocking_render(const TemporaryFolder& folder, std::vector<std::string> more = {}) {
  more.insert(more.begin(),
              {TENEBRA_PROGRAM, "render", write_moving_scene(folder), "--frames", "all", "--fps", "1000",
               "--size", "16x12", "-o", folder / "%05d.png", "--quiet", "--log", "/dev/stdout"});
  return more;
}

/// How many pictures there are once no more come.
std::size_t blocked_at(const TemporaryFolder& folder) {
  wait_for(folder / "00000.png");
  std::size_t count = 0;
  for (std::size_t now = folder.names().size(); now != count; now = folder.names().size()) {
    count = now;
    sleep_ms(500);
  }
  return count;
}

TEST(StopCommand, ASecondSignalEndsWhatBlocksAtOnce) {
  const TemporaryFolder folder;
  ChildProgram render(blocking_render(folder));
  EXPECT_LT(blocked_at(folder), 5000u);
  render.send(SIGINT);
  sleep_ms(300);
  render.send(SIGINT);
  const auto begin = std::chrono::steady_clock::now();
  const auto result = render.wait(60);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(3));
  EXPECT_EQ(result.exit_code, 128 + SIGINT);
  EXPECT_EQ(result.errors, "tenebra: stopped at once.\n");
}

TEST(StopCommand, ASignalOrTimeoutEndsWhatBlocksInTheEnd) {
  const TemporaryFolder folder;
  ChildProgram render(blocking_render(folder, {"--timeout", "1"}));
  blocked_at(folder);
  sleep_ms(2500);
  const auto result = render.wait(10);
  EXPECT_EQ(result.exit_code, 124);
  EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
  EXPECT_NE(result.errors.find("--timeout"), std::string::npos) << result.errors;
}

TEST(StopCommand, TimeoutKeepsWhatIsDoneAndResumes) {
  const TemporaryFolder folder;
  const auto render = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render",   write_moving_scene(folder),
                                       "--frames", "all",
                                       "--size",   "320x240",
                                       "-o",       folder / "%04d.png",
                                       "--log",    folder / "frames.csv",
                                       "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return tenebra(arguments);
  };
  const auto stopped = render({"--timeout", "0.3"});
  EXPECT_EQ(stopped.exit_code, 124) << stopped.errors;
  EXPECT_TRUE(is_one_sentence(stopped.errors)) << stopped.errors;
  for (const std::string& name : folder.names()) EXPECT_FALSE(name.ends_with(".tmp")) << name;
  const auto before_the_first = render({"--timeout", "1e-9"});
  EXPECT_EQ(before_the_first.exit_code, 124);
  EXPECT_TRUE(is_one_sentence(before_the_first.errors)) << before_the_first.errors;
  const auto resumed = render({"--resume"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  EXPECT_TRUE(fs::exists(folder / "0300.png"));
}

}  // namespace
}  // namespace tenebra::testing
