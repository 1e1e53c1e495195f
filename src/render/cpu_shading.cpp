#include "render/cpu_shading.h"

#include <cstring>

#include "parallel/parallel.h"

namespace tenebra::render {
namespace {

constexpr std::size_t shaded_at_once = 4096;

}  // namespace

Expected<void> CpuShading::begin(const ShadingTask& task) {
  frame_.emplace(task);
  return {};
}

Expected<void> CpuShading::shade_centres(const shade::PixelSamples& centres, io::Image8& picture) {
  if (!frame_->keeps_linear) centres_.clear();
  shade::shade_picture(frame_->subject, frame_->lighting, centres, frame_->display, picture,
                       frame_->keeps_linear ? &centres_ : nullptr);
  return {};
}

Expected<void> CpuShading::replace_centres(std::span<const std::uint32_t> pixels,
                                           std::span<const glm::vec3> colors, io::Image8& picture) {
  const shade::Display& display = frame_->display;
  parallel::parallel_ranges(pixels.size(), 1024, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t pixel = pixels[i];
      if (!centres_.empty()) centres_[pixel] = colors[i];
      encode_shown(display, shown(display, colors[i]), &picture.pixels[3 * pixel]);
    }
  });
  return {};
}

Expected<void> CpuShading::copy_linear(io::ImageF& out) {
  out = {frame_->width, frame_->height, 3, std::vector<float>(3 * centres_.size())};
  std::memcpy(out.pixels.data(), centres_.data(), sizeof(float) * out.pixels.size());
  return {};
}

Expected<void> CpuShading::shade_samples(const shade::Samples& samples,
                                         std::vector<shade::ShadedSample>& out) {
  shade::shade_samples(frame_->subject, frame_->lighting, samples, out);
  return {};
}

Expected<void> CpuShading::begin_means(const MeansTask& task) {
  means_ = task;
  const std::size_t count = task.pixels.size();
  sums_.assign(count, glm::vec3(0.0f));
  linear_sums_.assign(task.linear ? count : 0, glm::vec3(0.0f));
  if (!task.centre_counts) return {};
  parallel::parallel_ranges(count, shaded_at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) sums_[i] = shown(frame_->display, centres_[task.pixels[i]]);
    for (std::size_t i = first; task.linear && i < last; ++i) linear_sums_[i] = centres_[task.pixels[i]];
  });
  return {};
}

Expected<void> CpuShading::add_colors(const SampleShares& to, std::span<const shade::ShadedSample> colors) {
  const shade::Display& display = frame_->display;
  parallel::parallel_ranges(to.centres.size(), shaded_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (to.centres[i] != 0)
        sums_[to.first + i] += to.centres[i] * shown(display, centres_[means_.pixels[to.first + i]]);
  });
  parallel::parallel_ranges(colors.size(), shaded_at_once, [&](std::size_t begin, std::size_t end) {
    // A pixel's samples follow each other; they all belong to the range in which they begin.
    const auto goes_on = [&](std::size_t i) { return i > 0 && to.pixels[i] == to.pixels[i - 1]; };
    std::size_t i = begin;
    while (i < end && goes_on(i)) ++i;
    if (i == end) return;
    for (; i < end || (i < colors.size() && goes_on(i)); ++i)
      sums_[to.first + to.pixels[i]] += to.shares[i] * shown(display, colors[i].color);
  });
  if (means_.linear) add_linear(to, colors);
  return {};
}

void CpuShading::add_linear(const SampleShares& to, std::span<const shade::ShadedSample> colors) {
  for (std::size_t i = 0; i < to.centres.size(); ++i)
    if (to.centres[i] != 0)
      linear_sums_[to.first + i] += to.centres[i] * centres_[means_.pixels[to.first + i]];
  for (std::size_t i = 0; i < colors.size(); ++i)
    linear_sums_[to.first + to.pixels[i]] += to.shares[i] * colors[i].color;
}

Expected<void> CpuShading::add_samples(const shade::Samples& samples, const SampleShares& shares) {
  if (auto done = shade_samples(samples, shaded_); !done) return done;
  return add_colors(shares, shaded_);
}

Expected<void> CpuShading::finish_means(io::Image8& picture, io::ImageF& linear) {
  const float share = 1.0f / static_cast<float>(means_.samples);
  parallel::parallel_ranges(means_.pixels.size(), shaded_at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      encode_shown(frame_->display, share * sums_[i], &picture.pixels[3 * std::size_t{means_.pixels[i]}]);
    for (std::size_t i = first; means_.linear && i < last; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        linear.pixels[3 * std::size_t{means_.pixels[i]} + c] = share * linear_sums_[i][static_cast<int>(c)];
  });
  return {};
}

}  // namespace tenebra::render
