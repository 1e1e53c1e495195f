// tenebra render with soft shadows and ambient occlusion: its options, masks, log and notes; --config.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "io/image.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> render(const std::string& scene, std::vector<std::string> more) {
  std::vector<std::string> arguments{"render", scene, "--time", "5", "--size", "80x60"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// The grey values of a PFM file, rows from the bottom up as they are stored.
std::vector<float> read_pfm(const fs::path& path) {
  const std::string text = read_text(path);
  const std::string head = "Pf\n80 60\n-1.0\n";
  EXPECT_EQ(text.substr(0, 3), "Pf\n");
  const std::size_t count = 80 * 60;
  EXPECT_GE(text.size(), head.size());
  std::vector<float> values(count);
  if (text.size() >= 4 * count) std::memcpy(values.data(), text.data() + text.size() - 4 * count, 4 * count);
  return values;
}

/// Column `name` of the last row of a log.
double logged(const fs::path& log, const std::string& name) {
  std::istringstream stream(read_text(log));
  std::vector<std::string> header, row;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream cells(line);
    std::vector<std::string> split;
    for (std::string cell; std::getline(cells, cell, ',');) split.push_back(cell);
    (header.empty() ? header : row) = split;
  }
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (header[i] == name) return std::stod(row.at(i));
  }
  ADD_FAILURE() << "no column " << name;
  return 0;
}

TEST(SoftCommand, WritesTheVisibleFractionInEightAndThirtyTwoBits) {
  const TemporaryFolder folder;
  const auto result =
      tenebra(render(write_moving_scene(folder),
                     {"--shadows", "soft", "--light-size", "1.5x0.5", "-o", folder / "soft.png", "--mask",
                      folder / "mask.png", "--mask", folder / "mask.pfm", "--log", folder / "log.csv"}));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  const auto mask = io::read_png(folder / "mask.png");
  ASSERT_TRUE(mask) << mask.error().message;
  const std::vector<float> fraction = read_pfm(folder / "mask.pfm");
  int between = 0;
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 80; ++x) {
      const float stored = fraction[static_cast<std::size_t>((59 - y) * 80 + x)];
      ASSERT_EQ(mask->pixels[static_cast<std::size_t>(y * 80 + x)], std::lround(255 * stored))
          << x << ' ' << y;
      between += stored > 0 && stored < 1;
    }
  }
  EXPECT_GT(between, 20) << "penumbra";
  EXPECT_EQ(logged(folder / "log.csv", "soft_points_penumbra"), between);
  EXPECT_GT(logged(folder / "log.csv", "query_ms") + logged(folder / "log.csv", "shaft_ms"), 0);
  EXPECT_EQ(logged(folder / "log.csv", "rays"), 0) << "no hard shadows beside";
  const std::string log = read_text(folder / "log.csv");
  for (const char* setting :
       {"# shadows: soft\n", "# soft_solver: auto\n", "# soft_grouping: neighbourhood\n",
        "# soft_choice: largest\n", "# light_size: 1.5x0.5\n", "# ao: none\n"}) {
    EXPECT_NE(log.find(setting), std::string::npos) << setting << log;
  }
  const auto table = tenebra({"render", write_moving_scene(folder), "--shadows", "soft", "--light-size",
                              "1.5x0.5", "--frames", "0:1", "--size", "80x60", "-o", "none"});
  for (const char* stage : {"shaft", "query"}) {
    EXPECT_NE(table.output.find(stage), std::string::npos) << table.output;
  }
}

TEST(SoftCommand, EverySettingOfTheSolversDrawsTheSamePicture) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const std::vector<std::vector<std::string>> settings{{},
                                                       {"--paper", "soft-solver=bsp"},
                                                       {"--paper", "soft-solver=clip"},
                                                       {"--paper", "soft-grouping=triangle"},
                                                       {"--paper", "soft-choice=random"},
                                                       {"--threads", "1"},
                                                       {"--simd", "scalar"}};
  io::Image8 expected;
  for (std::vector<std::string> more : settings) {
    more.insert(more.end(), {"--shadows", "soft", "--light-size", "20%", "--quiet", "-o", folder / "a.png"});
    const auto result = tenebra(render(scene, more));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const auto image = io::read_png(folder / "a.png");
    ASSERT_TRUE(image) << image.error().message;
    if (expected.pixels.empty()) expected = *image;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
      ASSERT_NEAR(image->pixels[i], expected.pixels[i], 1) << more[0] << " " << more[1];
    }
  }
}

