#include "log/log_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <system_error>

#include "base/fail.h"

namespace tenebra::viewer {
namespace {

constexpr std::uintmax_t largest_log_bytes = std::uintmax_t{1} << 30;

/// A comment line "# name: value"; without a colon all of it is the name.
render::LogSetting setting_of(std::string_view line) {
  line.remove_prefix(std::min<std::size_t>(line.starts_with("# ") ? 2 : 1, line.size()));
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return {std::string(line), ""};
  std::string_view value = line.substr(colon + 1);
  if (value.starts_with(' ')) value.remove_prefix(1);
  return {std::string(line.substr(0, colon)), std::string(value)};
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t at = 0;;) {
    const std::size_t comma = line.find(',', at);
    fields.push_back(line.substr(at, comma - at));
    if (comma == std::string_view::npos) return fields;
    at = comma + 1;
  }
}

/// Text of a file that may hold any bytes, for a sentence.
std::string shown(std::string_view text) {
  std::string shown(text.substr(0, 40));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return shown;
}

/// A list of stages, which is kept as text: letters, so neither a number nor a damaged one.
bool is_list(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return (c >= 'a' && c <= 'z') || c == '_' || c == ' '; });
}

/// Reads line after line into a LogFile.
class LogParser {
public:
  explicit LogParser(LogFile& log) : log_(log) {}

  Expected<void> add(std::string_view line) {
    ++number_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty()) return {};
    if (line.starts_with('#')) {
      add_comment(setting_of(line));
      return {};
    }
    if (log_.columns.empty()) return add_header(line);
    if (line == header_) {  // logs written one after the other
      opens_ = true;
      return {};
    }
    return add_row(line);
  }

private:
  void add_comment(render::LogSetting comment) {
    constexpr std::string_view changed = "from here on ";
    if (comment.name.find_first_not_of(' ') == std::string::npos) return;  // as logs before 0.3 have them
    if (log_.columns.empty()) return log_.settings.push_back(std::move(comment));
    if (!comment.name.starts_with(changed)) return notes_.push_back(std::move(comment));
    opens_ = true;  // another process went on
    comment.name.erase(0, changed.size());
    log_.settings.push_back(std::move(comment));
  }

  Expected<void> add_header(std::string_view line) {
    header_ = line;
    for (const std::string_view field : fields_of(line)) log_.columns.emplace_back(field);
    if (log_.columns.front() == "frame" && log_.column("total_ms")) return {};
    return base::fail("{}: line {}: found '{}', expected the header of a frame log: frame,...,total_ms,...",
                      log_.name, number_, shown(line));
  }

  Expected<void> add_row(std::string_view line) {
    const auto fields = fields_of(line);
    if (fields.size() != log_.columns.size()) {
      return base::fail("{}: line {}: found {} values, expected the {} of the header", log_.name, number_,
                        fields.size(), log_.columns.size());
    }
    LoggedFrame row;
    row.row = line;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      double value = 0;
      const bool lists = std::find(render::list_columns.begin(), render::list_columns.end(),
                                   log_.columns[i]) != render::list_columns.end();
      if (lists && is_list(fields[i])) {
        row.values.push_back(0);
        continue;
      }
      const auto [end, error] = std::from_chars(fields[i].begin(), fields[i].end(), value);
      if (lists || error != std::errc() || end != fields[i].end() || !std::isfinite(value)) {
        return base::fail("{}: line {}: found '{}' as {}, expected {}", log_.name, number_, shown(fields[i]),
                          log_.columns[i], lists ? "names of stages" : "a number");
      }
      row.values.push_back(value);
    }
    constexpr double largest_frame = 1e9;
    if (!(row.values[0] >= 0 && row.values[0] <= largest_frame) ||
        row.values[0] != std::floor(row.values[0])) {
      return base::fail("{}: line {}: found frame {}, expected a whole number from 0", log_.name, number_,
                        shown(fields[0]));
    }
    row.frame = static_cast<int>(row.values[0]);
    row.opens_chunk = std::exchange(opens_, false);
    for (render::LogSetting& note : notes_) {
      row.opens_chunk |= note.name == chunk_comment || note.name == "resumed";
      if (note.name != chunk_comment) row.notes.push_back(std::move(note));
    }
    notes_.clear();
    log_.frames.push_back(std::move(row));
    return {};
  }

  LogFile& log_;
  std::string header_;
  std::vector<render::LogSetting> notes_;
  int number_ = 0;
  bool opens_ = true;
};

/// Marks the frames whose distance from the one before is not the usual: the smallest in the log.
void mark_jumps(std::vector<LoggedFrame>& frames) {
  const auto distance = [&](std::size_t i) { return frames[i].frame - frames[i - 1].frame; };
  int step = 0;
  for (std::size_t i = 1; i < frames.size(); ++i)
    if (distance(i) > 0 && (step == 0 || distance(i) < step)) step = distance(i);
  for (std::size_t i = 1; i < frames.size(); ++i)
    if (distance(i) != step) frames[i].opens_chunk = true;
}

}  // namespace

std::optional<std::size_t> LogFile::column(std::string_view name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

std::string LogFile::setting(std::string_view name) const {
  const auto found = std::find_if(settings.begin(), settings.end(),
                                  [&](const render::LogSetting& setting) { return setting.name == name; });
  return found == settings.end() ? "" : found->value;
}

Expected<LogFile> parse_log(const std::string& name, std::string_view text) {
  LogFile log;
  log.name = name;
  LogParser parser(log);
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) {
      log.remarks.push_back(fmt::format("{} ends in the middle of a line, which is left out", name));
      break;
    }
    if (auto added = parser.add(text.substr(0, end)); !added) return tl::unexpected(added.error());
    text.remove_prefix(end + 1);
  }
  if (log.columns.empty()) return base::fail("{}: found no header line, expected a frame log", name);
  if (log.setting(merged_comment).empty()) mark_jumps(log.frames);
  return log;
}

Expected<LogFile> read_log(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return base::fail("cannot read {}: no such file", path.string());
  if (!std::filesystem::is_regular_file(status))
    return base::fail("cannot read {}: not a regular file", path.string());
  if (std::filesystem::file_size(path, error) > largest_log_bytes || error)
    return base::fail("cannot read {}: larger than any frame log (1 GiB)", path.string());
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) return base::fail("cannot read {}", path.string());
  return parse_log(path.string(), text);
}

void keep_last_rows(LogFile& log) {
  std::map<int, std::size_t> last;
  for (std::size_t i = 0; i < log.frames.size(); ++i) last[log.frames[i].frame] = i;
  const std::size_t twice = log.frames.size() - last.size();
  if (twice == 0) return;
  std::vector<LoggedFrame> kept;
  for (std::size_t i = 0; i < log.frames.size(); ++i)
    if (last[log.frames[i].frame] == i) kept.push_back(std::move(log.frames[i]));
  log.frames = std::move(kept);
  log.remarks.push_back(fmt::format(
      "{}: {} rows are of frames that were drawn again: the last one of each counts", log.name, twice));
}

}  // namespace tenebra::viewer
