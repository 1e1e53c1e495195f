#include "window/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/fail.h"
#include "options/method_arguments.h"
#include "shared/scene_choice.h"
#include "shared/scene_summary.h"
#include "shell/console.h"
#include "window/shell_arguments.h"

namespace tenebra::viewer {
namespace {

using Wall = AnimationClock::Wall;

constexpr double message_s = 6.0;
constexpr double look_again_s = 0.1;            // while the worker is busy: progress
constexpr double progress_s = 0.25;             // its display moves this often
constexpr double longest_unpresented_s = 0.25;  // while a picture is about to come
constexpr double turn_s = 0.01;
constexpr double resting_sleep_s = 0.5;  // signals are looked at this often
constexpr float flight_share = 0.1f;     // of the scene's diagonal a second

Wall now() {
  return std::chrono::steady_clock::now();
}

const Clip* clip_of(const ScenePlan& plan, int clip) {
  return clip < 0 ? nullptr : &plan.scene.clips[static_cast<std::size_t>(clip)];
}

/// `name`, or with a number the first that no file has: a log does not replace an earlier one.
std::string unused_name(const std::filesystem::path& name) {
  std::filesystem::path file = name;
  std::error_code none;
  for (int i = 2; std::filesystem::exists(file, none); ++i) {
    file = fmt::format("{}_{}{}", name.stem().string(), i, name.extension().string());
  }
  return file.string();
}

/// With --gl-debug contexts collect what OpenGL complains about.
render::RasterChoice worker_raster(const ViewOptions& options) {
  render::RasterChoice choice = options.raster;
  choice.options.debug = options.gl_debug;
  return choice;
}

/// The middle of a pixel, 0 to 1 from the left and the top.
glm::dvec2 place_in(const Picture& picture, glm::ivec2 pixel) {
  const base::Image8& image = picture.a.result.image;
  return (glm::dvec2(pixel) + 0.5) / glm::dvec2(image.width, image.height);
}

FreeCamera start_camera(const SceneOptions& options) {
  return {*options.eye, options.look_at, options.up, options.fov_deg.value_or(FreeCamera{}.fov_deg)};
}

}  // namespace

Viewer::Viewer(ViewOptions options, WindowGl& gl, EventReport report, std::function<void()> wake)
    : options_(std::move(options)),
      gl_(gl),
      report_(std::move(report)),
      textures_(gl),
      worker_(worker_raster(options_), gl.is_software(), wake),
      explainer_(wake) {
  state_.slots = {options_.method, options_.compare.value_or(options_.method)};
  state_.compare = options_.compare.has_value();
  state_.show = options_.show;
  state_.wipe = options_.wipe;
  state_.overlay = options_.overlay;
  state_.size = options_.scene.size;
  state_.panel = options_.panel;
  state_.preview_ms = options_.preview_ms;
  if (options_.plan) {
    take_scene({options_.scene, std::move(options_.plan)});
  } else {
    worker_.open(options_.scene);
  }
}

double Viewer::sleep_s() const {
  const WorkerStatus status = worker_.status();
  if (due_ > 0) {
    // What the screen does not show yet needs no more turns than a hand can tell apart.
    const double since_s = std::chrono::duration<double>(now() - last_draw_).count();
    return unpresented_ && status.hurries ? std::max(0.0, turn_s - since_s) : 0;
  }
  const bool stirs = status.loading || status.drawing || !messages_.empty();
  double sleep_s = stirs ? std::min(look_again_s, worker_.look_again_s()) : resting_sleep_s;
  if (unpresented_) {
    const double since_s = std::chrono::duration<double>(now() - last_present_).count();
    sleep_s = std::min(sleep_s, std::max(1e-3, longest_unpresented_s - since_s));
  }
  return sleep_s;
}

bool Viewer::wants_presenting() const {
  if (!unpresented_) return false;
  const double since_s = std::chrono::duration<double>(now() - last_present_).count();
  return shown_ != drawn_ || window_shot_ || since_s >= longest_unpresented_s || !worker_.status().hurries;
}

void Viewer::presented() {
  unpresented_ = false;
  last_present_ = now();
  if (std::exchange(shown_, drawn_) != drawn_) report_.note("shown", fmt::format("{}", drawn_));
  if (shown_ == pictures_) worker_.presented();
  if (due_ > 0 || !input_undrawn_) return;
  input_undrawn_ = false;
  report_.note("drawn", "");
}

void Viewer::say(std::string text, bool failure) {
  report_.note(failure ? "failure" : "message", text);
  messages_.push_back(
      {std::move(text), failure, now() + std::chrono::milliseconds(static_cast<int>(message_s * 1e3))});
  due_ = std::max(due_, 1);
}

void Viewer::take_scene(OpenedScene opened) {
  if (!opened.scene) {
    if (!state_.scene) {
      failure_ = opened.scene.error().message;
      quit_ = true;
      return;
    }
    return say(opened.scene.error().message, true);
  }
  const bool first = !state_.scene;
  state_.scene = *opened.scene;
  state_.options = std::move(opened.options);
  const ScenePlan& plan = *state_.scene;
  state_.clip = plan.clip;
  state_.camera = plan.camera;
  AnimationClock clock(clip_of(plan, plan.clip), state_.options.fps);
  clock.set_loop(now(), first ? options_.loop : state_.clock.loop());
  clock.set_speed(now(), first ? options_.speed : state_.clock.speed());
  clock.set_fixed_step(now(), first ? options_.fixed_step : state_.clock.fixed_step());
  if (state_.options.time_s) clock.seek(now(), *state_.options.time_s);
  if (first ? options_.play : state_.clock.playing()) clock.play(now());
  state_.clock = clock;

  state_.camera_mode = CameraMode::scene;
  if (state_.options.eye) {
    state_.free = state_.start = start_camera(state_.options);
    state_.camera_mode = options_.navigate;
  }
  state_.edits = state_.options.edits;
  undo_.begin(state_.edits);
  answer_.reset();
  state_.pivot.reset();
  state_.pivot_asked = false;
  state_.selected_light = state_.selected_node = state_.selected_material = -1;
  take_light(first ? state_.slots[0].render.light : -1);
  for (FrameHistory& history : history_) history.clear();
  const auto bounds = summarize_scene(plan.scene).bounds;
  state_.diagonal_m = bounds ? glm::distance(bounds->low, bounds->high) : 1.0f;
  state_.centre = bounds ? 0.5f * (bounds->low + bounds->high) : glm::vec3(0.0f);
  state_.half_size_m = bounds ? 0.5f * (bounds->high - bounds->low) : glm::vec3(0.5f);
  state_.fly_speed = flight_share * state_.diagonal_m;
  state_.settings.remember(state_.options.file);
  report_.opened(state_.options.file, plan);
  for (const std::string& warning : plan.scene.warnings) say("Warning: " + warning);
}

/// The list of lights says which are on. One light beside emissive meshes, which are not in the list, or of
/// one slot alone stays a setting of the method.
void Viewer::take_light(int chosen) {
  const bool one_for_both = state_.slots[0].render.light == state_.slots[1].render.light;
  if (chosen >= 0 && (!one_for_both || state_.slots[0].render.area_lights.emissive_quads)) return;
  const Scene& scene = state_.scene->scene;
  const auto placed = unmoved_lights(scene, state_.edits, state_.clip, state_.options.time_s.value_or(0));
  if (chosen >= static_cast<int>(placed.size())) return;  // the renderer says so
  for (int i = 0; chosen >= 0 && i < state_.light_count(); ++i) {
    state_.light_edit(i).on = i == placed[static_cast<std::size_t>(chosen)].light;
  }
  undo_.begin(state_.edits);
  for (MethodOptions& slot : state_.slots) slot.render.light = -1;
}

void Viewer::take_picture(const std::shared_ptr<const Picture>& picture) {
  picture_ = picture;
  ++pictures_;
  report_.picture(*picture, pictures_);
  due_ = std::max(due_, 1);
  for (const std::string& note : picture->a.result.notes) say(note);
  if (!picture->preview.empty()) return;
  if (std::exchange(shot_waits_, false)) save_picture();
  if (picture->request >= settings_since_) {
    history_[static_cast<std::size_t>(picture->slot)].add(picture->a.record);
    if (picture->b) history_[1].add(picture->b->record);
  }
  if (!options_.log.empty()) toggle_log();  // --log: from the first picture on
  if (log_) log_picture(*picture);
  follow_explained_pixel(*picture);
  // By fixed steps the pictures move the clock; a hand that has moved it since is not overruled.
  if (state_.clock.fixed_step() && state_.clock.playing() && picture->request == requests_) {
    state_.clock.seek(now(), picture->a.record.time_s);
    if (state_.clock.is_over(now())) state_.clock.pause(now());
    sent_clock_ = state_.clock;
  }
  if (options_.record && !state_.clock.playing()) end_recording("Recorded to");
  if (++whole_pictures_ == options_.exit_after) quit_ = true;
}

void Viewer::take_pick(const std::optional<glm::vec3>& point) {
  if (!point) return say("There is nothing to focus on: this pixel shows the background.");
  Ui ui{state_, actions_, marks_, picture_.get(), history_, {}, {}, {}, 1};
  leave_scene_camera(ui, CameraMode::orbit);
  focus(state_.free, *point);
  state_.pivot.reset();
  state_.pivot_asked = true;  // it turns around this point
  due_ = std::max(due_, 1);
}

void Viewer::ask(QuestionKind kind, glm::ivec2 pixel) {
  if (!picture_ || picture_->scene != state_.scene) return;
  const base::Image8& image = picture_->a.result.image;
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= image.width || pixel.y >= image.height) return;
  explainer_.ask({kind, picture_, pixel, now()});
}

