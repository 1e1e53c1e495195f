// tenebra render: its files, its log, and what happens when it is stopped or cannot write.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "io/exr/exr_file.h"
#include "io/image.h"
#include "render/log/frame_log.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

io::Image8 picture(const fs::path& path) {
  auto image = io::read_png(path);
  EXPECT_TRUE(image) << image.error().message;
  return image.value_or(io::Image8{});
}

std::size_t count_of(const io::Image8& image, std::uint8_t value) {
  return static_cast<std::size_t>(std::count(image.pixels.begin(), image.pixels.end(), value));
}

/// Lines of a log that are neither comments nor the header.
std::vector<std::string> rows_of(const fs::path& log) {
  std::istringstream stream(read_text(log));
  std::vector<std::string> rows;
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with('#')) rows.push_back(line);
  }
  if (!rows.empty()) rows.erase(rows.begin());
  return rows;
}

/// Every row of the log has a field for each name of its header, and a line break.
void expect_whole_rows(const fs::path& log) {
  const std::string header = render::frame_log_header();
  EXPECT_TRUE(read_text(log).ends_with("\n")) << log;
  for (const std::string& row : rows_of(log))
    EXPECT_EQ(std::count(row.begin(), row.end(), ','), std::count(header.begin(), header.end(), ',')) << row;
}

/// Names in the folder but for the scene's files and the list of what is done.
std::vector<std::string> results_in(const TemporaryFolder& folder) {
  std::vector<std::string> names = folder.names();
  std::erase_if(
      names, [](const std::string& name) { return name.starts_with("moving.") || name.ends_with(".done"); });
  return names;
}

TEST(RenderCommand, DrawsOneFrameToItsDefaultPlace) {
  const TemporaryFolder folder;
  const auto result = tenebra({"render", write_moving_scene(folder)}, [&] {
    if (::chdir(folder.path().c_str()) != 0) ::_exit(99);
  });
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const io::Image8 image = picture(folder / "out/0000.png");
  EXPECT_EQ(image.width, 800);
  EXPECT_EQ(image.height, 600);
  EXPECT_EQ(image.channels, 3);
  EXPECT_EQ(fs::exists(folder / "out/0001.png"), false);
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
  EXPECT_NE(result.output.find("picture in out/0000.png"), std::string::npos) << result.output;
}

