#include "render/gl_shading.h"

#include <fmt/core.h>

#include "parallel/parallel.h"

namespace tenebra::render {
namespace {

shade_gl::Shares shares_of(const SampleShares& to) {
  return {to.first, to.pixels, to.shares, to.centres};
}

}  // namespace

Expected<std::unique_ptr<FrameShading>> GlShading::create() {
  auto passes = shade_gl::ColourPasses::create();
  if (!passes) return tl::unexpected(std::move(passes.error()));
  return std::unique_ptr<FrameShading>(new GlShading(std::move(*passes)));
}

Expected<void> GlShading::give_up(const Error& failure) {
  notes_.push_back(fmt::format("The CPU makes the colours from here on: {}.", failure.message));
  broken_ = true;
  by_gl_ = false;
  return cpu_.begin(*task_);
}

Expected<void> GlShading::begin(const ShadingTask& task) {
  task_.emplace(task);
  by_gl_ = false;
  if (broken_) return cpu_.begin(task);
  std::string lacks = shade_gl::lacks(task.subject, task.lighting);
  if (lacks.empty() && task.linear_means) lacks = "linear means are not made by OpenGL yet";
  if (!lacks.empty()) {
    notes_.push_back(fmt::format("The CPU makes the colours: {}.", lacks));
    return cpu_.begin(task);
  }
  by_gl_ = true;
  if (auto begun = passes_.begin(task.subject, task.lighting, task.display); !begun)
    return give_up(begun.error());
  return {};
}

Expected<void> GlShading::shade_centres(const shade::PixelSamples& centres, io::Image8& picture) {
  if (by_gl_) {
    const auto done = passes_.shade_centres(centres, picture);
    if (done) return done;
    if (auto given_up = give_up(done.error()); !given_up) return given_up;
  }
  return cpu_.shade_centres(centres, picture);
}

Expected<void> GlShading::replace_centres(std::span<const std::uint32_t> pixels,
                                          std::span<const glm::vec3> colors, io::Image8& picture) {
  if (!by_gl_) return cpu_.replace_centres(pixels, colors, picture);
  const shade::Display& display = task_->display;
  parallel::parallel_ranges(pixels.size(), 1024, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      encode_shown(display, shown(display, colors[i]), &picture.pixels[3 * std::size_t{pixels[i]}]);
  });
  return passes_.replace_centres(pixels, colors);
}

Expected<void> GlShading::copy_linear(io::ImageF& out) {
  return by_gl_ ? passes_.read_centres(out) : cpu_.copy_linear(out);
}

Expected<void> GlShading::shade_samples(const shade::Samples& samples,
                                        std::vector<shade::ShadedSample>& out) {
  return by_gl_ ? passes_.shade_samples(samples, out) : cpu_.shade_samples(samples, out);
}

Expected<void> GlShading::begin_means(const MeansTask& task) {
  samples_ = task.samples;
  return by_gl_ ? passes_.begin_means(task.pixels, task.centre_counts) : cpu_.begin_means(task);
}

Expected<void> GlShading::add_colors(const SampleShares& to, std::span<const shade::ShadedSample> colors) {
  return by_gl_ ? passes_.add_colors(colors, shares_of(to)) : cpu_.add_colors(to, colors);
}

Expected<void> GlShading::add_samples(const shade::Samples& samples, const SampleShares& to) {
  return by_gl_ ? passes_.add_samples(samples, shares_of(to)) : cpu_.add_samples(samples, to);
}

Expected<void> GlShading::finish_means(io::Image8& picture, io::ImageF& linear) {
  return by_gl_ ? passes_.finish_means(samples_, picture) : cpu_.finish_means(picture, linear);
}

std::vector<std::string> GlShading::take_notes() {
  return std::exchange(notes_, {});
}

}  // namespace tenebra::render
