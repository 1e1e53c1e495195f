// docs/papers.md: every claim of the three papers with what was found. Each verdict and figure comes from the
// run that writes it.
#include <fmt/core.h>

#include <array>

#include "base/machine.h"
#include "bench/common/bench_page.h"
#include "bench/paper/paper_session.h"
#include "io/output_file.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

struct PagePart {
  const char *title, *part;  ///< the part that makes the section
};
constexpr std::array page_parts{PagePart{hard_title, "hard"}, PagePart{soft_title, "soft"},
                                PagePart{ao_title, "ao"}, PagePart{bart_title, "bart"}};

constexpr const char* page_head =
    "# What the papers claim, and what is found here\n"
    "\n"
    "Written by `tenebra-bench paper --docs docs`; edit `bench/paper`, not this file. `--only PART` "
    "writes one section anew and leaves the others as they are.\n"
    "\n"
    "A claim is **true** or **false** by the figures of the run that wrote its section, or **not testable "
    "here**, with the reason: milliseconds on a GPU of 2011 say nothing about another machine, but ratios "
    "and counts do. Verdicts that depend on times count times within 5 % as equal. Verdicts that depend on "
    "counts are checked by `tests/bench/paper/paper_test.cpp`, on small pictures of the bundled scenes, "
    "where they may differ from those below; times are in no test. Node: a test of a triangle with a node of "
    "the tree. Other words: [vocabulary](architecture.md#vocabulary).\n"
    "\n";

/// "Made by `tenebra-bench paper --only hard --quick` on AMD EPYC, 2 cores; 2 threads."
std::string made_by(const PaperSession& session, const char* part) {
  const int threads = session.options.threads;
  return fmt::format(
      "Made by `tenebra-bench paper --only {}{}{}{}` on {}; {} thread{}.{}", part,
      session.by_effort(" --tiny", " --quick", ""), threads == 0 ? "" : fmt::format(" --threads {}", threads),
      session.paper.stride == 0 ? "" : fmt::format(" --stride {}", session.paper.stride),
      base::machine_description(), thread_count(), thread_count() == 1 ? "" : "s",
      session.skipped.empty()
          ? ""
          : " BART was not there: the bundled scenes stand in for it. It is on its authors' page "
            "(www.cse.chalmers.se/~uffe/BART/); `--data FOLDER` names the folder that has "
            "robots, museum and kitchen.");
}

}  // namespace

Expected<void> write_paper_page(const PaperSession& session) {
  const std::filesystem::path path = session.paper.docs / "papers.md";
  const std::string before = read_page(path);
  std::string page = page_head;
  for (const auto& [title, part] : page_parts) {
    std::string text = section_of(before, title);
    if (text.empty())
      text =
          fmt::format("## {}\n\nNot made yet: `tenebra-bench paper --only {} --docs docs`.\n\n", title, part);
    for (const PaperSection& section : session.sections) {
      if (section.title != title) continue;
      text = section_text(section, made_by(session, part));
      for (const auto& [name, svg] : section.plots) {
        const auto plot = session.paper.docs / fmt::format("papers_{}.svg", name);
        if (auto written = io::write_file(plot, svg); !written) return written;
      }
    }
    while (text.ends_with('\n')) text.pop_back();
    page += text + "\n\n";
  }
  page.pop_back();
  return io::write_file(path, page);
}

}  // namespace tenebra::bench