void Viewer::take_answer(PictureAnswer answer) {
  if (answer.question.picture->scene != state_.scene) return;
  due_ = std::max(due_, 2);
  if (answer.question.kind == QuestionKind::explain) {
    report_.explained(answer);
    answer_ = std::move(answer);
    return;
  }
  if (answer.pixel.background || state_.camera_mode != CameraMode::orbit) return;
  // The target slides along the line of sight: nothing moves in the picture.
  state_.pivot = answer.pixel.point;
  const glm::vec3 way = state_.free.target - state_.free.eye;
  const float distance = glm::dot(*state_.pivot - state_.free.eye, glm::normalize(way));
  if (distance > 0) state_.free.target = state_.free.eye + distance * glm::normalize(way);
}

/// A picture from the same place, perhaps of another size, answers the same question anew; from another place
/// there is none.
void Viewer::follow_explained_pixel(const Picture& picture) {
  if (!answer_) return;
  const Picture& asked = *answer_->question.picture;
  const base::Image8 &then = asked.a.result.image, &image = picture.a.result.image;
  const auto corner = [](const ViewRays& view, const base::Image8& of) {
    return view.d0 + static_cast<float>(of.width) * view.dx + static_cast<float>(of.height) * view.dy;
  };
  const auto near = [](glm::vec3 a, glm::vec3 b) { return glm::distance(a, b) <= 1e-4f * glm::length(a); };
  const bool same_place = picture.scene == asked.scene && picture.view.eye == asked.view.eye &&
                          near(picture.view.d0, asked.view.d0) &&
                          near(corner(picture.view, image), corner(asked.view, then));
  if (!same_place) return answer_.reset();
  const glm::ivec2 pixel = answer_->question.pixel;
  ask(QuestionKind::explain, {pixel.x * image.width / then.width, pixel.y * image.height / then.height});
}

