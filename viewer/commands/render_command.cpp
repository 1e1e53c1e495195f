// tenebra render: a scene file in, pictures, masks, a log and a trace out.
#include <fmt/core.h>
#include <array>
#include <chrono>
#include <memory>
#include <optional>

#include "commands/command.h"
#include "commands/render_log.h"
#include "options/config_file.h"
#include "parallel/job_queue.h"
#include "render/log/trace_json.h"
#include "render/mask_colour.h"
#include "shared/files_apart.h"
#include "shared/render_files.h"
#include "shared/render_plan.h"
#include "shared/scene_choice.h"
#include "shell/console.h"
#include "shell/progress.h"
#include "shell/stop_signals.h"

namespace tenebra::viewer {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

/// The files that grow with the frames.
struct Journals {
  std::optional<render::FrameLog> log;
  std::optional<render::FrameTrace> trace;

  Expected<void> open(const RenderOptions& options, std::span<const render::LogSetting> settings) {
    if (!options.log.empty()) {
      auto made = render::FrameLog::create(options.log, settings);
      if (!made) return tl::unexpected(made.error());
      log.emplace(std::move(*made));
    }
    if (!options.trace.empty()) {
      auto made = render::FrameTrace::create(options.trace, settings);
      if (!made) return tl::unexpected(made.error());
      trace.emplace(std::move(*made));
    }
    return {};
  }

  Expected<void> add(const render::FrameRecord& record, double begin_ms,
                     const std::vector<std::string>& notes) {
    if (log) {
      for (const std::string& note : notes) {
        if (auto noted = log->comment({"note", note}); !noted) return noted;
      }
      if (auto added = log->add(record); !added) return added;
    }
    return trace ? trace->add(record, begin_ms) : Expected<void>();
  }

  Expected<void> finish() {
    if (log) {
      if (auto finished = log->finish(); !finished) return finished;
    }
    return trace ? trace->finish() : Expected<void>();
  }
};

Expected<void> write_sample_masks(const RenderPlan& plan, const RenderOptions& options, int frame,
                                  const render::LightMask& mask) {
  const std::string light = plan.several_lights ? fmt::format("_L{}", mask.light) : "";
  for (const OutputPattern& pattern : options.mask_means) {
    const auto file = pattern.file(frame, light);
    auto written = pattern.is_pfm() ? base::write_pfm(file, mask.mean)
                                    : base::write_png(file, render::in_levels(mask.mean));
    if (!written) return written;
  }
  for (const OutputPattern& pattern : options.mask_samples) {
    for (std::size_t k = 0; k < mask.samples.size(); ++k) {
      const auto file = pattern.file(frame, fmt::format("{}_S{}", light, k));
      if (auto written = base::write_png(file, mask.samples[k]); !written) return written;
    }
  }
  return {};
}

Expected<void> write_pictures(const RenderPlan& plan, const RenderOptions& options, int frame,
                              const render::FrameResult& result) {
  if (options.pictures) {
    if (auto written = base::write_png(options.pictures->file(frame), result.image); !written) return written;
  }
  for (const OutputPattern& pattern : options.masks) {
    for (const render::LightMask& mask : result.masks) {
      const auto file = pattern.file(frame, plan.several_lights ? fmt::format("_L{}", mask.light) : "");
      auto written =
          pattern.is_pfm() ? base::write_pfm(file, mask.visible_fraction) : base::write_png(file, mask.mask);
      if (!written) return written;
    }
  }
  for (const render::LightMask& mask : result.masks)
    if (auto written = write_sample_masks(plan, options, frame, mask); !written) return written;
  for (const OutputPattern& pattern : options.mask_colours) {
    for (const render::LightMask& mask : result.masks) {
      const auto file = pattern.file(frame, plan.several_lights ? fmt::format("_L{}", mask.light) : "");
      auto written = pattern.is_pfm() ? base::write_pfm(file, render::mask_colour(mask))
                                      : base::write_png(file, render::mask_colour8(mask));
      if (!written) return written;
    }
  }
  return {};
}

Expected<void> prepare_folders(const RenderOptions& options) {
  std::vector<OutputPattern> patterns = options.masks;
  for (const auto* more : {&options.mask_colours, &options.mask_means, &options.mask_samples})
    patterns.insert(patterns.end(), more->begin(), more->end());
  if (options.pictures) patterns.push_back(*options.pictures);
  for (const OutputPattern& pattern : patterns) {
    if (auto prepared = pattern.prepare_folder(); !prepared) return prepared;
  }
  return {};
}

/// One render from the first frame to the last or to a signal. Files are written while the next frames are
/// computed, at most `most_waiting` frames behind.
class FrameLoop {
public:
  FrameLoop(const RenderPlan& plan, const RenderOptions& options) : plan_(plan), options_(options) {}