TEST(RenderCommand, WritesJpegsIntoFoldersThatItMakes) {
  const TemporaryFolder folder;
  const auto result = tenebra({"render", write_moving_scene(folder), "--size", "32x24", "--frames", "0:1",
                               "-o", folder / "a/b/%d.jpg", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const char* file : {"a/b/0.jpg", "a/b/1.jpg"})
    EXPECT_EQ(io::decode_rgba(read_text(folder / file)).value().width, 32) << file;
}

TEST(RenderCommand, WritesMasksOfZeroAndFullOnly) {
  const TemporaryFolder folder;
  const auto result = tenebra({"render", write_moving_scene(folder), "--time", "5", "--size", "160x120", "-o",
                               "none", "--mask", folder / "mask.png", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.output + result.errors, "");
  EXPECT_EQ(results_in(folder), std::vector<std::string>{"mask.png"});
  const io::Image8 mask = picture(folder / "mask.png");
  EXPECT_EQ(mask.channels, 1);
  EXPECT_GT(count_of(mask, 0), 500u) << "sky and shadow";
  EXPECT_GT(count_of(mask, 255), 500u) << "lit floor";
  EXPECT_EQ(count_of(mask, 0) + count_of(mask, 255), mask.pixels.size());
}

TEST(RenderCommand, DarkensWhatTheMaskSaysIsShadowed) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const std::vector<std::string> common{"render", scene, "--time", "5", "--size", "160x120", "--quiet", "-o"};
  auto with = common;
  with.insert(with.end(), {folder / "with.png"});
  auto without = common;
  without.insert(without.end(), {folder / "without.png", "--shadows", "none"});
  auto uncast = common;
  uncast.insert(uncast.end(), {folder / "uncast.png", "--no-cast", "blocker"});
  for (const auto& arguments : {with, without, uncast}) ASSERT_EQ(tenebra(arguments).exit_code, 0);
  const io::Image8 shadowed = picture(folder / "with.png");
  const io::Image8 plain = picture(folder / "without.png");
  EXPECT_EQ(picture(folder / "uncast.png"), plain) << "with the only blocker left out there is no shadow";
  std::size_t darker = 0;
  for (std::size_t i = 0; i < plain.pixels.size(); ++i) {
    EXPECT_LE(shadowed.pixels[i], plain.pixels[i]);
    darker += shadowed.pixels[i] < plain.pixels[i] ? 1 : 0;
  }
  EXPECT_GT(darker, 100u);
}

// Of the same colours, shown as they are and encoded: level 137 is a quarter of the light, 64 its display
// value.
TEST(RenderCommand, TransfersAndEnvironmentsArePutIntoThePicture) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  write_text(folder / "grey.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x7f");
  const auto drawn = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"render", scene, "--size", "64x48", "-o", folder / "a.png", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = tenebra(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return picture(folder / "a.png");
  };
  const std::vector<std::string> untoned{"--tone", "none"};
  const io::Image8 srgb = drawn(untoned), display = drawn({"--transfer", "display"});
  int brighter = 0;
  for (std::size_t i = 0; i < srgb.pixels.size(); ++i) {
    const double x = display.pixels[i] / 255.0;
    const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    const double slope = x <= 0.0031308 ? 12.92 : 1.055 / 2.4 * std::pow(x, 1 / 2.4 - 1);
    EXPECT_NEAR(srgb.pixels[i], 255 * encoded, 0.5 + 0.6 * slope) << i;
    brighter += srgb.pixels[i] > display.pixels[i];
  }
  EXPECT_GT(brighter, 100);
  const std::string picture_of_all = folder / "grey.hdr";
  const io::Image8 black = drawn({"--environment", picture_of_all, "--exposure", "1e-6"});
  EXPECT_EQ(count_of(black, 0), black.pixels.size());
  const io::Image8 grey = drawn({"--environment", picture_of_all, "--tone", "none"});
  EXPECT_GT(count_of(grey, 137), count_of(srgb, 137) + 300);
  // Toned unless asked not to: Khronos' curve takes 0.04 off a quarter, and level 126 shows what is left.
  const io::Image8 toned = drawn({"--environment", picture_of_all});
  EXPECT_GT(count_of(toned, 126), count_of(srgb, 126) + 300);
  EXPECT_EQ(toned, drawn({"--environment", picture_of_all, "--tone", "neutral"}));
  const std::vector<float> quarter{0.25f};
  const auto channel = [&](const char* name) { return io::exr::Channel{name, io::exr::Floats{quarter}}; };
  const auto exr = io::exr::encode({.width = 1,
                                    .height = 1,
                                    .channels = {channel("R"), channel("G"), channel("B")},
                                    .camera = {},
                                    .texts = {}});
  ASSERT_TRUE(exr) << exr.error().message;
  write_text(folder / "grey.exr", *exr);
  EXPECT_EQ(drawn({"--environment", folder / "grey.exr", "--tone", "none"}), grey);
  const io::Image8 grey_display = drawn({"--environment", picture_of_all, "--transfer", "display"});
  EXPECT_GT(count_of(grey_display, 64), count_of(display, 64) + 300);
}

