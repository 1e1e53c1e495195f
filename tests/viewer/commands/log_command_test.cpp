// tenebra log: logs merged, summed up, and as a page.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/image.h"
#include "log/log_merge.h"
#include "log/log_summary.h"
#include "log/page_text.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

using viewer::LogFile;

constexpr const char* header = "frame,time_s,raster_ms,total_ms,rays,nodes,lit_pixels\n";

/// Rows of frames first, first + step, ...: total_ms is `ms` + the frame's number, rays are 1000 + it.
std::string rows(int first, int last, int step = 1, double ms = 10) {
  std::string text;
  for (int frame = first; frame <= last; frame += step)
    text += fmt::format("{},{},1.5,{:.3f},{},7,3\n", frame, frame / 2.0, ms + frame, 1000 + frame);
  return text;
}

std::string log_text(const std::string& body, const std::string& shadows = "hard",
                     const std::string& machine = "one") {
  return "# machine: " + machine + "\n# scene: a.glb\n# shadows: " + shadows + "\n" + header + body;
}

LogFile parsed(const std::string& text, const std::string& name = "a.csv") {
  auto log = viewer::parse_log(name, text);
  EXPECT_TRUE(log) << log.error().message;
  return log ? std::move(*log) : LogFile{};
}

std::string refusal(const std::string& text) {
  const auto log = viewer::parse_log("a.csv", text);
  return log ? "" : log.error().message;
}

std::vector<int> first_frames(const LogFile& log) {
  std::vector<int> frames;
  for (const auto& frame : log.frames)
    if (frame.opens_chunk) frames.push_back(frame.frame);
  return frames;
}

TEST(LogFile, FindsWhereChunksBegin) {
  EXPECT_EQ(first_frames(parsed(log_text(rows(0, 9)))), std::vector<int>{0});
  EXPECT_EQ(first_frames(parsed(log_text(rows(0, 60, 20)))), std::vector<int>{0}) << "a step is no jump";
  EXPECT_EQ(first_frames(parsed(log_text(rows(0, 9) + rows(20, 29)))), (std::vector<int>{0, 20}));
  EXPECT_EQ(first_frames(parsed(log_text(rows(20, 29) + rows(0, 9)))), (std::vector<int>{20, 0}));
  EXPECT_EQ(first_frames(parsed(log_text(rows(0, 4) + header + rows(5, 9)))), (std::vector<int>{0, 5}))
      << "one log after the other";
  EXPECT_EQ(first_frames(parsed(log_text(rows(0, 4) + "# resumed: yes\n" + rows(5, 9)))),
            (std::vector<int>{0, 5}));
  EXPECT_EQ(first_frames(parsed(log_text(rows(0, 4) + "# note: slow\n" + rows(5, 9)))), std::vector<int>{0});
}

TEST(LogFile, ReadsWhatAResumedRenderLeaves) {
  const auto log =
      parsed(log_text(rows(0, 4) + "#      \n# from here on machine: two\n" + rows(5, 9) + "# \n#\n"));
  EXPECT_EQ(first_frames(log), (std::vector<int>{0, 5}));
  EXPECT_EQ(log.settings.back().name, "machine");
  EXPECT_EQ(log.settings.back().value, "two");
  for (const auto& frame : log.frames) EXPECT_TRUE(frame.notes.empty()) << "blank comments say nothing";
}

TEST(LogFile, OfAFrameDrawnAgainHasTheLastRowToBeSummedUp) {
  auto log = parsed(log_text(rows(0, 4) + "# resumed: with frame 2\n" + rows(2, 2) + rows(5, 6)));
  ASSERT_EQ(log.frames.size(), 8u);
  viewer::keep_last_rows(log);
  std::vector<int> frames;
  for (const auto& frame : log.frames) frames.push_back(frame.frame);
  EXPECT_EQ(frames, (std::vector<int>{0, 1, 3, 4, 2, 5, 6}));
  EXPECT_TRUE(log.frames[4].opens_chunk);
  ASSERT_EQ(log.remarks.size(), 1u);
  viewer::keep_last_rows(log);
  EXPECT_EQ(log.remarks.size(), 1u) << "nothing more to leave out";
}

