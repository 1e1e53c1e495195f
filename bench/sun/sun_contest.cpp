// Tenebra and Embree on the same points and suns.
#include <fmt/format.h>

#include <algorithm>

#include "base/fail.h"
#include "bench/ao/ao_race.h"
#include "bench/common/bench_frame.h"
#include "bench/common/bench_scenes.h"
#include "bench/sun/sun_models.h"
#include "bench/sun/sun_peer.h"
#include "bench/sun/sun_session.h"
#include "math/predicates.h"
#include "oracle/exact_mask.h"
#include "points/triangle_corners.h"
#include "sun/sun_hours.h"

namespace tenebra::bench {
namespace {

constexpr double lift_of_size = 1e-6;  // of the scene's diagonal: what Embree's rays leave their triangle by

/// A model and the points that are asked about.
struct SunModel {
  std::string name;
  FrameGeometry frame;
  sun::Receivers receivers;

  TriangleView triangles() const { return triangle_view(frame); }
  float lift_m() const {
    glm::vec3 low(HUGE_VALF), high(-HUGE_VALF);
    for (const glm::vec3& p : frame.positions) low = glm::min(low, p), high = glm::max(high, p);
    return static_cast<float>(lift_of_size * static_cast<double>(glm::length(high - low)));
  }
};

Expected<SunModel> model_of_scene(const char* name, const Scene& scene, const sun::FaceChoice& choice) {
  SunModel model{name, {}, {}};
  evaluate_frame(scene, -1, 0, model.frame);
  auto receivers = sun::face_receivers(scene, model.frame, choice);
  if (!receivers) return tl::unexpected(receivers.error());
  model.receivers = std::move(*receivers);
  return model;
}

/// From the triangles on: all that `tenebra sun` does but for its files.
std::vector<double> our_sums(const SunModel& model, const sun::Receivers& receivers, const sun::Suns& suns) {
  const FrameGeometry& frame = model.frame;
  const auto geometry = Geometry::create(frame.positions, frame.triangles, frame.casts_shadow);
  return sun::sun_hours(*geometry, receivers, suns, {}).value().sums;
}

/// Embree's trees and points for one model.
struct Peer {
  Peer(const SunModel& model, bool robust)
      : casters(model.triangles(), true, robust),
        places{peer_places(model.receivers, model.triangles(), false, model.lift_m()),
               peer_places(model.receivers, model.triangles(), true, model.lift_m())},
        receivers(model.receivers.list.size()) {}

  std::vector<double> sums(std::span<const sun::Sun> suns, const SunPlan& of) const {
    return peer_sums(casters, places[of.sorted ? 1 : 0], receivers, suns, of);
  }
  /// Takes the quickest plan, by some of the suns.
  void choose(std::span<const sun::Sun> suns) {
    std::vector<sun::Sun> some;
    for (std::size_t i = 0; i < suns.size(); i += std::max<std::size_t>(1, suns.size() / 12))
      some.push_back(suns[i]);
    double best = HUGE_VAL;
    for (const SunPlan& candidate : sun_plans(casters)) {
      const auto time = [&] { return cost_ms([&] { sums(some, candidate); }); };
      const double ms = std::min(time(), time());
      if (ms < best) best = ms, plan = candidate;
    }
  }

