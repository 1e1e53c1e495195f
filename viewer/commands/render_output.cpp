#include "commands/render_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/fail.h"
#include "commands/exr_output.h"
#include "commands/render_identity.h"
#include "io/file_hash.h"
#include "io/output_file.h"
#include "io/stream_writer.h"
#include "render/mask_colour.h"
#include "shared/render_files.h"

namespace tenebra::viewer {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& file) {
  std::error_code none;
  return fs::exists(file, none);
}

/// A hash of what files hold. One that cannot be read makes it differ from any that was listed, so that the
/// frame is drawn again.
std::string hash_of(const std::vector<OutputName>& files) {
  std::string hashes;
  for (const OutputName& output : files) hashes += io::file_hash(output.file).value_or("none") + "\n";
  return io::text_hash(hashes);
}

/// What a log that is continued does not say yet: another machine, other frames.
std::vector<render::LogSetting> changes(const render::LogPast& past,
                                        std::span<const render::LogSetting> settings) {
  std::vector<render::LogSetting> changed;
  const auto noted = [&](const render::LogSetting& setting) {
    return std::ranges::any_of(past.now, [&](const render::LogSetting& old) {
      return old.name == setting.name && old.value == setting.value;
    });
  };
  for (const render::LogSetting& setting : settings)
    if (!noted(setting)) changed.push_back({"from here on " + setting.name, setting.value});
  return changed;
}

/// Rounded to levels, each 1/255 of white, 255 at most.
io::Image8 error_levels(const io::ImageF& errors) {
  io::Image8 out{errors.width, errors.height, 1, {}};
  for (const float error : errors.pixels)
    out.pixels.push_back(static_cast<std::uint8_t>(std::min(std::round(error), 255.0f)));
  return out;
}

}  // namespace

Expected<void> RenderOutput::open(std::vector<render::LogSetting> settings) {
  for (render::LogSetting& setting : settings)  // as they are read again
    setting = {render::on_one_line(setting.name), render::on_one_line(setting.value)};
  identity_ = identity_of(settings);
  settings.push_back({"settings_hash", io::text_hash(render::log_head(identity_, ""))});
  if (auto opened = open_done_list(identity_); !opened) return opened;
  if (!options_.log.empty())
    if (auto opened = open_log(settings, identity_); !opened) return opened;
  std::ranges::sort(logged_);
  left_ = find_frames_left();
  if (goes_on_ && !left_.empty())
    if (auto noted = log_->comment({"resumed", fmt::format("with frame {}", left_.front().frame)}); !noted)
      return noted;
  // A trace is of one run; where nothing is left to do, the last one's stays.
  if (!options_.trace.empty() && !left_.empty()) {
    auto trace = render::FrameTrace::create(options_.trace, settings);
    if (!trace) return tl::unexpected(trace.error());
    trace_.emplace(std::move(*trace));
  }
  return {};
}

/// A single picture needs no list, but a list that is there must not go on to claim what this render makes
/// untrue.
Expected<void> RenderOutput::open_done_list(std::span<const render::LogSetting> identity) {
  const auto path = DoneList::path_of(options_);
  const bool wanted = options_.resume || plan_.of_several_frames;
  if (!path || (!wanted && !is_there(*path))) return {};
  auto list = DoneList::open(*path, identity, options_.resume);
  if (!list) return tl::unexpected(list.error());
  done_.emplace(std::move(*list));
  return {};
}

Expected<void> RenderOutput::open_log(std::span<const render::LogSetting> settings,
                                      std::span<const render::LogSetting> identity) {
  auto log = render::FrameLog::open(options_.log);
  if (!log) return tl::unexpected(log.error());
  log_.emplace(std::move(*log));
  const auto past = options_.resume ? log_->past() : render::LogPast();
  if (!past) return tl::unexpected(past.error());
  if (past->whole_bytes == 0) return log_->begin(settings);
  if (auto same = check_same_identity(options_.log, *past, identity); !same) return same;
  if (!past->has_header) return base::fail("cannot go on with {}: found no log of frames", options_.log);
  logged_ = past->frames;
  if (auto kept = log_->go_on(*past); !kept) return kept;
  goes_on_ = true;
  for (const render::LogSetting& change : changes(*past, settings))
    if (auto noted = log_->comment(change); !noted) return noted;
  return {};
}

/// By the list, a frame's files must hold what was written; the log lists frames only.
bool RenderOutput::is_done(int frame) const {
  if (!options_.resume) return false;
  const std::vector<OutputName> files = files_of_frame(plan_, options_, frame);
  if (!std::ranges::all_of(files, [](const OutputName& output) { return is_there(output.file); }))
    return false;
  if (done_)
    if (const auto entry = done_->frames().find(frame); entry != done_->frames().end())
      return entry->second == hash_of(files);
  return std::ranges::binary_search(logged_, frame);
}