void Viewer::follow_clock() {
  const AnimationClock& clock = state_.clock;
  if (!clock.fixed_step() && clock.is_over(now())) state_.clock.pause(now());
}

std::string Viewer::method_key() const {
  std::string key = fmt::format("{} {} {}x{}", state_.compare, state_.compare ? 0 : state_.active,
                                place_.width, place_.height);
  for (const MethodOptions& slot : state_.slots) key += "|" + method_arguments(slot);
  if (!state_.compare) {
    key = fmt::format("{} {}x{}|{}", state_.active, place_.width, place_.height,
                      method_arguments(state_.slots[static_cast<std::size_t>(state_.active)]));
  }
  key += fmt::format("|{}", static_cast<int>(state_.overlay));
  return key;
}

FrameRequest Viewer::make_request() const {
  FrameRequest request;
  request.asked = now();
  request.scene = state_.scene;
  request.clip = state_.clip;
  request.clock = state_.clock;
  request.camera = state_.camera;
  if (state_.camera_mode != CameraMode::scene) request.free = state_.free;
  request.edits = state_.edits;
  request.slot = state_.compare ? 0 : state_.active;
  const SceneDisplay& display = state_.scene->display;
  request.a = method_settings(state_.slots[static_cast<std::size_t>(request.slot)], place_, display);
  if (state_.compare) request.b = method_settings(state_.slots[1], place_, display);
  request.overlay = state_.overlay;
  request.record = options_.record;
  request.preview_ms = state_.preview_ms;
  return request;
}

