// --quality: what it sets, that options given themselves win wherever they stand, and what its pictures are.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>

#include "io/image.h"
#include "options/config_file.h"
#include "options/method_arguments.h"
#include "viewer/viewer_test_scene.h"
#include "window/view_options.h"

namespace tenebra::testing {
namespace {

/// The method that options stand for, as text without what is default.
std::string method_of(const std::string& text) {
  viewer::MethodOptions method;
  CLI::App app;
  viewer::add_method_options(app, method);
  viewer::add_config_option(app);
  app.parse(text);
  viewer::settle_quality(app, method);
  return viewer::method_arguments(method);
}

TEST(QualityOption, SetsWhatItStandsFor) {
  EXPECT_EQ(method_of("--quality fast"), "--soft-error 4 --ao-error 5 --ao-rays 16 --paper ao-downscale=2");
  EXPECT_EQ(method_of("--quality balanced"), "");
  EXPECT_EQ(method_of("--quality exact"), "--ao-error 1 --ao-rays 256");
  EXPECT_EQ(method_of("--quality exact --quality fast"), method_of("--quality fast")) << "the last counts";
}

TEST(QualityOption, LosesToOptionsGivenThemselves) {
  for (const char* text : {"--quality fast --ao-rays 32", "--ao-rays 32 --quality fast"})
    EXPECT_EQ(method_of(text), "--soft-error 4 --ao-error 5 --ao-rays 32 --paper ao-downscale=2") << text;
  for (const char* text : {"--paper soft-points=0 --quality fast", "--quality fast --paper soft-points=0"})
    EXPECT_EQ(method_of(text), "--ao-error 5 --ao-rays 16 --paper ao-downscale=2") << text;
  for (const char* text : {"--paper ao-downscale=1 --quality fast", "--quality fast --paper ao-downscale=1"})
    EXPECT_EQ(method_of(text), "--soft-error 4 --ao-error 5 --ao-rays 16") << text;
  EXPECT_EQ(method_of("--quality fast --ao-error 3"),
            "--soft-error 4 --ao-error 3 --ao-rays 16 --paper ao-downscale=2");
  EXPECT_EQ(method_of("--ao-rays 64 --ao-error 2.5 --quality exact"), "") << "the default, but given";
  EXPECT_EQ(method_of("--paper soft-points=3 --paper variant=Spheres --quality exact"),
            "--paper variant=Spheres --paper soft-points=3 --ao-error 1 --ao-rays 256");
}

TEST(QualityOption, LosesToThemInAFileToo) {
  const TemporaryFolder folder;
  const auto with = [&](const std::string& file, const std::string& line) {
    write_text(folder / "my.cfg", file);
    return method_of(line + " --config " + (folder / "my.cfg").string());
  };
  EXPECT_EQ(with("quality = fast\nao-rays = 32\n", ""),
            "--soft-error 4 --ao-error 5 --ao-rays 32 --paper ao-downscale=2");
  EXPECT_EQ(with("ao-rays = 32\nquality = fast\n", ""),
            "--soft-error 4 --ao-error 5 --ao-rays 32 --paper ao-downscale=2");
  EXPECT_EQ(with("quality = fast\n", "--ao-rays 32"),
            "--soft-error 4 --ao-error 5 --ao-rays 32 --paper ao-downscale=2");
  EXPECT_EQ(with("ao-rays = 32\n", "--quality fast"),
            "--soft-error 4 --ao-error 5 --ao-rays 32 --paper ao-downscale=2");
  EXPECT_EQ(with("quality = fast\n", "--quality exact"), "--ao-error 1 --ao-rays 256")
      << "the command line counts more";
}

TEST(QualityOption, IsRefusedInASentenceWhereUnknown) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  for (const char* command : {"render", "view"}) {
    for (const char* name : {"best", "faster", ""}) {
      const auto result = tenebra({command, scene, "--quality", name});
      EXPECT_EQ(result.exit_code, 1) << command << ' ' << name;
      EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
      EXPECT_NE(result.errors.find("expected fast, balanced or exact"), std::string::npos) << result.errors;
    }
  }
  for (const auto& [option, value] : {std::pair{"--paper", "soft-points=-1"},
                                      {"--paper", "soft-points=5000"},
                                      {"--paper", "ao-downscale=0"},
                                      {"--paper", "ao-downscale=9"}}) {
    const auto result = tenebra({"render", scene, option, value});
    EXPECT_EQ(result.exit_code, 1) << option << ' ' << value;
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
  }
}

TEST(QualityOption, SaysWhereItDoesNothing) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const auto warnings = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", scene, "--size", "16x12", "-o", "none"});
    const auto result = tenebra(more);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    std::string found;
    for (std::size_t at = 0; (at = result.errors.find("warning: ", at)) != std::string::npos; ++at)
      found += result.errors.substr(at, result.errors.find('\n', at) + 1 - at);
    return found;
  };
  const std::string idle = "warning: --quality does nothing without --shadows soft or --ao\n";
  EXPECT_EQ(warnings({"--quality", "fast"}), idle) << "hard shadows are exact, and as fast, in each preset";
  EXPECT_EQ(warnings({"--quality", "fast", "--ao", "rays", "--ao-rays", "1"}), "");
  EXPECT_EQ(warnings({"--ao", "adaptive", "--ao-error", "5", "--ao-distance", "1", "--ao-cache", "none"}),
            "");
  EXPECT_EQ(warnings({"--ao", "adaptive", "--ao-rays", "1"}),
            "warning: --ao-rays does nothing with --ao adaptive\n");
  EXPECT_EQ(warnings({"--ao", "rays", "--ao-rays", "1", "--ao-error", "5"}),
            "warning: --ao-error does nothing without --ao adaptive\n");
  const std::vector<std::string> soft{"--shadows", "soft", "--light-size", "1"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), soft.begin(), soft.end());
    return warnings(more);
  };
  EXPECT_EQ(with({"--quality", "fast"}), "");
  EXPECT_EQ(with({"--quality", "fast", "--paper", "soft-solver=bsp"}), "");
  EXPECT_EQ(with({"--paper", "soft-points=8", "--paper", "soft-solver=bsp"}),
            "warning: --paper soft-solver does nothing where lights are 8 points\n");
  EXPECT_EQ(with({"--paper", "soft-points=0", "--paper", "soft-choice=random"}), "");
  EXPECT_EQ(warnings({"--shadows", "none", "--paper", "samples=depth", "--paper", "variant=Spheres"}),
            "warning: --paper variant does nothing with --shadows none\n"
            "warning: --paper samples does nothing with --shadows none\n");
}