std::vector<PlannedFrame> RenderOutput::find_frames_left() const {
  std::vector<PlannedFrame> left;
  for (const PlannedFrame& frame : plan_.frames)
    if (!is_done(frame.frame)) left.push_back(frame);
  return left;
}

Expected<void> RenderOutput::write(const render::FrameRecord& record, double begin_ms,
                                   const render::FrameResult& result) {
  if (auto written = write_pictures({record.frame, record.time_s}, result); !written) return written;
  if (auto added = add_row(record, result.notes); !added) return added;
  if (trace_)
    if (auto added = trace_->add(record, begin_ms); !added) return added;
  ++frames_written_;
  if (!done_) return {};
  return done_->add(record.frame, hash_of(files_of_frame(plan_, options_, record.frame)));
}

Expected<void> RenderOutput::add_row(const render::FrameRecord& record,
                                     const std::vector<std::string>& notes) {
  if (!log_) return {};
  for (const std::string& note : notes)
    if (auto noted = log_->comment({"note", note}); !noted) return noted;
  return log_->add(record);
}

/// The picture comes last, and masks of emissive meshes, which files_of_frame leaves out, first: where the
/// files that are looked for are there, all are.
Expected<void> RenderOutput::write_pictures(const PlannedFrame& frame,
                                            const render::FrameResult& result) const {
  for (auto mask = result.masks.rbegin(); mask != result.masks.rend(); ++mask)
    if (auto written = write_masks(frame.frame, *mask); !written) return written;
  if (options_.pictures.to_pipe) return write_to_pipe(result.image);
  if (!options_.pictures.files) return {};
  const fs::path file = options_.pictures.files->file(frame.frame);
  if (options_.pictures.files->is_jpeg()) return io::write_jpeg(file, result.image);
  if (!options_.pictures.are_exr()) return io::write_png(file, result.image);
  const auto bytes = exr_of_frame(plan_, options_, identity_, frame, result);
  if (!bytes) return base::fail("cannot write {}: {}", file.string(), bytes.error().message);
  return io::write_file(file, *bytes);
}

Expected<void> RenderOutput::write_to_pipe(const io::Image8& image) const {
  if (options_.pictures.pipe_format == PipeFormat::rgb24) {
    const auto* const rows = reinterpret_cast<const char*>(image.pixels.data());
    return io::write_to_stdout({rows, image.pixels.size()}, &stop_);
  }
  const auto bytes = io::encode_png(image);
  if (!bytes) return base::fail("cannot write standard output: {}", bytes.error().message);
  return io::write_to_stdout(*bytes, &stop_);
}

Expected<void> RenderOutput::write_masks(int frame, const render::LightMask& mask) const {
  const std::string light = plan_.several_lights ? fmt::format("_L{}", mask.light) : "";
  for (const OutputPattern& pattern : options_.masks) {
    const auto file = pattern.file(frame, light);
    auto written =
        pattern.is_pfm() ? io::write_pfm(file, mask.visible_fraction) : io::write_png(file, mask.mask);
    if (!written) return written;
  }
  for (const OutputPattern& pattern : options_.mask_colours) {
    const auto file = pattern.file(frame, light);
    auto written = pattern.is_pfm() ? io::write_pfm(file, render::mask_colour(mask))
                                    : io::write_png(file, render::mask_colour8(mask));
    if (!written) return written;
  }
  for (const OutputPattern& pattern : options_.error_maps) {
    const auto file = pattern.file(frame, light);
    auto written =
        pattern.is_pfm() ? io::write_pfm(file, mask.error) : io::write_png(file, error_levels(mask.error));
    if (!written) return written;
  }
  return write_sample_masks(frame, light, mask);
}

Expected<void> RenderOutput::write_sample_masks(int frame, const std::string& light,
                                                const render::LightMask& mask) const {
  for (const OutputPattern& pattern : options_.mask_means) {
    const auto file = pattern.file(frame, light);
    auto written =
        pattern.is_pfm() ? io::write_pfm(file, mask.mean) : io::write_png(file, render::in_levels(mask.mean));
    if (!written) return written;
  }
  for (const OutputPattern& pattern : options_.mask_samples)
    for (std::size_t k = 0; k < mask.samples.size(); ++k) {
      const auto file = pattern.file(frame, fmt::format("{}_S{}", light, k));
      if (auto written = io::write_png(file, mask.samples[k]); !written) return written;
    }
  return {};
}

Expected<void> RenderOutput::finish() {
  if (log_)
    if (auto finished = log_->finish(); !finished) return finished;
  if (trace_)
    if (auto finished = trace_->finish(); !finished) return finished;
  return done_ ? done_->finish() : Expected<void>();
}

}  // namespace tenebra::viewer