TEST(LogFile, CountsUpToTheLastWholeRow) {
  const std::string whole = log_text(rows(0, 9));
  for (std::size_t cut = whole.size() - 30; cut < whole.size(); ++cut) {
    const auto log = parsed(whole.substr(0, cut));
    const bool between_rows = whole[cut - 1] == '\n';
    EXPECT_EQ(log.remarks.empty(), between_rows) << cut;
    for (const auto& frame : log.frames) EXPECT_EQ(frame.values.size(), 7u);
    EXPECT_GE(log.frames.size(), 8u);
  }
  EXPECT_EQ(parsed(log_text("")).frames.size(), 0u);
  EXPECT_EQ(parsed(log_text("0,0,1.5,1")).frames.size(), 0u);
}

TEST(LogFile, ReadsListsOfStages) {
  const auto with = [](std::string_view stages) {
    return fmt::format("frame,total_ms,not_needed,ran\n0,1.5,,{}\n", stages);
  };
  const auto log = parsed(with("evaluate ao_build"));
  ASSERT_EQ(log.frames.size(), 1u);
  EXPECT_EQ(log.frames[0].values, (std::vector<double>{0, 1.5, 0, 0}));
  for (const char* not_a_list : {"x1", "5"})
    EXPECT_EQ(refusal(with(not_a_list)),
              fmt::format("a.csv: line 2: found '{}' as ran, expected names of stages", not_a_list));
}

TEST(LogFile, NamesFileAndLineOfWhatIsNoLog) {
  EXPECT_EQ(refusal(log_text("0,0,1.5,10,1000,7\n")),
            "a.csv: line 5: found 6 values, expected the 7 of the header");
  EXPECT_EQ(refusal(log_text(rows(0, 2) + "3,0,1.5,fast,1000,7,3\n")),
            "a.csv: line 8: found 'fast' as total_ms, expected a number");
  for (const char* number : {"nan", "inf", "1e999", "1.5x", "", " 1", "+1", "\x01"}) {
    EXPECT_NE(refusal(log_text(fmt::format("0,0,1.5,{},1000,7,3\n", number))), "") << number;
  }
  for (const char* frame : {"-1", "0.5", "1e10"})
    EXPECT_NE(refusal(log_text(fmt::format("{},0,1.5,1,1000,7,3\n", frame))), "") << frame;
  EXPECT_NE(refusal(""), "");
  EXPECT_NE(refusal("# scene: a.glb\n"), "");
  EXPECT_NE(refusal("a,b\n1,2\n"), "");
  EXPECT_NE(refusal(std::string("\x89PNG\r\n\x1a\n\0\0\n", 11)), "");
}

TEST(LogSummary, LeavesFirstFramesOut) {
  const auto summary = viewer::summarize_log(parsed(log_text("5,0,1,9000,1,1,1\n" + rows(6, 8))));
  ASSERT_TRUE(summary);
  const auto& total = summary->times.back();
  EXPECT_EQ(total.name, "total_ms");
  EXPECT_EQ(total.values.count, 3u);
  EXPECT_EQ(total.values.median, 17);
  EXPECT_EQ(total.values.worst, 18);
  EXPECT_EQ(total.worst_frame, 8);
  EXPECT_EQ(summary->first_frames, std::vector<int>{5});
  EXPECT_EQ(summary->first_total_ms.worst, 9000);
  EXPECT_FALSE(summary->counts_first_frames);
  for (const auto& count : summary->counts) EXPECT_EQ(count.has_history, count.name == "nodes") << count.name;
}

TEST(LogSummary, CountsFirstFramesWhereThereAreNoOthers) {
  const auto summary = viewer::summarize_log(parsed(log_text(rows(3, 3))));
  ASSERT_TRUE(summary);
  EXPECT_TRUE(summary->counts_first_frames);
  EXPECT_EQ(summary->times.back().values.median, 13);
  EXPECT_FALSE(viewer::summarize_log(parsed(log_text("")))) << "no frame at all";
}

