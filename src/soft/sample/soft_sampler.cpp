#include "soft/sample/soft_sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "parallel/parallel.h"

namespace tenebra::soft {

namespace {

constexpr std::uint32_t most_places = 1024;  ///< of the light, for each slot; groups of more candidates than
                                             ///< are worth it end here, whatever their error

/// What irradiance is compared with: the 99.9th percentile of what pixels show, of every so many of them.
double white_of(const SoftFrame& frame, const SampledBlocks& blocks, const LightMeans& means) {
  constexpr std::size_t enough = 1 << 16;
  const std::size_t pixels = frame.out.irradiance.size(), step = pixels / enough + 1;
  std::vector<float> values;
  for (std::size_t i = 0; i < pixels; i += step) {
    if (frame.points.triangles[i] == no_triangle) continue;
    const std::uint32_t slot = blocks.slot(static_cast<std::uint32_t>(i));
    values.push_back(frame.out.irradiance[i] * (slot == no_slot ? 1.0f : means.irradiance[slot]));
  }
  if (values.empty()) return 0;
  const std::size_t rank = (values.size() * 999 + 999) / 1000 - 1;  // nearest rank
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return static_cast<double>(values[rank]);
}

/// What the sampled pixels are off by.
struct SampledErrors {
  std::vector<double> squares;       ///< of each block: sum over its pixels
  std::vector<std::uint32_t> count;  ///< of each block: pixels
  double square = 0;
  std::uint64_t pixels = 0, penumbra = 0;
};
/// Square of what a pixel's irradiance is off by.
double square_of(const SoftFrame& frame, const LightMeans& means, std::size_t slot, std::uint32_t pixel) {
  const auto full = static_cast<double>(frame.out.irradiance[pixel]);
  return static_cast<double>(means.square[slot]) * full * full;
}
SampledErrors errors_of(const SoftFrame& frame, const SampledBlocks& blocks, const LightMeans& means) {
  SampledErrors out;
  out.squares.resize(blocks.count()), out.count.resize(blocks.count());
  for (std::size_t slot = 0; slot < blocks.pixels.size(); ++slot) {
    const std::uint32_t pixel = blocks.pixels[slot];
    if (pixel == no_pixel) continue;
    out.squares[slot / block_slots] += square_of(frame, means, slot, pixel);
    ++out.count[slot / block_slots];
    ++out.pixels;
    if (means.fraction[slot] > 0 && means.fraction[slot] < 1) ++out.penumbra;
  }
  out.square = std::accumulate(out.squares.begin(), out.squares.end(), 0.0);
  return out;
}

std::vector<std::uint32_t> pixels_of(std::span<const SampledGroup> groups) {
  std::vector<std::uint32_t> out;
  for (const SampledGroup& group : groups) out.insert(out.end(), group.pixels.begin(), group.pixels.end());
  return out;
}

}  // namespace

std::uint32_t first_places(double error_255) {
  return std::bit_ceil(static_cast<std::uint32_t>(std::clamp(16 / error_255, 2.0, 128.0)));
}

/// Takes places `from` ... `to` - 1 of a phase, both multiples of a power of two.
void SoftSampler::look(const SoftFrame& frame, const LightPlaces& places,
                       std::span<const std::uint32_t> chosen, std::uint32_t phase, std::uint32_t from,
                       std::uint32_t to) {
  Phase& p = phases_[phase];
  p.rays = 0, p.done = false;
  take_phase(frame, blocks_, chosen, phase, p.points);
  TriangleView triangles = frame.triangles;
  triangles.version = frames_;
  const double size = glm::length(frame.light.ex);
  const std::uint32_t more = to - from;
  for (std::uint32_t k = 0; k < more; ++k) {
    const glm::dvec2 at = sobol_place(from * phases + phase * more + k);
    const glm::vec3 place = places.at(at.x, at.y);
    if (!p.tracer.trace_shadow_mask(p.points, frame.view, triangles, {.position = place},
                                    {.simd = frame.config.simd}, p.mask, frame.stop))
      return;
    p.rays += p.tracer.stats().rays;
    tally_.add(frame, blocks_, chosen, phase, k < more / 2 ? 0 : 1,
               glm::vec3((glm::dvec3(place) - frame.light.origin) / size), p.mask);
  }
  p.done = true;
}

/// All phases. False: stopped.
bool SoftSampler::look(const SoftFrame& frame, const LightPlaces& places,
                       std::span<const std::uint32_t> chosen, std::uint32_t from, std::uint32_t to,
                       SoftStats& stats) {
  parallel::parallel_tasks(static_cast<int>(phases), [&](int phase) {
    look(frame, places, chosen, static_cast<std::uint32_t>(phase), from, to);
  });
  for (const std::uint32_t block : chosen) tally_.rays[block] = to;
  bool done = true;
  for (const Phase& p : phases_) stats.sampled_rays += p.rays, done = done && p.done;
  return done;
}

/// Takes groups that err by more than `much`, a mean square, and that would rather be solved exactly than
/// look at `places`, out of the blocks and of `groups`.
void SoftSampler::leave(const SoftFrame& frame, double much, std::uint32_t places,
                        std::vector<SampledGroup>& groups, std::vector<std::uint32_t>& left) {
  std::erase_if(groups, [&](const SampledGroup& group) {
    if (worth_sampling(group.candidates, places)) return false;
    double square = 0;
    for (const std::uint32_t pixel : group.pixels)
      square += square_of(frame, means_, blocks_.slot(pixel), pixel);
    if (square <= much * static_cast<double>(group.pixels.size())) return false;
    for (const std::uint32_t pixel : group.pixels) blocks_.pixels[blocks_.slot(pixel)] = no_pixel;
    left.push_back(group.group);
    return true;
  });
}

bool SoftSampler::solve(const SoftFrame& frame, const AreaLight& light, std::span<const SampledGroup> groups,
                        SoftStats& stats, std::vector<std::uint32_t>& left) {
  left.clear();
  square_error_ = 0;
  if (groups.empty()) return true;
  ++frames_;
  std::vector<SampledGroup> sampled(groups.begin(), groups.end());
  blocks_ = sampled_blocks(frame, pixels_of(groups));
  tally_.start(blocks_);
  const LightPlaces places(light);
  std::vector<std::uint32_t> chosen(blocks_.count());
  std::iota(chosen.begin(), chosen.end(), 0u);
  SampledErrors errors;
  double unit = 0;
  for (std::uint32_t from = 0, to = first_places(frame.config.error_255);; from = to, to *= 2) {
    if (!look(frame, places, chosen, from, to, stats)) return false;
    find_means(blocks_, tally_, means_);
    errors = errors_of(frame, blocks_, means_);
    unit = white_of(frame, blocks_, means_) / 255;
    const double error = frame.config.error_255 * unit;
    const double allowed = error * error * static_cast<double>(stats.points_penumbra + errors.penumbra);
    if (errors.square <= allowed || to >= most_places) break;
    // Of the blocks that have looked most those look again that err by more than the mean that is allowed.
    const double much = allowed / static_cast<double>(errors.pixels);
    leave(frame, much, 2 * to, sampled, left);
    errors = errors_of(frame, blocks_, means_);
    std::erase_if(chosen, [&](std::uint32_t b) { return errors.squares[b] <= much * errors.count[b]; });
    if (chosen.empty()) break;
  }
  write(frame, stats);
  square_error_ = unit > 0 ? errors.square / (unit * unit) : 0;
  return true;
}

void SoftSampler::write(const SoftFrame& frame, SoftStats& stats) const {
  for (std::size_t slot = 0; slot < blocks_.pixels.size(); ++slot) {
    const std::uint32_t pixel = blocks_.pixels[slot];
    if (pixel == no_pixel) continue;
    const float fraction = means_.fraction[slot];
    frame.out.irradiance[pixel] *= means_.irradiance[slot];
    frame.out.visible_fraction[pixel] *= fraction;
    frame.classes[pixel] = static_cast<std::uint8_t>(SoftClass::sampled);
    ++(fraction <= 0 ? stats.points_dark : fraction >= 1 ? stats.points_lit : stats.points_penumbra);
    ++stats.points_sampled;
  }
}

}  // namespace tenebra::soft
