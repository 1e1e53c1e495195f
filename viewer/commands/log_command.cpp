// tenebra log: frame logs read again: merged, in numbers, as a page.
#include <algorithm>
#include <iterator>
#include <memory>

#include "base/fail.h"
#include "commands/command.h"
#include "io/output_file.h"
#include "log/log_merge.h"
#include "log/log_summary.h"
#include "log/report.h"
#include "shared/files_apart.h"
#include "shell/console.h"
#include "shell/stop_signals.h"

namespace tenebra::viewer {
namespace {

constexpr const char* log_examples =
    "Examples:\n"
    "  tenebra log summary out/frames.csv\n"
    "  tenebra log merge part0.csv part1.csv part2.csv -o frames.csv\n"
    "  tenebra log report before.csv after.csv -o report.html\n"
    "\n"
    "Logs are written by tenebra render --log. One left by a killed render counts up to its last whole row.";

constexpr const char* merge_examples =
    "Example:\n"
    "  tenebra log merge part0.csv part1.csv part2.csv -o frames.csv\n"
    "\n"
    "Logs of different settings or scenes are refused; machines and threads may differ. Rows are sorted by\n"
    "frame. Where a frame was drawn more than once, the last row given counts. First frames of the\n"
    "parts stay marked, by a comment line '# chunk: ...', so that percentiles still leave them out.";

constexpr const char* summary_examples =
    "Examples:\n"
    "  tenebra log summary out/frames.csv\n"
    "  tenebra log summary out/frames.csv --json\n"
    "\n"
    "The first frame of a chunk (where the log begins, frames jump, or the log says so) builds what later "
    "ones\n"
    "keep: percentiles leave it out. Percentiles are nearest ranks.";

constexpr const char* report_examples =
    "Examples:\n"
    "  tenebra log report out/frames.csv -o report.html\n"
    "  tenebra log report hard.csv soft.csv --pictures hard --pictures-b soft -o report.html\n"
    "\n"
    "The page is one file and needs no network. Pictures are looked for as DIR/%04d.png, or by a pattern\n"
    "like out/mask_%04d.png; at most 8 frames are shown, reduced in size.";

struct LogOptions {
  std::vector<std::string> logs;
  std::string a, b;
  std::string output;
  std::string pictures, pictures_b;
  bool json = false;
};

void print_remarks(const std::vector<std::string>& remarks) {
  for (const std::string& remark : remarks) print_error("note: {}.\n", remark);
}

/// A log to be summed up: each frame once.
Expected<LogFile> read_frames(const std::string& path) {
  auto log = read_log(path);
  if (!log) return log;
  keep_last_rows(*log);
  print_remarks(log->remarks);
  return log;
}

Expected<LogFile> read_and_note(const std::string& path) {
  auto log = read_log(path);
  if (log) print_remarks(log->remarks);
  return log;
}

Expected<int> merge(const LogOptions& options) {
  if (auto apart =
          check_files_apart({options.logs.begin(), options.logs.end()}, OutputName{"-o", options.output});
      !apart)
    return tl::unexpected(apart.error());
  std::vector<LogFile> logs;
  for (const std::string& path : options.logs) {
    auto log = read_and_note(path);
    if (!log) return tl::unexpected(log.error());
    logs.push_back(std::move(*log));
  }
  const auto merged = merge_logs(logs);
  if (!merged) return tl::unexpected(merged.error());
  print_remarks(merged->remarks);
  const StopSignals stop;
  if (auto written = io::write_file(options.output, merged->text); !written)
    return tl::unexpected(written.error());
  print_out("{} frames of {} logs in {}\n", merged->frames, logs.size(), options.output);
  return 0;
}

Expected<int> summary(const LogOptions& options) {
  const auto log = read_frames(options.a);
  if (!log) return tl::unexpected(log.error());
  const auto summary = summarize_log(*log);
  if (!summary) return tl::unexpected(summary.error());
  print_out("{}", options.json ? summary_json(*summary) : summary_text(*summary));
  return 0;
}

/// Numbers of the frames that every log has.
std::vector<int> common_frames(const std::vector<LogFile>& logs) {
  std::vector<std::vector<int>> frames;
  for (const LogFile& log : logs) {
    std::vector<int>& numbers = frames.emplace_back();
    for (const LoggedFrame& frame : log.frames) numbers.push_back(frame.frame);
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  }
  std::vector<int> common;
  std::set_intersection(frames.front().begin(), frames.front().end(), frames.back().begin(),
                        frames.back().end(), std::back_inserter(common));
  return common;
}

Expected<std::vector<PagePicture>> pictures_of(const LogOptions& options, const std::vector<LogFile>& logs) {
  if (options.pictures.empty()) return std::vector<PagePicture>{};
  const auto a = picture_pattern(options.pictures);
  if (!a) return base::fail("--pictures: {}", a.error().message);
  if (options.pictures_b.empty()) return page_pictures(common_frames(logs), *a, nullptr);
  const auto b = picture_pattern(options.pictures_b);
  if (!b) return base::fail("--pictures-b: {}", b.error().message);
  return page_pictures(common_frames(logs), *a, &*b);
}

Expected<int> report(const LogOptions& options) {
  std::vector<std::filesystem::path> inputs{options.a};
  if (!options.b.empty()) inputs.emplace_back(options.b);
  if (auto apart = check_files_apart(inputs, OutputName{"-o", options.output}); !apart)
    return tl::unexpected(apart.error());
  std::vector<LogFile> logs;
  for (const std::string& path : {options.a, options.b}) {
    if (path.empty()) continue;
    auto log = read_frames(path);
    if (!log) return tl::unexpected(log.error());
    logs.push_back(std::move(*log));
  }
  const auto pictures = pictures_of(options, logs);
  if (!pictures) return tl::unexpected(pictures.error());
  const auto page = report_page(logs, *pictures);
  if (!page) return tl::unexpected(page.error());
  const StopSignals stop;
  if (auto written = io::write_file(options.output, *page); !written) return tl::unexpected(written.error());
  print_out("{} KB in {}\n", (page->size() + 999) / 1000, options.output);
  return 0;
}

void add_merge(CLI::App& log, Run& run) {
  CLI::App& command = add_command(log, "merge", "Join the logs of a render's parts");
  const auto options = std::make_shared<LogOptions>();
  set_examples(command, merge_examples);
  add_files(command, "LOGS", options->logs, "Logs of one render, in any order").required();
  add_text(command, "-o,--output", options->output, "The log to write").type_name("FILE.csv").required();
  when_chosen(command, [options, &run] { run = [options] { return merge(*options); }; });
}

void add_summary(CLI::App& log, Run& run) {
  CLI::App& command = add_command(log, "summary", "Print medians, percentiles and the worst frame");
  const auto options = std::make_shared<LogOptions>();
  set_examples(command, summary_examples);
  add_text(command, "LOG", options->a, "A log").required();
  add_flag(command, "--json", options->json, "Print JSON");
  when_chosen(command, [options, &run] { run = [options] { return summary(*options); }; });
}

void add_report(CLI::App& log, Run& run) {
  CLI::App& command = add_command(log, "report", "Write a page: times over the animation, stages, pictures");
  const auto options = std::make_shared<LogOptions>();
  set_examples(command, report_examples);
  add_text(command, "A", options->a, "A log").required();
  add_text(command, "B", options->b, "Another, shown beside it");
  add_text(command, "-o,--output", options->output, "The page to write").type_name("FILE.html").required();
  const AddedOption pictures =
      add_text(command, "--pictures", options->pictures, "Pictures of A: their folder, or a pattern")
          .type_name("DIR|PATTERN");
  add_text(command, "--pictures-b", options->pictures_b, "Pictures of B, for a slider between the two")
      .type_name("DIR|PATTERN")
      .needs(pictures);
  when_chosen(command, [options, &run] { run = [options] { return report(*options); }; });
}

}  // namespace

void add_log_command(CLI::App& program, Run& run) {
  CLI::App& command = add_command(program, "log", "Merge frame logs, sum them up, make a page of them");
  set_examples(command, log_examples);
  add_merge(command, run);
  add_summary(command, run);
  add_report(command, run);
  when_chosen(command, [&run] {  // after the command within it, if one was given
    if (!run) run = [] { return base::fail("give a command: log merge, log summary or log report"); };
  });
}

}  // namespace tenebra::viewer
