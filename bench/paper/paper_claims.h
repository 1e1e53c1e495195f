// What the three papers claim, and what Tenebra's code says of it: the rows of docs/papers.md.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/common/bench_report.h"

namespace tenebra::bench {

enum class Verdict { holds, fails, not_here };

/// A sentence of a paper and what was found. A verdict follows from the figures in `found`, never from what
/// was expected.
struct Claim {
  std::string id;     ///< "olsson.sorting_visits_fewer_nodes"; stays when the wording changes
  std::string where;  ///< "Figure 6(a)"
  std::string says;   ///< the claim in our words
  Verdict verdict = Verdict::not_here;
  std::string found;  ///< figures, or why there are none
};

/// All of one paper that was run.
struct PaperSection {
  std::string title;  ///< of the section on the page
  std::string setup;  ///< what was run, on what, and where that differs from the paper; Markdown
  std::vector<Claim> claims;
  std::vector<std::pair<std::string, Rows>> tables;        ///< title and rows
  std::vector<std::pair<std::string, std::string>> plots;  ///< name and SVG
};

/// "true", "false", "not testable here".
const char* verdict_text(Verdict verdict);
inline Verdict verdict_of(bool holds) {
  return holds ? Verdict::holds : Verdict::fails;
}

/// The claim of that id; null: there is none.
const Claim* find_claim(const std::vector<Claim>& claims, const std::string& id);

/// The section as Markdown: its title, the sentence `made_by`, then the rest.
std::string section_text(const PaperSection& section, const std::string& made_by);

/// A count with commas: "1,234,567".
std::string counted(double count);

}  // namespace tenebra::bench
