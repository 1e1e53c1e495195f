#include "gl/survey.h"

#include <glad/gl.h>

#include <array>

#include "base/fail.h"
#include "gl/backend.h"
#include "gl/renderer_name.h"

namespace tenebra::gl {
namespace {

struct Limit {
  const char* name;
  GLenum query;
};
constexpr std::array<Limit, 10> asked{{{"texture_px", GL_MAX_TEXTURE_SIZE},
                                       {"texture_layers", GL_MAX_ARRAY_TEXTURE_LAYERS},
                                       {"viewport_px", GL_MAX_VIEWPORT_DIMS},
                                       {"texture_buffer_texels", GL_MAX_TEXTURE_BUFFER_SIZE},
                                       {"uniform_block_bytes", GL_MAX_UNIFORM_BLOCK_SIZE},
                                       {"storage_block_bytes", GL_MAX_SHADER_STORAGE_BLOCK_SIZE},
                                       {"storage_blocks", GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS},
                                       {"texture_units", GL_MAX_TEXTURE_IMAGE_UNITS},
                                       {"draw_buffers", GL_MAX_DRAW_BUFFERS},
                                       {"compute_invocations", GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS}}};

std::string text_of(GLenum name) {
  const GLubyte* const text = glGetString(name);
  return text != nullptr ? reinterpret_cast<const char*>(text) : "unnamed";
}

void describe(BackendResult made, Offer& out) {
  if (!made) {
    out.lacks = made.error().message;
    return;
  }
  Context context(std::move(*made));
  if (auto current = context.make_current(); !current) {
    out.lacks = current.error().message;
    return;
  }
  out.vendor = text_of(GL_VENDOR);
  out.renderer = text_of(GL_RENDERER);
  out.version = text_of(GL_VERSION);
  out.software = is_software_renderer(out.renderer);
  for (const Limit& limit : asked) {
    std::array<GLint64, 2> values{};  // a viewport's are two
    glGetInteger64v(limit.query, values.data());
    out.limits.emplace_back(limit.name, values[0]);
  }
}

Draws drawn_by(const Offer& offer) {
  if (!offer.lacks.empty()) return Draws::nothing;
  return offer.software ? Draws::by_software : Draws::by_hardware;
}

}  // namespace

std::vector<Offer> survey() {
  std::vector<Offer> offers;
  std::vector<EglPlatform> kinds;
  for (EglOffer& egl : egl_offers()) {
    Offer& offer = offers.emplace_back();
    offer.name = egl.name;
    if (egl.device) offer.context = fmt::format("egl:{}", *egl.device);
    kinds.push_back(egl.kind);
    describe(std::move(egl.backend), offer);
  }
  const auto chosen = choose_platform(kinds, [&](std::size_t i) { return drawn_by(offers[i]); });
  if (chosen) offers[*chosen].taken = true;
  Offer& offer = offers.emplace_back();
  offer.name = "OSMesa";
  offer.context = "osmesa";
  describe(create_osmesa_backend({}), offer);
  offer.taken = !chosen && offer.lacks.empty();
  return offers;
}

}  // namespace tenebra::gl