TEST(RenderCommand, NumbersFramesAndLights) {
  const TemporaryFolder folder;
  const auto result = tenebra({"render", write_moving_scene(folder, 2), "--frames", "3:9:3", "--size",
                               "32x24", "-o", folder / "p%03d.png", "--mask", folder / "m%d.png"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(results_in(folder),
            (std::vector<std::string>{"m3_L0.png", "m3_L1.png", "m6_L0.png", "m6_L1.png", "m9_L0.png",
                                      "m9_L1.png", "p003.png", "p006.png", "p009.png"}));
  ASSERT_EQ(tenebra({"render", folder / "moving.gltf", "--light", "1", "--size", "32x24", "-o", "none",
                     "--mask", folder / "one.png", "--frames", "3"})
                .exit_code,
            0);
  EXPECT_EQ(picture(folder / "one.png"), picture(folder / "m3_L1.png"));
}

TEST(RenderCommand, LogsEveryFrameAndHowItWasMade) {
  const TemporaryFolder folder;
  const auto result = tenebra({"render", write_moving_scene(folder), "--frames", "all", "--fps", "2",
                               "--size", "32x24", "-o", "none", "--log", folder / "frames.csv", "--trace",
                               folder / "trace.json", "--no-cast", "floor"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(results_in(folder), (std::vector<std::string>{"frames.csv", "trace.json"}));
  EXPECT_EQ(rows_of(folder / "frames.csv").size(), 21u) << "10 s at 2 a second, both ends";
  const std::string log = read_text(folder / "frames.csv");
  for (const char* setting : {"# machine: ", "# renderer: ", "# threads: ", "# simd: ", "# LP_NUM_THREADS: ",
                              "# scene: ", "# size: 32x24", "# variant: Tiles", "# no_cast: floor"}) {
    EXPECT_NE(log.find(setting), std::string::npos) << setting << "\n" << log;
  }
  int frames = 0;
  const json trace = json::parse(read_text(folder / "trace.json"));
  for (const json& event : trace) {
    frames += event["name"].get<std::string>().starts_with("frame ") ? 1 : 0;
  }
  EXPECT_EQ(frames, 21);
  for (const char* word : {"median", "95 %", "99 %", "worst", "total"}) {
    EXPECT_NE(result.output.find(word), std::string::npos) << result.output;
  }
}

TEST(RenderCommand, RastersOnTheCpuWithoutAnyOpenGl) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const auto by = [&](const std::string& raster) {
    const auto result = tenebra({"render", scene, "--size", "160x120", "-o", folder / (raster + ".png"),
                                 "--log", folder / (raster + ".csv"), "--raster", raster, "--context", "egl"},
                                [] { ::setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nowhere", 1); });
    return result;
  };
  for (const char* raster : {"cpu", "auto"}) {
    const auto result = by(raster);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const std::string log = read_text(folder / (std::string(raster) + ".csv"));
    EXPECT_NE(log.find("# raster: cpu\n"), std::string::npos) << log;
    EXPECT_NE(log.find("# renderer: none\n"), std::string::npos) << log;
  }
  EXPECT_EQ(read_text(folder / "cpu.png"), read_text(folder / "auto.png"));
  const auto without = by("gl");
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_TRUE(is_one_sentence(without.errors)) << without.errors;
}

TEST(RenderCommand, SeesTheSameFromACameraGivenByHand) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  ASSERT_EQ(
      tenebra({"render", scene, "--camera", "eye", "--size", "64x48", "-o", folder / "name.png"}).exit_code,
      0);
  ASSERT_EQ(
      tenebra({"render", scene, "--camera", "0", "--size", "64x48", "-o", folder / "number.png"}).exit_code,
      0);
  EXPECT_EQ(picture(folder / "name.png"), picture(folder / "number.png"));
  const auto by_hand = tenebra({"render", scene, "--eye", "-1,5,0.5", "--look-at", "0,0,0", "--up", "0,0,-1",
                                "--fov", "60", "--size", "64x48", "-o", folder / "hand.png"});
  EXPECT_EQ(by_hand.exit_code, 0) << by_hand.errors;
  EXPECT_NE(picture(folder / "hand.png"), picture(folder / "name.png"));
}

TEST(RenderCommand, ReportsOutputsThatCannotBeWritten) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  fs::create_directory(folder / "taken.png");
  const std::string long_name = std::string(300, 'n') + ".png";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"-o", folder / "taken.png"},      {"--mask", folder / "taken.png"},    {"--log", folder / "taken.png"},
      {"--trace", folder / "taken.png"}, {"--log", folder / "no/frames.csv"}, {"--log", "/dev/full"},
      {"--trace", "/dev/full"},          {"-o", folder / long_name}};
  for (const auto& [option, path] : cases) {
    std::vector<std::string> arguments{"render", scene, "--size", "32x24", "--quiet", option, path};
    if (option != "-o") arguments.insert(arguments.end(), {"-o", "none"});
    const auto result = tenebra(arguments);
    EXPECT_EQ(result.exit_code, 1) << option << " " << path;
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
    EXPECT_NE(result.errors.find(path), std::string::npos) << result.errors;
    EXPECT_EQ(results_in(folder), std::vector<std::string>{"taken.png"}) << "whole or absent";
  }
}

TEST(RenderCommand, LeavesWholeFilesAndRowsOnAFullDisk) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const auto result = tenebra({"render", scene, "--frames", "0:20", "--size", "32x24", "-o",
                               folder / "%d.png", "--log", folder / "frames.csv"},
                              [] {
                                const rlimit bound{2500, 2500};  // pictures fit, the log does not
                                ::setrlimit(RLIMIT_FSIZE, &bound);
                              });
  EXPECT_EQ(result.exit_code, 75);
  EXPECT_NE(result.errors.find("File too large"), std::string::npos) << result.errors;
  std::vector<std::string> names = results_in(folder);
  ASSERT_EQ(std::erase(names, "frames.csv"), 1u);
  for (const std::string& name : names) {
    EXPECT_TRUE(name.ends_with(".png")) << name;
    EXPECT_EQ(picture(folder / name).width, 32);
  }
  expect_whole_rows(folder / "frames.csv");
  EXPECT_LT(rows_of(folder / "frames.csv").size(), names.size()) << "the disk was full for a row";
}

