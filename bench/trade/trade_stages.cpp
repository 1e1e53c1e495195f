// Each stage that a scene may not need, switched off alone, on whole frames: what it costs or saves, and
// whether the picture is the same.
#include "bench/trade/trade_stages.h"

#include <fmt/core.h>
#include <algorithm>
#include <array>
#include <numeric>

#include "bench/ao/ao_objects.h"
#include "bench/ao/ao_race.h"
#include "bench/common/bench_frame.h"
#include "bench/common/bench_scenes.h"
#include "bench/common/memory_meter.h"
#include "bench/common/scene_renderer.h"
#include "bench/trade/trade_needs.h"
#include "scene/material_maps.h"
#include "stage/additions.h"

namespace tenebra::bench {
namespace {

constexpr float faint = 1e-30f;  // of a light: adds nothing that a picture holds, yet has to be traced

Expected<render::Renderer> renderer_of(const Scene& scene) {
  auto raster = render::FrameRaster::create({.kind = render::RasterKind::cpu});
  if (!raster) return tl::unexpected(raster.error());
  return render::Renderer::create(std::move(*raster), scene);
}

/// Draws one way of a pair, frame after frame.
class Drawer {
public:
  static Expected<Drawer> create(const Drawing& drawing) {
    auto renderer = renderer_of(*drawing.scene);
    if (!renderer) return tl::unexpected(renderer.error());
    return Drawer(drawing, std::move(*renderer));
  }

  Expected<void> draw() {
    if (drawing_.fresh) {
      auto again = renderer_of(*drawing_.scene);
      if (!again) return tl::unexpected(again.error());
      renderer_ = std::move(*again);
    } else if (drawing_.moved_before || times_.empty()) {
      if (auto done = renderer_.render_frame(before_, drawing_.settings, result_); !done) return done;
    }
    CostClock clock;
    if (auto done = renderer_.render_frame(drawing_.input, drawing_.settings, result_); !done) return done;
    times_.push_back(clock.ms());
    return {};
  }

  double ms() const { return median(times_); }
  double spent_ms() const { return std::accumulate(times_.begin(), times_.end(), 0.0); }
  const io::Image8& image() const { return result_.image; }

private:
  Drawer(const Drawing& drawing, render::Renderer renderer)
      : drawing_(drawing), before_(drawing.input), renderer_(std::move(renderer)) {
    if (drawing.moved_before) before_.geometry = nudged(before_.geometry);
  }

  const Drawing& drawing_;
  render::FrameInput before_;
  render::Renderer renderer_;
  render::FrameResult result_;
  std::vector<double> times_;
};

/// A drawer that has drawn once, and what it and its frames take, MB.
Expected<Drawer> begun(const Drawing& drawing, double& mb) {
  const MemoryMeter meter;
  auto drawer = Drawer::create(drawing);
  if (!drawer) return drawer;
  if (auto done = drawer->draw(); !done) return tl::unexpected(done.error());
  mb = meter.mb();
  return drawer;
}

/// A lamp beside the lights, in the place of the first of them.
Scene with_lamp(Scene scene, float intensity, std::optional<float> range_m, render::FrameInput& input) {
  Light light = scene.lights[static_cast<std::size_t>(input.lights[0].light)];
  light.type = LightType::point;
  light.intensity = intensity;
  light.range_m = range_m;
  scene.lights.push_back(light);
  input.lights.push_back(input.lights[0]);
  input.lights.back().light = static_cast<int>(scene.lights.size()) - 1;
  return scene;
}

Scene without_textures(Scene scene) {
  for (Material& material : scene.materials)
    for (TextureMap* map : scene::texture_maps(material)) *map = {};
  return scene;
}

bool has_area_light(const Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
    return light.type == LightType::area_rect || light.type == LightType::area_disk || light.diameter_deg > 0;
  });
}

void add_hard_pairs(const Drawing& base, std::vector<StagePair>& pairs) {
  const auto of = [&](Variant variant) {
    Drawing drawing = base;
    drawing.settings.hard.variant = variant;
    return drawing;
  };
  pairs.push_back({"tiles and clusters (without: PreciseSorted)", base, of(Variant::precise_sorted)});
  pairs.push_back(
      {"sort (PreciseSorted; without: Precise)", of(Variant::precise_sorted), of(Variant::precise)});
  pairs.push_back({"early accept (PreciseSEA; without: PreciseSorted)", of(Variant::precise_sea),
                   of(Variant::precise_sorted)});
  pairs.push_back({"second pass (PreciseSEATP; without: PreciseSEA)", of(Variant::precise_seatp),
                   of(Variant::precise_sea)});
}

void add_soft_pairs(const Scene& scene, const Drawing& base, std::vector<StagePair>& pairs) {
  Drawing soft = base;
  soft.settings.shadows = render::ShadowMode::soft;
  if (!has_area_light(scene))
    pairs.push_back({"soft shadows asked for, no light has an area (without: not asked for)", soft, base});
  soft.settings.area_lights.size = {4, 4}, soft.settings.area_lights.percent_of_diagonal = true;
  Drawing clip = soft;
  clip.settings.soft.solver = SoftSolver::clip;
  pairs.push_back({"silhouettes of meshes (without: clipping alone)", soft, clip, false});
}

}  // namespace

