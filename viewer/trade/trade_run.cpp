#include "trade/trade_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <string_view>

#include "base/statistics.h"
#include "base/stopwatch.h"
#include "shared/picture_difference.h"

namespace tenebra::viewer {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int crop_size = 96;
constexpr double enough_ms = 500;  // of one frame with one setting
constexpr double slow_ms = 2000;
constexpr double spread_s = 8;  // for frames that are drawn for the spread alone
constexpr double timing_s = 8;  // for timing a setting on them
constexpr std::size_t least_timed = 5;
constexpr std::size_t still_timed = 16;  // times that a frame of a still scene is timed at most
constexpr std::size_t least_measured = 4;
constexpr double finest_steps = 4, own_steps = 2;  // of the progress; a setting of a sweep is one

/// Resets the system's record of the most memory held. False: that is not allowed.
bool forget_peak_memory() {
  std::ofstream file("/proc/self/clear_refs");
  return static_cast<bool>(file << "5" << std::flush);
}

double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  return 0;
}

io::Image8 cut_out(const io::Image8& picture, int x0, int y0) {
  io::Image8 crop;
  crop.width = std::min(crop_size, picture.width);
  crop.height = std::min(crop_size, picture.height);
  crop.channels = picture.channels;
  const auto row_bytes = static_cast<std::ptrdiff_t>(crop.width) * picture.channels;
  for (int y = 0; y < crop.height; ++y) {
    const auto row = picture.pixels.begin() +
                     (static_cast<std::ptrdiff_t>(y0 + y) * picture.width + x0) * picture.channels;
    crop.pixels.insert(crop.pixels.end(), row, row + row_bytes);
  }
  return crop;
}

double squared_sum(const io::Image8& a, const io::Image8& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const int d = int(a.pixels[i]) - int(b.pixels[i]);
    sum += d * d;
  }
  return sum;
}

/// The upper left corner of the crop in which two pictures differ most, on a grid of half crops.
std::pair<int, int> differing_most(const io::Image8& a, const io::Image8& b) {
  std::pair<int, int> best{0, 0};
  double most = -1;
  for (int y = 0; y + std::min(crop_size, a.height) <= a.height; y += crop_size / 2)
    for (int x = 0; x + std::min(crop_size, a.width) <= a.width; x += crop_size / 2) {
      const double sum = squared_sum(cut_out(a, x, y), cut_out(b, x, y));
      if (sum > most) most = sum, best = {x, y};
    }
  return best;
}

/// Draws the frames of a plan with one setting after the other.
class Trader {
public:
  Trader(const TradeRequest& request, const std::function<void(double)>& progress, const StopFlag& stop)
      : request_(request), progress_(progress), stop_(stop) {
    const TradeAxes& axes = request.axes;
    const std::size_t sweeps = axes.antialias.size() + axes.soft_errors.size() + axes.ao_errors.size() - 2;
    const double all = double(axes.antialias.size() * axes.soft_errors.size() * axes.ao_errors.size());
    // Settings by themselves take longer, the finest longest.
    steps_ = finest_steps + double(sweeps) + own_steps * (std::min(double(request.most_measured), all) - 1);
  }

  Expected<TradeResult> run() {
    TradeResult result;
    result.axes = request_.axes;
    for (const PlannedFrame& frame : request_.frames) result.frames.push_back(frame.frame);
    auto reference = draw(finest(request_.axes));
    if (!reference) return tl::unexpected(reference.error());
    done(finest_steps);
    auto sweep = sweep_axes();
    if (!sweep) return tl::unexpected(sweep.error());
    const io::Image8& middle = reference->pictures[middle_frame()];
    std::tie(result.crop_x, result.crop_y) = differing_most(middle, coarsest_picture_);
    result.reference_crop = cut_out(middle, result.crop_x, result.crop_y);
    result.measured.push_back(judged(finest(request_.axes), *reference, *reference, result));
    if (auto measured = measure(*sweep, *reference, result); !measured)
      return tl::unexpected(measured.error());
    if (auto spread = measure_spread(result); !spread) return tl::unexpected(spread.error());
    return result;
  }

