#include "shade/block_shader.h"

#include <algorithm>
#include <cstring>

namespace tenebra::shade {
namespace {

const float* copied(std::span<const float> values, std::size_t first, std::size_t count, float* to) {
  std::copy_n(values.data() + first, count, to);
  return to;
}

}  // namespace

FrameTerms::FrameTerms(const Subject& of, const Lighting& lit_by)
    : subject(of), lighting(lit_by), code(kernels(SimdLevel::automatic)) {
  for (const PlacedLight& light : lighting.lights) lights.push_back(light_terms(light, subject.view));
  for (std::size_t i = 0; i < subject.surfaces.size(); ++i) {
    surfaces.push_back(subject.surfaces[i]);
    surfaces.back().ambient *= lighting.ambient_light;
  }
}

void BlockShader::place_run(std::uint32_t id, const float* x, const float* y, std::size_t first,
                            std::size_t count) {
  const Subject& subject = frame_.subject;
  if (id >= subject.geometry.triangles.size()) {
    const Surface background{.emissive = frame_.lighting.background};
    frame_.code.place({}, background, x, y, first, count, block_);
    return;
  }
  anything_seen_ = true;
  const TriangleSetup& setup = setups_.find(subject.geometry, subject.view, id, {x[first], y[first]});
  const std::size_t material = subject.surfaces.held(subject.geometry.materials[id]);
  frame_.code.place(setup, frame_.surfaces[material], x, y, first, count, block_);
}

void BlockShader::place(std::span<const std::uint32_t> ids, const float* x, const float* y) {
  block_.count = ids.size();
  anything_seen_ = false;
  for (std::size_t i = 0, end = 0; i < ids.size(); i = end) {
    while (end < ids.size() && ids[end] == ids[i]) ++end;
    place_run(ids[i], x, y, i, end - i);
  }
}

void BlockShader::shade(std::span<const LightFactors> factors, std::span<const float> openness,
                        std::size_t first) {
  frame_.code.begin(openness.empty() ? nullptr : copied(openness, first, block_.count, factor_), block_);
  for (std::size_t i = 0; anything_seen_ && i < frame_.lights.size(); ++i) add_light(i, factors[i], first);
}

void BlockShader::add_light(std::size_t light, const LightFactors& factors, std::size_t first) {
  const float* factor = nullptr;
  if (!factors.irradiance.empty()) {
    factor = copied(factors.irradiance, first, block_.count, factor_);
  } else if (!factors.mask.empty()) {
    const auto mask = factors.mask.subspan(first, block_.count);
    unsigned some = 0, all = 255;
    for (const std::uint8_t value : mask) {
      some |= value;
      all &= value;
    }
    if (some == 0) return;
    for (std::size_t i = 0; all != 255 && i < mask.size(); ++i)
      factor_[i] = static_cast<float>(mask[i]) / 255.0f;
    if (all != 255) factor = factor_;
  }
  if (is_coloured(factors.tint, first)) {
    add_coloured(light, factor, factors.tint.factors.subspan(first, block_.count));
  } else {
    frame_.code.light(frame_.lights[light], factor, block_);
  }
}

bool BlockShader::is_coloured(const TintFactors& tint, std::size_t first) const {
  if (tint.factors.empty()) return false;
  const std::size_t last = first + block_.count - 1;
  for (std::size_t run = first / TintFactors::run; run <= last / TintFactors::run; ++run)
    if (tint.coloured[run] != 0) return true;
  return false;
}

/// The light alone, coloured, and then added: the same bits as by itself where the tint is white.
void BlockShader::add_coloured(std::size_t light, const float* factor, std::span<const glm::vec3> tint) {
  std::memcpy(before_, block_.color, sizeof(before_));
  std::memset(block_.color, 0, sizeof(before_));
  frame_.code.light(frame_.lights[light], factor, block_);
  for (int c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < tint.size(); ++i)
      block_.color[c][i] = before_[c][i] + block_.color[c][i] * tint[i][c];
}

void BlockShader::shade_light(std::size_t light) {
  for (auto& channel : block_.color) std::fill_n(channel, SampleBlock::room, 0.0f);
  if (anything_seen_) frame_.code.light(frame_.lights[light], nullptr, block_);
}

}  // namespace tenebra::shade
