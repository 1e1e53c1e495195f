#include "trade/trade_run.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string_view>

#include "base/statistics.h"
#include "base/stopwatch.h"
#include "options/scene_edits.h"
#include "shared/picture_difference.h"
#include "shared/scene_choice.h"

namespace tenebra::viewer {
namespace {

constexpr int crop_size = 96;
constexpr double enough_ms = 500;  // of one frame with one setting

/// Makes the system's count of the most memory held begin anew. False: it does not let us.
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

base::Image8 cut_out(const base::Image8& picture, int x0, int y0) {
  base::Image8 crop;
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

double squared_sum(const base::Image8& a, const base::Image8& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const int d = int(a.pixels[i]) - int(b.pixels[i]);
    sum += d * d;
  }
  return sum;
}

/// The upper left corner of the crop in which two pictures differ most, on a grid of half crops.
std::pair<int, int> differing_most(const base::Image8& a, const base::Image8& b) {
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
      : request_(request), plan_(*request.plan), progress_(progress), stop_(stop) {
    const TradeAxes& axes = request.axes;
    const std::size_t sweeps = axes.antialias.size() + axes.soft_errors.size() + axes.ao_errors.size() - 2;
    const double all = double(axes.antialias.size() * axes.soft_errors.size() * axes.ao_errors.size());
    // The finest settings take longest, so the reference and the settings by themselves count for more.
    steps_ = double(sweeps) + 2.0 * std::min(double(request.most_measured), all) + 2.0;
  }

  Expected<TradeResult> run() {
    TradeResult result;
    result.axes = request_.axes;
    for (const PlannedFrame& frame : plan_.frames) result.frames.push_back(frame.frame);
    auto reference = draw(finest(request_.axes), 1);
    if (!reference) return tl::unexpected(reference.error());
    done(2);
    auto sweep = sweep_axes();
    if (!sweep) return tl::unexpected(sweep.error());
    const base::Image8& middle = reference->pictures[middle_frame()];
    std::tie(result.crop_x, result.crop_y) = differing_most(middle, coarsest_picture_);
    result.reference_crop = cut_out(middle, result.crop_x, result.crop_y);
    if (auto measured = measure(*sweep, *reference, result); !measured)
      return tl::unexpected(measured.error());
    return result;
  }

private:
  struct Drawn {
    std::vector<base::Image8> pictures;  ///< a frame each
    std::vector<double> ms;              ///< a frame each: the median of the repeats
    double first_ms = 0;
  };

  std::size_t middle_frame() const { return plan_.frames.size() / 2; }

  void done(double steps) {
    done_ += steps;
    if (progress_) progress_(std::min(done_ / steps_, 1.0));
  }

  Expected<render::Renderer> make_renderer() const {
    auto raster = render::FrameRaster::create(request_.options->raster);
    if (!raster) return tl::unexpected(raster.error());
    render::Renderer renderer = render::Renderer::create(std::move(*raster), plan_.scene);
    if (plan_.environment) renderer.set_environment(*plan_.environment);
    const SceneEdits& edits = request_.options->scene.edits;
    if (!edits.materials.empty()) renderer.set_materials(materials_of(plan_.scene, edits));
    return renderer;
  }

  Expected<double> draw_frame(render::Renderer& renderer, const PlannedFrame& planned,
                              const render::RenderSettings& settings) {
    const SceneOptions& options = request_.options->scene;
    base::Stopwatch watch;
    evaluate_frame(plan_.scene, plan_.clip, planned.time_s, input_.geometry);
    apply_node_edits(plan_.scene, options.edits, input_.geometry);
    input_.lights = placed_lights(plan_.scene, options.edits, plan_.clip, planned.time_s);
    input_.view = view_of(plan_, options, planned.time_s, plan_.size);
    if (auto drawn = renderer.render_frame(input_, settings, result_, {}, &stop_); !drawn)
      return tl::unexpected(drawn.error());
    return watch.lap_ms();
  }

  /// All frames with one setting, in a renderer of its own: the first once more, as it builds what the others
  /// keep.
  Expected<Drawn> draw(const TradeSetting& setting, int repeats) {
    auto renderer = make_renderer();
    if (!renderer) return tl::unexpected(renderer.error());
    const render::RenderSettings settings = with_setting(plan_.settings, request_.axes, setting);
    const auto first = draw_frame(*renderer, plan_.frames.front(), settings);
    if (!first) return tl::unexpected(first.error());
    Drawn drawn;
    drawn.first_ms = *first;
    for (const PlannedFrame& frame : plan_.frames) {
      const auto ms = median_ms(*renderer, frame, settings, repeats);
      if (!ms) return tl::unexpected(ms.error());
      drawn.ms.push_back(*ms);
      drawn.pictures.push_back(result_.image);
    }
    return drawn;
  }

  /// Of at most `repeats` frames: slow ones are drawn fewer times, as their times differ less.
  Expected<double> median_ms(render::Renderer& renderer, const PlannedFrame& frame,
                             const render::RenderSettings& settings, int repeats) {
    std::vector<double> ms;
    double sum_ms = 0;
    for (int i = 0; i < repeats && sum_ms < enough_ms; ++i) {
      const auto took = draw_frame(renderer, frame, settings);
      if (!took) return took;
      ms.push_back(*took);
      sum_ms += *took;
    }
    return base::summarize(ms).median;
  }

  /// The middle frame with one setting: its time and, in `result_`, its picture.
  Expected<TradePoint> sweep_one(const TradeSetting& setting) {
    const auto ms = median_ms(*sweeping_, plan_.frames[middle_frame()],
                              with_setting(plan_.settings, request_.axes, setting), request_.repeats);
    if (!ms) return tl::unexpected(ms.error());
    done(1);
    return TradePoint{setting, *ms, 0};
  }

  /// The middle frame with each value of an axis, of which `coarsest` is drawn already. Errors are against
  /// the last.
  Expected<std::vector<TradePoint>> sweep_axis(const TradePoint& coarsest,
                                               std::span<const TradeSetting> settings) {
    std::vector<TradePoint> points{coarsest};
    std::vector<base::Image8> pictures{coarsest_picture_};
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
    auto renderer = make_renderer();
    if (!renderer) return tl::unexpected(renderer.error());
    sweeping_.emplace(std::move(*renderer));
    const TradeSetting start = coarsest(request_.axes);
    const auto warmed = draw_frame(*sweeping_, plan_.frames[middle_frame()],
                                   with_setting(plan_.settings, request_.axes, start));
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

  /// The settings to be measured: those that promise to be worth it, and the one that a user gets who chooses
  /// nothing.
  std::vector<TradeSetting> promising(const TradeSweep& sweep) const {
    const std::vector<TradePoint> predicted = predicted_points(sweep);
    std::vector<TradeSetting> settings;
    for (const std::size_t i : thinned(predicted, pareto_front(predicted), request_.most_measured - 1))
      settings.push_back(predicted[i].setting);
    const TradeSetting usual = standard(request_.axes);
    if (std::find(settings.begin(), settings.end(), usual) == settings.end()) settings.push_back(usual);
    return settings;
  }

  /// Each of them by itself.
  Expected<void> measure(const TradeSweep& sweep, const Drawn& reference, TradeResult& result) {
    for (const TradeSetting& setting : promising(sweep)) {
      const bool peak_is_own = forget_peak_memory();
      const auto drawn = draw(setting, request_.repeats);
      if (!drawn) return tl::unexpected(drawn.error());
      result.measured.push_back(judged(setting, *drawn, reference, result));
      if (peak_is_own) result.measured.back().peak_mb = peak_memory_mb();
      done(2);
    }
    std::stable_sort(result.measured.begin(), result.measured.end(),
                     [](const TradedSetting& a, const TradedSetting& b) { return a.point.ms < b.point.ms; });
    std::vector<TradePoint> points;
    for (const TradedSetting& setting : result.measured) points.push_back(setting.point);
    result.front = pareto_front(points);
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
      traded.worst_error = std::max(traded.worst_error, error);
    }
    traded.point.error = std::sqrt(squares / static_cast<double>(drawn.pictures.size()));
    traded.first_frame_ms = drawn.first_ms;
    traded.crop = cut_out(drawn.pictures[middle_frame()], result.crop_x, result.crop_y);
    return traded;
  }

  const TradeRequest& request_;
  const RenderPlan& plan_;
  const std::function<void(double)>& progress_;
  const StopFlag& stop_;
  std::optional<render::Renderer> sweeping_;
  render::FrameInput input_;
  render::FrameResult result_;
  base::Image8 coarsest_picture_;  ///< of the frame in the middle
  double steps_ = 1, done_ = 0;
};

}  // namespace

Expected<TradeResult> run_trade(const TradeRequest& request, const std::function<void(double)>& progress,
                                const StopFlag& stop) {
  return Trader(request, progress, stop).run();
}

}  // namespace tenebra::viewer