TEST(LogMerge, SortsByFrameAndKeepsWhatItKnows) {
  const std::vector<LogFile> parts{parsed(log_text(rows(5, 9), "hard", "two"), "b.csv"),
                                   parsed(log_text("# note: builds\n" + rows(0, 4)), "a.csv")};
  const auto merged = viewer::merge_logs(parts);
  ASSERT_TRUE(merged) << merged.error().message;
  EXPECT_EQ(merged->frames, 10u);
  EXPECT_TRUE(merged->remarks.empty());
  const auto log = parsed(merged->text);
  ASSERT_EQ(log.frames.size(), 10u);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(log.frames[static_cast<std::size_t>(i)].frame, i);
  EXPECT_EQ(first_frames(log), (std::vector<int>{0, 5})) << "though frames do not jump any more";
  EXPECT_EQ(log.frames[0].notes.size(), 1u);
  EXPECT_NE(merged->text.find("# machine: two\n# machine: one\n"), std::string::npos) << merged->text;
  EXPECT_NE(merged->text.find("# frames: 10, from 0 to 9, of 2 logs\n"), std::string::npos);

  const auto again = viewer::merge_logs(std::vector<LogFile>{log});
  ASSERT_TRUE(again);
  EXPECT_EQ(first_frames(parsed(again->text)), (std::vector<int>{0, 5})) << "a merged log merges as well";
}

TEST(LogMerge, OfAFrameDrawnTwiceTakesTheLastGiven) {
  const std::vector<LogFile> parts{parsed(log_text(rows(0, 5)), "a.csv"),
                                   parsed(log_text(rows(5, 7, 1, 20)), "b.csv")};
  const auto merged = viewer::merge_logs(parts);
  ASSERT_TRUE(merged);
  EXPECT_EQ(merged->frames, 8u);
  EXPECT_EQ(merged->remarks.size(), 1u);
  EXPECT_EQ(parsed(merged->text).frames[5].values[3], 25);
}

TEST(LogMerge, RefusesLogsOfDifferentRenders) {
  const auto why = [](const std::string& other) {
    const std::vector<LogFile> parts{parsed(log_text(rows(0, 5)), "a.csv"), parsed(other, "b.csv")};
    const auto merged = viewer::merge_logs(parts);
    return merged ? "" : merged.error().message;
  };
  EXPECT_EQ(why(log_text(rows(6, 9), "soft")),
            "a.csv and b.csv are logs of different renders: shadows is 'hard' in the first and 'soft' in the "
            "second");
  EXPECT_NE(why("# ao: field\n" + log_text(rows(6, 9))).find("ao is nothing in the first"),
            std::string::npos);
  EXPECT_NE(why("# machine: x\n# scene: a.glb\n# shadows: hard\nframe,total_ms\n6,1\n").find("columns"),
            std::string::npos);
  EXPECT_NE(why(log_text("5,2.5,1,15,1006,7,3\n")).find("frame 5 has rays 1005 in a.csv and 1006 in b.csv"),
            std::string::npos);
  EXPECT_EQ(why(log_text("5,2.5,1,15,1005,999,3\n")), "") << "nodes depend on the frames before";
  const std::string elsewhere = "# scene: /mnt/a.glb\n# input_files: 1, 77\n# shadows: hard\n";
  const std::vector<LogFile> hashed{
      parsed(elsewhere + header + rows(0, 1)),
      parsed("# scene: a.glb" + elsewhere.substr(elsewhere.find('\n')) + header + rows(2, 3))};
  EXPECT_TRUE(viewer::merge_logs(hashed)) << "the same files in another place";
}

