#include "sun/columns.h"

#include <algorithm>
#include <string>

#include "base/fail.h"
#include "base/lower_case.h"
#include "base/number_in.h"
#include "io/input_file.h"

namespace tenebra::sun {
namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 30;

std::string_view trimmed(std::string_view text, std::string_view blanks = " \t\r") {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace

Lines::Lines(std::string_view text) : text_(text) {
  if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
}

std::optional<std::string_view> Lines::next() {
  if (text_.empty()) return std::nullopt;
  const std::size_t end = text_.find('\n');
  const std::string_view line = trimmed(text_.substr(0, end));
  text_.remove_prefix(end == text_.npos ? text_.size() : end + 1);
  ++number_;
  return line;
}

std::optional<double> finite_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  return base::finite_in(text);
}

void split_cells(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  std::size_t begin = 0, quotes = 0;
  for (std::size_t at = 0; at <= line.size(); ++at) {
    const bool ends = at == line.size() || (line[at] == ',' && quotes % 2 == 0);
    if (ends) {
      cells.push_back(trimmed(line.substr(begin, at - begin), " \t\r\""));
      begin = at + 1;
    } else if (line[at] == '"') {
      ++quotes;
    }
  }
}

Expected<Columns> read_columns(const std::filesystem::path& file, std::span<const std::string_view> names) {
  const auto text = io::read_file(file, most_bytes);
  if (!text) return tl::unexpected(text.error());
  Lines lines(*text);
  const auto next_row = [&] {
    auto line = lines.next();
    while (line && (line->empty() || line->starts_with('#'))) line = lines.next();
    return line;
  };
  std::vector<std::string_view> cells;
  split_cells(next_row().value_or(""), cells);
  std::vector<std::optional<std::size_t>> places;
  for (const std::string_view name : names) {
    const auto found =
        std::find_if(cells.begin(), cells.end(), [&](auto cell) { return base::lower_case(cell) == name; });
    places.push_back(found == cells.end() ? std::nullopt
                                          : std::optional(static_cast<std::size_t>(found - cells.begin())));
  }
  Columns columns{std::vector<std::vector<double>>(names.size()), 0};
  while (const auto line = next_row()) {
    split_cells(*line, cells);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!places[i]) continue;
      const std::string_view cell = *places[i] < cells.size() ? cells[*places[i]] : "";
      const auto number = finite_number(cell);
      if (!number)
        return base::fail("{}:{}: found {} for {}, expected a number", file.string(), lines.number(),
                          cell.empty() ? "nothing" : std::string(cell.substr(0, 40)), names[i]);
      columns.values[i].push_back(*number);
    }
    ++columns.rows;
  }
  if (columns.rows == 0)
    return base::fail("{}: found no row of numbers, expected a line of names and rows below it",
                      file.string());
  return columns;
}

}  // namespace tenebra::sun
