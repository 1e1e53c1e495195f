#include "render/lit_samples.h"

#include "parallel/parallel.h"

namespace tenebra::render {

void LitSamples::begin(std::size_t light_count, std::size_t tinted) {
  openness.clear();
  lights.resize(light_count);
  for (SampleLight& light : lights) {
    light.mask.clear();
    light.soft.visible_fraction.clear();
    light.soft.irradiance.clear();
    light.tint.begin(tinted);
  }
}

std::vector<shade::LightFactors> LitSamples::factors() const {
  std::vector<shade::LightFactors> out;
  for (const SampleLight& light : lights) {
    shade::LightFactors& to = out.emplace_back();
    if (light.soft.irradiance.empty()) to.mask = light.mask;
    to.irradiance = light.soft.irradiance;
    to.tint = light.tint.factors();
  }
  return out;
}

GatheredFactors::GatheredFactors(std::span<const shade::LightFactors> from,
                                 std::span<const std::uint32_t> samples) {
  const auto gather = [&](const auto& all, auto& some) {
    if (all.empty()) return;
    some.resize(samples.size());
    parallel::parallel_ranges(samples.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) some[i] = all[samples[i]];
    });
  };
  lights_.resize(from.size());
  for (std::size_t light = 0; light < from.size(); ++light) {
    OfLight& to = lights_[light];
    gather(from[light].mask, to.mask);
    gather(from[light].irradiance, to.irradiance);
    gather(from[light].tint.factors, to.tint);
    to.coloured.assign(to.tint.size() / shade::TintFactors::run + 1, 1);
  }
}

GatheredFactors GatheredFactors::of_bits(std::span<const shade::LightFactors> from,
                                         std::span<const std::uint32_t> bits) {
  GatheredFactors out;
  out.lights_.resize(from.size());
  for (std::size_t light = 0; light < from.size(); ++light) {
    if (from[light].mask.empty()) continue;
    std::vector<std::uint8_t>& mask = out.lights_[light].mask;
    mask.resize(bits.size());
    parallel::parallel_ranges(bits.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) mask[i] = (bits[i] >> light & 1u) != 0 ? 255 : 0;
    });
  }
  return out;
}

std::vector<shade::LightFactors> GatheredFactors::factors() const {
  std::vector<shade::LightFactors> out;
  for (const OfLight& light : lights_) {
    out.push_back({light.mask, light.irradiance, {}});
    if (!light.tint.empty()) out.back().tint = {light.tint, light.coloured};
  }
  return out;
}

}  // namespace tenebra::render