void Viewer::send_request() {
  if (!state_.scene || place_.width < 1) return;
  const std::string method = method_key();
  std::string key = fmt::format("{} {} {} {}", fmt::ptr(state_.scene.get()), state_.clip, state_.camera,
                                state_.camera_mode == CameraMode::scene ? "" : camera_arguments(state_.free));
  for (const EditOption& edit : edit_options(state_.edits))
    key += fmt::format("|{} {}", edit.name, edit.value);
  const bool new_method = method != sent_method_;
  if (!new_method && key == sent_key_ && state_.clock == sent_clock_ && !actions_.retry) return;
  FrameRequest request = make_request();
  request.number = ++requests_;
  report_.request(request);
  if (new_method) {
    settings_since_ = requests_;
    for (FrameHistory& history : history_) history.clear();
  }
  // A setting chosen by a click is wanted now; a hand that drags wants to see pictures on its way.
  worker_.request(std::move(request), new_method && !hand_moves_);
  sent_method_ = method;
  sent_key_ = key;
  sent_clock_ = state_.clock;
}

void Viewer::update() {
  WorkerResults results = worker_.take_results();
  for (OpenedScene& opened : results.opened) take_scene(std::move(opened));
  for (const auto& picture : results.pictures) take_picture(picture);
  for (const auto& point : results.picked) take_pick(point);
  for (PictureAnswer& answer : explainer_.take_answers()) take_answer(std::move(answer));
  for (const std::string& text : results.failures) say(text, true);
  for (const std::string& text : results.gl_messages) report_.note("gl", text);
  follow_clock();
  act();
  send_request();
  actions_.retry = false;
  worker_.stop_if_outdated();
  const WorkerStatus status = worker_.status();
  if (status.slow && std::chrono::duration<double>(now() - last_draw_).count() > progress_s) {
    due_ = std::max(due_, 1);
  }
  while (!messages_.empty() && messages_.front().until < now()) {
    messages_.pop_front();
    due_ = std::max(due_, 1);
  }
  report_.state(state_);
  if (!failure_.empty() && !state_.scene) quit_ = true;
}

/// The first name that no file has: a screenshot does not replace an earlier one.
std::filesystem::path Viewer::next_shot() {
  std::error_code none;
  do ++shots_;
  while (std::filesystem::exists(options_.shots->file(shots_), none));
  return options_.shots->file(shots_);
}

void Viewer::save_picture() {
  if (!picture_) return;
  if (!picture_->preview.empty()) {
    shot_waits_ = true;
    return say("This is a preview: the picture is saved when it is whole.");
  }
  const auto file = next_shot();
  const auto written = base::write_png(file, picture_->a.result.image);
  report_.note(written ? "shot" : "failure", written ? file.string() : written.error().message);
  say(written ? fmt::format("Picture saved to {}", file.string()) : written.error().message, !written);
}

void Viewer::after_draw(int framebuffer_width, int framebuffer_height) {
  if (!window_shot_) return;
  window_shot_ = false;
  const auto file = next_shot();
  const auto written = base::write_png(file, gl_.read_window(framebuffer_width, framebuffer_height));
  report_.note(written ? "shot" : "failure", written ? file.string() : written.error().message);
  say(written ? fmt::format("Window saved to {}", file.string()) : written.error().message, !written);
}

void Viewer::toggle_log() {
  if (log_) {
    const std::string path = log_->path();
    const auto finished = log_->finish();
    log_.reset();
    return say(finished ? fmt::format("Log written to {}", path) : finished.error().message, !finished);
  }
  if (!picture_) return;
  if (!picture_->preview.empty()) return say("The log starts with a whole picture; this is a preview.");
  const std::string path =
      options_.log.empty() ? unused_name("tenebra_frames.csv") : std::exchange(options_.log, "");
  auto log = SessionLog::start(path, state_, *picture_, worker_.raster());
  if (!log) return say(log.error().message, true);
  log_.emplace(std::move(*log));
  say(fmt::format("Logging frames to {}", path));
}

