// The program as a whole: help, bad options, exit codes, sentences.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cctype>
#include <ostream>

#include "io/image.h"
#include "settings/tables.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

TEST(Program, TeachesWithHelp) {
  const auto help = tenebra({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.errors, "");
  for (const std::string command : {"render", "info", "convert", "compare", "log", "verify"}) {
    EXPECT_NE(help.output.find(command), std::string::npos) << command;
    const auto own_help = tenebra({command, "--help"});
    EXPECT_EQ(own_help.exit_code, 0);
    EXPECT_NE(own_help.output.find("Example"), std::string::npos) << own_help.output;
    EXPECT_NE(own_help.output.find("tenebra " + command), std::string::npos) << own_help.output;
  }
}

/// Names that follow "  --" or ", --" at the start of lines.
std::vector<std::string> options_in(const std::string& help) {
  std::vector<std::string> names;
  for (std::size_t at = 0; (at = help.find("\n  -", at)) != std::string::npos; at += 1) {
    const std::size_t begin = at + 3, end = help.find_first_of(" \n", begin);
    names.push_back(help.substr(begin, end - begin));
  }
  return names;
}

TEST(Program, ExplainsEverySettingOfRender) {
  const std::string all = tenebra({"render", "--help", "all"}).output,
                    paper = tenebra({"help", "render", "paper"}).output;
  std::string topics = tenebra({"render", "--help"}).output;
  for (const char* topic : {"scene", "camera", "picture", "shadows", "ao", "output", "run"})
    topics += tenebra({"render", "--help", topic}).output;
  const auto expect = [&](const settings::About& about) {
    const bool of_paper = about.audience == settings::Audience::paper;
    const std::string option = about.is_switch ? fmt::format("\n  --{}", about.name)
                                               : fmt::format("\n  --{} ", about.name),
                      name = of_paper ? fmt::format("\n  {}=", about.name) : option;
    for (const std::string& page : {all, of_paper ? paper : topics})
      EXPECT_EQ(page.find(name) != std::string::npos,
                settings::given_as(about) == fmt::format("--{} ", about.name) || of_paper)
          << about.name;
    if (of_paper) {
      EXPECT_EQ(topics.find(option), std::string::npos) << about.name;
    }
  };
  for (const auto& setting : settings::scene_table()) expect(setting);
  for (const auto& setting : settings::method_table()) expect(setting);
}

TEST(Program, HelpOfRenderBeginsWithWhatPeopleAskForFirst) {
  const auto help = tenebra({"render", "--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(
      options_in(help.output),
      (std::vector<std::string>{"-o,--output", "--size", "--frames", "--shadows", "--light-size", "--ao",
                                "--quality", "--exposure", "--camera", "--environment", "-h,--help"}));
  EXPECT_NE(
      help.output.find("--help TOPIC, one of scene, camera, picture, shadows, ao, output, run, paper or all"),
      std::string::npos)
      << help.output;
  EXPECT_EQ(tenebra({"render", "a.glb", "--frames", "all", "--help"}).output, help.output);
  EXPECT_GT(options_in(tenebra({"render", "-h", "all"}).output).size(), 60u);
  EXPECT_EQ(tenebra({"info", "--help", "all"}).output, tenebra({"info", "--help"}).output);
}

TEST(Program, RareOptionsAreReadAndSuggestedAsOthersAre) {
  const TemporaryFolder folder;
  const auto result = tenebra({"render", write_moving_scene(folder), "--size", "16x12", "-o", "none",
                               "--cast-all", "--cutout-limit", "5"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors.find("--cast-all"), std::string::npos) << result.errors;
  EXPECT_NE(tenebra({"render", "a.glb", "--cutout-limt", "5"}).errors.find("did you mean --cutout-limit?"),
            std::string::npos);
}

TEST(Program, SuggestsTheNearestOption) {
  const auto said = [](const std::vector<std::string>& arguments) { return tenebra(arguments).errors; };
  const auto expect = [&](const std::vector<std::string>& arguments, const char* text) {
    EXPECT_NE(said(arguments).find(text), std::string::npos) << said(arguments);
  };
  expect({"render", "a.glb", "--siez", "40x30"}, "(did you mean --size?)");
  expect({"view", "--shadow=soft"}, "(did you mean --shadows?)");
  expect({"render", "a.glb", "--paper", "vairant=Tiles"}, "(did you mean variant?)");
  expect({"render", "a.glb", "--paper", "variant"},
         "--paper: found variant, expected KEY=VALUE with one of cone-sides, variant, samples");
  expect({"render", "a.glb", "--paper", "variant=Fast"},
         "--paper variant: found Fast, expected Tiles, Precise");
}

TEST(Program, SaysWhatItDoesNotKnowInTheOrderTyped) {
  EXPECT_NE(tenebra({"render", "a.glb", "--shadow", "soft"})
                .errors.find("found --shadow soft, which render does not know"),
            std::string::npos)
      << tenebra({"render", "a.glb", "--shadow", "soft"}).errors;
  EXPECT_NE(tenebra({"rendr", "a.glb"}).errors.find("unknown command 'rendr' (did you mean render?)"),
            std::string::npos);
  EXPECT_NE(tenebra({"no-such-scene.glb"}).errors.find("found no command and no file 'no-such-scene.glb'"),
            std::string::npos);
}

TEST(Program, HelpsThoseWhoAskInOtherWords) {
  EXPECT_EQ(tenebra({"help"}).output, tenebra({"--help"}).output);
  EXPECT_EQ(tenebra({"help", "render"}).output, tenebra({"render", "--help"}).output);
  EXPECT_EQ(tenebra({"-V"}).output, tenebra({"--version"}).output);
  EXPECT_EQ(tenebra({"-V"}).exit_code, 0);
}

TEST(Program, OpensAFileThatIsNamedAlone) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  EXPECT_EQ(tenebra({scene, "--no-such"}).errors, tenebra({"view", scene, "--no-such"}).errors);
  EXPECT_NE(tenebra({scene, "--no-such"}).errors.find("which view does not know"), std::string::npos);
}

TEST(Program, TakesOldNamesAndSaysTheNewOnes) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(),
                {"render", scene, "--size", "16x12", "-o", "none", "--log", folder / "log.csv"});
    const auto result = tenebra(more);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.errors + read_text(folder / "log.csv");
  };
  const std::string old_name = run({"--variant", "Spheres"}), new_name = run({"--paper", "variant=spheres"});
  EXPECT_NE(old_name.find("warning: --variant is --paper variant=VALUE now"), std::string::npos) << old_name;
  EXPECT_EQ(new_name.find("warning"), std::string::npos) << new_name;
  for (const std::string& log : {old_name, new_name})
    EXPECT_NE(log.find("variant: Spheres"), std::string::npos) << log.substr(0, 4000);
  write_text(folder / "my.cfg", "paper = [variant=Precise, samples=depth]\n");
  EXPECT_NE(run({"--config", folder / "my.cfg", "--paper", "variant=Spheres"}).find("variant: Spheres"),
            std::string::npos);
}

