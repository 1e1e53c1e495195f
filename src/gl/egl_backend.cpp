// Contexts without a window by EGL: Mesa's surfaceless platform, else the devices of a GPU server. Loaded at
// run time: what draws on the CPU needs no EGL.
#define EGL_NO_X11
#include <dlfcn.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>

#include "gl/backend.h"

#include "base/fail.h"

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
};

template <class Pointer>
bool find(void* library, const char* name, Pointer& function) {
  function = reinterpret_cast<Pointer>(dlsym(library, name));
  return function != nullptr;
}

Expected<Egl> load_egl() {
  // Never unloaded: its threads and its exit handlers outlive the contexts.
  void* const handle = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (handle == nullptr) return base::fail("EGL: found no libEGL.so.1");
  Egl egl;
  const bool complete =
      find(handle, "eglBindAPI", egl.bind_api) && find(handle, "eglChooseConfig", egl.choose_config) &&
      find(handle, "eglCreateContext", egl.create_context) &&
      find(handle, "eglDestroyContext", egl.destroy_context) &&
      find(handle, "eglGetCurrentContext", egl.current_context) && find(handle, "eglGetError", egl.error) &&
      find(handle, "eglGetPlatformDisplay", egl.platform_display) &&
      find(handle, "eglGetProcAddress", egl.function) && find(handle, "eglInitialize", egl.initialize) &&
      find(handle, "eglMakeCurrent", egl.make_current);
  dlclose(handle);
  if (!complete) return base::fail("EGL: found a library older than EGL 1.5");
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

struct Platform {
  std::string name;
  EGLenum platform;
  void* native;
};

std::vector<Platform> platforms(const Egl& egl) {
  std::vector<Platform> result{
      {"surfaceless", EGL_PLATFORM_SURFACELESS_MESA, reinterpret_cast<void*>(EGL_DEFAULT_DISPLAY)}};
  const auto query_devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.function("eglQueryDevicesEXT"));
  constexpr int max_devices = 32;
  std::array<EGLDeviceEXT, max_devices> devices{};
  EGLint count = 0;
  if (!query_devices || !query_devices(max_devices, devices.data(), &count)) return result;
  for (int i = 0; i < count; ++i) {
    result.push_back(
        {fmt::format("device {}", i), EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)]});
  }
  return result;
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
  if (display == EGL_NO_DISPLAY) return base::fail("{}: no such platform", platform.name);
  if (!egl.initialize(display, nullptr, nullptr)) {
    return base::fail("{}: not initialised (EGL error {:#x})", platform.name, egl.error());
  }
  const EGLContext context = create_context(egl, display, options);
  if (context == EGL_NO_CONTEXT) {
    return base::fail("{}: no OpenGL 4.5 core context (EGL error {:#x})", platform.name, egl.error());
  }
  auto backend = std::make_unique<EglBackend>(egl, display, context);
  if (!backend->make_current()) {
    return base::fail("{}: no context without a surface (EGL error {:#x})", platform.name, egl.error());
  }
  return backend;
}

}  // namespace

BackendResult create_egl_backend(ContextOptions options) {
  const auto egl = load_egl();
  if (!egl) return tl::unexpected(egl.error());
  std::string lacks;
  for (const Platform& platform : platforms(*egl)) {
    auto backend = create_on(*egl, platform, options);
    if (backend) return backend;
    lacks += (lacks.empty() ? "" : ", ") + backend.error().message;
  }
  return base::fail("EGL offers no OpenGL 4.5 core context without a window ({})", lacks);
}

}  // namespace tenebra::gl
