// Numbers of a file of comma-separated values, by the names in its first line.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <tenebra/expected.h>

namespace tenebra::sun {

struct Columns {
  /// One for each name that was asked for, finite numbers; empty: the file has no such column.
  std::vector<std::vector<double>> values;
  std::size_t rows = 0;

  bool has(std::size_t column) const { return !values[column].empty(); }
};

/// Hands out the lines of a text without blanks around them, and counts them from 1. A byte order mark is
/// passed over.
class Lines {
public:
  explicit Lines(std::string_view text);
  std::optional<std::string_view> next();
  std::size_t number() const { return number_; }

private:
  std::string_view text_;
  std::size_t number_ = 0;
};

/// The whole text as a finite number; a plus may stand before it.
std::optional<double> finite_number(std::string_view text);

/// The cells of a line of comma-separated values, without blanks and quotes around them. A comma within
/// quotes belongs to its cell.
void split_cells(std::string_view line, std::vector<std::string_view>& cells);

/// Reads the columns of these names, in lower or upper case; others may hold anything. Empty lines and lines
/// that begin with # are passed over. Refuses, by its line, a value that is no number; files without a row,
/// or of more than 1 GiB.
Expected<Columns> read_columns(const std::filesystem::path& file, std::span<const std::string_view> names);

}  // namespace tenebra::sun