TEST(Program, SaysItsVersion) {
  const auto version = tenebra({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_TRUE(version.output.starts_with("tenebra ")) << version.output;
}

struct BadUse {
  std::vector<std::string> arguments;
  std::string named;  ///< what the sentence must name
};

std::ostream& operator<<(std::ostream& stream, const BadUse& use) {
  for (const std::string& argument : use.arguments) stream << argument << ' ';
  return stream;
}

class BadOptions : public ::testing::TestWithParam<BadUse> {};

TEST_P(BadOptions, EndInOneSentence) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = GetParam().arguments;
  const std::string scene = write_moving_scene(folder);
  for (std::string& argument : arguments) {
    if (argument == "SCENE") argument = scene;
  }
  const auto result = tenebra(arguments, [&] {
    if (::chdir(folder.path().c_str()) != 0) ::_exit(99);
  });
  EXPECT_EQ(result.exit_code, !arguments.empty() && arguments[0] == "compare" ? 2 : 1);
  EXPECT_EQ(result.output, "");
  EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
  EXPECT_NE(result.errors.find(GetParam().named), std::string::npos) << result.errors;
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"moving.bin", "moving.gltf"}))
      << "nothing may be written";
}

std::vector<BadUse> bad_uses() {
  std::vector<BadUse> uses{
      {{}, "command"},
      {{"paint"}, "paint"},
      {{"render"}, "SCENE"},
      {{"render", "missing.gltf"}, "missing.gltf"},
      {{"render", "."}, "."},
      {{"info", "missing.obj"}, "missing.obj"},
      {{"convert", "SCENE"}, "OUT"},
      {{"convert", "SCENE", "out.obj"}, ".glb"},
      {{"convert", "missing.aff", "out.glb"}, "missing.aff"},
      {{"compare", "missing.png"}, "B"},
      {{"compare", "missing.png", "missing.png"}, "missing.png"},
      {{"compare", "a", "b", "--threshold", "256"}, "--threshold"},
      {{"compare", "SCENE", "SCENE"}, "moving.gltf"},
      {{"render", "SCENE", "--quality"}, "--quality: found no value, expected fast|balanced|exact"},
      {{"render", "SCENE", "--paper", "soft-points="},
       "--paper soft-points: found nothing, expected 1 to 4096"},
  };
  const std::vector<std::vector<std::string>> options{{"--size", "0x10"},
                                                      {"--size", "16385x16"},
                                                      {"--size", "800"},
                                                      {"--size", "-1x-1"},
                                                      {"--size", "1e3x5"},
                                                      {"--size", "99999999999x1"},
                                                      {"--fov", "0"},
                                                      {"--fov", "180"},
                                                      {"--fov", "-5"},
                                                      {"--fov", "nan"},
                                                      {"--fov", "wide"},
                                                      {"--fps", "0"},
                                                      {"--fps", "inf"},
                                                      {"--fps", ""},
                                                      {"--frames", "5:2"},
                                                      {"--frames", "-1"},
                                                      {"--frames", "0:9:0"},
                                                      {"--frames", "0:1:2:3"},
                                                      {"--frames", "a"},
                                                      {"--frames", "301"},
                                                      {"--frames", "0:301"},
                                                      {"--frames", "99999999999"},
                                                      {"--time", "soon"},
                                                      {"--time", "inf"},
                                                      {"--clip", "dance"},
                                                      {"--clip", "1"},
                                                      {"--camera", "other"},
                                                      {"--camera", "1"},
                                                      {"--light", "1"},
                                                      {"--light", "-1"},
                                                      {"--threads", "-1"},
                                                      {"--threads", "1025"},
                                                      {"--threads", "two"},
                                                      {"--paper", "variant=Fast"},
                                                      {"--simd", "mmx"},
                                                      {"--context", "glx"},
                                                      {"--shadows", "soft-ish"},
                                                      {"--paper", "samples=both"},
                                                      {"--paper", "cull=back"},
                                                      {"--exposure", "0"},
                                                      {"--exposure", "-1"},
                                                      {"--exposure", "1e39"},
                                                      {"--no-cast", "nothing"},
                                                      {"--paper", "cone-sides=2"},
                                                      {"--transfer", "linear"},
                                                      {"--environment", "missing.hdr"},
                                                      {"--eye", "0,0", "--look-at", "0,0,1"},
                                                      {"--eye", "0,0,x", "--look-at", "0,0,1"},
                                                      {"--eye", "0,0,0"},
                                                      {"--eye", "1e39,0,0", "--look-at", "0,0,0"},
                                                      {"--look-at", "0,0,0"},
                                                      {"--eye", "1,1,1", "--look-at", "1,1,1"},
                                                      {"--frames", "0", "--time", "1"},
                                                      {"-o", "picture.tiff"},
                                                      {"-o", "%d-%d.png"},
                                                      {"-o", "%s.png"},
                                                      {"-o", "%4d.png"},
                                                      {"-o", "a.png", "--frames", "0:1"},
                                                      {"--mask", "a.png", "--frames", "0:1"},
                                                      {"-o", "a.png", "--mask", "a.png"},
                                                      {"--mask", "a.png", "--shadows", "none"},
                                                      {"--mask", "a.jpg"},
                                                      {"--mask", "a.pfm"},
                                                      {"--mask", "a.png", "--mask", "%s.png"},
                                                      {"--light-size", "0x1", "--shadows", "soft"},
                                                      {"--light-size", "1x", "--shadows", "soft"},
                                                      {"--light-size", "1x-1"},
                                                      {"--light-size", "1x1x1"},
                                                      {"--light-size", "%"},
                                                      {"--light-size", "1 %"},
                                                      {"--light-size", "1e39"},
                                                      {"--light-size", "nan"},
                                                      {"--light-size", "0", "--light-size", "facing=0,0,0"},
                                                      {"--light-size", "facing=up", "--light-size", "1"},
                                                      {"--paper", "soft-solver=best"},
                                                      {"--paper", "soft-grouping=pixel"},
                                                      {"--paper", "soft-choice=first"},
                                                      {"--paper", "samples=depth", "--shadows", "soft"},
                                                      {"--paper", "samples=depth", "--ao", "rays"},
                                                      {"--paper", "cull=front", "--shadows", "soft"},
                                                      {"--ao", "yes"},
                                                      {"--paper", "ao-at=faces"},
                                                      {"--paper", "ao-layout=grid"},
                                                      {"--ao-rays", "0"},
                                                      {"--ao-distance", "0"},
                                                      {"--ao-distance", "far"},
                                                      {"--paper", "ao-positions=-1"},
                                                      {"--paper", "ao-directions=32x"},
                                                      {"--paper", "ao-directions=32x32x32"},
                                                      {"--paper", "ao-directions=-8x-8"},
                                                      {"--paper", "ao-directions=100000x100000"},
                                                      {"--paper", "ao-bits=16"},
                                                      {"--paper", "ao-deforming=maybe"},
                                                      {"--ao-cache", ""},
                                                      {"--config", "no.cfg"},
                                                      {"--log"},
                                                      {"--bias", "0.1"},
                                                      {"-o", "moving.gltf/b.png"},
                                                      {"-o", "moving.gltf/a.png"}};
  for (const auto& option : options) {
    std::vector<std::string> arguments{"render", "SCENE", "--quiet"};
    arguments.insert(arguments.end(), option.begin(), option.end());
    uses.push_back({arguments, option[0]});
  }
  uses.back().named = uses[uses.size() - 2].named = "folder";
  return uses;
}