/// Starts a long render and sends `signal` when its third picture is there.
ProgramResult interrupt(const TemporaryFolder& folder, int signal) {
  ChildProgram render({TENEBRA_PROGRAM, "render", write_moving_scene(folder), "--frames", "all", "--size",
                       "160x120", "-o", folder / "%04d.png", "--log", folder / "frames.csv", "--trace",
                       folder / "trace.json"});
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!fs::exists(folder / "0002.png") && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  render.send(signal);
  return render.wait();
}

TEST(RenderCommand, StopsCleanlyBetweenFrames) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TemporaryFolder folder;
    const auto result = interrupt(folder, signal);
    EXPECT_EQ(result.exit_code, 128 + signal) << result.errors;
    EXPECT_NE(result.errors.find("stopped after"), std::string::npos) << result.errors;
    std::vector<std::string> names = results_in(folder);
    ASSERT_EQ(std::erase(names, "frames.csv"), 1u);
    ASSERT_EQ(std::erase(names, "trace.json"), 1u);
    EXPECT_GE(names.size(), 3u);
    EXPECT_LT(names.size(), static_cast<std::size_t>(moving_scene_frames));
    EXPECT_EQ(rows_of(folder / "frames.csv").size(), names.size()) << "a row for every picture";
    EXPECT_TRUE(json::accept(read_text(folder / "trace.json")));
    for (const std::string& name : names) EXPECT_EQ(picture(folder / name).width, 160) << name;
  }
}

TEST(RenderCommand, LeavesWholePicturesAndRowsWhenKilled) {
  const TemporaryFolder folder;
  EXPECT_EQ(interrupt(folder, SIGKILL).exit_code, 128 + SIGKILL);
  std::size_t pictures = 0;
  for (const std::string& name : results_in(folder)) {
    if (!name.ends_with(".png")) continue;
    EXPECT_EQ(picture(folder / name).width, 160) << name;
    ++pictures;
  }
  expect_whole_rows(folder / "frames.csv");
  const std::size_t rows = rows_of(folder / "frames.csv").size();
  EXPECT_TRUE(rows == pictures || rows + 1 == pictures) << rows << " rows, " << pictures << " pictures";
  EXPECT_FALSE(json::accept(read_text(folder / "trace.json"))) << "its end is missing";
  EXPECT_TRUE(json::accept(read_text(folder / "trace.json") + "]")) << "and nothing else";
}

}  // namespace
}  // namespace tenebra::testing
