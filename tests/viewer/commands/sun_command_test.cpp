// tenebra sun: from a map's OBJ to each kind of file, and what is asked for wrongly.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "formats/import_scene.h"
#include "io/image.h"
#include "io/input_file.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

/// A floor and a wall in map coordinates. `between`: lines between their faces.
std::string write_map(const TemporaryFolder& folder, const std::string& between = "") {
  const std::string file = folder / "map.obj";
  std::ofstream(file) << "v 690000 5330000 500\nv 690020 5330000 500\nv 690020 5330020 500\n"
                         "v 690000 5330020 500\nv 690000 5330010 500\nv 690020 5330010 500\n"
                         "v 690020 5330010 504\nv 690000 5330010 504\nf 1 2 3 4\n"
                      << between << "f 5 6 7 8\n";
  return file;
}

std::vector<std::string> asked(const std::string& scene, std::vector<std::string> more) {
  std::vector<std::string> all{"sun",       scene,   "--up-axis",  "z",      "--place",
                               "48.1,11.6", "--day", "2026-06-21", "--step", "60"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST(SunCommand, FacesAsColoursAndTables) {
  const TemporaryFolder folder;
  const auto result =
      tenebra(asked(write_map(folder), {"-o", folder / "hours.glb", "--csv", folder / "new/hours.csv",
                                        "--json", folder / "hours.json", "--full", "16"}));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(result.output.starts_with("4 faces, 64 points, 16 suns, hours ")) << result.output;
  EXPECT_NE(result.output.find("colours: viridis, 0 to 16 hours"), std::string::npos) << result.output;
  const auto model = formats::import_scene(folder / "hours.glb");
  ASSERT_TRUE(model.has_value()) << model.error().message;
  EXPECT_EQ(model->meshes.at(0).colors.size(), 12u);
  const std::string csv = io::read_file(folder / "new/hours.csv", std::size_t{1} << 24).value();
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_TRUE(std::filesystem::exists(folder / "hours.json"));
}

TEST(SunCommand, TheGroundAsAPlanAndARaster) {
  const TemporaryFolder folder;
  const auto result =
      tenebra(asked(write_map(folder), {"--ground", "501", "--cell", "5", "--png", folder / "plan.png",
                                        "--tiff", folder / "plan.tif", "--epsg", "25832"}));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(result.output.starts_with("16 cells, ")) << result.output;
  EXPECT_TRUE(io::read_png(folder / "plan.png").has_value());
  EXPECT_TRUE(io::read_file(folder / "plan.tif", std::size_t{1} << 24).value().starts_with("II*"));
}

/// An hour of light from the south, of a place without a zone, and the sky's.
std::string write_weather(const TemporaryFolder& folder) {
  const std::string file = folder / "town.epw";
  std::ofstream out(file);
  out << "LOCATION,Town,-,X,TMY,1,48,0,0,500\n";
  for (int line = 2; line < 8; ++line) out << "COMMENTS\n";
  out << "DATA PERIODS,1,1,Data,Sunday,1/1,12/31\n"
         "2003,6,21,12,60,?,1,2,3,4,5,6,7,8,800,100\n2003,12,21,12,60,?,1,2,3,4,5,6,7,8,400,50\n";
  return file;
}

TEST(SunCommand, LightOfAWeatherFile) {
  const TemporaryFolder folder;
  const std::string csv = folder / "light.csv";
  const auto row = [&](std::vector<std::string> more) {
    std::vector<std::string> all{"sun",       write_map(folder, "o wall\n"),
                                 "--up-axis", "z",
                                 "--epw",     write_weather(folder),
                                 "--sky",     "tregenza",
                                 "--csv",     csv,
                                 "--ground",  "500",
                                 "--cell",    "8"};
    all.insert(all.end(), more.begin(), more.end());
    const auto result = tenebra(all);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    const std::string text = io::read_file(csv, std::size_t{1} << 24).value();
    return text.substr(text.find('\n') + 1);
  };
  const std::string whole = row({}), summer = row({"--days", "06-01:06-30"});
  EXPECT_NE(whole.find(",2,2003-06-21T11:30:00Z,2003-12-21T11:30:00Z,"), std::string::npos) << whole;
  EXPECT_NE(summer.find(",1,2003-06-21T11:30:00Z,2003-06-21T11:30:00Z\n"), std::string::npos) << summer;
  EXPECT_NE(row({"--no-cast", "wall"}).find(",0.15,2,"), std::string::npos) << "the open sky's light";
}

TEST(SunCommand, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  const std::string map = write_map(folder), csv = folder / "hours.csv", weather = write_weather(folder),
                    points = folder / "points.csv";
  std::ofstream(points) << "x,y,z\n690001,5330001,501\n";
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"sun", map, "--up-axis", "z", "--csv", csv}, "found no suns"},
      {{"sun", map, "--place", "48,11", "--day", "2026-06-21"}, "which axis is up"},
      {asked(map, {"--place", "100,11"}), "found the latitude 100"},
      {asked(map, {"--day", "2026-02-30"}), "2026-02-30"},
      {asked(map, {"--png", folder / "plan.png"}), "--png is for --ground"},
      {asked(map, {"--ground", "0", "--epsg", "25832"}), "--epsg is for --tiff"},
      {asked(map, {"--ground", "0", "--tiff", csv + ".tif", "--epsg", "4326"}), "which is in degrees"},
      {asked(map, {"-o", folder / "hours.png"}), "ends in .glb"},
      {asked(map, {"--points", ""}), "--points: found nothing"},
      {asked(map, {"--full", "3"}), "--full is for -o and --png"},
      {asked(map, {"--csv", map}), "map.obj"},
      {asked(map, {"--node", "tower"}), "found no node called tower"},
      {asked(map, {"--epw", weather}), "--epw excludes --place"},
      {{"sun", map, "--up-axis", "z", "--epw", map}, "found no LOCATION"},
      {{"sun", map, "--up-axis", "z", "--epw", weather, "--days", "2003-06-01:2003-06-30"}, "found years"},
      {{"sun", map, "--up-axis", "z", "--epw", weather, "--points", points}, "has no normal"},
      {{"sun", map, "--up-axis", "z", "--epw", weather, "--step", "90"}, "found 90 minutes"},
      {{"sun", map, "--up-axis", "z", "--epw", weather, "--days", "7:8"},
       "town.epw: found no hour of these --days"},
      {{"sun", map, "--up-axis", "z", "--suns", points, "--epw", weather}, "--suns excludes --epw"},
      {{"sun", map, "--up-axis", "z", "--suns", points, "--season", "wall=4:10"}, "found suns without days"},
      {asked(map, {"--season", "wall=4:10", "--sky", "tregenza", "--csv", csv}), "found no light of days"},
      {asked(map, {"--sky", "tregenza", "-o", folder / "hours.glb"}), "--sky without --epw is a column"},
      {asked(map, {"--sky", "tregenza", "--points", points, "--csv", csv}), "has no normal"},
      {{"sun", map, "--place", "48,11", "--days", "4:10"}, "found no year"},
      {{"sun", map, "--place", "48,11", "--days", "4"}, "--epw those of any, like 4:9 or 04-01:09-30"},
      {asked(map, {"--days", "4:10"}), "--day excludes --days"},
      {asked(map, {"--sky", "blue"}), "found blue, expected tregenza"},
      {asked(map, {"--season", "tree=4:10"}), "found no node called tree"},
      {asked(map, {"--season", "tree"}), "expected NODE=FIRST:LAST"}};
  for (const auto& [arguments, sentence] : cases) {
    const auto result = tenebra(arguments);
    EXPECT_NE(result.exit_code, 0) << sentence;
    EXPECT_NE(result.errors.find(sentence), std::string::npos) << result.errors;
  }
  EXPECT_FALSE(std::filesystem::exists(csv));
}

}  // namespace
}  // namespace tenebra::testing