  EmbreeScene casters;
  PeerPlaces places[2];
  std::size_t receivers;
  SunPlan plan;
};

/// The same points, each a receiver by itself, so that sums of one sun are a mask.
sun::Receivers each_point(const sun::Receivers& receivers) {
  sun::Receivers points = receivers;
  points.list.clear();
  for (std::uint32_t i = 0; i < receivers.positions.size(); ++i)
    points.list.push_back({i + 1, receivers.triangles[i], -1, 0, receivers.positions[i]});
  return points;
}

/// Counts the answers of both that differ from the oracle's, at some points and suns.
void check_answers(SunSession& session, const SunModel& model, const Peer& peer, const sun::Suns& suns) {
  const sun::Receivers points = each_point(model.receivers);
  const std::size_t looks = static_cast<std::size_t>(session.by_effort(50, 1000, 4000)),
                    step = std::max<std::size_t>(1, points.list.size() / looks),
                    skies = static_cast<std::size_t>(session.by_effort(1, 3, 6));
  const PeerPlaces places = peer_places(points, model.triangles(), false, model.lift_m());
  double ours_wrong = 0, theirs_wrong = 0, checked = 0;
  for (std::size_t k = 0; k < skies; ++k) {
    sun::Suns one = suns;
    one.list = {suns.list[(2 * k + 1) * suns.list.size() / (2 * skies)]};
    one.list.front().weight = 1;
    const glm::vec3 to_sun(one.list.front().to_sun);
    const auto ours = our_sums(model, points, one);
    const auto theirs = peer_sums(peer.casters, places, points.list.size(), one.list, {});
    const oracle::ExactShadow exact({}, model.triangles(), {.directional = true, .to_light = to_sun}, {});
    oracle::ExactMaskStats stats;
    for (std::size_t i = 0; i < points.list.size(); i += step, ++checked) {
      const std::uint32_t id = points.triangles[i];
      const points::Corners c = points::corners_of(model.triangles(), id);
      const double seen = math::direction_side(c.v[0], c.v[1], c.v[2], to_sun) == 1 &&
                                  exact.blocker(points.positions[i], id, stats) == no_triangle
                              ? 1
                              : 0;
      ours_wrong += ours[i] != seen, theirs_wrong += theirs[i] != seen;
    }
  }
  session.wrong_ours = session.wrong_ours.value_or(0) + ours_wrong;
  session.wrong_embree = session.wrong_embree.value_or(0) + theirs_wrong;
  session.checked += checked;
}

void contest(SunSession& session, const SunModel& model, Peer& plain, Peer& robust, const char* sky,
             const sun::Suns& suns, Rows& rows) {
  plain.choose(suns.list), robust.choose(suns.list);
  progress(fmt::format("{}: {} suns of a {}", model.name, suns.list.size(), sky));
  std::vector<double> ours_ms, plain_ms, robust_ms, ours, theirs;
  for (int round = 0; round < session.by_effort(1, 3, 5); ++round) {
    ours_ms.push_back(cost_ms([&] { ours = our_sums(model, model.receivers, suns); }));
    plain_ms.push_back(cost_ms([&] { theirs = plain.sums(suns.list, plain.plan); }));
    robust_ms.push_back(cost_ms([&] { robust.sums(suns.list, robust.plan); }));
  }
  std::size_t differing = 0;
  for (std::size_t i = 0; i < ours.size(); ++i)
    differing += std::abs(ours[i] - theirs[i]) > 1e-6 * (1 + ours[i]) ? 1 : 0;
  const double ratio = median(ours_ms) / median(plain_ms), robust_ratio = median(ours_ms) / median(robust_ms);
  session.ratios.push_back(ratio), session.robust_ratios.push_back(robust_ratio);
  rows.push_back({sky, std::to_string(suns.list.size()), fmt::format("{:.0f}", median(ours_ms)),
                  fmt::format("{:.0f}", median(plain_ms)), fmt::format("{:.0f}", median(robust_ms)),
                  fmt::format("{:.3f}", ratio), fmt::format("{:.3f}", robust_ratio),
                  std::to_string(differing), sun_plan_name(plain.plan)});
  const auto figure = [&](const char* by, const char* what, double value, const char* unit) {
    session.report.add({"sun", model.name, by, sky, what, value, unit});
  };
  figure("tenebra", "time", median(ours_ms), "ms"), figure("embree", "time", median(plain_ms), "ms");
  figure("embree robust", "time", median(robust_ms), "ms"), figure("tenebra", "ratio", ratio, "");
  figure("embree", "differing_receivers", static_cast<double>(differing), "");
}

Expected<void> measure(SunSession& session, const Expected<SunModel>& made) {
  if (!made) return tl::unexpected(made.error());
  const SunModel& model = *made;
  progress(fmt::format("{}: {} triangles, {} faces, {} points", model.name, model.frame.triangles.size(),
                       model.receivers.list.size(), model.receivers.positions.size()));
  Peer plain(model, false), robust(model, true);
  Rows rows{{"suns of a", "suns", "ms", "embree", "robust", "ratio", "of robust", "differ", "embree's plan"}};
  const sun::Suns day = suns_of_day(session.by_effort(120, 10, 10));
  contest(session, model, plain, robust, "day", day, rows);
  contest(session, model, plain, robust, "year",
          suns_of_year(session.by_effort(120, 30, 15), session.by_effort(240, 60, 60)), rows);
  print_table(model.name, rows);
  check_answers(session, model, plain, day);
  return {};
}

Expected<SunModel> city(SunSession& session, int per_face) {
  std::unique_ptr<testing::TemporaryFolder> made;
  auto scene = load_scene(find_scene(bench_scene("city"), session.options.data, made));
  if (!scene) return tl::unexpected(scene.error());
  return model_of_scene("city", *scene, {.per_face = per_face});
}

}  // namespace

Expected<void> measure_houses(SunSession& session) {
  const int rows = session.by_effort(2, 15, 15);
  return measure(session, model_of_scene("houses", houses_scene(rows, rows - 1),
                                         {.nodes = {"houses"}, .per_m2 = session.by_effort(0.1, 1.0, 1.0)}));
}

Expected<void> measure_city(SunSession& session) {
  return measure(session, city(session, 1));
}

Expected<void> measure_terrain(SunSession& session) {
  const int quads = session.by_effort(20, 708, 708), middle = session.by_effort(8, 224, 224);
  return measure(
      session, model_of_scene("terrain", terrain_scene(quads, middle), {.nodes = {"middle"}, .per_face = 1}));
}

Expected<void> measure_year(SunSession& session) {
  const auto model = city(session, 1);
  if (!model) return tl::unexpected(model.error());
  const sun::Suns suns = suns_of_year(session.by_effort(60, 1, 1), 60);
  const double ms = cost_ms([&] { our_sums(*model, model->receivers, suns); });
  progress(fmt::format("year: {} suns, {} points, {:.1f} s", suns.list.size(),
                       model->receivers.positions.size(), ms / 1e3));
  session.report.add({"sun", "city", "tenebra", "whole year", "time", ms / 1e3, "s"});
  session.year_s = ms / 1e3;
  return {};
}

}  // namespace tenebra::bench