  /// See time_setting.
  Expected<double> time(const TradePoint& point) {
    auto session = open();
    if (!session) return tl::unexpected(session.error());
    const bool still = request_.more_frames.empty();
    const auto& frames = still ? request_.frames : request_.more_frames;
    const render::RenderSettings settings = with_setting(request_.settings, request_.axes, point.setting);
    if (const auto first = draw_frame(*session, frames.front(), settings); !first) return first;
    // Frames differ more than draws of one: more frames before more draws of each.
    const double draws = timing_s / std::max(point.ms / 1e3, 1e-4);  // that there is time for
    const std::size_t most = std::max(still ? still_timed : least_timed, frames.size()),
                      count = std::clamp(std::size_t(draws), least_timed, most);
    const int repeats = std::clamp(int(draws / double(count)), 1, request_.repeats);
    std::vector<double> times;
    for (std::size_t i = 0; i < count; ++i) {
      const auto ms =
          median_ms(*session, frames[(2 * i + 1) * frames.size() / (2 * count)], settings, repeats);
      if (!ms) return ms;
      times.push_back(*ms);
      done(steps_ / double(count));
    }
    return base::summarize(times).median;
  }

private:
  struct Drawn {
    std::vector<io::Image8> pictures;  ///< one for each frame
    std::vector<double> ms;            ///< for each timed frame the median of the repeats
    double first_ms = 0;
    double peak_mb = 0;  ///< 0: unknown
  };

  std::size_t middle_frame() const { return request_.frames.size() / 2; }

  void done(double steps) {
    done_ += steps;
    if (progress_) progress_(std::min(done_ / steps_, 1.0));
  }

  Expected<session::Session> open() const {
    return session::Session::open(request_.scene, request_.edits, request_.raster);
  }

  Expected<double> draw_frame(session::Session& session, const PlannedFrame& planned,
                              const render::RenderSettings& settings) {
    session.place(request_.clip, planned.time_s, request_.view(planned.time_s));
    if (auto drawn = session.draw(settings, result_, {}, &stop_); !drawn)
      return tl::unexpected(drawn.error());
    return result_.timings.total_ms;
  }

  /// All frames with one setting, in a session of its own: the first once more, as it builds what the others
  /// keep, or where that takes long the others alone are timed.
  Expected<Drawn> draw(const TradeSetting& setting) {
    const bool peak_is_own = forget_peak_memory();
    auto session = open();
    if (!session) return tl::unexpected(session.error());
    const render::RenderSettings settings = with_setting(request_.settings, request_.axes, setting);
    const auto first = draw_frame(*session, request_.frames.front(), settings);
    if (!first) return tl::unexpected(first.error());
    Drawn drawn;
    drawn.first_ms = *first;
    const bool slow = *first > slow_ms && request_.frames.size() > 1;
    if (slow) drawn.pictures.push_back(result_.image);
    for (const PlannedFrame& frame : std::span(request_.frames).subspan(slow ? 1 : 0)) {
      const auto ms = median_ms(*session, frame, settings, request_.repeats);
      if (!ms) return tl::unexpected(ms.error());
      drawn.ms.push_back(*ms);
      drawn.pictures.push_back(result_.image);
    }
    if (peak_is_own) drawn.peak_mb = peak_memory_mb();
    return drawn;
  }

  /// The median of at most so many draws; slow frames are drawn fewer times, as their times differ less.
  Expected<double> median_ms(session::Session& session, const PlannedFrame& frame,
                             const render::RenderSettings& settings, int repeats) {
    std::vector<double> ms;
    double sum_ms = 0;
    for (int i = 0; i < repeats && sum_ms < enough_ms; ++i) {
      const auto took = draw_frame(session, frame, settings);
      if (!took) return took;
      ms.push_back(*took);
      sum_ms += *took;
    }
    return base::summarize(ms).median;
  }

  /// The middle frame with one setting: its time and, in `result_`, its picture.
  Expected<TradePoint> sweep_one(const TradeSetting& setting) {
    const auto ms = median_ms(*sweeping_, request_.frames[middle_frame()],
                              with_setting(request_.settings, request_.axes, setting), request_.repeats);
    if (!ms) return tl::unexpected(ms.error());
    done(1);
    return TradePoint{setting, *ms, 0};
  }

