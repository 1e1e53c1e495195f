#include "window/event_report.h"

#include <fmt/core.h>
#include <cerrno>
#include <cstring>

#include <nlohmann/json.hpp>

#include "base/fail.h"
#include "options/method_arguments.h"
#include "options/settings_names.h"

namespace tenebra::viewer {
namespace {

using Json = nlohmann::ordered_json;

/// Of the scene that is open; while none is, that of places as they stand.
FileFrame file_frame(const ViewState& state) {
  return state.scene ? state.scene->scene.frame : FileFrame{};
}

std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

const char* name_of(CameraMode mode) {
  return mode == CameraMode::scene ? "scene" : mode == CameraMode::orbit ? "orbit" : "fly";
}

const char* name_of(CompareView view) {
  constexpr const char* names[] = {"a", "b", "side", "wipe", "difference"};
  return names[static_cast<std::size_t>(view)];
}

}  // namespace

Expected<EventReport> EventReport::create(const std::string& path) {
  EventReport report;
  if (path.empty()) return report;
  report.file_.reset(std::fopen(path.c_str(), "w"));
  if (!report.file_) return base::fail("--report {}: {}", path, std::strerror(errno));
  return report;
}

void EventReport::line(const std::string& text) {
  if (!file_) return;
  (void)std::fwrite(text.data(), 1, text.size(), file_.get());
  (void)std::fputc('\n', file_.get());
  (void)std::fflush(file_.get());
}

void EventReport::opened(const std::string& file, const session::StagedScene& scene) {
  if (!file_) return;
  line(dump({{"event", "opened"},
             {"file", file},
             {"lights", scene.scene.lights.size()},
             {"clips", scene.scene.clips.size()},
             {"cameras", scene.scene.cameras.size()}}));
}

void EventReport::request(const FrameRequest& request) {
  if (!file_) return;
  line(dump(
      {{"event", "request"}, {"number", request.number}, {"time_s", request.clock.time_at(request.asked)}}));
}

void EventReport::picture(const Picture& picture, std::uint64_t number) {
  if (!file_) return;
  const render::FrameRecord& a = picture.a.record;
  Json json{{"event", "picture"},
            {"number", number},
            {"request", picture.request},
            {"frame", a.frame},
            {"time_s", a.time_s},
            {"width", picture.a.result.image.width},
            {"height", picture.a.result.image.height},
            {"total_ms", a.timings.total_ms},
            {"delay_ms", picture.delay_ms},
            {"rays", a.stats.rays},
            {"nodes", a.stats.nodes},
            {"soft_groups", a.soft.groups},
            {"ao_points", a.ao.points},
            {"preview", picture.preview}};
  if (picture.b) {
    json["nodes_b"] = picture.b->record.stats.nodes;
    json["differing"] = picture.difference.differing;
    json["largest"] = picture.difference.largest;
  }
  if (picture.overlay.kind == Overlay::nodes) json["overlay_peak"] = picture.overlay.peak;
  if (picture.overlay.kind == Overlay::classes) json["overlay_classes"] = picture.overlay.class_sizes;
  line(dump(json));
}

void EventReport::explained(const PictureAnswer& answer) {
  if (!file_) return;
  constexpr const char* sights[] = {"lit", "faces away", "out of reach", "blocked"};
  Json lights = Json::array();
  for (const render::LightExplanation& light : answer.pixel.lights) {
    Json& json = lights.emplace_back(
        Json{{"light", light.number}, {"sight", sights[static_cast<std::size_t>(light.sight)]}});
    if (light.visible_fraction) json["visible_fraction"] = *light.visible_fraction;
    if (light.occluder)
      json["occluder"] = light.occluder->triangle, json["occluder_node"] = light.occluder->node;
  }
  Json json{{"event", "explained"},
            {"pixel", {answer.question.pixel.x, answer.question.pixel.y}},
            {"ms", answer.ms},
            {"background", answer.pixel.background}};
  if (!answer.pixel.background) {
    json["triangle"] = answer.pixel.seen.triangle;
    json["node"] = answer.pixel.seen.node;
    json["material"] = answer.pixel.seen.material;
  }
  json["lights"] = std::move(lights);
  if (!answer.day.empty()) {
    Json& day = json["day"] = Json::array();
    for (const render::LightExplanation& sun : answer.day)
      day.push_back(sun.occluder ? fmt::format("node {}", sun.occluder->node)
                                 : sights[static_cast<std::size_t>(sun.sight)]);
  }
  line(dump(json));
}

void EventReport::state(const ViewState& state) {
  if (!file_) return;
  const auto overlay = state.overlay == Overlay::none    ? "none"
                       : state.overlay == Overlay::nodes ? "nodes"
                                                         : "classes";
  Json edits = Json::array();
  for (const EditOption& edit : edit_options(state.edits))
    edits.push_back(fmt::format("{} {}", edit.name, edit.value));
  const std::string text = dump({{"event", "state"},
                                 {"file", state.options.file},
                                 {"clip", state.clip},
                                 {"playing", state.clock.playing()},
                                 {"speed", state.clock.speed()},
                                 {"loop", state.clock.loop()},
                                 {"fixed_step", state.clock.fixed_step()},
                                 {"camera", name_of(state.camera_mode)},
                                 {"free", camera_arguments(state.free, file_frame(state))},
                                 {"active", state.active},
                                 {"a", method_arguments(state.slots[0])},
                                 {"b", method_arguments(state.slots[1])},
                                 {"compare", state.compare},
                                 {"show", name_of(state.show)},
                                 {"wipe", state.wipe},
                                 {"overlay", overlay},
                                 {"lights", light_edit_texts(state.edits.lights)},
                                 {"edits", edits},
                                 {"selected_light", state.selected_light},
                                 {"selected_node", state.selected_node},
                                 {"selected_material", state.selected_material},
                                 {"sun", fmt::format("{} {:02}:{:02}", sun::day_text(state.sun.day),
                                                     state.sun.minute / 60, state.sun.minute % 60)},
                                 {"panel", state.panel},
                                 {"help", state.help}});
  if (text == last_state_) return;
  last_state_ = text;
  line(text);
}

void EventReport::marks(const Marks& marks) {
  if (!file_) return;
  Json json{{"event", "marks"}};
  for (const auto& [name, place] : marks) json[name] = {place.x, place.y, place.z, place.w};
  const std::string text = dump(json);
  if (text == last_marks_) return;
  last_marks_ = text;
  line(text);
}

void EventReport::note(const char* event, const std::string& text) {
  if (file_) line(dump({{"event", event}, {"text", text}}));
}

}  // namespace tenebra::viewer
