// tenebra render --resume, --chunk: what is done is not done again, and several processes
// share a folder. Renders that are killed: tests/resume_test.py.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <set>
#include <sstream>
#include <thread>

#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

namespace fs = std::filesystem;

/// Renders of one scene into one folder.
struct Farm {
  TemporaryFolder folder;
  std::string scene = write_moving_scene(folder);

  std::vector<std::string> arguments(const std::string& frames, const std::vector<std::string>& more) const {
    std::vector<std::string> list{"render", scene, "--frames",           frames,   "--size",
                                  "32x24",  "-o",  folder / "p%02d.png", "--quiet"};
    list.insert(list.end(), more.begin(), more.end());
    return list;
  }
  ProgramResult render(const std::string& frames, const std::vector<std::string>& more = {}) const {
    return tenebra(arguments(frames, more));
  }
  void expect_refused(const std::vector<std::string>& more, const std::string& named) const {
    const auto result = render("0:4", more);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
    EXPECT_NE(result.errors.find(named), std::string::npos) << result.errors;
  }
  fs::file_time_type time_of(const std::string& name) const { return fs::last_write_time(folder / name); }
  std::vector<std::string> pictures() const {
    std::vector<std::string> names = folder.names();
    std::erase_if(names, [](const std::string& name) { return !name.ends_with(".png"); });
    return names;
  }
  /// The frames of a log, in its order.
  std::vector<int> rows(const std::string& log) const {
    std::istringstream stream(read_text(folder / log));
    std::vector<int> frames;
    for (std::string line; std::getline(stream, line);)
      if (!line.starts_with('#') && !line.starts_with("frame")) frames.push_back(std::stoi(line));
    return frames;
  }
};

TEST(ResumeCommand, DrawsWhatIsMissingAndNothingElse) {
  const Farm farm;
  const std::vector<std::string> resume{"--resume", "--log", farm.folder / "a.csv"};
  ASSERT_EQ(farm.render("0:2", {"--log", farm.folder / "a.csv"}).exit_code, 0);
  fs::remove(farm.folder / "p01.png");
  const auto first = farm.time_of("p00.png");
  const auto resumed = farm.render("0:4", resume);
  ASSERT_EQ(resumed.exit_code, 0) << resumed.errors;
  EXPECT_EQ(farm.pictures().size(), 5u);
  EXPECT_EQ(farm.time_of("p00.png"), first);
  EXPECT_EQ(farm.rows("a.csv"), (std::vector<int>{0, 1, 2, 1, 3, 4})) << "of frame 1 the last row counts";
  const auto last = farm.time_of("p04.png");
  ASSERT_EQ(farm.render("0:4", resume).exit_code, 0);
  EXPECT_EQ(farm.time_of("p04.png"), last);
  EXPECT_EQ(farm.rows("a.csv").size(), 6u);
}

TEST(ResumeCommand, SaysInTheLogWhereItWentOnAndWithWhat) {
  const Farm farm;
  const std::vector<std::string> log{"--resume", "--log", farm.folder / "a.csv"};
  const auto render = [&](const std::string& frames, const char* threads) {
    std::vector<std::string> more = log;
    more.insert(more.end(), {"--threads", threads});
    EXPECT_EQ(farm.render(frames, more).exit_code, 0);
  };
  const auto has = [&](const std::string& line) {
    const std::string text = read_text(farm.folder / "a.csv");
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find(line, at)) != std::string::npos; ++at) ++count;
    return count;
  };
  render("0:1", "1");
  EXPECT_EQ(has("# resumed: "), 0u);
  render("0:2", "2");
  render("0:3", "1");
  EXPECT_EQ(has("# resumed: with frame 2\n"), 1u);
  EXPECT_EQ(has("# resumed: with frame 3\n"), 1u);
  EXPECT_EQ(has("# from here on threads: 2\n"), 1u);
  EXPECT_EQ(has("# from here on threads: 1\n"), 1u) << "what changes back is said too";
}

TEST(ResumeCommand, TakesNamesThatStandInNoLineAsTheyAre) {
  const Farm farm;
  const std::vector<std::string> odd{"-o", farm.folder / "a\tb%02d.png"};
  EXPECT_EQ(farm.render("0:1", odd).exit_code, 0);
  EXPECT_EQ(farm.render("0:2", {odd[0], odd[1], "--resume"}).exit_code, 0);
  EXPECT_EQ(farm.pictures().size(), 3u);
}

