// Single frames: errors against 256 samples per pixel, and costs over one sample.
#include <fmt/format.h>

#include <algorithm>

#include "bench/common/bench_scenes.h"
#include "bench/picture/picture_errors.h"
#include "bench/picture/picture_maker.h"
#include "bench/picture/picture_session.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

constexpr ScenePlace places[] = {
    {"city", 150}, {"robots", 100}, {"kitchen", 100}, {"gallery", 60}, {"court", 60}};

/// What one view gives, by `sample_counts`.
struct ViewResult {
  PictureError errors[3];
  double ms[3] = {};
  double refined[3] = {};  ///< share of the pixels that got more than one sample
  double cost(int which) const { return ms[which] / ms[0]; }
};

Expected<ViewResult> measure_view(PictureMaker& maker, int pixels, int rounds) {
  ViewResult result;
  const auto drawn = maker.draw(reference_sampling);
  if (!drawn) return tl::unexpected(drawn.error());
  const io::Image8 reference = **drawn;
  std::vector<double> times[3];
  for (int round = 0; round <= rounds; ++round) {  // the first is not timed
    for (int k = 0; k < 3; ++k) {
      const auto picture = maker.draw({sample_counts[k]});
      if (!picture) return tl::unexpected(picture.error());
      if (round > 0) times[k].push_back(maker.total_ms());
      if (round > 0) continue;
      result.errors[k] = picture_error(**picture, reference);
      result.refined[k] = static_cast<double>(maker.refined()) / pixels;
    }
  }
  for (int k = 0; k < 3; ++k) result.ms[k] = median(times[k]);
  return result;
}

class Measurement {
public:
  explicit Measurement(PictureSession& session) : session_(session) {}
  Expected<void> measure(const ScenePlace& place, const Scene& scene);
  void conclude() const;

private:
  void report(const std::string& name, const ViewResult& result);

  PictureSession& session_;
  Rows table_{{"view", "ms", "4", "16", "cost 4", "cost 16", "refined 4", "refined 16", "rms 1", "rms 4",
               "rms 16", "missed 1", "missed 4", "missed 16"}};
  std::vector<ViewResult> results_;
};

void Measurement::report(const std::string& name, const ViewResult& r) {
  for (int k = 0; k < 3; ++k) {
    const auto add = [&](const char* quantity, double value, const char* unit) {
      session_.report.add(
          {"views", name, "tenebra", fmt::format("samples={}", sample_counts[k]), quantity, value, unit});
    };
    add("time", r.ms[k], "ms");
    add("rms", r.errors[k].rms, "1/255");
    add("missed", 100 * r.errors[k].missed, "%");
    add("refined", 100 * r.refined[k], "%");
  }
  const auto percent = [](double share, int digits) { return fmt::format("{:.{}f} %", 100 * share, digits); };
  table_.push_back({name, fmt::format("{:.1f}", r.ms[0]), fmt::format("{:.1f}", r.ms[1]),
                    fmt::format("{:.1f}", r.ms[2]), fmt::format("{:.3f}", r.cost(1)),
                    fmt::format("{:.3f}", r.cost(2)), percent(r.refined[1], 1), percent(r.refined[2], 1),
                    fmt::format("{:.2f}", r.errors[0].rms), fmt::format("{:.2f}", r.errors[1].rms),
                    fmt::format("{:.2f}", r.errors[2].rms), percent(r.errors[0].missed, 2),
                    percent(r.errors[1].missed, 3), percent(r.errors[2].missed, 3)});
}

Expected<void> Measurement::measure(const ScenePlace& place, const Scene& scene) {
  const int side = session_.by_effort(48, 1024, 1024);
  auto maker = PictureMaker::create({scene, side, side, thread_count()});
  if (!maker) return tl::unexpected(maker.error());
  maker->evaluate(place.frame);
  const auto result = measure_view(*maker, side * side, session_.by_effort(1, 5, 15));
  if (!result) return tl::unexpected(result.error());
  const std::string name = fmt::format("{} {}", place.scene, place.frame);
  results_.push_back(*result);
  report(name, *result);
  progress(fmt::format("{}: rms {:.2f} at 4, {:.2f} at 16; cost {:.2f}, {:.2f}", name, result->errors[1].rms,
                       result->errors[2].rms, result->cost(1), result->cost(2)));
  return {};
}

void Measurement::conclude() const {
  if (results_.empty()) return;
  print_table(
      "Single frames compared with 256 samples of every pixel (times: medians in ms of the whole frame; "
      "refined: pixels with more than one sample)",
      table_);
  std::vector<double> cost[2];
  double rms[2] = {}, missed = 0;
  for (const ViewResult& r : results_) {
    for (int k = 0; k < 2; ++k) {
      cost[k].push_back(r.cost(k + 1));
      rms[k] = std::max(rms[k], r.errors[k + 1].rms);
    }
    missed = std::max(missed, 100 * r.errors[2].missed);
  }
  PictureHeadline& h = session_.headline;
  h.rms_4 = rms[0], h.rms_16 = rms[1];
  h.cost_4 = geometric_mean(cost[0]), h.cost_16 = geometric_mean(cost[1]);
  h.missed_percent = missed;
}

}  // namespace

Expected<void> measure_picture_views(PictureSession& session) {
  Measurement measurement(session);
  const auto body = [&](const ScenePlace& place, const BenchScene& known,
                        const std::filesystem::path& file) -> Expected<void> {
    const auto scene = load_picture_scene(file, known.no_cast);
    if (!scene) return tl::unexpected(scene.error());
    return measurement.measure(place, *scene);
  };
  if (auto done = for_each_place(places, session.options.data, session.skipped, body); !done) return done;
  measurement.conclude();
  return {};
}

}  // namespace tenebra::bench
