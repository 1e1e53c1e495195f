// Look-ups against Embree's nearest hits: rays from outside points towards an object, the same for all, on
// one thread and on all.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "bench/ao/ao_contestants.h"
#include "bench/ao/ao_race.h"
#include "bench/ao/ao_session.h"
#include "bench/common/bench_plot.h"
#include "parallel/parallel.h"
#include "support/seeded_random.h"

namespace tenebra::bench {
namespace {

/// Points one to three radii off the middle, facing it.
std::vector<Receiver> points_around(const Ball& ball, int count) {
  testing::Random random(5);
  std::vector<Receiver> points;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 out = random.direction();
    points.push_back({glm::vec3(ball.centre + out * (ball.radius * random.in(1.05, 3))), glm::vec3(-out)});
  }
  return points;
}

/// The fastest of Embree (all but the first two) over racer `field`.
double speedup(const std::vector<Racer>& racers, std::size_t field) {
  double embree = racers[2].ms;
  for (std::size_t i = 3; i < racers.size(); ++i) embree = std::min(embree, racers[i].ms);
  return embree / racers[field].ms;
}

Expected<void> measure_object(AoSession& session, const Object& object,
                              std::vector<std::vector<std::string>>& rows, std::vector<Bars>& bars) {
  const ObjectTree tree(object);
  const AoPeer peer(object);
  const auto chords = build_field(object, tree, session.table());
  const auto paper = build_field(object, tree, session.table(FieldLayout::positions_directions));
  if (!chords || !paper) return tl::unexpected((!chords ? chords : paper).error());
  std::vector<Racer> racers{{"field, chords", field_tracer(**chords)},
                            {"field, paper", field_tracer(**paper)},
                            {"embree, single rays", peer.single_rays()},
                            {"embree, packets", peer.packets(false)},
                            {"embree, coherent packets", peer.packets(true)}};
  const auto points = points_around(tree.ball, session.by_effort(20, 1500, 4000));
  const auto rays = batches_towards(points, CosineRays(256, 6), tree.ball.centre, tree.ball.radius);
  const double count = static_cast<double>(rays.size()) * trees::batch_size;
  for (const int threads : {1, thread_count()}) {
    with_threads(threads, [&] { race(racers, rays, session.by_effort(1, 5, 9)); });
    std::vector<std::string> row{object.name, fmt::format("{}", threads)};
    bars.resize(racers.size());
    for (std::size_t r = 0; r < racers.size(); ++r) {
      const Racer& racer = racers[r];
      const double ns = racer.ms * 1e6 / count;
      bars[r].name = racer.name;
      if (threads == 1) bars[r].values.push_back(ns);
      row.push_back(fmt::format("{:.2f}", ns));
      session.report.add(
          {"lookups", object.name, racer.name, fmt::format("threads={}", threads), "time", ns, "ns/ray"});
    }
    for (const std::size_t field : {0u, 1u}) {
      const double faster = speedup(racers, field);
      row.push_back(fmt::format("{:.1f}", faster));
      session.report.add({"lookups", object.name, racers[field].name, fmt::format("threads={}", threads),
                          "speedup", faster, ""});
    }
    rows.push_back(row);
    if (object.triangles.size() >= 5000) keep_least(session.headline.lookup_speedup, speedup(racers, 0));
    if (threads == thread_count()) break;  // one thread is all there is
  }
  return {};
}

}  // namespace

Expected<void> measure_lookups(AoSession& session) {
  std::vector<std::string> known;  // named with the errors already
  const auto objects = error_objects(session.options.data, known);
  if (!objects) return tl::unexpected(objects.error());
  std::vector<std::string> names;
  std::vector<Bars> bars;
  std::vector<std::vector<std::string>> rows{{"object", "threads", "chords ns", "paper ns", "embree 1 ns",
                                              "embree 16 ns", "embree 16 coherent ns", "chords x",
                                              "paper x"}};
  for (const Object& object : *objects) {
    if (session.effort == Effort::tiny && object.name != "flake") continue;
    progress(fmt::format("look-ups: {}", object.name));
    if (auto done = measure_object(session, object, rows, bars); !done) return done;
    names.push_back(object.name);
  }
  print_table("Look-ups against Embree's nearest hits, per ray (x: the fastest of Embree over the field)",
              rows);
  session.report.add_plot("lookups", bar_plot("A ray on one thread", {"time (ns)", true}, names, bars));
  return {};
}

}  // namespace tenebra::bench
