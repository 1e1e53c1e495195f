#include "bench/paper/paper_claims.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace tenebra::bench {
namespace {

std::string markdown_table(const Rows& rows) {
  std::string text;
  for (const auto& row : rows) {
    text += '|';
    for (const std::string& cell : row) text += ' ' + cell + " |";
    text += '\n';
    if (&row != &rows.front()) continue;
    text += '|';
    for (std::size_t c = 0; c < row.size(); ++c) text += "---|";
    text += '\n';
  }
  return text + '\n';
}

}  // namespace

const char* verdict_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::holds:
      return "true";
    case Verdict::fails:
      return "false";
    case Verdict::not_here:
      return "not testable here";
  }
  return "";
}

const Claim* find_claim(const std::vector<Claim>& claims, const std::string& id) {
  const auto found = std::find_if(claims.begin(), claims.end(), [&](const Claim& c) { return c.id == id; });
  return found == claims.end() ? nullptr : &*found;
}

std::string section_text(const PaperSection& section, const std::string& made_by) {
  Rows claims{{"where", "the paper says", "here", "found"}};
  for (const Claim& c : section.claims)
    claims.push_back({c.where, c.says, fmt::format("**{}**", verdict_text(c.verdict)), c.found});
  std::string text = fmt::format("## {}\n\n{}\n\n{}\n\n", section.title, made_by, section.setup);
  if (!section.claims.empty()) text += markdown_table(claims);
  for (const auto& [name, svg] : section.plots)
    text += fmt::format("<img src=\"papers_{}.svg\" alt=\"{}\" width=\"49%\"/>\n", name, name);
  if (!section.plots.empty()) text += '\n';
  for (const auto& [title, rows] : section.tables)
    text += fmt::format("{}:\n\n{}", title, markdown_table(rows));
  return text;
}

std::string counted(double count) {
  const std::string digits = fmt::format("{:.0f}", std::abs(std::round(count)));
  std::string text = count < 0 ? "-" : "";
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

}  // namespace tenebra::bench
