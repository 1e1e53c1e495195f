// tenebra render: a scene file in, pictures, masks, a log and a trace out.
#include <fmt/core.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>

#include "base/fail.h"
#include "commands/command.h"
#include "commands/frame_budget.h"
#include "commands/render_identity.h"
#include "commands/render_log.h"
#include "commands/render_output.h"
#include "io/output_file.h"
#include "io/stream_writer.h"
#include "options/config_file.h"
#include "options/memory_option.h"
#include "parallel/job_queue.h"
#include "render/log/stage_sets.h"
#include "shared/files_apart.h"
#include "shared/render_files.h"
#include "shared/render_plan.h"
#include "shell/console.h"
#include "shell/draw_limit.h"
#include "shell/exit_codes.h"
#include "shell/memory_limit.h"
#include "shell/progress.h"
#include "shell/stop_signals.h"

namespace tenebra::viewer {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

Expected<void> prepare_folders(const RenderOptions& options) {
  std::vector<OutputPattern> patterns = options.masks;
  for (const auto* more :
       {&options.mask_colours, &options.mask_means, &options.mask_samples, &options.error_maps})
    patterns.insert(patterns.end(), more->begin(), more->end());
  if (options.pictures.files) patterns.push_back(*options.pictures.files);
  for (const OutputPattern& pattern : patterns) {
    if (auto prepared = pattern.prepare_folder(); !prepared) return prepared;
    io::remove_stale_temporaries(pattern.file(0).parent_path());
  }
  const AoConfig& ao = options.method.render.ao;
  if (ao.mode != AoMode::none && !ao.cache.empty()) io::remove_stale_temporaries(ao.cache);
  return {};
}

/// One render from the first frame to the last or to a signal. Files are written while the next frames are
/// computed, at most `most_waiting` frames behind.
class FrameLoop {
public:
  FrameLoop(const RenderPlan& plan, const RenderOptions& options, StopSignals& stop)
      : plan_(plan),
        options_(options),
        stop_(stop),
        output_(plan, options, stop.flag()),
        choice_(budget_choice(plan.settings)),
        settings_(plan.settings) {
    if (!options.budget_ms || !choice_.any()) return;
    ladder_ = budget_ladder(options.method);
    budget_.emplace(*options.budget_ms, ladder_.size());
  }

  Expected<void> run() {
    auto session = open_session(plan_, options_);
    if (!session) return tl::unexpected(session.error());
    FrameGeometry first_frame;
    const session::StagedScene& staged = *plan_.staged;
    evaluate_frame(staged.scene, staged.clip, plan_.frames.front().time_s, first_frame);
    auto settings = describe_render(plan_, options_, raster_names(session->renderer().raster()), first_frame);
    const auto sources = describe_sources(plan_, options_);
    if (!sources) return tl::unexpected(sources.error());
    settings.insert(settings.end(), sources->begin(), sources->end());
    if (auto opened = output_.open(std::move(settings)); !opened) return opened;
    frames_ = output_.frames_left();
    stop_.be_orderly();

    parallel::JobQueue files(most_waiting);
    Progress progress(static_cast<int>(frames_.size()), options_.quiet);
    for (const PlannedFrame& frame : frames_) {
      const auto drawn = draw(*session, frame, progress, files);
      if (is_stop(drawn)) break;
      if (!drawn) return drawn;
      progress.show(static_cast<int>(drawn_.size()));
      if (stop_.exit_code() != 0) break;
    }
    auto written = files.finish();
    if (is_stop(written)) failed_to_write_ = false;  // a pipe that nobody reads
    if (written || is_stop(written)) written = output_.finish();
    failed_to_write_ = !written;
    return written;
  }

  /// Whether `run` failed because a file could not be written.
  bool failed_to_write() const { return failed_to_write_; }

  /// Of the frames that were drawn.
  std::span<const TimedFrame> drawn() const { return drawn_; }
  /// What --budget chose; "" without it.
  std::string taken_text() const {
    if (taken_.empty()) return "";
    const auto [least, most] = std::ranges::minmax(taken_);
    std::string text = errors_text(ladder_[least], choice_);
    if (least != most) text += fmt::format(" to {}", errors_text(ladder_[most], choice_));
    return fmt::format("--budget {:g}: {}\n", *options_.budget_ms, text);
  }
  std::size_t written() const { return output_.frames_written(); }
  /// The frames that were to be drawn.
  std::size_t frames() const { return frames_.size(); }

private:
  // Results that are being written, the one being computed and the one that waits for room.
  static constexpr std::size_t most_waiting = 2, results = most_waiting + 2;

