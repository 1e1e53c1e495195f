// Contexts without a window by EGL: on the devices that it lists, the first of which that is a GPU is taken,
// and on Mesa's surfaceless platform. Loaded at run time: what draws on the CPU needs no EGL.
#define EGL_NO_X11
#include <dlfcn.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>

#include "gl/backend.h"

#include "base/fail.h"
#include "gl/egl_choice.h"
#include "gl/renderer_name.h"

namespace tenebra::gl {
namespace {

/// Functions of libEGL.
struct Egl {
  decltype(&eglBindAPI) bind_api = nullptr;
  decltype(&eglChooseConfig) choose_config = nullptr;
  decltype(&eglCreateContext) create_context = nullptr;
  decltype(&eglDestroyContext) destroy_context = nullptr;
  decltype(&eglGetCurrentContext) current_context = nullptr;
  decltype(&eglGetError) error = nullptr;
  decltype(&eglGetPlatformDisplay) platform_display = nullptr;
  decltype(&eglGetProcAddress) function = nullptr;
  decltype(&eglInitialize) initialize = nullptr;
  decltype(&eglMakeCurrent) make_current = nullptr;
  decltype(&eglQueryString) string = nullptr;
};

template <class Pointer>
bool find(void* library, const char* name, Pointer& function) {
  function = reinterpret_cast<Pointer>(dlsym(library, name));
  return function != nullptr;
}

Expected<Egl> load_egl() {
  // Never unloaded: its threads and its exit handlers outlive the contexts.
  void* const handle = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (handle == nullptr) return base::fail(ErrorKind::device, "EGL: found no libEGL.so.1");
  Egl egl;
  const bool complete =
      find(handle, "eglBindAPI", egl.bind_api) && find(handle, "eglChooseConfig", egl.choose_config) &&
      find(handle, "eglCreateContext", egl.create_context) &&
      find(handle, "eglDestroyContext", egl.destroy_context) &&
      find(handle, "eglGetCurrentContext", egl.current_context) && find(handle, "eglGetError", egl.error) &&
      find(handle, "eglGetPlatformDisplay", egl.platform_display) &&
      find(handle, "eglGetProcAddress", egl.function) && find(handle, "eglInitialize", egl.initialize) &&
      find(handle, "eglMakeCurrent", egl.make_current) && find(handle, "eglQueryString", egl.string);
  dlclose(handle);
  if (!complete) return base::fail(ErrorKind::device, "EGL: found a library older than EGL 1.5");
  return egl;
}

/// eglGetProcAddress of the library that is loaded: a FunctionLoader holds no state.
Function egl_function(const char* name) {
  static const auto loaded = load_egl();
  return loaded ? loaded->function(name) : nullptr;
}

struct EglBackend final : Context::Backend {
  EglBackend(const Egl& egl, EGLDisplay display, EGLContext context)
      : egl_(egl), display_(display), context_(context) {}
  // The display stays initialised: EGL has one per process, and other contexts may live on it.
  ~EglBackend() override {
    if (egl_.current_context() == context_) {
      egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    egl_.destroy_context(display_, context_);
  }
  bool make_current() override {
    return egl_.bind_api(EGL_OPENGL_API) &&
           egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
  }
  FunctionLoader loader() const override { return egl_function; }
  std::string_view kind_name() const override { return "egl"; }

private:
  Egl egl_;
  EGLDisplay display_;
  EGLContext context_;
};

/// Where a context can be asked for.
struct Platform {
  std::string name;
  EGLenum platform = 0;
  void* native = nullptr;
  EglPlatform kind = EglPlatform::surfaceless;
  std::optional<int> device;  ///< none: the surfaceless platform
};

bool has_word(const char* list, std::string_view word) {
  const std::string padded = fmt::format(" {} ", list != nullptr ? list : "");
  return padded.find(fmt::format(" {} ", word)) != std::string::npos;
}

/// In the order of EGL, whose dispatcher asks the drivers in the order of their files.
std::vector<Platform> devices_of(const Egl& egl) {
  // The dispatcher has entry points for what no driver can do: only these words say that it is there.
  const char* const can = egl.string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const bool lists = has_word(can, "EGL_EXT_device_base") || has_word(can, "EGL_EXT_device_enumeration");
  if (!lists || !has_word(can, "EGL_EXT_platform_device")) return {};
  const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.function("eglQueryDevicesEXT"));
  const auto text = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(egl.function("eglQueryDeviceStringEXT"));
  constexpr int max_devices = 32;
  std::array<EGLDeviceEXT, max_devices> devices{};
  EGLint count = 0;
  std::vector<Platform> result;
  if (query == nullptr || !query(max_devices, devices.data(), &count)) return result;
  for (int i = 0; i < count; ++i) {
    const EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
    const char* const kinds = text != nullptr ? text(device, EGL_EXTENSIONS) : nullptr;
    const bool software = has_word(kinds, "EGL_MESA_device_software");
    result.push_back({fmt::format("device {}", i), EGL_PLATFORM_DEVICE_EXT, device,
                      software ? EglPlatform::software_device : EglPlatform::device, i});
  }
  return result;
}

std::vector<Platform> platforms_of(const Egl& egl) {
  std::vector<Platform> all = devices_of(egl);
  all.push_back({"surfaceless",
                 EGL_PLATFORM_SURFACELESS_MESA,
                 reinterpret_cast<void*>(EGL_DEFAULT_DISPLAY),
                 EglPlatform::surfaceless,
                 {}});
  return all;
}

EGLContext create_context(const Egl& egl, EGLDisplay display, ContextOptions options) {
  // No surface is ever drawn to: any configuration that OpenGL can use will do.
  const EGLint config_wants[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint config_count = 0;
  if (!egl.bind_api(EGL_OPENGL_API)) return EGL_NO_CONTEXT;
  if (!egl.choose_config(display, config_wants, &config, 1, &config_count) || config_count == 0) {
    return EGL_NO_CONTEXT;
  }
  const EGLint wants[] = {EGL_CONTEXT_MAJOR_VERSION,
                          4,
                          EGL_CONTEXT_MINOR_VERSION,
                          5,
                          EGL_CONTEXT_OPENGL_PROFILE_MASK,
                          EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                          EGL_CONTEXT_OPENGL_DEBUG,
                          options.debug ? EGL_TRUE : EGL_FALSE,
                          EGL_NONE};
  return egl.create_context(display, config, EGL_NO_CONTEXT, wants);
}

BackendResult create_on(const Egl& egl, const Platform& platform, ContextOptions options) {
  const EGLDisplay display = egl.platform_display(platform.platform, platform.native, nullptr);
  if (display == EGL_NO_DISPLAY) return base::fail(ErrorKind::device, "{}: no such platform", platform.name);
  if (!egl.initialize(display, nullptr, nullptr)) {
    return base::fail(ErrorKind::device, "{}: not initialised (EGL error {:#x})", platform.name, egl.error());
  }
  const EGLContext context = create_context(egl, display, options);
  if (context == EGL_NO_CONTEXT) {
    return base::fail(ErrorKind::device, "{}: no OpenGL 4.5 core context (EGL error {:#x})", platform.name,
                      egl.error());
  }
  auto backend = std::make_unique<EglBackend>(egl, display, context);
  if (!backend->make_current()) {
    return base::fail(ErrorKind::device, "{}: no context without a surface (EGL error {:#x})", platform.name,
                      egl.error());
  }
  return backend;
}

/// Of the context that is current.
bool draws_by_software(const Egl& egl) {
  using GetString = const unsigned char* (*)(unsigned);
  constexpr unsigned gl_renderer = 0x1F01;
  const auto get_string = reinterpret_cast<GetString>(egl.function("glGetString"));
  const unsigned char* const renderer = get_string != nullptr ? get_string(gl_renderer) : nullptr;
  return renderer != nullptr && is_software_renderer(reinterpret_cast<const char*>(renderer));
}

BackendResult create_on_device(const Egl& egl, int device, ContextOptions options) {
  const std::vector<Platform> devices = devices_of(egl);
  if (devices.empty())
    return base::fail(ErrorKind::device, "EGL lists no devices; found device {} asked for", device);
  if (static_cast<std::size_t>(device) >= devices.size()) {
    return base::fail(ErrorKind::device,
                      "EGL: found device {} asked for, expected 0 to {}; tenebra info --gl lists them",
                      device, devices.size() - 1);
  }
  auto backend = create_on(egl, devices[static_cast<std::size_t>(device)], options);
  if (!backend) return base::fail(ErrorKind::device, "EGL {}", backend.error().message);
  return backend;
}

}  // namespace

BackendResult create_egl_backend(ContextOptions options, std::optional<int> device) {
  const auto egl = load_egl();
  if (!egl) return tl::unexpected(egl.error());
  if (device) return create_on_device(*egl, *device, options);
  const std::vector<Platform> platforms = platforms_of(*egl);
  std::vector<EglPlatform> kinds;
  for (const Platform& platform : platforms) kinds.push_back(platform.kind);
  std::vector<std::unique_ptr<Context::Backend>> made(platforms.size());
  std::string lacks;
  const auto chosen = choose_platform(kinds, [&](std::size_t i) {
    auto backend = create_on(*egl, platforms[i], options);
    if (!backend) {
      lacks += (lacks.empty() ? "" : ", ") + backend.error().message;
      return Draws::nothing;
    }
    made[i] = std::move(*backend);
    return draws_by_software(*egl) ? Draws::by_software : Draws::by_hardware;
  });
  if (chosen) return std::move(made[*chosen]);
  return base::fail(ErrorKind::device, "EGL offers no OpenGL 4.5 core context without a window ({})", lacks);
}

std::deque<EglOffer> egl_offers() {
  std::deque<EglOffer> offers;  // not a vector: g++ 12 warns of what it does when it grows
  const auto egl = load_egl();
  if (!egl) return offers;
  for (const Platform& platform : platforms_of(*egl))
    offers.push_back({platform.name, platform.kind, platform.device, create_on(*egl, platform, {})});
  return offers;
}

}  // namespace tenebra::gl