TEST(SoftCommand, SaysOnceWhichSizeLightsWithoutOneGet) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const auto result = tenebra({"render", scene, "--shadows", "soft", "--frames", "0:2", "--size", "32x24",
                               "-o", "none", "--log", folder / "log.csv"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(result.errors.starts_with("note: point lights have no size")) << result.errors;
  EXPECT_EQ(result.errors.find("note: ", 1), std::string::npos) << result.errors;
  EXPECT_NE(read_text(folder / "log.csv").find("# note: point lights have no size"), std::string::npos);
  const auto quiet =
      tenebra({"render", scene, "--shadows", "soft", "--size", "32x24", "-o", "none", "--quiet"});
  EXPECT_EQ(quiet.output + quiet.errors, "");
}

TEST(SoftCommand, WarnsOfOptionsThatDoNothing) {
  const TemporaryFolder folder;
  const auto result =
      tenebra(render(write_moving_scene(folder),
                     {"-o", "none", "--light-size", "4%", "--ao-rays", "16", "--paper", "soft-solver=clip"}));
  EXPECT_EQ(result.exit_code, 0);
  for (const char* warning : {"warning: --light-size does nothing without --shadows soft\n",
                              "warning: --ao-rays does nothing without --ao\n",
                              "warning: --paper soft-solver does nothing without --shadows soft\n"}) {
    EXPECT_NE(result.errors.find(warning), std::string::npos) << result.errors;
  }
}

TEST(Config, GivesOptionsThatTheCommandLineOverrules) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  write_text(folder / "my.cfg",
             "# settings\nsize = 40x30\nquiet = true\neye = 0,5,1\nlook-at = \"0,0,0\"\nno-cast = [floor]\n"
             "[render]\nlight-size = 30%\nshadows = soft\n[view]\ntone = none\n");
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"render",          scene, "--config",
                                       folder / "my.cfg", "-o",  folder / "a.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = tenebra(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.output + result.errors, "");
    return io::read_png(folder / "a.png").value_or(io::Image8{});
  };
  const io::Image8 from_file = run({});
  EXPECT_EQ(from_file.width, 40);
  EXPECT_EQ(run({"--size", "20x10"}).width, 20);
  ASSERT_EQ(tenebra({"render", scene, "--size", "40x30", "--eye", "0,5,1", "--look-at", "0,0,0", "--no-cast",
                     "floor", "--light-size", "30%", "--shadows", "soft", "-o", folder / "b.png"})
                .exit_code,
            0);
  EXPECT_EQ(from_file, *io::read_png(folder / "b.png"));
}

