// The frame log and the trace, read back as a spreadsheet and a trace viewer do.
#include <fmt/core.h>

#include "render/log/frame_log.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <bit>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <sstream>

#include "render/log/stage_sets.h"
#include "render/log/trace_json.h"
#include "support/killed_writer.h"
#include "support/temporary_folder.h"

namespace tenebra {
namespace {

using nlohmann::json;
using testing::read_text;
using testing::TemporaryFolder;

/// A record in which every value is another one.
render::FrameRecord numbered_record(int frame) {
  render::FrameRecord record;
  record.frame = frame;
  record.time_s = frame / 3.0;
  double milliseconds = 1.125;
  for (const auto& stage : render::frame_stages) record.timings.*stage.value = milliseconds++;
  record.timings.total_ms = 100.5;
  std::uint64_t count = 1000;
  std::array<std::uint64_t, sizeof(TraceStats) / 8> counts;
  for (auto& value : counts) value = count++;
  record.stats = std::bit_cast<TraceStats>(counts);
  record.soft.groups = 77;
  record.ao.cache_cells = 78;
  record.stats.nodes = 0xffffffffffffffffu;
  return record;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

TEST(FrameLog, HeaderBeginsAsPromised) {
  const std::string promised =
      "frame,time_s,raster_ms,readback_ms,rays_ms,sort_ms,build_ms,traverse_ms,writeback_ms,composite_ms,"
      "total_ms,"
      "rays,triangles,nodes,leaf_tests,shadowed_pixels,";
  EXPECT_EQ(render::frame_log_header().substr(0, promised.size()), promised);
}

TEST(FrameLog, HasAColumnForEveryValueOfAFrame) {
  const std::size_t values = (sizeof(FrameTimings) + sizeof(TraceStats) + sizeof(SoftStats) +
                              sizeof(AoStats) + sizeof(render::AntialiasStats)) /
                             8;  // all doubles and 64-bit counts
  const auto names = split(render::frame_log_header());
  constexpr std::size_t of_record = 5;  // frame, time_s, soft_error, ao_error, tries
  EXPECT_EQ(names.size(), values + of_record + render::list_columns.size());
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << "no name twice";
}

// "`shaft_ms`, `init_ms`": the names in the first cells of the table below "## Columns".
TEST(FrameLog, EveryColumnStandsOnceInTheTableOfTheDocumentation) {
  std::istringstream page(
      read_text(std::filesystem::path(TENEBRA_SCENES_DIR).parent_path() / "docs" / "log.md"));
  std::vector<std::string> documented;
  bool in_table = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) in_table = line == "## Columns";
    if (!in_table || !line.starts_with("| `")) continue;
    std::istringstream names(line.substr(0, line.find('|', 1)));
    for (std::string between, name; std::getline(names, between, '`') && std::getline(names, name, '`');)
      documented.push_back(name);
  }
  auto logged = split(render::frame_log_header());
  std::sort(documented.begin(), documented.end());
  std::sort(logged.begin(), logged.end());
  EXPECT_EQ(documented, logged);
}

TEST(FrameLog, SaysWhichStagesTheSettingsAskedForAndTheFrameDidNotNeed) {
  render::RenderSettings settings;
  settings.shadows = render::ShadowMode::soft;
  settings.antialias = 4;
  render::FrameRecord record;
  record.asked = render::asked_stages(settings, false);
  record.timings.evaluate_ms = record.timings.raster_ms = record.timings.composite_ms = 1;
  record.timings.points_ms = record.timings.rays_ms = record.timings.build_ms = 1;
  record.timings.traverse_ms = record.timings.writeback_ms = record.timings.antialias_ms = 1;
  EXPECT_TRUE(render::frame_log_row(record).ends_with(
      ",shaft init query irradiance tint layer,"
      "evaluate raster points rays build traverse writeback composite antialias"))
      << render::frame_log_row(record);

  EXPECT_EQ(render::stage_names(render::asked_stages({}, true)),
            "evaluate raster readback points rays build traverse tint writeback composite layer");
  settings.soft_points = 8;
  settings.antialias = 1;
  EXPECT_EQ(render::stage_names(render::asked_stages(settings, false)),
            "evaluate raster points rays build traverse tint writeback composite layer");
  settings = {};
  settings.hard.variant = Variant::precise_seatp;
  settings.see_through = SeeThrough::cast;
  settings.ao.mode = AoMode::field;
  EXPECT_EQ(render::stage_names(render::asked_stages(settings, false)),
            "evaluate raster points ao_build ao rays sort build traverse writeback composite layer");
  settings.shadows = render::ShadowMode::none;
  settings.ao.mode = AoMode::none;
  EXPECT_EQ(render::stage_names(render::asked_stages(settings, false)), "evaluate raster composite layer");
}

TEST(FrameLog, ReadsBackAsASpreadsheetDoes) {
  const TemporaryFolder folder;
  const std::vector<render::LogSetting> settings{{"machine", "a, b"}, {"scene", "two\nlines.glb"}};
  auto log = render::FrameLog::create(folder / "frames.csv", settings);
  ASSERT_TRUE(log);
  ASSERT_TRUE(log->add(numbered_record(0)));
  ASSERT_TRUE(log->add(numbered_record(7)));
  ASSERT_TRUE(log->finish());

  std::istringstream stream(read_text(folder / "frames.csv"));
  std::vector<std::string> comments;
  std::vector<std::map<std::string, std::string>> rows;
  std::vector<std::string> names;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with('#')) {
      EXPECT_TRUE(names.empty()) << "comments stand above the header";
      comments.push_back(line);
    } else if (names.empty()) {
      names = split(line);
    } else {
      const auto fields = split(line);
      ASSERT_EQ(fields.size(), names.size());
      auto& row = rows.emplace_back();
      for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = fields[i];
    }
  }
  EXPECT_EQ(comments, (std::vector<std::string>{"# machine: a, b", "# scene: two lines.glb"}));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1]["frame"], "7");
  EXPECT_EQ(rows[1]["time_s"], "2.33333333");
  EXPECT_EQ(rows[0]["evaluate_ms"], "1.125");
  EXPECT_EQ(rows[0]["antialias_ms"],  // the last of the stages
            fmt::format("{:.3f}", 0.125 + static_cast<double>(render::frame_stages.size())));
  EXPECT_EQ(rows[0]["soft_groups"], "77");
  EXPECT_EQ(rows[0]["ao_cache_cells"], "78");
  EXPECT_EQ(rows[0]["total_ms"], "100.500");
  EXPECT_EQ(rows[0]["rays"], "1000");
  EXPECT_EQ(rows[0]["nodes"], "18446744073709551615");
}

