#include "window/glfw_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <cstdlib>
#include <filesystem>
#include <memory>

#include "base/fail.h"
#include "shell/stop_signals.h"
#include "window/viewer.h"

namespace tenebra::viewer {
namespace {

constexpr const char* without_window = "tenebra render makes the same pictures without a window";

std::string glfw_problem() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "no reason given";
}

/// GLFW from its start to its end.
struct Library {
  static Expected<std::unique_ptr<Library>> start() {
#ifdef GLFW_PLATFORM  // GLFW 3.4 asks for Wayland first, which complains on stderr where it has no folder for
                      // sockets
    if (std::getenv("XDG_RUNTIME_DIR") == nullptr) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
    if (!glfwInit()) {
      return base::fail("no window can be opened: found no display ({}), expected one in DISPLAY; {}",
                        glfw_problem(), without_window);
    }
    return std::make_unique<Library>();
  }
  ~Library() {
    glfwTerminate();
  }
};

struct Destroy {
  void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};
using Window = std::unique_ptr<GLFWwindow, Destroy>;

Expected<Window> open_window(const ViewOptions& options, const UserSettings& settings) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, options.gl_debug ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);  // until there is something to see: show_when_ready
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  const Size size = options.window.value_or(settings.window);
  Window window(glfwCreateWindow(size.width, size.height, "Tenebra", nullptr, nullptr));
  if (!window) {
    return base::fail("no window with OpenGL 3.3 can be opened ({}); {}", glfw_problem(), without_window);
  }
  glfwSetWindowSizeLimits(window.get(), 240, 180, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwMakeContextCurrent(window.get());
  glfwSwapInterval(1);
  return window;
}

float scale_of(GLFWwindow* window) {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window, &x, &y);
  return x;
}

/// Dear ImGui in a window, from its start to its end.
class Gui {
public:
  explicit Gui(GLFWwindow* window) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    take_events(window);
    ImGui_ImplOpenGL3_Init("#version 330 core");
    apply_style(scale_of(window));
  }
  ~Gui() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

private:
  /// Dear ImGui hears of everything but the mouse's buttons, which come from the viewer's MouseQueue, and
  /// takes in one frame all that it has heard: the queue that it has itself (1.87 and later) would hold back
  /// what follows.
  static void take_events(GLFWwindow* window) {
    const GLFWmousebuttonfun own = glfwSetMouseButtonCallback(window, nullptr);
    glfwSetMouseButtonCallback(window, own);
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    glfwSetMouseButtonCallback(window, own);
#if IMGUI_VERSION_NUM >= 18700
    ImGui::GetIO().ConfigInputTrickleEventQueue = false;
#endif
  }
};

/// Null before and after its session.
Viewer* viewer_of(GLFWwindow* window) {
  return static_cast<Viewer*>(glfwGetWindowUserPointer(window));
}

static_assert(key_code::space == GLFW_KEY_SPACE && key_code::escape == GLFW_KEY_ESCAPE &&
              key_code::tab == GLFW_KEY_TAB && key_code::backspace == GLFW_KEY_BACKSPACE &&
              key_code::right == GLFW_KEY_RIGHT && key_code::left == GLFW_KEY_LEFT &&
              key_code::home == GLFW_KEY_HOME && key_code::end == GLFW_KEY_END);

/// GLFW's code, but letters as the keyboard's layout has them.
int code_of(int key, int scancode) {
  const char* name = glfwGetKeyName(key, scancode);
  const bool letter = name && name[0] >= 'a' && name[0] <= 'z' && name[1] == 0;
  return letter ? name[0] - 'a' + 'A' : key;
}

/// Every event makes the window draw. Set before Dear ImGui's own callbacks, which call these in turn.
void watch_events(GLFWwindow* window) {
  static constexpr auto came = +[](GLFWwindow* w, const char* what) {
    if (Viewer* viewer = viewer_of(w)) viewer->input_came(what);
  };
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    if (Viewer* viewer = viewer_of(w)) viewer->mouse().move({static_cast<float>(x), static_cast<float>(y)});
    came(w, "move");
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
    if (Viewer* viewer = viewer_of(w)) viewer->mouse().button(button, action == GLFW_PRESS);
    came(w, action == GLFW_PRESS ? "press" : "release");
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double, double) { came(w, "wheel"); });
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
    Viewer* viewer = viewer_of(w);
    if (action == GLFW_RELEASE || !viewer) return came(w, "key up");
    viewer->press_key({.code = code_of(key, scancode),
                       .shift = (modifiers & GLFW_MOD_SHIFT) != 0,
                       .ctrl = (modifiers & GLFW_MOD_CONTROL) != 0,
                       .repeat = action == GLFW_REPEAT});
  });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned) { came(w, "character"); });
  glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int) { came(w, "enter"); });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int) { came(w, "focus"); });
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { came(w, "size"); });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { came(w, "refresh"); });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** files) {
    if (Viewer* viewer = viewer_of(w)) viewer->drop({files, files + count});
  });
}