TEST(Config, NamesFileAndWordOfWhatIsWrong) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const std::vector<std::pair<std::string, std::string>> cases{
      {"siez = 40x30\n", "siez"},
      {"size = 40\n", "40"},
      {"quiet = perhaps\n", "perhaps"},
      {"config = b.cfg\n", "config"},
      {"[render]\nsize = 1x1\nwidth = 3\n", "width"}};
  for (const auto& [text, word] : cases) {
    write_text(folder / "my.cfg", text);
    const auto result = tenebra({"render", scene, "--config", folder / "my.cfg", "-o", "none"});
    EXPECT_EQ(result.exit_code, 1) << text;
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
    EXPECT_NE(result.errors.find("my.cfg"), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find(word), std::string::npos) << result.errors;
  }
  for (const std::string& file : {std::string(folder / "missing.cfg"), folder.path().string()}) {
    const auto result = tenebra({"render", scene, "--config", file, "-o", "none"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
    EXPECT_NE(result.errors.find(file), std::string::npos) << result.errors;
  }
}

TEST(SoftCommand, TakesTheSmallestErrorThatFitsTheBudget) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const auto draw = [&](const std::string& name, std::vector<std::string> more) {
    for (const char* word : {"--shadows", "soft", "--light-size", "1.5x0.5", "-o"}) more.emplace_back(word);
    more.push_back(folder / (name + ".png"));
    more.insert(more.end(), {"--log", folder / (name + ".csv")});
    const auto result = tenebra(render(scene, more));
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result;
  };
  draw("exact", {});
  const auto rich = draw("rich", {"--budget", "600000"});
  EXPECT_NE(rich.output.find("--budget 600000: --soft-error 0\n"), std::string::npos) << rich.output;
  EXPECT_EQ(rich.errors, "");
  EXPECT_EQ(read_text(folder / "rich.png"), read_text(folder / "exact.png"));
  EXPECT_EQ(logged(folder / "rich.csv", "soft_error"), 0);
  EXPECT_EQ(logged(folder / "rich.csv", "tries"), 1);
  const auto poor = draw("poor", {"--budget", "0.001"});
  const std::string taken = fmt::format("{:g}", logged(folder / "poor.csv", "soft_error"));
  EXPECT_NE(poor.errors.find("--budget 0.001: nothing is as quick; the quickest, --soft-error " + taken +
                             ", takes"),
            std::string::npos)
      << poor.errors;
  draw("quickest", {"--soft-error", taken});
  EXPECT_EQ(read_text(folder / "poor.png"), read_text(folder / "quickest.png"));
  EXPECT_NE(read_text(folder / "poor.csv").find("# note: tried for frame"), std::string::npos);
  EXPECT_NE(read_text(folder / "poor.csv").find("# budget: 0.001 ms"), std::string::npos);
  const auto both = tenebra(render(scene, {"--shadows", "soft", "--budget", "9", "--soft-error", "1"}));
  EXPECT_EQ(both.exit_code, 1);
  EXPECT_NE(both.errors.find("--soft-error"), std::string::npos) << both.errors;
  const auto hard = tenebra(render(scene, {"--budget", "900", "-o", "none"}));
  EXPECT_EQ(hard.exit_code, 0);
  EXPECT_NE(hard.errors.find("--budget does nothing without --shadows soft or --ao adaptive"),
            std::string::npos)
      << hard.errors;
}

TEST(SoftCommand, SaysOnceThatGroupsChangedTheirSolver) {
  const TemporaryFolder folder;
  const auto draw = [&](std::vector<std::string> more) {
    std::vector<std::string> all{"render",       (fs::path(TENEBRA_SCENES_DIR) / "court.glb").string(),
                                 "--size",       "24x14",
                                 "--frames",     "60:61",
                                 "--shadows",    "soft",
                                 "--light",      "0",
                                 "--paper",      "soft-solver=bsp",
                                 "--light-size", "2%",
                                 "--antialias",  "1",
                                 "-o",           "none",
                                 "--log",        folder / "log.csv"};
    all.insert(all.end(), more.begin(), more.end());
    return tenebra(all);
  };
  const auto standard = draw({});
  EXPECT_EQ(standard.exit_code, 0) << standard.errors;
  EXPECT_GT(logged(folder / "log.csv", "soft_groups_changed"), 0);
  const std::size_t first = standard.errors.find("clipped in place of the BSP");
  EXPECT_NE(first, std::string::npos) << standard.errors;
  EXPECT_EQ(standard.errors.find("clipped in place of the BSP", first + 1), std::string::npos)
      << standard.errors;
  EXPECT_NE(read_text(folder / "log.csv").find("soft_memory: the system's, 4 MB a tree"), std::string::npos);

  const auto refused = draw({"--memory", "soft:2"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.errors.find("2 MB are allowed and points that are solved together need at least"),
            std::string::npos)
      << refused.errors;
}

TEST(SoftCommand, WritesAMapOfTheErrors) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const auto result = tenebra(render(scene, {"--shadows", "soft", "--light-size", "1.5x0.5", "-o", "none",
                                             "--mask", "error:" + (folder / "error.pfm").string(), "--mask",
                                             "error:" + (folder / "error.png").string()}));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const float error : read_pfm(folder / "error.pfm")) ASSERT_EQ(error, 0) << "exact";
  const auto picture = io::read_png(folder / "error.png");
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(picture->width, 80);
  const auto hard =
      tenebra(render(scene, {"-o", "none", "--mask", "error:" + (folder / "hard.pfm").string()}));
  EXPECT_EQ(hard.exit_code, 1);
  EXPECT_NE(hard.errors.find("expected --shadows soft"), std::string::npos) << hard.errors;
}

}  // namespace
}  // namespace tenebra::testing
