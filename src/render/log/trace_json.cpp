#include "render/log/trace_json.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "base/json_string.h"
#include "render/log/stage_sets.h"

namespace tenebra::render {
namespace {

constexpr double us_per_ms = 1000.0;

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
    head += (&setting == settings.data() ? "" : ",\n") + base::json_string(setting.name) + ":" +
            base::json_string(setting.value);
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