bool is_visible(GLFWwindow* window) {
  return glfwGetWindowAttrib(window, GLFW_VISIBLE) == GLFW_TRUE;
}

/// The window is shown with its first picture, or after a second if its scene takes longer to load: then it
/// says so.
void show_when_ready(GLFWwindow* window, const Viewer& viewer) {
  constexpr double patience_s = 1.0;
  if (!is_visible(window) && (viewer.picture() || glfwGetTime() > patience_s)) glfwShowWindow(window);
}

/// How long to wait for events.
void wait_for_events(GLFWwindow* window, const Viewer& viewer) {
  constexpr double hidden_s = 0.005;
  const double sleep_s = is_visible(window) ? viewer.sleep_s() : hidden_s;
  sleep_s > 0 ? glfwWaitEventsTimeout(sleep_s) : glfwPollEvents();
}

/// A key that was pressed and released between two frames is down in one of them for Dear ImGui too, as keys
/// work the panel.
void feed_keys(const std::vector<KeyPress>& pressed) {
#if IMGUI_VERSION_NUM < 18700
  for (const KeyPress& press : pressed) {
    if (press.code >= 0 && press.code <= GLFW_KEY_LAST) ImGui::GetIO().KeysDown[press.code] = true;
  }
#else
  (void)pressed;
#endif
}

/// After ImGui::NewFrame: keys are as the keyboard has them again.
void release_keys(GLFWwindow* window, const std::vector<KeyPress>& pressed) {
#if IMGUI_VERSION_NUM < 18700
  for (const KeyPress& press : pressed) {
    if (press.code >= GLFW_KEY_SPACE && press.code <= GLFW_KEY_LAST)
      ImGui::GetIO().KeysDown[press.code] = glfwGetKey(window, press.code) == GLFW_PRESS;
  }
#else
  (void)window, (void)pressed;
#endif
}

void draw_frame(GLFWwindow* window, WindowGl& gl, Viewer& viewer) {
  int width = 0, height = 0, units = 0, ignored = 0;
  glfwGetFramebufferSize(window, &width, &height);
  glfwGetWindowSize(window, &units, &ignored);
  if (width < 1 || height < 1) return;  // minimised
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  viewer.mouse().feed(ImGui::GetIO());
  const std::vector<KeyPress> pressed = viewer.pressed_keys();
  feed_keys(pressed);
  ImGui::NewFrame();
  release_keys(window, pressed);
  viewer.draw(scale_of(window), static_cast<float>(width) / static_cast<float>(units));
  ImGui::Render();
  viewer.update();  // what the user has changed is requested before the screen is drawn
  if (!viewer.wants_presenting() || !is_visible(window)) return;
  gl.clear(width, height);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  viewer.after_draw(width, height);
  glfwSwapBuffers(window);
  viewer.presented();
}

void set_title(GLFWwindow* window, const Viewer& viewer, std::string& shown) {
  const std::string file = std::filesystem::path(viewer.state().options.file).filename().string();
  if (file == shown) return;
  shown = file;
  glfwSetWindowTitle(window, (file + " - Tenebra").c_str());
}

}  // namespace

Expected<int> run_window(const ViewOptions& options) {
  StopSignals stop;  // before the worker's thread
  const auto library = Library::start();
  if (!library) return tl::unexpected(library.error());
  const SettingsKeeper kept(options.settings);
  const auto window = open_window(options, kept.settings());
  if (!window) return tl::unexpected(window.error());
  auto gl = WindowGl::load(glfwGetProcAddress, options.gl_debug);
  if (!gl) return tl::unexpected(gl.error());
  auto report = EventReport::create(options.report);
  if (!report) return tl::unexpected(report.error());

  watch_events(window->get());
  const Gui gui(window->get());
  Viewer viewer(options, *gl, std::move(*report), glfwPostEmptyEvent);
  viewer.use_settings(kept);
  glfwSetWindowUserPointer(window->get(), &viewer);
  std::string title;
  while (!viewer.is_over() && !glfwWindowShouldClose(window->get()) && stop.caught() == 0) {
    wait_for_events(window->get(), viewer);
    viewer.update();
    show_when_ready(window->get(), viewer);
    if (viewer.needs_drawing()) draw_frame(window->get(), *gl, viewer);
    set_title(window->get(), viewer, title);
  }
  glfwSetWindowUserPointer(window->get(), nullptr);
  int width = 0, height = 0;
  glfwGetWindowSize(window->get(), &width, &height);
  viewer.keep_settings(kept, {width, height});
  if (auto finished = viewer.finish(); !finished) return tl::unexpected(finished.error());
  return stop.caught() != 0 ? stop.exit_code() : 0;
}

}  // namespace tenebra::viewer