  /// Draws the frame with settings_, from its time to the picture; what that took is in `result`.
  Expected<void> draw_once(session::Session& session, const PlannedFrame& planned, Progress& progress,
                           const StopFlag& stop, render::FrameResult& result) {
    begun_ = Clock::now();
    session.place(planned.time_s, plan_.rays(planned.time_s));
    const auto on_progress = [&](std::string_view what, double done) { progress.show_building(what, done); };
    return session.draw(settings_, result, on_progress, &stop);
  }

  /// The same with the smallest errors that fit into --budget.
  Expected<void> draw_within_budget(session::Session& session, const PlannedFrame& planned,
                                    Progress& progress, render::FrameResult& result) {
    std::vector<std::string> notes;  // of tries that are given up, too: each is said only once
    const auto draw = [&](std::size_t rung, double limit_ms) -> Expected<double> {
      set_errors(choice_, ladder_[rung], settings_);
      const DrawLimit limit(limit_ms, stop_.flag());
      auto drawn = draw_once(session, planned, progress, limit.flag(), tried_);
      if (!drawn && is_stop(drawn) && !stop_.flag().requested())
        return std::numeric_limits<double>::infinity();
      if (!drawn) return tl::unexpected(drawn.error());
      notes.insert(notes.end(), tried_.notes.begin(), tried_.notes.end());
      return tried_.timings.total_ms;
    };
    Clock::time_point kept_begun;
    const auto keep = [&] {
      std::swap(tried_, result);
      kept_begun = begun_;
    };
    if (auto drawn = budget_->draw(draw, keep); !drawn) return drawn;
    begun_ = kept_begun;
    set_errors(choice_, ladder_[budget_->rung()], settings_);
    result.notes = std::move(notes);
    if (!budget_->fits() && !said_nothing_fits_) {
      said_nothing_fits_ = true;
      result.notes.push_back(fmt::format(
          "--budget {:g}: nothing is as quick; the quickest, {}, takes {:.1f} ms in frame {}",
          *options_.budget_ms, errors_text(ladder_[budget_->rung()], choice_), budget_->ms(), planned.frame));
    }
    return {};
  }

  Expected<void> draw(session::Session& session, const PlannedFrame& planned, Progress& progress,
                      parallel::JobQueue& files) {
    render::FrameResult& result = results_[drawn_.size() % results];
    auto drawn = budget_ ? draw_within_budget(session, planned, progress, result)
                         : draw_once(session, planned, progress, stop_.flag(), result);
    if (!drawn) return drawn;
    if (!options_.quiet) progress.print_notes(result.notes);

    render::FrameRecord record{planned.frame, planned.time_s, result.timings,  result.stats,
                               result.soft,   result.ao,      result.antialias};
    record.asked = render::asked_stages(settings_, session.renderer().raster().is_gl());
    if (choice_.soft) record.soft_error = settings_.soft.error_255;
    if (choice_.ao) record.ao_error = settings_.ao.error_255;
    if (budget_) {
      record.tries = budget_->tries().size();
      taken_.push_back(budget_->rung());
      if (record.tries > 1)
        result.notes.push_back(
            fmt::format("tried for frame {}: {}", planned.frame, tries_text(*budget_, ladder_, choice_)));
    }
    drawn_.push_back({record.frame, record.timings});
    const double begin_ms = milliseconds(begun_ - begin_);
    auto added =
        files.add([this, record, begin_ms, &result] { return output_.write(record, begin_ms, result); });
    failed_to_write_ = !added;
    return added;
  }

  const RenderPlan& plan_;
  const RenderOptions& options_;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point begun_;  ///< the frame at hand; with --budget the try that is kept
  StopSignals& stop_;
  RenderOutput output_;
  std::vector<PlannedFrame> frames_;
  std::array<render::FrameResult, results> results_;
  std::vector<TimedFrame> drawn_;
  bool failed_to_write_ = false;

