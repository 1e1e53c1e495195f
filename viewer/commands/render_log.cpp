#include "commands/render_log.h"

#include <fmt/core.h>

#include "base/machine.h"
#include "base/statistics.h"
#include "commands/frame_budget.h"
#include "options/settings_names.h"
#include "parallel/parallel.h"

namespace tenebra::viewer {
namespace {

std::string camera_text(const session::StagedScene& staged, const SceneOptions& options) {
  std::string text = fmt::format("{} ({})", staged.camera,
                                 staged.scene.cameras[static_cast<std::size_t>(staged.camera)].name);
  if (options.eye) {
    text = fmt::format("eye {} look-at {} up {}", place_text(*options.eye), place_text(options.look_at),
                       vector_text(options.up.value_or(
                           glm::vec3(staged.scene.frame.direction_to_file(glm::dvec3(0, 1, 0))))));
  }
  return options.fov_deg ? fmt::format("{}, fov {} degrees", text, *options.fov_deg) : text;
}

std::string environment_text(const session::StagedScene& staged, const SceneOptions& options) {
  if (!options.environment.empty()) return options.environment;
  return staged.environment ? "a soft sky" : "none";
}

std::string added_text(const stage::AddedParts& added) {
  std::string text;
  for (const auto& [is_added, name] :
       {std::pair(added.camera, "camera"), std::pair(added.light, added.lamp ? "lamp" : "sun"),
        std::pair(added.floor, "floor"), std::pair(added.sky, "sky")})
    if (is_added) text += fmt::format("{}{}", text.empty() ? "" : ", ", name);
  return text.empty() ? "nothing" : text;
}

std::string frames_text(const RenderPlan& plan, double fps) {
  const PlannedFrame& first = plan.frames.front();
  const PlannedFrame& last = plan.frames.back();
  return fmt::format("{}, from {} ({} s) to {} ({} s), {} per second where the scene states none",
                     plan.frames.size(), first.frame, first.time_s, last.frame, last.time_s, fps);
}

double shadow_ms(const FrameTimings& t) {
  return t.rays_ms + t.sort_ms + t.build_ms + t.traverse_ms + t.shaft_ms + t.init_ms + t.query_ms +
         t.irradiance_ms + t.writeback_ms;
}

/// Only the BSP's bits depend on it, so any render can be resumed with more for the others.
std::string soft_memory_text(const SoftShadowConfig& soft) {
  const std::string all = soft.memory_bytes ? fmt::format("{} MB", *soft.memory_bytes >> 20) : "the system's";
  return settings::soft_memory_mb(soft) ? all : fmt::format("{}, {} MB a tree", all, soft.tree_bytes >> 20);
}

std::string summary_row(std::string_view name, std::span<const TimedFrame> frames, auto value) {
  std::vector<double> values;
  for (const TimedFrame& frame : frames) values.push_back(value(frame.timings));
  const base::Summary summary = base::summarize(values);
  if (summary.worst <= 0) return "";
  return fmt::format("{:<20}{:>10.2f}{:>10.2f}{:>10.2f}{:>10.2f}   {}\n", name, summary.median,
                     summary.percentile_95, summary.percentile_99, summary.worst,
                     frames[summary.worst_at].frame);
}

}  // namespace

std::vector<render::LogSetting> describe_method(const MethodOptions& method) {
  std::vector<render::LogSetting> list;
  for (const auto& setting : settings::method_table()) {
    const bool told = setting.name == "quality" || setting.name == "soft-memory" ||
                      setting.name == "threads" ||
                      setting.name == "simd";  // the first by what it stands for, the others below
    if (told || !settings::is_used(setting.used, method.render)) continue;
    list.push_back({settings::underscored(setting.name), setting.text(method)});
  }
  const SoftShadowConfig& soft = method.render.soft;
  if (method.render.shadows == render::ShadowMode::soft && soft.solver == SoftSolver::bsp)
    list.push_back({"soft_memory", soft_memory_text(soft)});
  return list;
}

std::vector<render::LogSetting> describe_render(const RenderPlan& plan, const RenderOptions& options,
                                                const RasterNames& raster, const FrameGeometry& first_frame) {
  const render::RenderSettings& settings = plan.settings;
  const SimdLevel asked = settings.hard.simd;
  const SimdLevel simd = asked == SimdLevel::automatic ? best_simd_level() : asked;
  const session::StagedScene& staged = *plan.staged;
  const bool has_clip = staged.clip >= 0;
  std::vector<render::LogSetting> list{
      {"machine", base::machine_description()},
      {"renderer", raster.renderer},
      {"raster", raster.raster},
      {"shading", raster.shading},
      {"threads", settings.threads == 0 ? fmt::format("{} (all cores)", thread_count())
                                        : fmt::format("{}", settings.threads)},
      {"simd", std::string(simd_level_name(simd))},
      {"LP_NUM_THREADS", base::environment_or("LP_NUM_THREADS", "not set")},
      {"scene", options.scene.file},
      {"triangles", fmt::format("{}", first_frame.triangles.size())},
      {"dropped_non_finite", fmt::format("{}", first_frame.dropped_non_finite)},
      {"clip", has_clip ? staged.scene.clips[static_cast<std::size_t>(staged.clip)].name : "none"},
      {"frames", frames_text(plan, options.scene.fps)},
      {"camera", camera_text(staged, options.scene)},
      {"size", fmt::format("{}x{}", settings.width, settings.height)},
      {"cone_sides", fmt::format("{}", options.scene.import.cone_sides)},
      {"transfer", staged.scene.transfer == Transfer::srgb ? "srgb" : "display"},
      {"cast_all", options.scene.cast_all ? "yes" : "no"},
      {"cutout_limit", fmt::format("{}", options.scene.cutout_limit)},
      {"surfaces", options.scene.plain ? "plain" : "full"},
      {"environment", environment_text(staged, options.scene)},
      {"added", added_text(staged.added)},
  };
  for (render::LogSetting& setting : describe_method(settings::settled(options.method, settings)))
    list.push_back(std::move(setting));
  if (options.budget_ms) {
    std::erase_if(list, [](const auto& s) { return s.name == "soft_error" || s.name == "ao_error"; });
    list.push_back({"budget", fmt::format("{} ms", *options.budget_ms)});
    list.push_back(
        {"budget_from", errors_text(budget_ladder(options.method).front(),
                                    budget_choice(options.method.render))});  // --quality decides it
  }
  list.push_back({"exposure_from",
                  settings::takes_measured_exposure(options.method, staged.display) ? "auto" : "option"});
  for (EditOption& edit : edit_options(options.scene.edits)) {
    list.push_back({setting_name(edit), std::move(edit.value)});
  }
  if (!options.scene.import.scene.empty()) list.push_back({"scene_of_file", options.scene.import.scene});
  for (const std::string& name : options.scene.no_cast) list.push_back({"no_cast", name});
  for (const auto& folder : options.scene.import.texture_paths)
    list.push_back({"texture_path", folder.string()});
  if (!options.scene.import.root.empty()) list.push_back({"file_root", options.scene.import.root.string()});
  for (const std::string& warning : staged.scene.warnings) list.push_back({"warning", warning});
  return list;
}

std::string summary_table(std::span<const TimedFrame> frames) {
  if (frames.empty()) return "";
  std::string table = fmt::format("{:<20}{:>10}{:>10}{:>10}{:>10}   frame\n", "milliseconds", "median",
                                  "95 %", "99 %", "worst");
  for (const auto& stage : render::frame_stages) {
    table += summary_row(stage.name, frames, [&](const FrameTimings& t) { return t.*stage.value; });
  }
  table += summary_row("shadows", frames, shadow_ms);
  table += summary_row("shadows and points", frames,
                       [](const FrameTimings& t) { return shadow_ms(t) + t.points_ms; });
  table += summary_row("total", frames, [](const FrameTimings& t) { return t.total_ms; });
  return table;
}

}  // namespace tenebra::viewer
