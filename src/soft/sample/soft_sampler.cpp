#include "soft/sample/soft_sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "parallel/parallel.h"

namespace tenebra::soft {

namespace {

constexpr std::uint32_t most_places = 1024;  ///< on the light, for each slot; groups for which exact solving
                                             ///< would still take longer end here, whatever their error

/// The reference for light: the 99.9th percentile of what the pixels show, over a regular choice of them;
/// where that is 0, the largest.
double white_of(const ShownFrame& frame, const SampledBlocks& blocks, const LightMeans& means,
                std::vector<float>& values) {
  constexpr std::size_t enough = 1 << 16;
  const std::size_t pixels = frame.soft.out.irradiance.size(), step = pixels / enough + 1;
  values.clear();
  for (std::size_t i = 0; i < pixels; i += step) {
    if (frame.soft.points.triangles[i] == no_triangle) continue;
    const auto pixel = static_cast<std::uint32_t>(i);
    const std::uint32_t slot = blocks.slot(pixel);
    const double share = slot == no_slot ? 1.0 : static_cast<double>(means.irradiance[slot]);
    values.push_back(static_cast<float>(frame.light_at(pixel) * share));
  }
  if (values.empty()) return 0;
  const std::size_t rank = (values.size() * 999 + 999) / 1000 - 1;  // nearest rank
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  if (!(values[rank] > 0)) return static_cast<double>(*std::max_element(values.begin(), values.end()));
  return static_cast<double>(values[rank]);
}

bool is_penumbra(float fraction) {
  return fraction > 0 && fraction < 1;
}

/// Square of the error of what a pixel shows.
double square_of(const ShownFrame& frame, const LightMeans& means, std::size_t slot, std::uint32_t pixel) {
  const double full = frame.light_at(pixel);
  return static_cast<double>(means.square[slot]) * full * full;
}
void find_errors(const ShownFrame& frame, const SampledBlocks& blocks, const LightMeans& means,
                 SampledErrors& out) {
  out.squares.assign(blocks.count(), 0.0), out.count.assign(blocks.count(), 0);
  out.pixels = out.penumbra = 0;
  for (std::size_t slot = 0; slot < blocks.pixels.size(); ++slot) {
    const std::uint32_t pixel = blocks.pixels[slot];
    if (pixel == no_pixel) continue;
    out.squares[slot / block_slots] += square_of(frame, means, slot, pixel);
    ++out.count[slot / block_slots];
    ++out.pixels;
    if (is_penumbra(means.fraction[slot])) ++out.penumbra;
  }
  out.square = std::accumulate(out.squares.begin(), out.squares.end(), 0.0);
}

/// The place, moved to the lit side of the light's plane by more than rounding may have put it behind: what
/// lies in the light's plane hides none of it. A sun's is a direction and stays.
glm::vec3 before_plane(const glm::vec3& place, const LightFrame& light) {
  const float most = std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z)});
  return glm::vec3(glm::dvec3(place) + light.weight * static_cast<double>(most) * 0x1p-21 * light.normal);
}

void gather_pixels(std::span<const SampledGroup> groups, std::vector<std::uint32_t>& out) {
  out.clear();
  for (const SampledGroup& group : groups) out.insert(out.end(), group.pixels.begin(), group.pixels.end());
}

}  // namespace

// Decided by counts. Their weights are microseconds of a point on one core, fitted to the measured times of
// groups (eight views, errors of 0.5 to 8/255; the square: the gallery before a light of half its diagonal).
// Exact solving takes longer with the candidates before one point, far longer where these are leaves that
// leave the light in many parts: that is not known, so few candidates are reason enough to solve exactly, and
// many not to, as each of them meets the parts that the others leave. A ray takes longer the more of the
// candidates are beside the light at any one point: under a sun these are nearly all, and its tile meets
// them.
bool worth_sampling(const CandidateCounts& candidates, std::uint32_t places) {
  if (candidates.all < 64 + 6 * std::min(places, 64u)) return false;
  const double all = candidates.all, before_light = candidates.from_middle, beside = 1 - before_light / all;
  const double exact = 0.3 + 0.05 * before_light + 0.0002 * before_light * before_light + 0.003 * all;
  const double ray = 0.05 + 0.6 * beside * beside;
  return exact >= 1 + places * ray;
}

std::uint32_t first_places(double error_255) {
  return std::bit_ceil(static_cast<std::uint32_t>(std::clamp(16 / error_255, 2.0, 128.0)));
}

SoftSampler::SoftSampler() {
  for (Phase& phase : phases_) phase.tracer.share_triangles(phases_.front().tracer);
}

