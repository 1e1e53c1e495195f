#include "render/log/trace_json.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "render/log/stage_sets.h"

namespace tenebra::render {
namespace {

constexpr double us_per_ms = 1000.0;

/// Length of the well-formed UTF-8 sequence at the start of `text` (RFC 3629); 0 if there is none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0; };
  const auto continues = [&](std::size_t i) { return (byte(i) & 0xc0) == 0x80; };
  const int first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first < 0xe0 && continues(1)) return 2;
  const int second = byte(1);
  const bool second_is_short = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool second_is_beyond = (first == 0xed && second > 0x9f) || (first == 0xf4 && second > 0x8f);
  if (second_is_short || second_is_beyond || !continues(1) || !continues(2)) return 0;
  if (first >= 0xe0 && first < 0xf0) return 3;
  return first >= 0xf0 && first < 0xf5 && continues(3) ? 4 : 0;
}

/// A JSON string; bytes that are not UTF-8 (file names may hold any) become question marks.
std::string json_string(std::string_view text) {
  std::string json = "\"";
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const char c = text.front();
    if (length == 0) {
      json += '?';
    } else if (c == '"' || c == '\\') {
      json.append({'\\', c});
    } else if (static_cast<unsigned char>(c) < 0x20) {
      json += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      json.append(text.substr(0, length));
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return json + "\"";
}

std::string slice(std::string_view name, double begin_ms, double duration_ms, std::string_view arguments) {
  return fmt::format(
      "{{\"name\":\"{}\",\"cat\":\"frame\",\"ph\":\"X\",\"pid\":1,\"tid\":1,\"ts\":{:.3f},\"dur\":{:.3f},"
      "\"args\":{{{}}}}}",
      name, begin_ms * us_per_ms, duration_ms * us_per_ms, arguments);
}

std::string counts_of(const FrameRecord& record) {
  std::string text = fmt::format("\"time_s\":{:.9g}", record.time_s);
  for (const auto& column : count_columns)
    text += fmt::format(",\"{}\":{}", column.name, column.value(record));
  for (const auto& column : method_columns)
    text += fmt::format(",\"{}\":{}", column.name, column.value(record));
  for (const auto& column : estimate_columns)
    text += fmt::format(",\"{}\":{:.3f}", column.name, column.value(record));
  return text + fmt::format(",\"{}\":\"{}\"", list_columns[0],
                            stage_names(record.asked & ~stages_run(record.timings)));
}

/// Stages that took any time, and the frame around them: never shorter than their sum, so that slices nest.
std::string slices_of(const FrameRecord& record, double begin_ms) {
  std::string stages;
  double at_ms = begin_ms;
  for (const auto& stage : frame_stages) {
    const double duration_ms = record.timings.*stage.value;
    if (duration_ms <= 0) continue;
    stages += ",\n" + slice(stage.name, at_ms, duration_ms, "");
    at_ms += duration_ms;
  }
  const double total_ms = std::max(record.timings.total_ms, at_ms - begin_ms);
  return ",\n" + slice(fmt::format("frame {}", record.frame), begin_ms, total_ms, counts_of(record)) + stages;
}

}  // namespace

Expected<FrameTrace> FrameTrace::create(const std::filesystem::path& path,
                                        std::span<const LogSetting> settings) {
  auto file = io::Journal::open(path);
  if (!file) return tl::unexpected(file.error());
  std::string head =
      "[\n{\"name\":\"process_name\",\"ph\":\"M\",\"pid\":1,\"tid\":1,\"args\":{\"name\":\"tenebra\"}},\n"
      "{\"name\":\"settings\",\"ph\":\"i\",\"s\":\"g\",\"pid\":1,\"tid\":1,\"ts\":0,\"args\":{";
  for (const LogSetting& setting : settings) {
    head += (&setting == settings.data() ? "" : ",\n") + json_string(setting.name) + ":" +
            json_string(setting.value);
  }
  head += "}}";
  if (auto written = file->begin(head); !written) return tl::unexpected(written.error());
  return FrameTrace(std::move(*file));
}

Expected<void> FrameTrace::add(const FrameRecord& record, double begin_ms) {
  return file_.append(slices_of(record, begin_ms));
}

Expected<void> FrameTrace::finish() {
  if (auto written = file_.append("\n]\n"); !written) return written;
  return file_.finish();
}

}  // namespace tenebra::render