TEST(FrameLog, HasEachRowOnceItIsAddedAndReportsAFullDevice) {
  const TemporaryFolder folder;
  {
    auto log = render::FrameLog::create(folder / "frames.csv", {});
    ASSERT_TRUE(log);
    EXPECT_EQ(read_text(folder / "frames.csv"), render::frame_log_header() + "\n");
    ASSERT_TRUE(log->add(numbered_record(0)));
    const std::string row = render::frame_log_row(numbered_record(0)) + "\n";
    EXPECT_TRUE(read_text(folder / "frames.csv").ends_with("\n" + row));
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "frames.csv")) << "a log that is dropped stays";
  EXPECT_FALSE(render::FrameLog::create(folder / "no/frames.csv", {}));
  // Linux has this device, which is always full; other systems, and some containers, do not.
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  EXPECT_FALSE(render::FrameLog::create("/dev/full", {}));
}

TEST(FrameLog, HasWholeLinesBeforeItsLastWhenKilledAtRandomTimes) {
  constexpr int kills = 60;
  const TemporaryFolder folder;
  const std::string header = render::frame_log_header(), row = render::frame_log_row(numbered_record(7));
  std::mt19937 random(3);
  for (int i = 0; i < kills; ++i) {
    const auto write = [&] {
      auto log = render::FrameLog::create(folder / "frames.csv", {});
      while (log && log->comment({"note", std::string(static_cast<std::size_t>(i), 'n')}) &&
             log->add(numbered_record(7))) {
      }
    };
    ASSERT_TRUE(testing::kill_while_it_writes(random, write)) << "the writer failed by itself";
    if (!std::filesystem::exists(folder / "frames.csv")) continue;
    const std::string text = read_text(folder / "frames.csv");
    const std::size_t whole_bytes = render::parse_log(text, header).whole_bytes;
    EXPECT_EQ(text.find('\n', whole_bytes), std::string::npos) << i;
    std::istringstream stream(text.substr(0, whole_bytes));
    for (std::string line; std::getline(stream, line);)
      ASSERT_TRUE(line == header || line == row || line.starts_with('#')) << line;
  }
}

