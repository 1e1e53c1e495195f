#include "log/log_merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "base/fail.h"

namespace tenebra::viewer {
namespace {

using render::LogSetting;

/// Where and over which frames it ran, not what is drawn. Triangles are those of the first frame.
constexpr std::array<std::string_view, 13> settings_of_a_run{
    "machine", "threads", "simd",   "LP_NUM_THREADS", "frames",  "triangles",         "ao_cache",
    "warning", "note",    "merged", "chunk",          "resumed", "dropped_non_finite"};
/// Where files lie; where a log has the hash of what they hold, that counts.
constexpr std::array<std::string_view, 2> settings_of_a_place{"scene", "texture_path"};
constexpr std::string_view content_hash = "input_files";

/// Counts that follow from scene and settings alone: two rows of one frame have the same.
constexpr std::array<std::string_view, 5> certain_counts{"time_s", "rays", "triangles", "shadowed_pixels",
                                                         "lit_pixels"};

bool is_of_a_run(std::string_view name) {
  return std::find(settings_of_a_run.begin(), settings_of_a_run.end(), name) != settings_of_a_run.end();
}

/// Values by name, of what must be equal. A name may stand more than once.
std::map<std::string, std::vector<std::string>> what_is_drawn(const LogFile& log) {
  std::map<std::string, std::vector<std::string>> values;
  for (const LogSetting& setting : log.settings)
    if (!is_of_a_run(setting.name)) values[setting.name].push_back(setting.value);
  if (values.contains(std::string(content_hash)))
    for (const std::string_view name : settings_of_a_place) values.erase(std::string(name));
  return values;
}

std::string text_of(const std::map<std::string, std::vector<std::string>>& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? "nothing" : fmt::format("'{}'", fmt::join(found->second, "', '"));
}

Expected<void> check_same_render(const LogFile& first, const LogFile& other) {
  const auto a = what_is_drawn(first), b = what_is_drawn(other);
  std::set<std::string> names;
  for (const auto* values : {&a, &b})
    for (const auto& [name, value] : *values) names.insert(name);
  for (const std::string& name : names) {
    const std::string in_a = text_of(a, name), in_b = text_of(b, name);
    if (in_a != in_b) {
      return base::fail("{} and {} are logs of different renders: {} is {} in the first and {} in the second",
                        first.name, other.name, name, in_a, in_b);
    }
  }
  if (first.columns == other.columns) return {};
  const auto differ =
      std::mismatch(first.columns.begin(), first.columns.end(), other.columns.begin(), other.columns.end());
  const auto name_at = [](auto at, auto end) { return at == end ? std::string("no more") : *at; };
  return base::fail("{} and {} have different columns: {} in the first where the second has {}", first.name,
                    other.name, name_at(differ.first, first.columns.end()),
                    name_at(differ.second, other.columns.end()));
}

/// A row and the log that it stands in.
struct Place {
  const LogFile* log = nullptr;
  const LoggedFrame* frame = nullptr;
};

Expected<void> check_same_frame(const Place& a, const Place& b) {
  for (const std::string_view name : certain_counts) {
    const auto column = a.log->column(name);
    if (!column || a.frame->values[*column] == b.frame->values[*column]) continue;
    return base::fail("frame {} has {} {} in {} and {} in {}: these are logs of different renders",
                      a.frame->frame, name, a.frame->values[*column], a.log->name, b.frame->values[*column],
                      b.log->name);
  }
  return {};
}

/// What the logs say of where they ran: each different value once, in their order.
std::vector<LogSetting> settings_of(std::span<const LogFile> logs, const std::map<int, Place>& rows) {
  std::vector<LogSetting> list;
  for (const LogSetting& setting : logs.front().settings)
    if (!is_of_a_run(setting.name)) list.push_back(setting);
  std::set<std::pair<std::string, std::string>> known;
  for (const LogFile& log : logs)
    for (const LogSetting& setting : log.settings)
      if (is_of_a_run(setting.name) && setting.name != "frames" &&
          known.emplace(setting.name, setting.value).second)
        list.push_back(setting);
  if (!rows.empty()) {
    list.push_back({"frames", fmt::format("{}, from {} to {}, of {} logs", rows.size(), rows.begin()->first,
                                          rows.rbegin()->first, logs.size())});
  }
  for (const LogFile& log : logs) list.push_back({std::string(merged_comment), log.name});
  return list;
}

}  // namespace

Expected<MergedLog> merge_logs(std::span<const LogFile> logs) {
  MergedLog merged;
  std::map<int, Place> rows;
  std::size_t twice = 0;
  for (const LogFile& log : logs) {
    if (auto same = check_same_render(logs.front(), log); !same) return tl::unexpected(same.error());
    for (const LoggedFrame& frame : log.frames) {
      const Place here{&log, &frame};
      const auto [place, is_new] = rows.try_emplace(frame.frame, here);
      if (is_new) continue;
      if (auto same = check_same_frame(place->second, here); !same) return tl::unexpected(same.error());
      place->second = here;
      ++twice;
    }
  }
  const auto add_comment = [&](const LogSetting& setting) {
    merged.text += fmt::format("# {}: {}\n", setting.name, setting.value);
  };
  for (const LogSetting& setting : settings_of(logs, rows)) add_comment(setting);
  merged.text += fmt::format("{}\n", fmt::join(logs.front().columns, ","));
  for (const auto& [number, place] : rows) {
    if (place.frame->opens_chunk) add_comment({std::string(chunk_comment), "begins, in " + place.log->name});
    for (const LogSetting& note : place.frame->notes) add_comment(note);
    merged.text += place.frame->row + "\n";
  }
  merged.frames = rows.size();
  if (twice > 0) {
    merged.remarks.push_back(fmt::format(
        "{} rows are of frames that occur more than once: the last one given of each counts", twice));
  }
  return merged;
}

}  // namespace tenebra::viewer
