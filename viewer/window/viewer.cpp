#include "window/viewer.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/fail.h"
#include "window/scene_start.h"
#include "window/shell_arguments.h"

namespace tenebra::viewer {
namespace {

constexpr double progress_s = 0.25;  // its display moves this often

/// With --gl-debug contexts collect what OpenGL complains about.
render::RasterChoice worker_raster(const ViewOptions& options) {
  render::RasterChoice choice = options.raster;
  choice.options.debug = options.gl_debug;
  return choice;
}

}  // namespace

Viewer::Viewer(ViewOptions options, WindowGl& gl, EventReport report, const std::function<void()>& wake)
    : options_(std::move(options)),
      gl_(gl),
      report_(std::move(report)),
      textures_(gl),
      recording_(std::exchange(options_.record, std::nullopt)),
      search_(trade_work(options_.raster), wake),
      counter_(count_sun, wake),
      worker_(worker_raster(options_), gl.is_software(), wake),
      answers_(wake) {
  state_.slots = {options_.method, options_.compare.value_or(options_.method)};
  state_.compare = options_.compare.has_value();
  state_.show = options_.show;
  state_.wipe = options_.wipe;
  state_.overlay = options_.overlay;
  state_.size = options_.scene.size;
  state_.panel = options_.panel;
  state_.preview_ms = options_.preview_ms;
  if (options_.staged) {
    take_scene({options_.scene, std::move(options_.staged)});
  } else {
    worker_.open(options_.scene);
  }
}

double Viewer::sleep_s() const {
  const WorkerStatus status = worker_.status();
  const bool moves = status.loading || status.drawing || !messages_.empty() || search_.status().running ||
                     counter_.status().running || will_count_;
  return pace_.sleep_s({status.hurries, moves, worker_.look_again_s()}, now());
}

bool Viewer::wants_presenting() const {
  return pace_.wants_presenting(window_shot_, worker_.status().hurries, now());
}

void Viewer::presented() {
  const DrawPace::Presented done = pace_.presented();
  if (done.new_picture) report_.note("shown", fmt::format("{}", done.picture));
  if (done.newest) worker_.presented();
  if (done.inputs) report_.note("drawn", "");
}

void Viewer::say(std::string text, bool failure) {
  report_.note(failure ? "failure" : "message", text);
  messages_.add(std::move(text), failure, now());
  pace_.ask(1);
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
  start_scene(state_, *opened.scene, std::move(opened.options), options_, now());
  undo_.begin(state_.edits);
  answers_.close();
  counter_.forget();
  counting_.reset();
  state_.sun.dark_light = -1;
  for (FrameHistory& history : history_) history.clear();
  state_.settings.remember(state_.options.file);
  report_.opened(state_.options.file, *state_.scene);
  for (const std::string& warning : state_.scene->scene.warnings) say("Warning: " + warning);
}

void Viewer::take_picture(const std::shared_ptr<const Picture>& picture) {
  picture_ = picture;
  pace_.picture_came();
  report_.picture(*picture, pace_.pictures());
  for (const std::string& note : picture->a.result.notes) say(note);
  if (picture->preview.empty()) take_whole_picture(picture);
}

void Viewer::take_whole_picture(const std::shared_ptr<const Picture>& picture) {
  if (std::exchange(shot_waits_, false)) save_picture();
  if (picture->request >= settings_since_) {
    history_[static_cast<std::size_t>(picture->slot)].add(picture->a.record);
    if (picture->b) history_[1].add(picture->b->record);
  }
  if (!options_.log.empty()) toggle_log();  // --log: from the first picture on
  if (log_) log_picture(*picture);
  answers_.follow(picture);
  // By fixed steps the pictures move the clock; a hand that has moved it since is not overruled.
  if (state_.clock.fixed_step() && state_.clock.playing() && picture->request == requests_) {
    state_.clock.seek(now(), picture->a.record.time_s);
    if (state_.clock.is_over(now())) state_.clock.pause(now());
    sent_.clock = state_.clock;
  }
  if (recording_.is_on() && !state_.clock.playing()) end_recording("Recorded to");
  if (++whole_pictures_ == options_.exit_after) quit_ = true;
}

Ui Viewer::ui_at_rest() {
  return {state_, actions_, marks_, picture_.get(), history_, {}, {}, {}, 1};
}

void Viewer::take_pick(const std::optional<glm::vec3>& point) {
  if (!point) return say("There is nothing to focus on: this pixel shows the background.");
  Ui ui = ui_at_rest();
  leave_scene_camera(ui, CameraMode::orbit);
  focus(state_.free, *point);
  state_.pivot.reset();
  state_.pivot_asked = true;  // it turns around this point
  pace_.ask(1);
}

void Viewer::ask(QuestionKind kind, glm::dvec2 place) {
  if (!drawn_picture_ || drawn_picture_->scene != state_.scene) return;
  // The hand points at what was drawn; the whole picture may have come since.
  answers_.ask(kind, drawn_picture_, place);
  if (picture_->preview.empty()) answers_.follow(picture_);
}

void Viewer::take_answer(PictureAnswer answer) {
  if (answer.question.picture->scene != state_.scene) return;
  pace_.ask(2);
  if (answer.question.kind == QuestionKind::explain) {
    report_.explained(answer);
    return answers_.show(std::move(answer));
  }
  if (answer.pixel.background || state_.camera_mode != CameraMode::orbit) return;
  // The target slides along the line of sight: nothing moves in the picture.
  state_.pivot = answer.pixel.point;
  const glm::vec3 way = state_.free.target - state_.free.eye;
  const float distance = glm::dot(*state_.pivot - state_.free.eye, glm::normalize(way));
  if (distance > 0) state_.free.target = state_.free.eye + distance * glm::normalize(way);
}

void Viewer::follow_clock() {
  const AnimationClock& clock = state_.clock;
  if (!clock.fixed_step() && clock.is_over(now())) state_.clock.pause(now());
}

void Viewer::send_request() {
  if (!state_.scene || place_.width < 1) return;
  RequestKey key = request_key(state_, place_);
  if (key == sent_ && !actions_.retry) return;
  const bool new_method = key.method != sent_.method;
  FrameRequest request = view_request(state_, place_, recording_.files(), now());
  request.number = ++requests_;
  report_.request(request);
  if (new_method) {
    settings_since_ = requests_;
    for (FrameHistory& history : history_) history.clear();
  }
  // A setting chosen by a click is wanted now; a hand that drags wants to see pictures on its way.
  worker_.request(std::move(request), new_method && !hand_moves_);
  sent_ = std::move(key);
  changed_ = now();
}

void Viewer::update() {
  WorkerResults results = worker_.take_results();
  for (OpenedScene& opened : results.opened) take_scene(std::move(opened));
  for (const auto& picture : results.pictures) take_picture(picture);
  for (const auto& point : results.picked) take_pick(point);
  for (const MeteredScene& metered : results.metered) {
    if (!metered.exposures)
      say(metered.exposures.error().message, true);
    else if (metered.scene == state_.scene)
      state_.display.exposures = *metered.exposures, state_.metered_edits = metered.edits;
  }
  for (auto& answer : answers_.take()) {
    if (answer)
      take_answer(std::move(*answer));
    else
      say(answer.error().message, true);
  }
  for (const std::string& text : results.failures) say(text, true);
  for (const std::string& text : results.gl_messages) report_.note("gl", text);
  follow_clock();
  act();
  send_request();
  actions_.retry = false;
  worker_.stop_if_outdated();
  follow_search();
  follow_sun();
  const WorkerStatus status = worker_.status();
  if (status.slow && pace_.since_drawn_s(now()) > progress_s) pace_.ask(1);
  if (messages_.forget_old(now())) pace_.ask(1);
  report_.state(state_);
  if (!failure_.empty() && !state_.scene) quit_ = true;
}

void Viewer::frame_all() {
  if (!picture_) return;
  Ui ui = ui_at_rest();
  leave_scene_camera(ui, CameraMode::orbit);
  const io::Image8& image = picture_->a.result.image;
  frame(state_.free, state_.centre - state_.half_size_m, state_.centre + state_.half_size_m,
        static_cast<double>(image.width) / image.height);
  state_.pivot.reset();
  state_.pivot_asked = true;  // it turns around the middle
  pace_.ask(1);
}

void Viewer::act() {
  const Actions actions = std::exchange(actions_, {});
  actions_.retry = actions.retry;  // for send_request
  quit_ = quit_ || actions.quit;
  if (actions.cancel && worker_.status().drawing) {
    worker_.cancel();
    state_.clock.pause(now());
    sent_.clock = state_.clock;
    say("Cancelled: this is the last finished picture. Press R to compute the new one.");
  }
  if (actions.cancel && !worker_.status().drawing) {
    search_.stop();
    if (counts_) state_.sun.colours = false;
  }
  if (actions.picture_shot) save_picture();
  if (actions.window_shot) window_shot_ = true, pace_.ask(1);
  if (actions.toggle_log) toggle_log();
  if (actions.focus && picture_) worker_.pick(*actions.focus);
  if (actions.meter && state_.scene && !state_.is_metered()) {
    SceneOptions options = state_.options;
    options.edits = state_.edits;
    worker_.meter(state_.scene, std::move(options));
  }
  if (actions.explain) ask(QuestionKind::explain, *actions.explain);
  if (actions.pivot) ask(QuestionKind::pivot, *actions.pivot);
  if (actions.end_explanation) answers_.close(), pace_.ask(2);
  if (actions.undo && !undo_.undo(state_.edits)) say("There is nothing to undo.");
  if (actions.redo && !undo_.redo(state_.edits)) say("There is nothing to redo.");
  if (actions.open) drop({*actions.open});
  if (actions.open_dialog) state_.open_dialog = open_dialog_at(state_.settings.folder), pace_.ask(3);
  if (actions.frame_all) frame_all();
  if (actions.record) toggle_recording();
  if (actions.trade) toggle_trade();
}

void Viewer::drop(const std::vector<std::string>& files) {
  if (files.empty()) return;
  report_.note("drop", files.front());
  worker_.open(settings_for(files.front(), options_.scene));
  if (files.size() > 1) say(fmt::format("{} files were dropped; the first is opened.", files.size()));
}

Expected<void> Viewer::finish() {
  for (const std::string& text : gl_.take_messages()) report_.note("gl", text);
  report_.note("end", fmt::format("{} pictures", pace_.pictures()));
  if (log_) {
    if (auto finished = log_->finish(); !finished) return finished;
  }
  if (!failure_.empty()) return base::fail("{}", failure_);
  return {};
}

void Viewer::copy_arguments() {
  const std::string text = shell_arguments(state_, state_.clock.time_at(now()), place_);
  ImGui::SetClipboardText(text.c_str());
  report_.note("copied", text);
  say("Copied: " + text);
}

void Viewer::draw_parts(Ui& ui, const Layout& layout, ImVec2 window) {
  draw_view(ui, textures_, layout.view);
  draw_explanation_card(ui, layout.view);
  draw_transport(ui, layout.transport);
  if (layout.has_panel) draw_panel(ui, layout.panel);
  draw_progress(ui, layout.view);
  if (state_.help) draw_help(ui, window);
  draw_open_dialog(ui, window);
  messages_.draw(layout.view, marks_);
}

void Viewer::draw(float scale, float pixels_a_unit) {
  const auto seconds = static_cast<float>(pace_.since_drawn_s(now()));
  pace_.begin_draw(mouse_.waits(), now());
  ImGuiIO& io = ImGui::GetIO();
  hand_moves_ = ImGui::IsAnyMouseDown();
  const std::string log = log_ ? log_->path() : "";
  marks_.clear();
  drawn_picture_ = picture_;
  Ui ui{state_, actions_, marks_, picture_.get(), history_, keys_, worker_.status(), log, scale, answer()};
  ui.trade = search_.status();
  if (state_.scene) ui.trade_subject = trade_subject(state_, place_, now());
  ui.sun = counter_.status();
  const auto hours = shown_hours();
  ui.hours = hours.get();
  textures_.show_hours(hours);
  handle_keys(ui, std::min(seconds, 0.1f));
  const ImGuiConfigFlags nav = ImGuiConfigFlags_NavEnableKeyboard;
  io.ConfigFlags = state_.keys_in_panel ? io.ConfigFlags | nav : io.ConfigFlags & ~nav;
  if (flies(io)) pace_.ask(1);

  const Layout layout = layout_of(ui, io.DisplaySize);
  const Size shown = picture_size(state_, layout.view, pixels_a_unit);
  place_ = state_.size.value_or(shown);
  if (picture_) {
    const io::Image8& image = picture_->a.result.image;
    textures_.show(picture_, state_,
                   picture_->preview.empty() && image.width <= shown.width && image.height <= shown.height);
  }
  draw_parts(ui, layout, io.DisplaySize);
  if (actions_.copy_arguments && state_.scene) copy_arguments();
  undo_.follow(state_.edits, !hand_moves_ && !ImGui::IsAnyItemActive());
  if (actions_ != Actions{}) pace_.ask(1);
  keys_.clear();
  report_.marks(marks_);
  pace_.end_draw();
}

}  // namespace tenebra::viewer