TEST(FrameLog, GoesOnBehindItsLastWholeRow) {
  const TemporaryFolder folder;
  const std::vector<render::LogSetting> settings{{"machine", "a: b"}, {"size", "4x3"}};
  {
    auto log = render::FrameLog::create(folder / "frames.csv", settings);
    ASSERT_TRUE(log && log->add(numbered_record(5)) && log->add(numbered_record(6)) && log->finish());
  }
  testing::write_text(folder / "frames.csv", read_text(folder / "frames.csv") + "7,0.2");
  auto log = render::FrameLog::open(folder / "frames.csv");
  ASSERT_TRUE(log);
  const auto past = log->past();
  ASSERT_TRUE(past && past->has_header);
  EXPECT_EQ(past->frames, (std::vector<int>{5, 6}));
  ASSERT_EQ(past->settings.size(), 2u);
  EXPECT_EQ(past->settings[0].value, "a: b");
  EXPECT_EQ(past->settings[1].name, "size");
  ASSERT_TRUE(log->go_on(*past) && log->add(numbered_record(7)) && log->finish());
  const auto now = render::parse_log(read_text(folder / "frames.csv"), render::frame_log_header());
  EXPECT_EQ(now.frames, (std::vector<int>{5, 6, 7}));
}

TEST(FrameTrace, IsJsonWhoseStagesLieWithinTheirFrames) {
  const TemporaryFolder folder;
  const std::vector<render::LogSetting> settings{
      {"scene", "quote \" back \\ tab \t \xc3\xa4 \xff \xed\xa0\x80 \xf0\x9f\x8c\x92"}};
  auto trace = render::FrameTrace::create(folder / "trace.json", settings);
  ASSERT_TRUE(trace);
  render::FrameRecord short_total = numbered_record(1);
  short_total.timings.total_ms = 0.5;  // rounding of clocks must not break the nesting
  ASSERT_TRUE(trace->add(numbered_record(0), 10.0));
  ASSERT_TRUE(trace->add(short_total, 300.0));
  ASSERT_TRUE(trace->finish());

  const json parsed = json::parse(read_text(folder / "trace.json"));
  EXPECT_EQ(parsed[1]["args"]["scene"], "quote \" back \\ tab \t \xc3\xa4 ? ??? \xf0\x9f\x8c\x92");
  double frame_begin = 0;
  double frame_end = 0;
  double last_end = 0;
  std::vector<std::string> names;
  for (const json& event : parsed) {
    if (event["ph"] != "X") continue;
    const std::string name = event["name"];
    const double begin = event["ts"];
    const double end = begin + event["dur"].get<double>();
    if (name.starts_with("frame ")) {
      EXPECT_EQ(event["args"]["nodes"], 0xffffffffffffffffu);
      EXPECT_GE(begin, frame_end);
      frame_begin = last_end = begin;
      frame_end = end;
    } else {
      EXPECT_GE(begin, frame_begin);
      EXPECT_NEAR(begin, last_end, 1e-6);
      EXPECT_LE(end, frame_end + 1e-6);
      last_end = end;
    }
    names.push_back(name);
  }
  EXPECT_EQ(names.size(), 2 * (1 + render::frame_stages.size()));
  EXPECT_EQ(names.front(), "frame 0");
  EXPECT_EQ(names[1], "evaluate");
}

TEST(FrameTrace, IsWholeJsonWithoutFramesAndOmitsStagesThatDidNotRun) {
  const TemporaryFolder folder;
  auto trace = render::FrameTrace::create(folder / "trace.json", {});
  ASSERT_TRUE(trace);
  render::FrameRecord record;
  record.timings.raster_ms = 1;
  record.timings.total_ms = 2;
  ASSERT_TRUE(trace->add(record, 0));
  ASSERT_TRUE(trace->finish());
  EXPECT_EQ(json::parse(read_text(folder / "trace.json")).size(), 4u) << "process, settings, frame, raster";

  auto empty = render::FrameTrace::create(folder / "empty.json", {});
  ASSERT_TRUE(empty && empty->finish());
  EXPECT_TRUE(json::parse(read_text(folder / "empty.json")).is_array());
}

}  // namespace
}  // namespace tenebra
