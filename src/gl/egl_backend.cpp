// Contexts without a window by EGL: Mesa's surfaceless platform, else the devices of a GPU server.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>

#include "gl/backend.h"

#include "base/fail.h"

namespace tenebra::gl {
namespace {

struct EglBackend final : Context::Backend {
  EglBackend(EGLDisplay display, EGLContext context) : display_(display), context_(context) {}
  // The display stays initialised: EGL has one per process, and other contexts may live on it.
  ~EglBackend() override {
    if (eglGetCurrentContext() == context_) {
      eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    eglDestroyContext(display_, context_);
  }
  bool make_current() override {
    return eglBindAPI(EGL_OPENGL_API) && eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
  }
  FunctionLoader loader() const override {
    return [](const char* name) { return eglGetProcAddress(name); };
  }
  std::string_view kind_name() const override { return "egl"; }

private:
  EGLDisplay display_;
  EGLContext context_;
};

struct Platform {
  std::string name;
  EGLenum platform;
  void* native;
};

std::vector<Platform> platforms() {
  std::vector<Platform> result{
      {"surfaceless", EGL_PLATFORM_SURFACELESS_MESA, reinterpret_cast<void*>(EGL_DEFAULT_DISPLAY)}};
  const auto query_devices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
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

EGLContext create_context(EGLDisplay display, ContextOptions options) {
  // No surface is ever drawn to: any configuration that OpenGL can use will do.
  const EGLint config_wants[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint config_count = 0;
  if (!eglBindAPI(EGL_OPENGL_API)) return EGL_NO_CONTEXT;
  if (!eglChooseConfig(display, config_wants, &config, 1, &config_count) || config_count == 0) {
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
  return eglCreateContext(display, config, EGL_NO_CONTEXT, wants);
}

BackendResult create_on(const Platform& platform, ContextOptions options) {
  const EGLDisplay display = eglGetPlatformDisplay(platform.platform, platform.native, nullptr);
  if (display == EGL_NO_DISPLAY) return base::fail("{}: no such platform", platform.name);
  if (!eglInitialize(display, nullptr, nullptr)) {
    return base::fail("{}: not initialised (EGL error {:#x})", platform.name, eglGetError());
  }
  const EGLContext context = create_context(display, options);
  if (context == EGL_NO_CONTEXT) {
    return base::fail("{}: no OpenGL 4.5 core context (EGL error {:#x})", platform.name, eglGetError());
  }
  auto backend = std::make_unique<EglBackend>(display, context);
  if (!backend->make_current()) {
    return base::fail("{}: no context without a surface (EGL error {:#x})", platform.name, eglGetError());
  }
  return backend;
}

}  // namespace

BackendResult create_egl_backend(ContextOptions options) {
  std::string lacks;
  for (const Platform& platform : platforms()) {
    auto backend = create_on(platform, options);
    if (backend) return backend;
    lacks += (lacks.empty() ? "" : ", ") + backend.error().message;
  }
  return base::fail("EGL offers no OpenGL 4.5 core context without a window ({})", lacks);
}

}  // namespace tenebra::gl