  /// The middle frame with each value of an axis, of which `coarsest` is drawn already. Errors are against
  /// the last.
  Expected<std::vector<TradePoint>> sweep_axis(const TradePoint& coarsest,
                                               std::span<const TradeSetting> settings) {
    std::vector<TradePoint> points{coarsest};
    std::vector<io::Image8> pictures{coarsest_picture_};
    for (const TradeSetting& setting : settings.subspan(1)) {
      const auto point = sweep_one(setting);
      if (!point) return tl::unexpected(point.error());
      points.push_back(*point);
      pictures.push_back(result_.image);
    }
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i].error = rms_difference(pictures[i], pictures.back());
    return points;
  }

  Expected<TradeSweep> sweep_axes() {
    auto session = open();
    if (!session) return tl::unexpected(session.error());
    sweeping_.emplace(std::move(*session));
    const TradeSetting start = coarsest(request_.axes);
    const auto warmed = draw_frame(*sweeping_, request_.frames[middle_frame()],
                                   with_setting(request_.settings, request_.axes, start));
    if (!warmed) return tl::unexpected(warmed.error());
    const auto first = sweep_one(start);
    if (!first) return tl::unexpected(first.error());
    coarsest_picture_ = result_.image;
    TradeSweep sweep;
    for (const auto& [points, settings] :
         {std::pair(&sweep.antialias, antialias_sweep(request_.axes)),
          std::pair(&sweep.soft, soft_sweep(request_.axes)), std::pair(&sweep.ao, ao_sweep(request_.axes))}) {
      auto swept = sweep_axis(*first, settings);
      if (!swept) return tl::unexpected(swept.error());
      *points = std::move(*swept);
    }
    sweeping_.reset();
    return sweep;
  }

  /// How long it will take to time so many frames with a setting whose frame takes about `point.ms`.
  double seconds_of(const TradePoint& point, std::size_t frames) const {
    const double ms = std::max(point.ms, 0.1),
                 draws = std::clamp(std::ceil(enough_ms / ms), 1.0, double(request_.repeats));
    return ms * draws * double(frames) / 1e3;
  }

  /// The settings to be measured beside the finest: those that promise to be worth it, and the one that a
  /// user gets who chooses nothing. As many as there is time for.
  std::vector<TradeSetting> promising(const TradeSweep& sweep) const {
    const std::vector<TradePoint> predicted = predicted_points(sweep);
    const std::vector<std::size_t> front = pareto_front(predicted);
    const auto chosen = [&](std::size_t most) {
      std::vector<TradePoint> points;
      const auto add = [&](const TradePoint& point) {
        const auto same = [&](const TradePoint& other) { return other.setting == point.setting; };
        if (point.setting != finest(request_.axes) && std::none_of(points.begin(), points.end(), same))
          points.push_back(point);
      };
      for (const std::size_t i : thinned(predicted, front, most - 1)) add(predicted[i]);
      for (const TradePoint& point : predicted)
        if (point.setting == standard(request_.axes)) add(point);
      return points;
    };
    const double left_s = request_.aim_s - std::chrono::duration<double>(Clock::now() - begun_).count();
    std::vector<TradePoint> points = chosen(request_.most_measured);
    for (std::size_t most = request_.most_measured; most > least_measured; points = chosen(--most)) {
      double sum_s = 0;
      for (const TradePoint& point : points)
        sum_s += point.ms / 1e3 + seconds_of(point, request_.frames.size());
      if (sum_s <= left_s) break;
    }
    std::vector<TradeSetting> settings;
    settings.reserve(points.size());
    for (const TradePoint& point : points) settings.push_back(point.setting);
    return settings;
  }

  /// Each of them by itself.
  Expected<void> measure(const TradeSweep& sweep, const Drawn& reference, TradeResult& result) {
    for (const TradeSetting& setting : promising(sweep)) {
      const auto drawn = draw(setting);
      if (!drawn) return tl::unexpected(drawn.error());
      result.measured.push_back(judged(setting, *drawn, reference, result));
      done(own_steps);
    }
    std::stable_sort(result.measured.begin(), result.measured.end(),
                     [](const TradedSetting& a, const TradedSetting& b) { return a.point.ms < b.point.ms; });
    std::vector<TradePoint> points;
    for (const TradedSetting& setting : result.measured) points.push_back(setting.point);
    result.front = pareto_front(points);
    return {};
  }

  /// How far two coarse settings are apart in the one of some frames where it is most.
  Expected<double> worst_coarse_error(session::Session& session, std::span<const PlannedFrame> frames,
                                      std::size_t step) {
    const TradeAxes& axes = request_.axes;
    const auto second = [](const auto& values) {
      return values[std::min<std::size_t>(1, values.size() - 1)];
    };
    const TradeSetting coarse = coarsest(axes),
                       finer{second(axes.antialias), second(axes.soft_errors), second(axes.ao_errors)};
    double worst = 0;
    for (std::size_t i = step / 2; i < frames.size(); i += step) {
      const auto drawn = draw_frame(session, frames[i], with_setting(request_.settings, axes, coarse));
      if (!drawn) return drawn;
      const io::Image8 picture = result_.image;
      const auto again = draw_frame(session, frames[i], with_setting(request_.settings, axes, finer));
      if (!again) return again;
      worst = std::max(worst, rms_difference(picture, result_.image));
    }
    return worst;
  }

  /// Errors of all settings grow and shrink together from frame to frame: what coarse ones show goes for all.
  Expected<void> measure_spread(TradeResult& result) {
    if (request_.more_frames.empty()) return {};
    auto session = open();
    if (!session) return tl::unexpected(session.error());
    const Clock::time_point begun = Clock::now();
    const auto tried = worst_coarse_error(*session, request_.frames, 1);
    if (!tried) return tl::unexpected(tried.error());
    const double took_s = std::chrono::duration<double>(Clock::now() - begun).count(),
                 all_s = took_s * double(request_.more_frames.size()) / double(request_.frames.size());
    const std::size_t step = std::min(std::size_t(std::ceil(std::max(all_s / spread_s, 1.0))),
                                      request_.more_frames.size());  // one at least
    const auto more = worst_coarse_error(*session, request_.more_frames, step);
    if (!more) return tl::unexpected(more.error());
    if (*tried > 0) result.spread = std::max(1.0, *more / *tried);
    return {};
  }

  TradedSetting judged(const TradeSetting& setting, const Drawn& drawn, const Drawn& reference,
                       const TradeResult& result) const {
    TradedSetting traded;
    traded.point = {setting, base::summarize(drawn.ms).median, 0};
    double squares = 0;
    for (std::size_t f = 0; f < drawn.pictures.size(); ++f) {
      const double error = rms_difference(drawn.pictures[f], reference.pictures[f]);
      squares += error * error;
      traded.frame_errors.push_back(error);
      traded.worst_error = std::max(traded.worst_error, error);
    }
    traded.point.error = std::sqrt(squares / static_cast<double>(drawn.pictures.size()));
    traded.frames_ms = drawn.ms;
    traded.first_frame_ms = drawn.first_ms;
    traded.peak_mb = drawn.peak_mb;
    traded.crop = cut_out(drawn.pictures[middle_frame()], result.crop_x, result.crop_y);
    return traded;
  }

  const TradeRequest& request_;
  const std::function<void(double)>& progress_;
  const StopFlag& stop_;
  std::optional<session::Session> sweeping_;
  render::FrameResult result_;
  io::Image8 coarsest_picture_;  ///< of the frame in the middle
  double steps_ = 1, done_ = 0;
  const Clock::time_point begun_ = Clock::now();
};

}  // namespace

Expected<TradeResult> run_trade(const TradeRequest& request, const std::function<void(double)>& progress,
                                const StopFlag& stop) {
  return Trader(request, progress, stop).run();
}

Expected<double> time_setting(const TradeRequest& request, const TradePoint& point,
                              const std::function<void(double)>& progress, const StopFlag& stop) {
  return Trader(request, progress, stop).time(point);
}

}  // namespace tenebra::viewer
