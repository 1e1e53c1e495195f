// The viewer without its window: state, worker, panels. Any OpenGL context with Dear ImGui on it can show it.
#pragma once

#include <deque>

#include "window/event_report.h"
#include "window/mouse_queue.h"
#include "window/panels/panels.h"
#include "window/session_log.h"
#include "window/undo_history.h"
#include "window/view_options.h"

namespace tenebra::viewer {

class Viewer {
public:
  /// `gl` must outlive it. `wake` is called on another thread when `update` has something to do.
  Viewer(ViewOptions options, WindowGl& gl, EventReport report, std::function<void()> wake);

  /// Takes what the worker has finished and asks it for what the state wants; once a turn of the loop.
  void update();
  /// Draws everything; between ImGui::NewFrame and ImGui::Render. `pixels_a_unit`: of the framebuffer.
  void draw(float scale, float pixels_a_unit);
  /// After it was drawn by OpenGL: writes a screenshot of the window if one was asked for.
  void after_draw(int framebuffer_width, int framebuffer_height);
  void drop(const std::vector<std::string>& files);
  /// At the begin of a session, and at its end; a failure is a line in the report.
  void use_settings(const SettingsKeeper& kept);
  void keep_settings(const SettingsKeeper& kept, Size window);
  /// Ends the log; its failure, if any, or that of the first scene.
  Expected<void> finish();

  bool is_over() const { return quit_; }
  bool needs_drawing() const { return due_ > 0 || wants_presenting(); }
  /// Whether what was drawn last is to be brought to the screen: where a picture is about to come, that
  /// picture brings along what the hand has changed. Software OpenGL would take the picture's processors.
  bool wants_presenting() const;
  void presented();  ///< what was drawn is on the screen
  void press_key(KeyPress press) {
    keys_.push_back(press);
    input_came("key down");
  }
  /// Since the last draw.
  const std::vector<KeyPress>& pressed_keys() const { return keys_; }
  MouseQueue& mouse() { return mouse_; }
  /// The window draws again: Dear ImGui takes a frame or two to settle. `what`, for the report.
  void input_came(const char* what) {
    due_ = std::max(due_, 3);
    input_undrawn_ = true;
    report_.note("input", what);
  }
  double sleep_s() const;  ///< how long to wait for events at most
  const ViewState& state() const { return state_; }
  const Picture* picture() const { return picture_.get(); }
  const PictureAnswer* answer() const { return answer_ ? &*answer_ : nullptr; }
  const Marks& marks() const { return marks_; }
  std::string message() const { return messages_.empty() ? "" : messages_.back().text; }

private:
  struct Message {
    std::string text;
    bool failure;
    AnimationClock::Wall until;
  };

  void take_scene(OpenedScene opened);
  void take_light(int chosen);
  void take_picture(const std::shared_ptr<const Picture>& picture);
  void take_pick(const std::optional<glm::vec3>& point);
  void take_answer(PictureAnswer answer);
  void ask(QuestionKind kind, glm::ivec2 pixel);
  void follow_explained_pixel(const Picture& picture);
  void follow_clock();
  FrameRequest make_request() const;
  std::string method_key() const;
  void send_request();
  void act();
  void say(std::string text, bool failure = false);
  void draw_messages(Area view);
  std::filesystem::path next_shot();
  void save_picture();
  void toggle_log();
  void frame_all();
  void toggle_recording();
  void end_recording(const std::string& how);
  void log_picture(const Picture& picture);

  ViewOptions options_;
  WindowGl& gl_;
  EventReport report_;
  ViewTextures textures_;
  ViewState state_;
  Actions actions_;
  Marks marks_;
  std::vector<KeyPress> keys_;
  MouseQueue mouse_;
  std::array<FrameHistory, 2> history_;
  std::optional<SessionLog> log_;
  std::shared_ptr<const Picture> picture_;
  std::optional<PictureAnswer> answer_;  // that is shown
  UndoHistory undo_;
  std::deque<Message> messages_;
  std::string failure_;  // that ends the program

  Size place_{0, 0};  // of the picture in the window
  AnimationClock before_recording_;
  bool hand_moves_ = false;  // a mouse button is down
  std::string sent_key_, sent_method_;
  AnimationClock sent_clock_;
  std::uint64_t requests_ = 0;
  std::uint64_t settings_since_ = 0;  // the first request with the present settings
  std::uint64_t pictures_ = 0;
  std::uint64_t drawn_ = 0;  // of pictures_, by the last draw
  std::uint64_t shown_ = 0;  // of pictures_, on the screen
  int whole_pictures_ = 0;   // that are no previews
  int shots_ = 0;
  bool window_shot_ = false;
  bool shot_waits_ = false;  // for a whole picture
  bool input_undrawn_ = false;
  bool quit_ = false;
  int due_ = 3;               // frames of the window to draw
  bool unpresented_ = false;  // something is drawn and not on the screen
  AnimationClock::Wall last_draw_{}, last_present_{};

  RenderWorker worker_;  // last: its thread ends first
  Explainer explainer_;  // and before that this one's
};

}  // namespace tenebra::viewer