  Expected<void> run(StopSignals& stop) {
    auto raster = render::FrameRaster::create(options_.raster);
    if (!raster) return tl::unexpected(raster.error());
    render::Renderer renderer = render::Renderer::create(std::move(*raster), plan_.scene);
    if (plan_.environment) renderer.set_environment(*plan_.environment);
    if (!options_.scene.edits.materials.empty())
      renderer.set_materials(materials_of(plan_.scene, options_.scene.edits));
    FrameGeometry first_frame;
    evaluate_frame(plan_.scene, plan_.clip, plan_.frames.front().time_s, first_frame);
    const auto settings = describe_render(plan_, options_, raster_names(renderer.raster()), first_frame);
    if (auto opened = journals_.open(options_, settings); !opened) return opened;

    parallel::JobQueue files(most_waiting);
    Progress progress(static_cast<int>(plan_.frames.size()), options_.quiet);
    for (const PlannedFrame& frame : plan_.frames) {
      const auto drawn = draw(renderer, frame, progress, stop.flag(), files);
      if (!drawn && drawn.error().message == "stopped") break;
      if (!drawn) return drawn;
      progress.show(static_cast<int>(records_.size()));
      if (stop.caught() != 0) break;
    }
    if (auto written = files.finish(); !written) return written;
    return journals_.finish();
  }

  std::span<const render::FrameRecord> records() const { return records_; }

private:
  // Results that are still written, the one that is computed and the one that waits for room.
  static constexpr std::size_t most_waiting = 2, results = most_waiting + 2;

  Expected<void> draw(render::Renderer& renderer, const PlannedFrame& planned, Progress& progress,
                      const StopFlag& stop, parallel::JobQueue& files) {
    const auto begin = Clock::now();
    render::FrameResult& result = results_[records_.size() % results];
    evaluate_frame(plan_.scene, plan_.clip, planned.time_s, input_.geometry);
    apply_node_edits(plan_.scene, options_.scene.edits, input_.geometry);
    input_.lights = placed_lights(plan_.scene, options_.scene.edits, plan_.clip, planned.time_s);
    input_.view = view_of(plan_, options_.scene, planned.time_s, plan_.size);
    const double evaluate_ms = milliseconds(Clock::now() - begin);
    const auto on_progress = [&](std::string_view what, double done) { progress.show_building(what, done); };
    if (auto drawn = renderer.render_frame(input_, plan_.settings, result, on_progress, &stop); !drawn)
      return drawn;
    if (!options_.quiet) progress.print_notes(result.notes);

    render::FrameRecord record{planned.frame, planned.time_s, result.timings,  result.stats,
                               result.soft,   result.ao,      result.antialias};
    record.timings.evaluate_ms = evaluate_ms;
    record.timings.total_ms = milliseconds(Clock::now() - begin);
    records_.push_back(record);
    return files.add([this, record, begin, &result] { return write(record, begin, result); });
  }

  Expected<void> write(const render::FrameRecord& record, Clock::time_point begin,
                       const render::FrameResult& result) {
    // A row says that the frame's files are there.
    if (auto written = write_pictures(plan_, options_, record.frame, result); !written) return written;
    return journals_.add(record, milliseconds(begin - begin_), result.notes);
  }

  const RenderPlan& plan_;
  const RenderOptions& options_;
  const Clock::time_point begin_ = Clock::now();
  Journals journals_;
  render::FrameInput input_;
  std::array<render::FrameResult, results> results_;
  std::vector<render::FrameRecord> records_;
};

void print_summary(const RenderPlan& plan, const RenderOptions& options,
                   std::span<const render::FrameRecord> records) {
  print_out("{}", summary_table(records));
  print_out("{} of {} frames, {}x{} pixels", records.size(), plan.frames.size(), plan.settings.width,
            plan.settings.height);
  if (options.pictures) print_out(", pictures in {}", options.pictures->text());
  for (const OutputPattern& mask : options.masks) print_out(", masks in {}", mask.text());
  for (const OutputPattern& mask : options.mask_colours) print_out(", coloured masks in {}", mask.text());
  for (const OutputPattern& mask : options.mask_means) print_out(", means of masks in {}", mask.text());
  for (const OutputPattern& mask : options.mask_samples) print_out(", masks of samples in {}", mask.text());
  if (!options.log.empty()) print_out(", log in {}", options.log);
  if (!options.trace.empty()) print_out(", trace in {}", options.trace);
  print_out("\n");
}

Expected<int> render(const RenderOptions& options) {
  if (auto checked = check_render_options(options); !checked) return tl::unexpected(checked.error());
  const auto plan = plan_render(options);
  if (!plan) return tl::unexpected(plan.error());
  if (!options.quiet) {
    print_warnings(options.warnings);
    print_warnings(plan->scene.warnings);
  }
  if (auto prepared = prepare_folders(options); !prepared) return tl::unexpected(prepared.error());
  if (auto apart = check_files_apart(plan->inputs, files_of_render(*plan, options)); !apart)
    return tl::unexpected(apart.error());

  StopSignals stop;
  FrameLoop loop(*plan, options);
  if (auto done = loop.run(stop); !done) return tl::unexpected(done.error());
  if (!options.quiet) print_summary(*plan, options, loop.records());
  const bool stopped = loop.records().size() < plan->frames.size();
  if (stopped)
    print_error("tenebra: stopped after {} of {} frames\n", loop.records().size(), plan->frames.size());
  return stopped ? exit_code_of(stop.caught()) : 0;
}

}  // namespace

void add_render_command(CLI::App& program, Run& run) {
  CLI::App& command =
      add_command(program, "render", "Write pictures with shadows, masks and a log of frame times");
  const auto options = std::make_shared<RenderOptions>();
  add_render_options(command, *options);
  when_chosen(command, [options, &command, &run] {
    settle_quality(command, options->method);
    settle_render_options(*options);
    options->config = config_file_of(command);
    options->warnings = idle_method_options(command, options->method);
    run = [options] { return render(*options); };
  });
}

}  // namespace tenebra::viewer
