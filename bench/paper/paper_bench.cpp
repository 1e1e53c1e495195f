// tenebra-bench paper: the figures and tables of the three papers by the papers' own methods, their claims
// with a verdict each, and the page of the documentation that tells it.
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <memory>

#include "base/fail.h"
#include "bench/common/bench_frame.h"
#include "bench/common/bench_scenes.h"
#include "bench/paper/paper_session.h"
#include "io/output_file.h"

namespace tenebra::bench {
namespace {

constexpr std::array parts{
    BenchPart<PaperSession>{"hard", measure_paper_hard}, BenchPart<PaperSession>{"soft", measure_paper_soft},
    BenchPart<PaperSession>{"ao", measure_paper_ao}, BenchPart<PaperSession>{"bart", measure_paper_bart}};
const std::span<const BenchPart<PaperSession>> all_parts(parts);

/// Before minutes of measuring, not after them.
Expected<void> check_paper(const PaperOptions& options) {
  if (options.stride < 0)
    return base::fail("--stride: found {}, expected 0 (by effort) or more", options.stride);
  if (options.docs.empty()) return {};
  std::error_code ignored;
  if (!std::filesystem::is_directory(options.docs, ignored))
    return base::fail("--docs: {} is not a folder, expected one to write papers.md to",
                      options.docs.string());
  const auto page = io::OutputFile::create(options.docs / "papers.md");
  return page ? Expected<void>() : tl::unexpected(page.error());
}

std::vector<LastLine> last_lines(const PaperSession& session) {
  std::array<double, 3> counts{};
  for (const PaperSection& section : session.sections)
    for (const Claim& claim : section.claims) ++counts[static_cast<std::size_t>(claim.verdict)];
  return {{"claims_true", counts[0], 0}, {"claims_false", counts[1], 0}, {"claims_untested", counts[2], 0}};
}

Expected<void> measure_papers(const PartsArguments& arguments, const PaperOptions& options) {
  if (auto fine = check_paper(options); !fine) return fine;
  PaperSession session(arguments);
  session.paper = options;
  if (auto done = measure_and_write(arguments, all_parts, session); !done) return done;
  if (!options.docs.empty()) {
    if (auto written = write_paper_page(session); !written) return written;
  }
  print_end("paper", session.skipped, last_lines(session));
  return {};
}

}  // namespace

std::string PaperSession::scene_of(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    std::unique_ptr<testing::TemporaryFolder> made;
    if (name == names.back() || !find_scene(bench_scene(name), bart_folder(options.data), made).empty())
      return name;
    skipped.push_back(skipped_sentence(name));
  }
  return {};
}

void PaperSession::finish(PaperSection section) {
  std::printf("\n%s\n", section.title.c_str());
  for (const Claim& c : section.claims)
    std::printf("  %-18s %s: %s\n%21s%s\n", verdict_text(c.verdict), c.where.c_str(), c.says.c_str(), "",
                c.found.c_str());
  for (const auto& [title, rows] : section.tables) print_table(title, rows);
  std::fflush(stdout);
  for (const auto& [name, svg] : section.plots) report.add_plot(name, svg);
  sections.push_back(std::move(section));
}

void add_paper_command(CLI::App& program, Run& run) {
  const auto options = std::make_shared<PaperOptions>();
  CLI::App& command = add_parts_command(
      program, run, {"paper", "Figures, tables and claims of the three papers, by their own methods"},
      part_names(all_parts),
      [options](const PartsArguments& arguments) { return measure_papers(arguments, *options); });
  command
      .add_option("--docs", options->docs,
                  "Write papers.md and its plots, the page of the documentation;\nwith --only the sections "
                  "of other parts stay as they are")
      ->type_name("FOLDER");
  command
      .add_option("--stride", options->stride,
                  "Take every Nth frame of an animation [8, with --quick 160;\n"
                  "of bart 1, with --quick 16]")
      ->type_name("N");
}

}  // namespace tenebra::bench