INSTANTIATE_TEST_SUITE_P(Program, BadOptions, ::testing::ValuesIn(bad_uses()), [](const auto& use) {
  std::string name = std::to_string(use.index);
  for (const std::string& argument : use.param.arguments) {
    name += "_";
    for (const char c : argument)
      name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? std::string(1, c) : "";
  }
  return name;
});

TEST(Program, EndsSilentlyWithItsReaderAndSaysWhenADiskIsFull) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const auto closed = tenebra({"info", scene}, [] {
    int ends[2];
    if (::pipe(ends) != 0) ::_exit(99);
    ::close(ends[0]);
    ::dup2(ends[1], STDOUT_FILENO);
  });
  EXPECT_EQ(closed.exit_code, 141);
  EXPECT_EQ(closed.errors, "");

  const auto full = tenebra({"info", scene}, [] {
    const int device = ::open("/dev/full", O_WRONLY);
    if (device < 0) ::_exit(99);
    ::dup2(device, STDOUT_FILENO);
  });
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_TRUE(is_one_sentence(full.errors)) << full.errors;
}

TEST(Program, EndsInASentenceWithoutMemory) {
  // A sanitizer reserves terabytes of addresses before main().
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need more address space than this test leaves";
#endif
  const TemporaryFolder folder;
  constexpr int side = 8192;  // 64 MiB decoded
  ASSERT_TRUE(io::write_png(folder / "large.png", {side, side, 1, std::vector<std::uint8_t>(side * side)}));
  for (const rlim_t limit_mib : {100, 150, 200, 250}) {
    const auto result = tenebra({"compare", folder / "large.png", folder / "large.png"}, [&] {
      const rlimit bound{limit_mib << 20, limit_mib << 20};
      ::setrlimit(RLIMIT_AS, &bound);
    });
    EXPECT_EQ(result.exit_code, 2) << limit_mib;
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
    EXPECT_NE(result.errors.find("memory"), std::string::npos) << result.errors;
  }
}

}  // namespace
}  // namespace tenebra::testing