void Viewer::frame_all() {
  if (!picture_) return;
  Ui ui{state_, actions_, marks_, picture_.get(), history_, {}, {}, {}, 1};
  leave_scene_camera(ui, CameraMode::orbit);
  const base::Image8& image = picture_->a.result.image;
  frame(state_.free, state_.centre - state_.half_size_m, state_.centre + state_.half_size_m,
        static_cast<double>(image.width) / image.height);
  state_.pivot.reset();
  state_.pivot_asked = true;  // it turns around the middle
  due_ = std::max(due_, 1);
}

/// Every frame from the first on, as --record does.
void Viewer::toggle_recording() {
  if (options_.record) {
    state_.clock.pause(now());
    return end_recording("Recording ended; the pictures are in");
  }
  const std::string folder = unused_name("tenebra_frames");
  auto pattern = OutputPattern::parse(folder + "/%04d.png");
  if (pattern) {
    if (auto prepared = pattern->prepare_folder(); !prepared) return say(prepared.error().message, true);
  }
  if (!pattern) return say(pattern.error().message, true);
  before_recording_ = state_.clock;
  options_.record = std::move(*pattern);
  state_.recording = true;
  state_.clock.set_loop(now(), false);
  state_.clock.set_fixed_step(now(), true);
  state_.clock.set_speed(now(), std::abs(state_.clock.speed()));
  state_.clock.seek(now(), state_.clock.start_s());
  state_.clock.play(now());
  say(fmt::format("Recording {} frames to {}", state_.clock.frames(), folder));
}

void Viewer::end_recording(const std::string& how) {
  say(fmt::format("{} {}", how, options_.record->text()));
  options_.record.reset();
  if (!std::exchange(state_.recording, false)) return;
  state_.clock.set_loop(now(), before_recording_.loop());
  state_.clock.set_fixed_step(now(), before_recording_.fixed_step());
  state_.clock.set_speed(now(), before_recording_.speed());
}

void Viewer::use_settings(const SettingsKeeper& kept) {
  const std::vector<std::string> opened =
      std::move(state_.settings.recent);  // a scene that was there already
  state_.settings = kept.settings();
  for (const std::string& file : opened) state_.settings.remember(file);
  if (!options_.panel_given) state_.panel = state_.settings.panel;
  if (!kept.problem().empty()) say(kept.problem(), true);
}

void Viewer::keep_settings(const SettingsKeeper& kept, Size window) {
  if (window.width > 0 && window.height > 0) state_.settings.window = window;
  state_.settings.panel = state_.panel;
  if (const auto done = kept.keep(state_.settings); !done) report_.note("failure", done.error().message);
}

void Viewer::log_picture(const Picture& picture) {
  const bool belongs = log_->belongs(state_);
  const auto added = belongs ? log_->add(picture) : Expected<void>();
  if (!added) {
    say(added.error().message, true);
    log_.reset();
  } else if (!belongs) {
    toggle_log();
    say("The log ended where the settings changed.");
  }
}

void Viewer::act() {
  const Actions actions = std::exchange(actions_, {});
  actions_.retry = actions.retry;  // for send_request
  quit_ = quit_ || actions.quit;
  if (actions.cancel && worker_.status().drawing) {
    worker_.cancel();
    state_.clock.pause(now());
    sent_clock_ = state_.clock;
    say("Cancelled: the picture is the last that was finished. Press R to compute the new one.");
  }
  if (actions.picture_shot) save_picture();
  if (actions.window_shot) window_shot_ = true, due_ = std::max(due_, 1);
  if (actions.toggle_log) toggle_log();
  if (actions.focus && picture_) worker_.pick(place_in(*picture_, *actions.focus));
  if (actions.explain) ask(QuestionKind::explain, *actions.explain);
  if (actions.pivot) ask(QuestionKind::pivot, *actions.pivot);
  if (actions.end_explanation) answer_.reset(), due_ = std::max(due_, 2);
  if (actions.undo && !undo_.undo(state_.edits)) say("There is nothing to undo.");
  if (actions.redo && !undo_.redo(state_.edits)) say("There is nothing to do again.");
  if (actions.open) drop({*actions.open});
  if (actions.open_dialog)
    state_.open_dialog = open_dialog_at(state_.settings.folder), due_ = std::max(due_, 3);
  if (actions.frame_all) frame_all();
  if (actions.record) toggle_recording();
}