TEST(PageText, EscapesWhatHtmlReadsAndEncodesAsTheStandardSays) {
  EXPECT_EQ(viewer::page_text("<a href=\"x\">&\n\x01\xff\xc3\xa4"),
            "&lt;a href=&quot;x&quot;&gt;&amp;&#10; \xef\xbf\xbd\xc3\xa4");
  EXPECT_EQ(viewer::base64(""), "");
  EXPECT_EQ(viewer::base64("f"), "Zg==");
  EXPECT_EQ(viewer::base64("fo"), "Zm8=");
  EXPECT_EQ(viewer::base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(viewer::base64("\xff\xfe\xfd"), "//79");
}

TEST(LogCommand, TakesWhatRenderWrites) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  for (const char* part : {"0:2", "3:5"}) {
    const auto drawn =
        tenebra({"render", scene, "--frames", part, "--size", "40x30", "-o", folder / "pictures/%04d.png",
                 "--log", folder / (std::string(part).substr(0, 1) + ".csv"), "--quiet"});
    ASSERT_EQ(drawn.exit_code, 0) << drawn.errors;
  }
  const auto merged = tenebra({"log", "merge", folder / "3.csv", folder / "0.csv", "-o", folder / "all.csv"});
  ASSERT_EQ(merged.exit_code, 0) << merged.errors;
  const auto summary = tenebra({"log", "summary", folder / "all.csv", "--json"});
  ASSERT_EQ(summary.exit_code, 0) << summary.errors;
  const auto json = nlohmann::json::parse(summary.output);
  EXPECT_EQ(json["frames"], 6);
  EXPECT_EQ(json["first_frames"]["frames"], (std::vector<int>{0, 3}));
  EXPECT_GT(json["times_ms"]["total"]["median"], 0);

  const auto text = tenebra({"log", "summary", folder / "all.csv"});
  EXPECT_NE(text.output.find("6 frames. Not counted above: 2 first of a chunk (0, 3)"), std::string::npos)
      << text.output;
  const auto report =
      tenebra({"log", "report", folder / "0.csv", folder / "all.csv", "--pictures", folder / "pictures",
               "--pictures-b", folder / "pictures/%04d.png", "-o", folder / "report.html"});
  ASSERT_EQ(report.exit_code, 0) << report.errors;
  const std::string page = read_text(folder / "report.html");
  EXPECT_EQ(page.find("http"), std::string::npos) << "no network";
  EXPECT_NE(page.find("data:image/png;base64,"), std::string::npos);
  EXPECT_NE(page.find("type=\"range\""), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
}

TEST(LogCommand, NeverWritesOverWhatItReads) {
  const TemporaryFolder folder;
  const std::string text = log_text(rows(0, 4)), path = folder / "a.csv";
  write_text(path, text);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"log", "report", path, "-o", path},
        {"log", "merge", path, path, "-o", path}}) {
    const auto result = tenebra(arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
    EXPECT_EQ(read_text(path), text);
  }
}

TEST(LogCommand, FailsInOneSentence) {
  const TemporaryFolder folder;
  write_text(folder / "a.csv", log_text(rows(0, 3)));
  write_text(folder / "soft.csv", log_text(rows(4, 6), "soft"));
  write_text(folder / "none.csv", log_text(""));
  const std::string a = folder / "a.csv", out = folder / "out.html";
  const std::vector<std::vector<std::string>> uses{
      {"log"},
      {"log", "paint"},
      {"log", "merge", "-o", out},
      {"log", "merge", a},
      {"log", "merge", a, folder / "soft.csv", "-o", out},
      {"log", "merge", a, folder / "missing.csv", "-o", out},
      {"log", "summary", folder.path()},
      {"log", "summary", folder / "none.csv"},
      {"log", "report", folder / "none.csv", "-o", out},
      {"log", "report", a, a, a, "-o", out},
      {"log", "report", a, "-o", out, "--pictures", folder.path()},
      {"log", "report", a, "-o", out, "--pictures", "a%s.png"},
      {"log", "report", a, "-o", out, "--pictures-b", folder.path()},
      {"log", "report", a, "-o", folder / "no/out.html"}};
  for (const auto& use : uses) {
    const auto result = tenebra(use);
    EXPECT_EQ(result.exit_code, 1) << fmt::format("{}", fmt::join(use, " "));
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
  }
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace tenebra::testing
