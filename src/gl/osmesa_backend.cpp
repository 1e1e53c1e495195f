// Contexts in plain memory by OSMesa, loaded at run time: Mesa 25.1 and later ship it no more.
#include <dlfcn.h>

#include <array>
#include <cstdint>

#include "gl/backend.h"

#include "base/fail.h"

namespace tenebra::gl {
namespace {

// What GL/osmesa.h declares; its package need not be installed.
using OSMesaContext = struct osmesa_context*;
constexpr int osmesa_format = 0x22, osmesa_profile = 0x33, osmesa_core_profile = 0x34;
constexpr int osmesa_major = 0x36, osmesa_minor = 0x37;
constexpr int gl_rgba = 0x1908;
constexpr unsigned gl_unsigned_byte = 0x1401;

struct Library {
  OSMesaContext (*create)(const int* wants, OSMesaContext shared) = nullptr;
  void (*destroy)(OSMesaContext) = nullptr;
  unsigned char (*make_current)(OSMesaContext, void* pixels, unsigned type, int width, int height) = nullptr;
  OSMesaContext (*current)() = nullptr;
  FunctionLoader loader = nullptr;
};

template <class Pointer>
bool find(void* library, const char* name, Pointer& function) {
  function = reinterpret_cast<Pointer>(dlsym(library, name));
  return function != nullptr;
}

Expected<Library> load_library() {
  void* handle = nullptr;
  for (const char* file : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}) {
    // Never unloaded: its threads and its exit handlers outlive the contexts.
    handle = dlopen(file, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (handle) break;
  }
  if (!handle)
    return base::fail(ErrorKind::device,
                      "OSMesa: found none of libOSMesa.so.8, libOSMesa.so.6, libOSMesa.so");
  Library library;
  const bool complete = find(handle, "OSMesaCreateContextAttribs", library.create) &&
                        find(handle, "OSMesaDestroyContext", library.destroy) &&
                        find(handle, "OSMesaMakeCurrent", library.make_current) &&
                        find(handle, "OSMesaGetCurrentContext", library.current) &&
                        find(handle, "OSMesaGetProcAddress", library.loader);
  dlclose(handle);
  if (!complete)
    return base::fail(
        "OSMesa: found a library without OSMesaCreateContextAttribs, expected Mesa 12.0 or newer");
  return library;
}

struct OsmesaBackend final : Context::Backend {
  OsmesaBackend(const Library& library, OSMesaContext context) : library_(library), context_(context) {}
  ~OsmesaBackend() override {
    if (library_.current() == context_) library_.make_current(nullptr, nullptr, 0, 0, 0);
    library_.destroy(context_);
  }
  bool make_current() override {
    return library_.make_current(context_, pixel_.data(), gl_unsigned_byte, 1, 1);
  }
  FunctionLoader loader() const override { return library_.loader; }
  std::string_view kind_name() const override { return "osmesa"; }

private:
  Library library_;
  OSMesaContext context_;
  std::array<std::uint8_t, 4> pixel_{};  ///< the default framebuffer that OSMesa insists on
};

}  // namespace

BackendResult create_osmesa_backend(ContextOptions) {
  const auto library = load_library();
  if (!library) return tl::unexpected(library.error());
  const int wants[] = {
      osmesa_format, gl_rgba, osmesa_profile, osmesa_core_profile, osmesa_major, 4, osmesa_minor, 5, 0};
  const OSMesaContext context = library->create(wants, nullptr);
  if (!context) return base::fail(ErrorKind::device, "OSMesa offers no OpenGL 4.5 core context");
  return std::make_unique<OsmesaBackend>(*library, context);
}

}  // namespace tenebra::gl
