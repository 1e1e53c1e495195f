#include "bench/hash/picture_hashes.h"

#include <fmt/format.h>

#include "bench/common/bench_report.h"
#include "bench/common/scene_renderer.h"
#include "bench/hash/hash_bits.h"
#include "bench/hash/hash_frame.h"
#include "raster/gbuffer.h"
#include "render/renderer.h"

namespace tenebra::bench {
namespace {

struct PictureMode {
  const char* name;
  render::RenderSettings settings;
};

std::vector<PictureMode> picture_modes(int scale) {
  const auto sized = [&](HashPicture picture) {
    const auto [width, height] = hash_size(picture, scale);
    return render::RenderSettings{.width = width, .height = height};
  };
  std::vector<PictureMode> modes{{"hard", sized(HashPicture::hard)},
                                 {"soft", sized(HashPicture::soft)},
                                 {"ao", sized(HashPicture::ambient)}};
  render::RenderSettings &soft = modes[1].settings, &ambient = modes[2].settings;
  soft.shadows = render::ShadowMode::soft;
  soft.area_lights.size = glm::vec2(4.0f);
  soft.area_lights.percent_of_diagonal = true;
  ambient.shadows = render::ShadowMode::none;
  ambient.ao = {.mode = AoMode::field, .rays = 16, .positions = 81, .directions = 64};
  return modes;
}

/// Draws ids in the context that is current; it must outlive this.
class IdDrawing {
public:
  explicit IdDrawing(raster::GBufferPass pass) : pass_(std::move(pass)) {}
  Expected<std::vector<std::uint32_t>> draw(const render::FrameInput& input, int width, int height) {
    if (auto uploaded = buffers_.upload(input.geometry); !uploaded) return tl::unexpected(uploaded.error());
    if (auto drawn = pass_.draw(input.view, buffers_, width, height, drawn_); !drawn)
      return tl::unexpected(drawn.error());
    std::vector<std::uint32_t> ids;
    raster::read_triangle_ids(drawn_, ids);
    return ids;
  }

private:
  raster::GBufferPass pass_;
  raster::GeometryBuffers buffers_;
  raster::GBuffer drawn_;
};

/// One scene in one context.
class PictureHasher {
public:
  PictureHasher(const Scene& scene, std::string name, std::string kind, render::Renderer renderer,
                IdDrawing ids)
      : scene_(scene),
        name_(std::move(name)),
        kind_(std::move(kind)),
        renderer_(std::move(renderer)),
        ids_(std::move(ids)) {}

  Expected<void> add(int number, const PictureMode& mode, std::vector<std::string>& lines) {
    const int width = mode.settings.width, height = mode.settings.height;
    evaluate_input(scene_, number, width, height, input_);
    const auto keep = [&](const std::string& what, std::uint64_t hash) {
      lines.push_back(hash_line(name_, number, fmt::format("{}.{}.{}", kind_, mode.name, what), hash));
    };
    const auto ids = ids_.draw(input_, width, height);
    if (!ids) return tl::unexpected(ids.error());
    keep("ids", hash_of(*ids));
    if (auto drawn = renderer_.render_frame(input_, mode.settings, result_); !drawn) return drawn;
    keep("picture", hash_of(result_.image.pixels));
    for (const render::LightMask& mask : result_.masks) {
      BitHash hash;
      hash.add(mask.mask.pixels).add(mask.visible_fraction.pixels);
      keep(fmt::format("mask.{}", mask.light), hash.value());
    }
    return {};
  }

private:
  const Scene& scene_;
  std::string name_, kind_;
  render::Renderer renderer_;  // owns the context
  IdDrawing ids_;
  render::FrameInput input_;
  render::FrameResult result_;
};

}  // namespace

Expected<std::vector<std::string>> hash_pictures(const Scene& scene, const HashedScene& chosen,
                                                 gl::Context context, int scale) {
  const std::string kind(context.kind_name());
  auto renderer = render::Renderer::create(std::move(context), scene);
  if (!renderer) return tl::unexpected(renderer.error());
  auto pass = raster::GBufferPass::create();
  if (!pass) return tl::unexpected(pass.error());
  progress(fmt::format("{}: pictures by {}", chosen.name, kind));
  std::vector<std::string> lines{fmt::format("# Drawn by {}, {}; another driver may draw other bits.", kind,
                                             renderer->raster().gl_renderer())};
  PictureHasher hasher(scene, chosen.name, kind, std::move(*renderer), IdDrawing(std::move(*pass)));
  for (const int number : chosen.frames) {
    for (const PictureMode& mode : picture_modes(scale)) {
      if (auto done = hasher.add(number, mode, lines); !done) return tl::unexpected(done.error());
    }
  }
  return lines;
}

}  // namespace tenebra::bench
