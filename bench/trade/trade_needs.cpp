// Only what a scene requires: what stages cost as frames need them, beside what they would cost if all of it
// were done, with the same answer.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/ao/ao_race.h"
#include "bench/hard/hard_views.h"
#include "bench/soft/soft_fair.h"
#include "bench/trade/trade_needs.h"
#include "gl/context.h"
#include "render/renderer.h"

namespace tenebra::bench {
namespace {

/// A run of the tracer on `view`, the last of some; `before` comes before each.
struct TracedRun {
  ShadowMask mask;
  TraceStats stats;
  FrameTimings timings;  // medians of the stages that are asked for
  double ms = 0;
};
TracedRun trace(const HardView& view, const HardShadowConfig& config, int rounds, ShadowTracer& tracer,
                const std::function<void()>& before = {}) {
  TracedRun run;
  std::vector<double> ms, rays, build;
  for (int round = 0; round < rounds; ++round) {
    if (before) before();
    CostClock clock;
    tracer.trace_shadow_mask(view.frame.points, view.frame.triangles(), view.light, config, run.mask);
    ms.push_back(clock.ms());
    const FrameTimings& t = tracer.timings();
    rays.push_back(t.rays_ms + t.sort_ms);
    build.push_back(t.build_ms);
  }
  run.stats = tracer.stats();
  run.timings.rays_ms = median(rays);
  run.timings.build_ms = median(build);
  run.ms = median(ms);
  return run;
}

/// The clusters of triangles: what follows a frame, and what does not have to.
void need_clusters(TradeSession& session, const HardView& view, int rounds) {
  ShadowTracer kept, shaken, fresh;
  ShadowMask unused;
  const FrameGeometry all_moved = nudged(view.frame.geometry);
  const auto meet = [&](ShadowTracer& tracer, const FrameGeometry& earlier) {
    tracer.trace_shadow_mask(view.frame.points, triangle_view(earlier), view.light, {}, unused);
  };
  const TracedRun needed = trace(view, {}, rounds, kept, [&] { meet(kept, view.before); });
  const TracedRun all = trace(view, {}, rounds, shaken, [&] { meet(shaken, all_moved); });
  session.needs.push_back({"boxes refitted around what moved", view.name, "of all clusters",
                           needed.timings.build_ms, all.timings.build_ms, needed.mask == all.mask});
  const TracedRun anew = trace(view, {}, rounds, fresh, [&] { fresh = ShadowTracer(); });
  session.needs.push_back({"order of the triangles kept", view.name, "found once a scene",
                           needed.timings.build_ms, anew.timings.build_ms, needed.mask == anew.mask});
}

/// Sorting: tiles that lie together are nodes as they stand, and only the others are sorted.
void need_sort(TradeSession& session, const HardView& view, int rounds) {
  ShadowTracer tiles, paper, two;
  const TracedRun few = trace(view, {}, rounds, tiles);
  const TracedRun sorted = trace(view, {.variant = Variant::precise_sorted}, rounds, paper);
  session.needs.push_back({"tiles sorted where depth has gaps", view.name, "Tiles; all rays: PreciseSorted",
                           few.timings.rays_ms, sorted.timings.rays_ms, few.mask == sorted.mask});
  session.needs.push_back({"rays for points that the light reaches", view.name,
                           fmt::format("{} rays of {} pixels", few.stats.rays, view.frame.pixel_count())});
  session.needs.push_back(
      {"tests in double, and exactly, where the stage before leaves a doubt", view.name,
       fmt::format("of {} tests of a ray with a triangle {} in double, {} exactly", few.stats.leaf_tests,
                   few.stats.float_unknown, few.stats.double_unknown)});
  const TracedRun passes = trace(view, {.variant = Variant::precise_seatp}, rounds, two);
  const TracedRun one = trace(view, {.variant = Variant::precise_sea}, rounds, paper);
  session.needs.push_back(
      {"second pass (3.4; all: one pass)", view.name,
       fmt::format("{:.2f} M node tests, in one pass {:.2f} M", static_cast<double>(passes.stats.nodes) / 1e6,
                   static_cast<double>(one.stats.nodes) / 1e6),
       passes.ms, one.ms, passes.mask == one.mask});
}

/// A frame that sees nothing: the sky alone.
void need_points(TradeSession& session, const HardView& view, int rounds) {
  HardView sky = view;
  const std::vector<std::uint32_t> nothing(view.frame.pixel_count(), no_triangle);
  compute_visible_points(nothing, view.frame.points.width, view.frame.points.height, view.frame.view,
                         view.frame.triangles(), sky.frame.points);
  ShadowTracer tracer;
  const TracedRun seen = trace(view, {}, rounds, tracer), unseen = trace(sky, {}, rounds, tracer);
  const bool dark = std::all_of(unseen.mask.begin(), unseen.mask.end(), [](auto m) { return m == 0; });
  session.needs.push_back({"nothing traced where nothing is seen", view.name,
                           fmt::format("{} node tests", unseen.stats.nodes), unseen.ms, seen.ms, dark});
}

/// A light of no intensity beside the others: it gets no rays. The scene's lights, and the first once more.
Expected<void> need_lights(TradeSession& session, const Scene& original, const HardView& view, int rounds) {
  auto context = gl::Context::create(gl::ContextKind::automatic);
  if (!context) return tl::unexpected(context.error());
  Scene scene = original;
  render::FrameInput input{view.frame.geometry, view.frame.lights, view.frame.view};
  scene.lights.push_back(scene.lights[static_cast<std::size_t>(input.lights[0].light)]);
  input.lights.push_back(input.lights[0]);
  input.lights.back().light = static_cast<int>(scene.lights.size()) - 1;
  auto renderer = render::Renderer::create(std::move(*context), scene);
  if (!renderer) return tl::unexpected(renderer.error());
  const render::RenderSettings settings{.width = view.frame.points.width, .height = view.frame.points.height};
  io::Image8 images[2];
  double ms[2] = {0, 0};
  for (const int lit : {0, 1}) {
    scene.lights.back().intensity = lit == 0 ? 0.0f : 1e-30f;  // adds nothing that a picture holds
    renderer->set_lights(scene.lights);
    std::vector<double> times;
    render::FrameResult result;
    for (int round = 0; round < rounds; ++round) {
      if (auto drawn = renderer->render_frame(input, settings, result); !drawn) return drawn;
      times.push_back(result.timings.total_ms);
    }
    ms[lit] = median(times);
    images[lit] = std::move(result.image);
  }
  session.needs.push_back({"no shadow from a light that is off", view.name, "the whole frame", ms[0], ms[1],
                           images[0] == images[1]});
  return {};
}

/// Shafts decide what is plainly lit or dark; 64 rays of Embree stand for any solver of the rest.
void need_shafts(TradeSession& session, const SoftView& view, int rounds) {
  const EmbreeScene casters(view.frame.triangles(), true);
  const auto receivers = sampled_receivers(view.frame);
  const SoftSampler sampler(view.light, 64, Packing::tile);
  ShaftedSampler shafted;
  std::vector<float> all(view.frame.pixel_count()), needed(all.size());
  std::vector<double> all_ms, needed_ms;
  for (int round = 0; round < rounds; ++round) {
    CostClock clock;
    sampler.trace(casters, receivers, view.frame.points.width, view.frame.points.height, {}, all);
    all_ms.push_back(clock.ms());
    CostClock again;
    shafted.trace(view, casters, receivers, sampler, needed);
    needed_ms.push_back(again.ms());
  }
  SoftShadowTracer tracer;
  SoftMask mask;
  tracer.trace(view.frame.points, view.frame.normals, view.frame.triangles(), view.light, {}, mask);
  const SoftStats& s = tracer.stats();
  const auto count = static_cast<double>(s.points_lit + s.points_dark + s.points_penumbra);
  // Dark of the shafts must be dark by rays; lit points differ by the rays' noise.
  bool same = true;
  for (std::size_t i = 0; i < all.size(); ++i)
    same = same && (tracer.classes()[i] != static_cast<std::uint8_t>(SoftClass::dark) || all[i] == needed[i]);
  session.needs.push_back(
      {"solvers where shafts do not decide", view.name,
       fmt::format("{:.0f} % of the points (64 rays); exact: {:.0f} % lit, {:.0f} % dark",
                   100 * shafted.traced_part(), 100 * static_cast<double>(s.points_lit) / count,
                   100 * static_cast<double>(s.points_dark) / count),
       median(needed_ms), median(all_ms), same});
}

void print_needs(const std::vector<NeedRow>& needs) {
  std::vector<std::vector<std::string>> rows{
      {"stage", "view", "threads", "ms", "all, ms", "same bits", "what is left"}};
  for (const NeedRow& n : needs) {
    const bool timed = n.all_ms > 0;
    rows.push_back({n.stage, n.view, fmt::format("{}", n.threads), timed ? short_number(n.with_ms) : "",
                    timed ? short_number(n.all_ms) : "", n.same ? *n.same ? "yes" : "NO" : "", n.shrunk});
  }
  print_table("What frames need of each stage, and what all of it would cost", rows);
}

}  // namespace

FrameGeometry nudged(FrameGeometry geometry) {
  for (glm::vec3& p : geometry.positions) {
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = std::nextafter(p[axis], std::numeric_limits<float>::infinity());
  }
  return geometry;
}

namespace {

Expected<void> measure_hard(TradeSession& session, const Scene& scene, const HardView& view) {
  progress(view.name + ": what the frame needs");
  const int rounds = session.by_effort(1, 3, 15);
  need_clusters(session, view, rounds);
  need_sort(session, view, rounds);
  need_points(session, view, rounds);
  if (auto lights = need_lights(session, scene, view, rounds); !lights) return lights;
  return need_fields(session, view.name, scene, view.frame);
}

}  // namespace

Expected<void> measure_trade_needs(TradeSession& session) {
  const std::vector<HardFrames> frames{{"robots", {100}}, {"kitchen", {100}}, {"city", {150}}};
  auto done = for_each_view(
      session.options, frames, session.by_effort<PictureSize>({64, 64}, {}, {}), session.skipped,
      [&](const Scene& scene, const HardView& view) {
        return session.on_each_number_of_threads([&] { return measure_hard(session, scene, view); });
      });
  if (!done) return done;
  ViewChoice choice{.only = {"robots", "kitchen", "court"}};
  if (session.effort == Effort::tiny) choice.width = 32, choice.height = 24;
  done = for_each_view(session.options, choice, session.skipped, [&](const SoftView& view) {
    progress(view.name + ": what soft shadows need");
    return session.on_each_number_of_threads([&]() -> Expected<void> {
      need_shafts(session, view, session.by_effort(1, 1, 3));
      return {};
    });
  });
  if (!done) return done;
  print_needs(session.needs);
  double differing = 0;
  for (const NeedRow& n : session.needs) {
    differing += n.same.value_or(true) ? 0 : 1;
    if (n.all_ms == 0) continue;
    const auto add = [&](const char* quantity, double ms) {
      session.report.add({"trade needs", n.view, n.stage, n.shrunk,
                          fmt::format("{} on {}", quantity, threads_text(n.threads)), ms, "ms"});
    };
    add("time", n.with_ms), add("time of all", n.all_ms);
  }
  session.headline["needs_differing"] = differing;
  return {};
}

}  // namespace tenebra::bench
