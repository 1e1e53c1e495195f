// Look-ups against Embree's nearest hits: rays from outside points towards an object, the same for all, on
// one thread and on all.
#include <algorithm>
#include <cmath>

#include "ao_contestants.h"
#include "ao_session.h"
#include "bench_plot.h"
#include "parallel/parallel.h"
#include "support/seeded_random.h"

namespace tenebra::bench {
namespace {

struct Contestant {
  std::string name;
  Tracer tracer;
  std::vector<double> times_ms;
};

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

/// All contestants in turn, round by round, so that what else the machine does meets all alike.
void race(std::vector<Contestant>& contestants, std::span<const RayBatch> rays, int rounds) {
  for (Contestant& c : contestants) {
    c.times_ms.clear();
    trace_ms(rays.first(std::min<std::size_t>(rays.size(), 512)), c.tracer);  // warm
  }
  for (int round = 0; round < rounds; ++round) {
    for (Contestant& c : contestants) c.times_ms.push_back(trace_ms(rays, c.tracer));
  }
}

/// Median over the rounds of (the faster Embree / field), the ratio of neighbours in time.
double speedup(const std::vector<Contestant>& c, std::size_t field) {
  std::vector<double> ratios;
  std::size_t embree = 2;
  for (std::size_t i = 3; i < c.size(); ++i) {
    if (median(c[i].times_ms) < median(c[embree].times_ms)) embree = i;
  }
  for (std::size_t i = 0; i < c[field].times_ms.size(); ++i)
    ratios.push_back(c[embree].times_ms[i] / c[field].times_ms[i]);
  return median(ratios);
}

Expected<void> measure_object(AoSession& session, const Object& object,
                              std::vector<std::vector<std::string>>& rows) {
  const ObjectTree tree(object);
  const AoPeer peer(object);
  const auto chords = build_field(object, tree, {});
  const auto paper = build_field(object, tree, {.layout = FieldLayout::positions_directions});
  if (!chords || !paper) return tl::unexpected((!chords ? chords : paper).error());
  std::vector<Contestant> contestants{{"field, chords", field_tracer(**chords), {}},
                                      {"field, paper", field_tracer(**paper), {}},
                                      {"embree, single rays", peer.single_rays(), {}},
                                      {"embree, packets", peer.packets(false), {}},
                                      {"embree, coherent packets", peer.packets(true), {}}};
  const auto points = points_around(tree.ball, session.by_effort(20, 1500, 4000));
  const auto rays = batches_towards(points, CosineRays(16, 16, 6), tree.ball.centre, tree.ball.radius);
  const double count = static_cast<double>(rays.size()) * batch_size;
  for (const int threads : {1, thread_count()}) {
    with_threads(threads, [&] { race(contestants, rays, session.by_effort(1, 5, 9)); });
    std::vector<std::string> row{object.name, fmt::format("{}", threads)};
    for (const Contestant& c : contestants) {
      const double ns = median(c.times_ms) * 1e6 / count;
      row.push_back(fmt::format("{:.2f}", ns));
      session.report.add(
          {"lookups", object.name, c.name, fmt::format("threads={}", threads), "time", ns, "ns/ray"});
    }
    for (const std::size_t field : {0u, 1u}) {
      const double faster = speedup(contestants, field);
      row.push_back(fmt::format("{:.1f}", faster));
      session.report.add({"lookups", object.name, contestants[field].name, fmt::format("threads={}", threads),
                          "speedup", faster, ""});
    }
    rows.push_back(row);
    if (object.triangles.size() >= 5000) keep_least(session.headline.lookup_speedup, speedup(contestants, 0));
    if (threads == thread_count()) break;  // one thread is all there is
  }
  return {};
}

}  // namespace

Expected<void> measure_lookups(AoSession& session) {
  std::vector<std::string> known;  // named with the errors already
  const auto objects = error_objects(session.options.data, known);
  if (!objects) return tl::unexpected(objects.error());
  std::vector<std::vector<std::string>> rows{{"object", "threads", "chords ns", "paper ns", "embree 1 ns",
                                              "embree 16 ns", "embree 16 coherent ns", "chords x",
                                              "paper x"}};
  for (const Object& object : *objects) {
    progress(fmt::format("look-ups: {}", object.name));
    if (auto done = measure_object(session, object, rows); !done) return done;
  }
  print_table("Look-ups against Embree's nearest hits, a ray (x: the fastest of Embree over the field)",
              rows);
  return {};
}

}  // namespace tenebra::bench