TEST(QualityOption, OfTheSecondMethodStandsOnTheFirst) {
  viewer::ViewOptions options;
  CLI::App app;
  viewer::add_view_options(app, options);
  app.parse("--shadows soft --quality fast --ao-rays 5 --compare=\"--quality exact\"");
  viewer::settle_quality(app, options.method);
  ASSERT_TRUE(viewer::settle_view_options(options));
  EXPECT_EQ(viewer::method_arguments(options.method),
            "--shadows soft --soft-error 4 --ao-error 5 --ao-rays 5 --paper ao-downscale=2");
  ASSERT_TRUE(options.compare);
  EXPECT_EQ(viewer::method_arguments(*options.compare), "--shadows soft --ao-error 1 --ao-rays 256");
}

/// "2.8 to 6.7": the errors of a setting on all views, from the first row of docs/trade.md that has it, where
/// cells are "12.3 · 2.83 · 39.3", time and errors; with so many decimals.
std::string documented(const std::string& page, const std::string& setting, int decimals) {
  const std::size_t row = page.find("| " + setting + " |");
  if (row == std::string::npos) return "no row of " + setting;
  const std::string separator = " · ";
  double least = 1e9, most = 0;
  std::size_t at = page.find('|', row + 1);
  for (const std::size_t end = page.find('\n', row); page.find('|', at + 1) < end;
       at = page.find('|', at + 1)) {
    const std::size_t error = page.find(separator, at) + separator.size();
    const double value = std::strtod(page.c_str() + error, nullptr);
    least = std::min(least, value), most = std::max(most, value);
  }
  return fmt::format("{:.{}f} to {:.{}f}", least, decimals, most, decimals);
}

// The page is written by what measures; docs/commands.md and --help repeat some of it.
TEST(QualityOption, IsDocumentedWithTheErrorsThatWereMeasured) {
  const std::filesystem::path root = std::filesystem::path(TENEBRA_SCENES_DIR).parent_path();
  const std::string page = read_text(root / "docs" / "trade.md"),
                    commands = read_text(root / "docs" / "commands.md"),
                    help = tenebra({"render", "--help"}).output;
  const auto between = [](const std::string& text, const char* first, const char* last) {
    const std::size_t begin = text.find(first);
    std::string part = text.substr(std::min(begin, text.size()), text.find(last, begin) - begin);
    part.erase(std::unique(part.begin(), part.end(),
                           [](char a, char b) { return std::isspace(a) != 0 && std::isspace(b) != 0; }),
               part.end());
    std::replace(part.begin(), part.end(), '\n', ' ');
    return part;
  };
  const std::string told = between(commands, "- `--quality fast|", "\n- "),
                    helped = between(help, "--quality fast|", "--shadows none|");
  for (const char* setting : {"error asked (--soft-error), 4", "field, half resolution, 16 rays",
                              "field, 64 rays", "field, 256 rays"}) {
    const std::string exactly = documented(page, setting, 1), roughly = documented(page, setting, 0);
    EXPECT_NE(told.find(exactly), std::string::npos) << exactly << " of " << setting << " in " << told;
    EXPECT_NE(helped.find(roughly), std::string::npos) << roughly << " of " << setting << " in " << helped;
  }
}

/// A picture with soft shadows.
io::Image8 picture(const TemporaryFolder& folder, const std::string& scene, std::vector<std::string> more) {
  std::vector<std::string> arguments{"render",        scene,  "--time",       "5",   "--size",  "80x60",
                                     "--shadows",     "soft", "--light-size", "1.5", "--quiet", "-o",
                                     folder / "p.png"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto result = tenebra(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  return io::read_png(folder / "p.png").value_or(io::Image8{});
}

TEST(QualityOption, ExactIsTheDefaultExactPictureToTheBit) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const io::Image8 standard = picture(folder, scene, {});
  EXPECT_EQ(picture(folder, scene, {"--quality", "exact"}), standard);
  EXPECT_EQ(picture(folder, scene, {"--quality", "balanced"}), standard);
  const io::Image8 fast = picture(folder, scene, {"--quality", "fast"});
  EXPECT_EQ(fast, standard) << "few occluders: nothing is quicker than exact";
  EXPECT_EQ(picture(folder, scene, {"--soft-error", "4"}), fast);
  EXPECT_NE(picture(folder, scene, {"--paper", "soft-points=8"}), standard);
  EXPECT_EQ(picture(folder, scene, {"--paper", "soft-points=0", "--quality", "fast"}), standard);
}

}  // namespace
}  // namespace tenebra::testing
