// The viewer without its window: state, worker, panels. Any OpenGL context with Dear ImGui on it can show it.
#pragma once

#include "window/draw_pace.h"
#include "window/event_report.h"
#include "window/files/recording.h"
#include "window/files/session_log.h"
#include "window/messages.h"
#include "window/mouse_queue.h"
#include "window/panels/panels.h"
#include "window/pixel_answers.h"
#include "window/undo_history.h"
#include "window/view_options.h"
#include "window/view_request.h"

namespace tenebra::viewer {

class Viewer {
public:
  /// `gl` must outlive it. `wake` is called on another thread when `update` has something to do.
  Viewer(ViewOptions options, WindowGl& gl, EventReport report, const std::function<void()>& wake);

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
  bool needs_drawing() const { return pace_.is_due() || wants_presenting(); }
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
  /// The window draws again. `what`, for the report.
  void input_came(const char* what) {
    pace_.input_came();
    report_.note("input", what);
  }
  double sleep_s() const;  ///< how long to wait for events at most
  const ViewState& state() const { return state_; }
  const Picture* picture() const { return picture_.get(); }
  TradeStatus trade() const { return search_.status(); }
  const PictureAnswer* answer() const { return answers_.shown(); }
  const Marks& marks() const { return marks_; }
  std::string message() const { return messages_.newest(); }

private:
  static AnimationClock::Wall now() { return std::chrono::steady_clock::now(); }
  // What has come.
  void take_scene(OpenedScene opened);
  void take_picture(const std::shared_ptr<const Picture>& picture);
  void take_whole_picture(const std::shared_ptr<const Picture>& picture);
  void take_pick(const std::optional<glm::vec3>& point);
  void take_answer(PictureAnswer answer);
  // What is wanted.
  void act();
  void ask(QuestionKind kind, glm::dvec2 place);
  void frame_all();
  void follow_clock();
  void send_request();
  void say(std::string text, bool failure = false);
  // What is written.
  void save_picture();
  void save_shot(const char* what, const io::Image8& image);
  void toggle_log();
  void log_picture(const Picture& picture);
  void toggle_recording();
  void toggle_trade();
  void follow_search();
  void follow_sun();
  void count_hours();
  std::shared_ptr<const CountedSun> shown_hours() const;  ///< that fit what is shown; null: none do
  void end_recording(const std::string& how);
  // What is drawn.
  Ui ui_at_rest();  ///< for what the viewer does itself, not the hand
  void draw_parts(Ui& ui, const Layout& layout, ImVec2 window);
  void copy_arguments();

  ViewOptions options_;
  WindowGl& gl_;
  EventReport report_;
  ViewTextures textures_;
  ViewState state_;
  Actions actions_;
  Marks marks_;
  std::vector<KeyPress> keys_;
  MouseQueue mouse_;
  DrawPace pace_;
  std::array<FrameHistory, 2> history_;
  std::optional<SessionLog> log_;
  Recording recording_;
  std::shared_ptr<const Picture> picture_;        // the newest
  std::shared_ptr<const Picture> drawn_picture_;  // the newest at the last draw
  UndoHistory undo_;
  Messages messages_;
  std::string failure_;  // that ends the program

  Size place_{0, 0};         // of the picture in the window
  bool hand_moves_ = false;  // a mouse button is down
  RequestKey sent_;
  std::uint64_t requests_ = 0;
  std::uint64_t settings_since_ = 0;  // the first request with the present settings
  int whole_pictures_ = 0;            // that are no previews
  int shots_ = 0;
  bool window_shot_ = false;
  bool shot_waits_ = false;  // for a whole picture
  bool quit_ = false;

  bool searches_ = false;  // as the last turn of the loop found it
  TradeSearch search_;
  std::shared_ptr<const sun::Suns> suns_;  // of the day that the panel shows; null: it shows none
  SunDay suns_of_;
  std::optional<SunQuestion> counting_;  // the last that was begun
  bool counts_ = false;                  // as far as this thread knows
  bool will_count_ = false;              // as soon as the view rests
  AnimationClock::Wall changed_{};       // the last change of the view or the day
  SunCounter counter_;
  RenderWorker worker_;   // last: its thread ends first
  PixelAnswers answers_;  // and before that this one's
};

}  // namespace tenebra::viewer
