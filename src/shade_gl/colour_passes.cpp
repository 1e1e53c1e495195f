#include "shade_gl/colour_passes.h"

#include <embedded_shaders.h>
#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "parallel/parallel.h"
#include "shade/encoder.h"

namespace tenebra::shade_gl {
namespace {

// Locations of shaders/*.
constexpr GLint width_px_at = 19, width_at = 14, places_at = 15, openness_at = 16, light_count_at = 17;
constexpr GLint first_at = 20, shares_at = 21, pixels_at = 22, count_at = 30;
constexpr GLint exposure_at = 40, tone_at = 41, srgb_at = 42, thresholds_at = 43, factors_at = 50;
// Bindings of storage.
constexpr GLuint inputs_binding = 5, colors_binding = 6, sums_binding = 7, list_binding = 0;

constexpr std::size_t group_size = 64,
                      most_groups = 32768;  // of shaders/numbers.glsl; every OpenGL has 65535
static_assert(most_lights == 64);
constexpr std::string_view limits = "#define LIGHT_COUNT 64\n";
static_assert(static_cast<int>(shade::Tone::neutral) == 1 && static_cast<int>(shade::Tone::aces) == 2);
static_assert(sizeof(shade::ShadedSample) == sizeof(glm::vec4));

void bind(GLuint at, const gl::Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, at, buffer.name());
}

void barrier() {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

/// The least value of each level; of level 0: 0.
std::array<float, 256> thresholds_of(const shade::LevelTable& table) {
  std::array<float, 256> out{};
  for (std::size_t i = 0; i < table.threshold.size(); ++i)
    if (table.threshold[i] < std::numeric_limits<float>::infinity())
      out[static_cast<std::size_t>(table.level[i]) + 1] = table.threshold[i];
  return out;
}

void set_display(const gl::Program& program, const shade::Display& display) {
  const std::array<float, 256> thresholds = thresholds_of(shade::level_table(display.transfer));
  glProgramUniform1f(program.name(), exposure_at, display.exposure);
  glProgramUniform1i(program.name(), tone_at, static_cast<int>(display.tone));
  glProgramUniform1i(program.name(), srgb_at, display.transfer == Transfer::srgb ? 1 : 0);
  glProgramUniform1fv(program.name(), thresholds_at, 256, thresholds.data());
}

bool is_coloured(const shade::TintFactors& tint) {
  return !tint.factors.empty() &&
         std::any_of(tint.coloured.begin(), tint.coloured.end(), [](std::uint8_t some) { return some != 0; });
}

std::size_t pixels_of(const shade::PixelSamples& centres) {
  return static_cast<std::size_t>(centres.width) * static_cast<std::size_t>(centres.height);
}

}  // namespace

Expected<ColourPasses> ColourPasses::create() {
  namespace s = shaders;
  ColourPasses passes;
  struct Pass {
    const char* name;
    gl::Program* to;
    std::vector<std::string_view> pieces;
  };
  for (const Pass& pass : std::vector<Pass>{
           {"colours",
            &passes.colours_,
            {limits, s::numbers_glsl, s::samples_glsl, s::textures_glsl, s::surfaces_glsl, s::bend_glsl,
             s::lights_glsl, s::colours_comp}},
           {"replaced", &passes.replaced_, {s::numbers_glsl, s::replaced_comp}},
           {"picture", &passes.picture_, {s::numbers_glsl, s::display_glsl, s::picture_comp}},
           {"centre_sums", &passes.centre_sums_, {s::numbers_glsl, s::display_glsl, s::centre_sums_comp}},
           {"sample_sums", &passes.sample_sums_, {s::numbers_glsl, s::display_glsl, s::sample_sums_comp}},
           {"means", &passes.means_, {s::numbers_glsl, s::display_glsl, s::means_comp}}}) {
    auto built = gl::Program::build_compute(pass.name, pass.pieces);
    if (!built) return tl::unexpected(std::move(built.error()));
    *pass.to = std::move(*built);
  }
  return passes;
}

Expected<void> ColourPasses::begin(const shade::Subject& subject, const shade::Lighting& lighting,
                                   const shade::Display& display) {
  traffic_ = {};
  light_count_ = lighting.lights.size();
  for (const gl::Program* program : {&picture_, &centre_sums_, &sample_sums_, &means_})
    set_display(*program, display);
  return inputs_.send(subject, lighting, traffic_.sent_bytes);
}

void ColourPasses::run(const gl::Program& program, std::size_t count) {
  const std::size_t groups = (count + group_size - 1) / group_size;
  if (groups == 0) return;
  const std::size_t across = std::min(groups, most_groups), down = (groups + across - 1) / across;
  glProgramUniform1ui(program.name(), count_at, static_cast<GLuint>(count));
  glUseProgram(program.name());
  glDispatchCompute(static_cast<GLuint>(across), static_cast<GLuint>(down), 1);
  glUseProgram(0);
  barrier();
  ++traffic_.passes;
}

Expected<std::span<const std::byte>> ColourPasses::read(const gl::Buffer& from, std::size_t bytes) {
  if (auto begun = download_.start(from, bytes); !begun) return tl::unexpected(begun.error());
  traffic_.read_bytes += bytes;
  ++traffic_.waits;
  return download_.finish();
}

void ColourPasses::add_factors(std::span<const shade::LightFactors> factors,
                               std::span<const float> openness) {
  const GLuint name = colours_.name();
  for (std::size_t i = 0; i < light_count_; ++i) {
    const shade::LightFactors all;
    const shade::LightFactors& light = i < factors.size() ? factors[i] : all;
    std::array<GLuint, 3> where{0, 0, 0};
    if (!light.irradiance.empty()) {
      where = {2, lists_.add(light.irradiance), 0};
    } else if (!light.mask.empty()) {
      where = {1, lists_.add(light.mask), 0};
    }
    if (is_coloured(light.tint)) where[2] = lists_.add(light.tint.factors);
    glProgramUniform3uiv(name, factors_at + static_cast<GLint>(i), 1, where.data());
  }
  glProgramUniform1ui(name, openness_at, openness.empty() ? 0 : lists_.add(openness));
  glProgramUniform1i(name, light_count_at, static_cast<GLint>(light_count_));
}

Expected<void> ColourPasses::run_colours(std::size_t count, const gl::Buffer& to) {
  if (auto sent = lists_.send(traffic_.sent_bytes); !sent) return sent;
  inputs_.bind(colours_);
  bind(inputs_binding, lists_.buffer());
  bind(colors_binding, to);
  run(colours_, count);
  return {};
}

Expected<void> ColourPasses::shade_centres(const shade::PixelSamples& centres, io::Image8& picture) {
  const std::size_t count = pixels_of(centres), words = 3 * ((count + 3) / 4);
  width_ = centres.width, height_ = centres.height;
  if (auto room = centre_colors_.reserve(sizeof(glm::vec4) * count); !room) return room;
  if (auto room = bytes_.reserve(4 * words); !room) return room;
  lists_.begin();
  lists_.add(centres.ids);
  add_factors(centres.factors, centres.openness);
  glProgramUniform1ui(colours_.name(), width_at, static_cast<GLuint>(width_));
  glProgramUniform1f(colours_.name(), width_px_at, 1.0f);
  if (auto drawn = run_colours(count, centre_colors_); !drawn) return drawn;
  bind(colors_binding, centre_colors_);
  bind(inputs_binding, bytes_);
  glProgramUniform1ui(picture_.name(), count_at, static_cast<GLuint>(count));
  run(picture_, count);
  const auto found = read(bytes_, 4 * words);
  if (!found) return tl::unexpected(found.error());
  picture.width = width_, picture.height = height_, picture.channels = 3;
  picture.pixels.resize(3 * count);
  constexpr std::size_t at_once = std::size_t{1} << 18;
  parallel::parallel_ranges(picture.pixels.size(), at_once, [&](std::size_t first, std::size_t last) {
    std::memcpy(&picture.pixels[first], found->data() + first, last - first);
  });
  return {};
}

Expected<void> ColourPasses::replace_centres(std::span<const std::uint32_t> pixels,
                                             std::span<const glm::vec3> colors) {
  lists_.begin();
  glProgramUniform1ui(replaced_.name(), pixels_at, lists_.add(pixels));
  glProgramUniform1ui(replaced_.name(), first_at, lists_.add(colors));
  if (auto sent = lists_.send(traffic_.sent_bytes); !sent) return sent;
  bind(inputs_binding, lists_.buffer());
  bind(colors_binding, centre_colors_);
  run(replaced_, pixels.size());
  return {};
}

Expected<void> ColourPasses::read_centres(io::ImageF& out) {
  const std::size_t count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  const auto found = read(centre_colors_, sizeof(glm::vec4) * count);
  if (!found) return tl::unexpected(found.error());
  out = {width_, height_, 3, std::vector<float>(3 * count)};
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(&out.pixels[3 * i], found->data() + sizeof(glm::vec4) * i, 3 * sizeof(float));
  return {};
}

Expected<void> ColourPasses::shade_samples(const shade::Samples& samples,
                                           std::vector<shade::ShadedSample>& out) {
  const std::size_t count = samples.ids.size(), bytes = sizeof(glm::vec4) * count;
  out.resize(count);
  if (count == 0) return {};
  if (auto room = sample_colors_.reserve(bytes); !room) return room;
  lists_.begin();
  lists_.add(samples.ids);
  glProgramUniform1ui(colours_.name(), places_at, lists_.add(samples.places));
  glProgramUniform1ui(colours_.name(), width_at, 0);
  glProgramUniform1f(colours_.name(), width_px_at, samples.width_px);
  add_factors(samples.factors, samples.openness);
  if (auto drawn = run_colours(count, sample_colors_); !drawn) return drawn;
  const auto found = read(sample_colors_, bytes);
  if (!found) return tl::unexpected(found.error());
  std::memcpy(out.data(), found->data(), bytes);
  return {};
}

Expected<void> ColourPasses::begin_means(std::span<const std::uint32_t> pixels, bool centre_counts) {
  pixels_ = pixels;
  if (pixels.empty()) return {};
  if (auto room = sums_.reserve(sizeof(glm::vec4) * pixels.size()); !room) return room;
  if (auto sent = pixels_on_gpu_.upload(std::as_bytes(pixels)); !sent) return sent;
  traffic_.sent_bytes += pixels.size_bytes();
  const float zero = 0;
  glClearNamedBufferData(sums_.name(), GL_R32F, GL_RED, GL_FLOAT, &zero);
  if (!centre_counts) return {};
  glProgramUniform1ui(centre_sums_.name(), first_at, 0);
  glProgramUniform1ui(centre_sums_.name(), shares_at, 0);
  bind(list_binding, pixels_on_gpu_);
  bind(inputs_binding, pixels_on_gpu_);  // not read
  bind(colors_binding, centre_colors_);
  bind(sums_binding, sums_);
  run(centre_sums_, pixels.size());
  return {};
}

Expected<void> ColourPasses::add_shares(std::size_t count, const gl::Buffer& colors, const Shares& shares,
                                        std::uint32_t pixels_from, std::uint32_t shares_from,
                                        std::uint32_t centres_from) {
  bind(inputs_binding, lists_.buffer());
  bind(sums_binding, sums_);
  const auto first = static_cast<GLuint>(shares.first);
  if (!shares.centres.empty()) {
    bind(list_binding, pixels_on_gpu_);
    bind(colors_binding, centre_colors_);
    glProgramUniform1ui(centre_sums_.name(), first_at, first);
    glProgramUniform1ui(centre_sums_.name(), shares_at, centres_from);
    run(centre_sums_, shares.centres.size());
  }
  bind(colors_binding, colors);
  glProgramUniform1ui(sample_sums_.name(), first_at, first);
  glProgramUniform1ui(sample_sums_.name(), shares_at, shares_from);
  glProgramUniform1ui(sample_sums_.name(), pixels_at, pixels_from);
  run(sample_sums_, count);
  return {};
}

Expected<void> ColourPasses::add_samples(const shade::Samples& samples, const Shares& shares) {
  const std::size_t count = samples.ids.size();
  lists_.begin();
  lists_.add(samples.ids);
  glProgramUniform1ui(colours_.name(), places_at, lists_.add(samples.places));
  glProgramUniform1ui(colours_.name(), width_at, 0);
  glProgramUniform1f(colours_.name(), width_px_at, samples.width_px);
  add_factors(samples.factors, samples.openness);
  const std::uint32_t pixels_from = lists_.add(shares.pixels), shares_from = lists_.add(shares.shares),
                      centres_from = lists_.add(shares.centres);
  if (auto room = sample_colors_.reserve(sizeof(glm::vec4) * std::max<std::size_t>(count, 1)); !room)
    return room;
  if (auto drawn = run_colours(count, sample_colors_); !drawn) return drawn;
  return add_shares(count, sample_colors_, shares, pixels_from, shares_from, centres_from);
}

Expected<void> ColourPasses::add_colors(std::span<const shade::ShadedSample> colors, const Shares& shares) {
  lists_.begin();
  lists_.add(shares.pixels);  // so that no list begins at 0
  const std::uint32_t pixels_from = lists_.add(shares.pixels), shares_from = lists_.add(shares.shares),
                      centres_from = lists_.add(shares.centres);
  if (auto sent = lists_.send(traffic_.sent_bytes); !sent) return sent;
  if (auto room = sample_colors_.reserve(std::max<std::size_t>(colors.size_bytes(), 16)); !room) return room;
  if (!colors.empty()) sample_colors_.update(0, std::as_bytes(colors));
  traffic_.sent_bytes += colors.size_bytes();
  return add_shares(colors.size(), sample_colors_, shares, pixels_from, shares_from, centres_from);
}

Expected<void> ColourPasses::finish_means(std::size_t samples, io::Image8& picture) {
  if (pixels_.empty()) return {};
  if (auto room = bytes_.reserve(4 * pixels_.size()); !room) return room;
  bind(inputs_binding, bytes_);
  bind(sums_binding, sums_);
  glProgramUniform1f(means_.name(), first_at, 1.0f / static_cast<float>(samples));
  run(means_, pixels_.size());
  const auto found = read(bytes_, 4 * pixels_.size());
  if (!found) return tl::unexpected(found.error());
  constexpr std::size_t at_once = 16384;
  parallel::parallel_ranges(pixels_.size(), at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      std::memcpy(&picture.pixels[3 * std::size_t{pixels_[i]}], found->data() + 4 * i, 3);
  });
  return {};
}

}  // namespace tenebra::shade_gl