  BudgetChoice choice_;
  render::RenderSettings settings_;  ///< of the frame at hand
  std::vector<BudgetErrors> ladder_;
  std::optional<FrameBudget> budget_;  ///< none: no --budget, or nothing to choose
  render::FrameResult tried_;
  std::vector<std::size_t> taken_;  ///< of the ladder, by each frame
  bool said_nothing_fits_ = false;
};

/// Standard output is for messages, unless pictures go there.
std::FILE* messages_of(const RenderOptions& options) {
  return options.pictures.to_pipe ? stderr : stdout;
}

void print_summary(const RenderPlan& plan, const RenderOptions& options, std::span<const TimedFrame> frames,
                   std::size_t done_before) {
  std::FILE* const stream = messages_of(options);
  const bool still = plan.frames.size() == 1 && frames.size() == 1;
  if (!still) write_text(stream, summary_table(frames));
  const std::string size = fmt::format("{}x{} pixels", plan.settings.width, plan.settings.height);
  std::string text = still ? fmt::format("{} in {:.0f} ms", size, frames[0].timings.total_ms)
                           : fmt::format("{} of {} frames, {}", frames.size(), plan.frames.size(), size);
  if (done_before > 0) text += fmt::format(", {} were done before", done_before);
  if (const auto& files = options.pictures.files)
    text += still ? fmt::format(", picture in {}", files->file(plan.frames[0].frame).string())
                  : fmt::format(", pictures in {}", files->text());
  for (const OutputPattern& mask : options.masks) text += fmt::format(", masks in {}", mask.text());
  for (const OutputPattern& mask : options.mask_colours)
    text += fmt::format(", coloured masks in {}", mask.text());
  for (const OutputPattern& mask : options.mask_means)
    text += fmt::format(", means of masks in {}", mask.text());
  for (const OutputPattern& mask : options.mask_samples)
    text += fmt::format(", masks of samples in {}", mask.text());
  for (const OutputPattern& map : options.error_maps) text += fmt::format(", errors in {}", map.text());
  if (!options.log.empty()) text += fmt::format(", log in {}", options.log);
  if (!options.trace.empty()) text += fmt::format(", trace in {}", options.trace);
  write_text(stream, text + "\n");
}

Expected<int> render(const RenderOptions& options) {
  if (auto checked = check_render_options(options); !checked) return tl::unexpected(checked.error());
  if (auto limited = limit_memory(options.memory_mb); !limited) return tl::unexpected(limited.error());
  if (options.pictures.to_pipe && io::stdout_is_terminal())
    return base::fail(
        "-o - writes pictures to standard output, which is a terminal; expected a pipe or a file");
  StopSignals stop(options.timeout_s, StopSignals::Start::at_once);
  const auto plan = plan_render(options);
  if (!plan) return tl::unexpected(plan.error());
  if (!options.quiet) {
    print_warnings(options.warnings);
    print_warnings(plan->staged->scene.warnings);
  }
  if (auto prepared = prepare_folders(options); !prepared) return tl::unexpected(prepared.error());
  std::vector<std::filesystem::path> inputs = plan->staged->inputs;
  if (!options.config.empty()) inputs.emplace_back(options.config);
  if (auto apart = check_files_apart(inputs, files_of_render(*plan, options)); !apart)
    return tl::unexpected(apart.error());
  if (plan->frames.empty()) {
    if (!options.quiet)
      write_text(messages_of(options),
                 fmt::format("no frames in chunk {}/{}\n", options.chunk.index, options.chunk.count));
    return 0;
  }

  stop.be_orderly();
  FrameLoop loop(*plan, options, stop);
  if (auto done = loop.run(); !done) {
    if (!loop.failed_to_write()) return tl::unexpected(done.error());
    print_failure(done.error().message);
    return exit_codes::outputs_failed;
  }
  if (!options.quiet) write_text(messages_of(options), loop.taken_text());
  if (!options.quiet)
    print_summary(*plan, options, loop.drawn().first(loop.written()), plan->frames.size() - loop.frames());
  const std::size_t written = loop.written();
  if (written == loop.frames()) return 0;
  const int code = stop.exit_code();
  print_error("tenebra: stopped after {} of {} frames{}\n", written, loop.frames(),
              code == exit_codes::timed_out ? ", as the time of --timeout is up" : "");
  return code;
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
    settle_memory(command, options->memory_mb, options->method);
    options->config = config_file_of(command);
    options->warnings = idle_method_options(command, options->method);
    if (options->budget_ms && !budget_choice(options->method.render).any())
      options->warnings.emplace_back("--budget does nothing without --shadows soft or --ao adaptive");
    run = [options] { return render(*options); };
  });
}

}  // namespace tenebra::viewer