TEST(ResumeCommand, ALogAloneIsEnough) {
  const Farm farm;
  const std::vector<std::string> measure{"-o", "none", "--log", farm.folder / "a.csv", "--resume"};
  std::vector<std::string> arguments{"render", farm.scene, "--size", "32x24", "--quiet", "--frames", "0:2"};
  arguments.insert(arguments.end(), measure.begin(), measure.end());
  ASSERT_EQ(tenebra(arguments).exit_code, 0);
  write_text(farm.folder / "a.csv", read_text(farm.folder / "a.csv") + "3,0.1,to");  // torn
  arguments[6] = "0:5";
  ASSERT_EQ(tenebra(arguments).exit_code, 0);
  EXPECT_EQ(farm.rows("a.csv"), (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

TEST(ResumeCommand, RefusesWhatWasMadeInAnotherWayAndNamesTheSetting) {
  const Farm farm;
  ASSERT_EQ(farm.render("0:2", {"--log", farm.folder / "a.csv"}).exit_code, 0);
  farm.expect_refused({"--resume", "--exposure", "2"}, "expected exposure 1, found 2");
  farm.expect_refused({"--resume", "--no-cast", "floor"}, "expected no_cast none, found floor");
  farm.expect_refused({"--resume", "--mask", farm.folder / "m%d.png"}, "outputs");
  farm.expect_refused({"--resume", "--fps", "10"}, "expected fps 30, found 10");
  write_text(farm.scene, read_text(farm.scene) + "\n");
  farm.expect_refused({"--resume"}, "input_files");
  fs::remove(farm.folder / ".p%02d.png.done");
  farm.expect_refused({"--resume", "--log", farm.folder / "a.csv"}, "a.csv: expected input_files");
  write_text(farm.folder / "b.csv", "some table\n1,2\n");
  fs::remove(farm.folder / ".p%02d.png.done");
  farm.expect_refused({"--resume", "--log", farm.folder / "b.csv"}, "b.csv");
  EXPECT_EQ(read_text(farm.folder / "b.csv"), "some table\n1,2\n");
  // Threads and vector instructions leave every bit as it is.
  EXPECT_EQ(farm.render("0:2", {"--resume", "--threads", "1", "--simd", "scalar"}).exit_code, 0);
}

TEST(ResumeCommand, WhatWasMadeInAnotherWayIsNotTakenForDone) {
  const Farm farm;
  ASSERT_EQ(farm.render("0:4").exit_code, 0);
  const std::string old = read_text(farm.folder / "p04.png");
  ASSERT_EQ(farm.render("0", {"--exposure", "3"}).exit_code, 0);
  const auto first = farm.time_of("p00.png");
  ASSERT_EQ(farm.render("0:4", {"--exposure", "3", "--resume"}).exit_code, 0);
  EXPECT_EQ(farm.time_of("p00.png"), first);
  EXPECT_NE(read_text(farm.folder / "p04.png"), old);
}

TEST(ResumeCommand, DrawsAgainWhatAnotherPatternWroteOver) {
  const Farm farm;
  ASSERT_EQ(farm.render("0:4", {"--log", farm.folder / "a.csv"}).exit_code, 0);
  const auto first = farm.time_of("p00.png");
  const std::string second = read_text(farm.folder / "p02.png"), fourth = read_text(farm.folder / "p04.png");
  ASSERT_EQ(farm.render("2:3", {"-o", farm.folder / "p0%d.png", "--exposure", "3"}).exit_code, 0);
  ASSERT_NE(read_text(farm.folder / "p02.png"), second);
  write_text(farm.folder / "p04.png", fourth.substr(0, fourth.size() / 2));  // a disk that lost the rest
  ASSERT_EQ(farm.render("0:4", {"--log", farm.folder / "a.csv", "--resume"}).exit_code, 0);
  EXPECT_EQ(read_text(farm.folder / "p02.png"), second);
  EXPECT_EQ(read_text(farm.folder / "p04.png"), fourth);
  EXPECT_EQ(farm.time_of("p00.png"), first);
  EXPECT_EQ(farm.rows("a.csv"), (std::vector<int>{0, 1, 2, 3, 4, 2, 3, 4}));
}

TEST(ResumeCommand, ChunksHaveEachFrameOnce) {
  const Farm farm;
  std::vector<int> all;
  for (const char* chunk : {"1/3", "2/3", "3/3"}) {
    const std::string log = std::string("c") + chunk[0] + ".csv";
    ASSERT_EQ(farm.render("2:12:2", {"--chunk", chunk, "--log", farm.folder / log, "--resume"}).exit_code, 0);
    for (const int frame : farm.rows(log)) all.push_back(frame);
  }
  EXPECT_EQ(all, (std::vector<int>{2, 4, 6, 8, 10, 12}));
  const auto none = farm.render("0:1", {"--chunk", "1/5"});
  EXPECT_EQ(none.exit_code, 0) << none.errors;
  for (const char* chunk : {"0/3", "4/3", "1", "1/0", "a/b", "1/2/3"})
    farm.expect_refused({"--chunk", chunk}, "--chunk");
}

TEST(ResumeCommand, ProcessesOnOneFolderDoNotHurtEachOther) {
  const Farm farm, alone;
  ASSERT_EQ(alone.render("0:39").exit_code, 0);
  std::vector<std::unique_ptr<ChildProgram>> processes;
  for (int i = 0; i < 4; ++i) {
    std::vector<std::string> arguments = farm.arguments("0:39", {"--resume"});
    arguments.insert(arguments.begin(), TENEBRA_PROGRAM);
    processes.push_back(std::make_unique<ChildProgram>(arguments));
  }
  for (auto& process : processes) {
    const auto result = process->wait();
    EXPECT_EQ(result.exit_code, 0) << result.errors;
  }
  ASSERT_EQ(farm.pictures(), alone.pictures());
  for (const std::string& name : alone.pictures())
    EXPECT_EQ(read_text(farm.folder / name), read_text(alone.folder / name)) << name;
}

TEST(ResumeCommand, OneProcessWritesALogAndOneWayOfDrawingAFolder) {
  const Farm farm;
  std::vector<std::string> arguments = farm.arguments("all", {"--log", farm.folder / "a.csv"});
  arguments.insert(arguments.begin(), TENEBRA_PROGRAM);
  ChildProgram first(arguments);
  while (!fs::exists(farm.folder / "p01.png")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  first.send(SIGSTOP);  // not to be at its end before the others begin
  farm.expect_refused({"--log", farm.folder / "a.csv", "--resume"}, "another process is writing it");
  farm.expect_refused({"--exposure", "2"}, "expected exposure 1, found 2");
  first.send(SIGKILL);
  first.wait();
  EXPECT_EQ(farm.render("0:1", {"--exposure", "2"}).exit_code, 0);
}

TEST(ResumeCommand, RemovesTemporaryFilesThatNobodyWrites) {
  const Farm farm;
  std::vector<std::string> arguments = farm.arguments("all", {});
  arguments.insert(arguments.begin(), TENEBRA_PROGRAM);
  std::set<std::string> left;
  for (int i = 0; i < 50 && left.empty(); ++i) {
    ChildProgram render(arguments);
    while (!fs::exists(farm.folder / "p00.png")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(i));
    render.send(SIGKILL);
    render.wait();
    for (const std::string& name : farm.folder.names())
      if (name.ends_with(".tmp")) left.insert(name);
    fs::remove(farm.folder / "p00.png");
  }
  // On a fast disk every kill may come between two files.
  if (left.empty()) GTEST_SKIP() << "no kill hit a file that was being written";
  write_text(farm.folder / ".tenebra-elsewhere-1-0.tmp", "written by another machine now");
  ASSERT_EQ(farm.render("0").exit_code, 0);
  for (const std::string& name : farm.folder.names())
    EXPECT_TRUE(!name.ends_with(".tmp") || name.starts_with(".tenebra-elsewhere")) << name;
  EXPECT_TRUE(fs::exists(farm.folder / ".tenebra-elsewhere-1-0.tmp"));
  fs::last_write_time(farm.folder / ".tenebra-elsewhere-1-0.tmp",
                      fs::file_time_type::clock::now() - std::chrono::hours(2));
  ASSERT_EQ(farm.render("0").exit_code, 0);
  EXPECT_FALSE(fs::exists(farm.folder / ".tenebra-elsewhere-1-0.tmp"));
}

}  // namespace
}  // namespace tenebra::testing