void Viewer::drop(const std::vector<std::string>& files) {
  if (files.empty()) return;
  report_.note("drop", files.front());
  worker_.open(options_for(files.front(), options_.scene));
  if (files.size() > 1) say(fmt::format("{} files were dropped; the first is opened.", files.size()));
}

Expected<void> Viewer::finish() {
  for (const std::string& text : gl_.take_messages()) report_.note("gl", text);
  report_.note("end", fmt::format("{} pictures", pictures_));
  if (log_) {
    if (auto finished = log_->finish(); !finished) return finished;
  }
  if (!failure_.empty()) return base::fail("{}", failure_);
  return {};
}

void Viewer::draw_messages(Area view) {
  float y = view.low.y + 10;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  for (const Message& message : messages_) {
    const float width = std::min(view.size.x - 20, 640.0f * ImGui::GetFontSize() / 15);
    const ImVec2 size = ImGui::CalcTextSize(message.text.c_str(), nullptr, false, width - 24);
    list.AddRectFilled({view.low.x + 10, y}, {view.low.x + 34 + size.x, y + size.y + 14}, palette::shade, 4);
    list.AddRectFilled({view.low.x + 10, y}, {view.low.x + 13, y + size.y + 14},
                       message.failure ? palette::warning : palette::accent);
    list.AddText(nullptr, 0, {view.low.x + 22, y + 7}, palette::text, message.text.c_str(), nullptr,
                 width - 24);
    y += size.y + 20;
    marks_["message"] = {view.low.x + 10, view.low.y + 10, view.low.x + 34 + size.x, y};
  }
}

void Viewer::draw(float scale, float pixels_a_unit) {
  const float seconds = std::chrono::duration<float>(now() - last_draw_).count();
  last_draw_ = now();
  due_ = std::max(mouse_.waits() ? 3 : 0, due_ - 1);
  ImGuiIO& io = ImGui::GetIO();
  hand_moves_ = ImGui::IsAnyMouseDown();
  const std::string log = log_ ? log_->path() : "";
  marks_.clear();
  Ui ui{state_, actions_, marks_, picture_.get(), history_, keys_, worker_.status(), log, scale, answer()};
  handle_keys(ui, std::min(seconds, 0.1f));
  const ImGuiConfigFlags nav = ImGuiConfigFlags_NavEnableKeyboard;
  io.ConfigFlags = state_.keys_in_panel ? io.ConfigFlags | nav : io.ConfigFlags & ~nav;
  if (flies(io)) due_ = std::max(due_, 1);

  const Layout layout = layout_of(ui, io.DisplaySize);
  place_ = state_.size.value_or(picture_size(state_, layout.view, pixels_a_unit));
  if (picture_) {
    const Size shown = picture_size(state_, layout.view, pixels_a_unit);
    const base::Image8& image = picture_->a.result.image;
    textures_.show(picture_, state_,
                   picture_->preview.empty() && image.width <= shown.width && image.height <= shown.height);
  }
  draw_view(ui, textures_, layout.view);
  draw_explanation_card(ui, layout.view);
  draw_transport(ui, layout.transport);
  if (layout.has_panel) draw_panel(ui, layout.panel);
  draw_progress(ui, layout.view);
  if (state_.help) draw_help(ui, io.DisplaySize);
  draw_open_dialog(ui, io.DisplaySize);
  draw_messages(layout.view);
  if (actions_.copy_arguments && state_.scene) {
    const std::string text = shell_arguments(state_, state_.clock.time_at(now()), place_);
    ImGui::SetClipboardText(text.c_str());
    report_.note("copied", text);
    say("Copied: " + text);
  }
  undo_.follow(state_.edits, !hand_moves_ && !ImGui::IsAnyItemActive());
  const Actions& asked = actions_;
  if (asked.quit || asked.cancel || asked.retry || asked.picture_shot || asked.window_shot ||
      asked.toggle_log || asked.focus || asked.open || asked.open_dialog || asked.frame_all || asked.record ||
      asked.explain || asked.pivot || asked.end_explanation || asked.undo || asked.redo) {
    due_ = std::max(due_, 1);
  }
  keys_.clear();
  report_.marks(marks_);
  drawn_ = pictures_;
  unpresented_ = true;
}

}  // namespace tenebra::viewer
