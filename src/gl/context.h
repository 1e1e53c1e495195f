// Offscreen OpenGL contexts: by EGL on a GPU if there is one, else in software by EGL or OSMesa, chosen at
// run time; or one adopted from a window.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tenebra/expected.h>

namespace tenebra::gl {

enum class ContextKind { automatic, egl, osmesa };

/// A kind, and for EGL the device, counted as EGL lists them (gl/survey.h).
struct ContextChoice {
  constexpr ContextChoice(ContextKind kind_ = ContextKind::automatic, std::optional<int> device_ = {})
      : kind(kind_), device(device_) {}
  ContextKind kind;
  std::optional<int> device;  ///< none: the first that draws by more than software, else any
};
std::optional<ContextChoice> context_choice_from_name(std::string_view name);  ///< auto, egl, egl:N, osmesa

struct ContextOptions {
  bool debug = false;  ///< collect the driver's messages (KHR_debug) for take_debug_messages
};

using Function = void (*)();
using FunctionLoader = Function (*)(const char* name);  ///< glfwGetProcAddress and its like

/// An OpenGL 4.5 core context, current on the thread that made it, with its functions loaded. The table of
/// functions is one for the process: of several contexts, use only the one last created or made current.
class Context {
public:
  /// automatic: EGL, else OSMesa. EGL: the first device that draws by more than software, else the
  /// surfaceless platform, else a device that draws by software. Fails with a sentence that names what each
  /// lacked.
  static Expected<Context> create(ContextChoice choice, ContextOptions options = {});
  /// The context that is current on this thread, owned by someone else (a window) who outlives this object.
  static Expected<Context> adopt(FunctionLoader loader);
  Context(Context&&) noexcept;
  Context& operator=(Context&&) noexcept;
  ~Context();

  /// Makes it current on this thread again and its functions those of the process (adopted: functions only).
  Expected<void> make_current();

  bool is_adopted() const;                 ///< others draw in it, too
  std::string_view kind_name() const;      ///< "egl", "osmesa" or "window"
  const std::string& description() const;  ///< GL_RENDERER, GL_VERSION

  FunctionLoader function_loader() const;  ///< for others who draw in this context

  /// Errors and warnings since the last call, oldest first; always empty without ContextOptions::debug.
  std::vector<std::string> take_debug_messages();

  struct Backend;
  explicit Context(std::unique_ptr<Backend> backend);

private:
  std::unique_ptr<Backend> backend_;
};

}  // namespace tenebra::gl