/// Looks at places `from` to `to` - 1 of a phase. Their number is a power of two that divides `from`: so
/// these places, too, are spread evenly.
void SoftSampler::look(const SoftFrame& frame, const LightPlaces& places,
                       std::span<const std::uint32_t> chosen, std::uint32_t phase, std::uint32_t from,
                       std::uint32_t to) {
  Phase& p = phases_[phase];
  p.rays = 0, p.done = false;
  if (stop_requested(frame.stop)) return;
  take_phase(frame, blocks_, chosen, phase, p.points);
  const double size = glm::length(frame.light.ex);
  const std::uint32_t more = to - from;
  for (std::uint32_t k = 0; k < more; ++k) {
    const glm::dvec2 at = sobol_place(from * phases + phase * more + k);
    const glm::vec3 place = before_plane(places.at(at.x, at.y), frame.light);
    if (!p.tracer.trace_shadow_mask(p.points, triangles_, light_at(places.light(), place),
                                    {.simd = frame.config.simd}, p.mask, frame.stop))
      return;
    p.rays += p.tracer.stats().rays;
    tally_.add(frame, blocks_, chosen, phase, half_of_place(phase, k, more),
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

/// Takes out of the blocks and of `groups` those groups whose mean square error is more than `much` and that
/// are solved exactly in less time than it takes to look at `places`.
void SoftSampler::leave(const ShownFrame& frame, double much, std::uint32_t places,
                        std::vector<SampledGroup>& groups, std::vector<std::uint32_t>& left) {
  std::erase_if(groups, [&](const SampledGroup& group) {
    if (worth_sampling(group.candidates, places)) return false;
    double square = 0;
    for (const std::uint32_t pixel : group.pixels)
      square += square_of(frame, means_, blocks_.slot(pixel), pixel);
    if (square <= much * static_cast<double>(group.pixels.size())) return false;
    for (const std::uint32_t pixel : group.pixels) {
      const std::uint32_t slot = blocks_.slot(pixel);
      frame.soft.out.irradiance[pixel] *=
          means_.irradiance[slot];  // white is found by this until it is solved
      if (is_penumbra(means_.fraction[slot])) ++left_penumbra_;
      blocks_.pixels[slot] = no_pixel;
    }
    left.push_back(group.group);
    return true;
  });
}

bool SoftSampler::solve(const ShownFrame& shown, const AreaLight& light, std::span<const SampledGroup> groups,
                        SoftStats& stats, std::vector<std::uint32_t>& left, std::span<float> errors_255) {
  left.clear();
  square_error_ = 0;
  left_penumbra_ = 0;
  if (groups.empty()) return true;
  const SoftFrame& frame = shown.soft;
  const std::uint64_t version = triangles_.version + 1;
  triangles_ = frame.triangles;
  triangles_.version = version;
  if (!phases_.front().tracer.follow(triangles_, frame.config.simd, frame.stop)) return false;
  sampled_.assign(groups.begin(), groups.end());
  gather_pixels(groups, pixels_);
  find_blocks(frame, pixels_, blocks_);
  tally_.start(blocks_);
  const LightPlaces places(light);
  chosen_.resize(blocks_.count());
  std::iota(chosen_.begin(), chosen_.end(), 0u);
  SampledErrors& errors = errors_;
  const double asked = std::min(frame.config.error_255, 255.0);
  double unit = 0;
  for (std::uint32_t from = 0, to = first_places(asked);; from = to, to *= 2) {
    if (!look(frame, places, chosen_, from, to, stats)) return false;
    find_means(frame, blocks_, tally_, means_);
    find_errors(shown, blocks_, means_, errors);
    unit = white_of(shown, blocks_, means_, values_) / 255;
    const double error = asked * unit;
    const double allowed =
        error * error * static_cast<double>(stats.points_penumbra + left_penumbra_ + errors.penumbra);
    if (errors.square <= allowed || !(unit > 0) || to >= most_places) break;
    // Those of the blocks that have looked at most places look again that err by more than the mean that is
    // allowed.
    const double much = allowed / static_cast<double>(errors.pixels);
    leave(shown, much, 2 * to, sampled_, left);
    find_errors(shown, blocks_, means_, errors);
    std::erase_if(chosen_, [&](std::uint32_t b) { return errors.squares[b] <= much * errors.count[b]; });
    if (chosen_.empty()) break;
  }
  write_errors(shown, unit, errors_255);
  write(frame, stats);
  square_error_ = unit > 0 ? errors.square / (unit * unit) : 0;
  return true;
}

/// To be called before write(), which changes the data that they are found from.
void SoftSampler::write_errors(const ShownFrame& frame, double unit, std::span<float> errors_255) const {
  if (!(unit > 0)) return;
  for (std::size_t slot = 0; slot < blocks_.pixels.size(); ++slot) {
    const std::uint32_t pixel = blocks_.pixels[slot];
    if (pixel != no_pixel)
      errors_255[pixel] = static_cast<float>(std::sqrt(square_of(frame, means_, slot, pixel)) / unit);
  }
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