std::vector<StagePair> stage_pairs(const Scene& scene, int frame, PictureSize size,
                                   std::vector<Scene>& others) {
  Drawing base;
  base.scene = &scene;
  evaluate_input(scene, frame, size.width, size.height, base.input);
  base.settings.width = size.width, base.settings.height = size.height;

  others.reserve(5);  // pairs point at them
  const auto beside = [&](float intensity, std::optional<float> range_m) {
    Drawing drawing = base;
    others.push_back(with_lamp(scene, intensity, range_m, drawing.input));
    drawing.scene = &others.back();
    return drawing;
  };
  std::vector<StagePair> pairs;
  pairs.push_back({"a light that is off has no shadow", beside(0, {}), beside(faint, {})});
  pairs.push_back({"a light that reaches nothing has no rays", beside(faint, 1e-6f), beside(faint, {})});
  Drawing moved = base;
  moved.moved_before = true;
  pairs.push_back({"boxes of what stands are kept (without: all has moved)", base, moved});
  add_hard_pairs(base, pairs);
  add_soft_pairs(scene, base, pairs);
  Drawing ao = base, ao_fresh;
  ao.settings.ao.mode = AoMode::adaptive;
  ao_fresh = ao;
  ao_fresh.fresh = true;
  pairs.push_back({"what occlusion has built is kept (without: built anew)", ao, ao_fresh});
  Drawing plain = base;
  others.push_back(without_textures(scene));
  plain.scene = &others.back();
  pairs.push_back({"textures (without: none)", base, plain, scene.images.empty()});
  Drawing smooth = base, everywhere;
  smooth.settings.antialias = 4;
  everywhere = smooth;
  everywhere.settings.antialias_everywhere = true;
  pairs.push_back({"anti-aliasing, 4 samples (without: 1)", smooth, base, false});
  pairs.push_back({"samples where a pixel needs them (without: everywhere)", smooth, everywhere, false});
  return pairs;
}

Expected<StageRow> measure_stage(const StagePair& pair, const std::string& view, const Turns& turns) {
  StageRow row{pair.stage, view};
  auto as_is = begun(pair.as_is, row.mb), without = begun(pair.without, row.without_mb);
  if (!as_is || !without) return tl::unexpected((!as_is ? as_is : without).error());
  for (int round = 1; round < turns.rounds; ++round) {
    if (as_is->spent_ms() + without->spent_ms() >= turns.enough_ms) break;
    for (Drawer* drawer : {&*as_is, &*without})
      if (auto done = drawer->draw(); !done) return tl::unexpected(done.error());
  }
  row.ms = as_is->ms(), row.without_ms = without->ms();
  if (pair.same_bits) row.same = as_is->image() == without->image();
  return row;
}

namespace {

/// A scene that stands still and has neither a light nor a texture; it gets the program's sun and sky.
Scene bare_scene() {
  Scene scene;
  scene.materials.emplace_back();
  scene.meshes.push_back(mesh_of(make_knot(256, 32)));
  scene.nodes.emplace_back().mesh = 0;
  stage::add_missing_camera_and_light(scene);
  return scene;
}

Expected<void> measure_view(TradeSession& session, const Scene& scene, const std::string& view, int frame) {
  progress(view + ": each stage switched off alone");
  std::vector<Scene> others;
  const PictureSize size = session.by_effort<PictureSize>({32, 32}, {256, 256}, {1024, 1024});
  for (const StagePair& pair : stage_pairs(scene, frame, size, others)) {
    auto done = session.on_each_number_of_threads([&]() -> Expected<void> {
      auto row = measure_stage(pair, view, session.turns());
      if (row) session.stages.push_back(std::move(*row));
      return row ? Expected<void>() : tl::unexpected(row.error());
    });
    if (!done) return done;
  }
  return {};
}

void print_stages(const std::vector<StageRow>& stages) {
  Rows rows{{"stage", "view", "threads", "ms", "without, ms", "MB", "without, MB", "same bits"}};
  for (const StageRow& s : stages)
    rows.push_back({s.stage, s.view, fmt::format("{}", s.threads), short_number(s.ms),
                    short_number(s.without_ms), fmt::format("{:.0f}", s.mb),
                    fmt::format("{:.0f}", s.without_mb), s.same ? *s.same ? "yes" : "NO" : "not promised"});
  print_table("Each stage switched off alone", rows);
}

}  // namespace

Expected<void> measure_trade_stages(TradeSession& session) {
  constexpr std::array places{ScenePlace{"city", 150},    ScenePlace{"gallery", 100},
                              ScenePlace{"court", 60},    ScenePlace{"robots", 100},
                              ScenePlace{"kitchen", 100}, ScenePlace{"museum5", 20}};
  auto done = for_each_place(
      places, session.options.data, session.skipped,
      [&](const ScenePlace& place, const BenchScene& known, const auto& file) -> Expected<void> {
        const auto scene = load_scene(file, known.no_cast);
        if (!scene) return tl::unexpected(scene.error());
        return measure_view(session, *scene, fmt::format("{} {}", place.scene, place.frame), place.frame);
      });
  if (!done) return done;
  if (done = measure_view(session, bare_scene(), "knot", 0); !done) return done;
  print_stages(session.stages);
  double differing = 0;
  for (const StageRow& s : session.stages) {
    differing += s.same.value_or(true) ? 0 : 1;
    const std::string on = fmt::format("threads={}", s.threads);
    session.report.add({"trade stages", s.view, s.stage, on, "time", s.ms, "ms"});
    session.report.add({"trade stages", s.view, s.stage, on, "time without", s.without_ms, "ms"});
    session.report.add({"trade stages", s.view, s.stage, on, "memory", s.mb, "MB"});
    session.report.add({"trade stages", s.view, s.stage, on, "memory without", s.without_mb, "MB"});
  }
  session.headline["stages_differing"] = differing;
  return {};
}

}  // namespace tenebra::bench
