#include "shade/shading.h"

#include <algorithm>
#include <functional>

#include "parallel/parallel.h"
#include "shade/block_shader.h"

namespace tenebra::shade {
namespace {

constexpr std::size_t samples_at_once = 64 * SampleBlock::capacity;
constexpr std::size_t rows_at_once = 16;  // neighbouring rows see the same triangles

/// Calls work(shader, first) for each block of pixels from `first` on, placed.
void for_each_block(const FrameTerms& frame, const PixelSamples& pixels,
                    const std::function<void(BlockShader&, std::size_t)>& work) {
  const auto width = static_cast<std::size_t>(pixels.width), height = static_cast<std::size_t>(pixels.height);
  parallel::parallel_ranges(height, rows_at_once, [&](std::size_t top, std::size_t bottom) {
    BlockShader shader(frame);
    float x[SampleBlock::room] = {}, y[SampleBlock::room] = {};
    for (std::size_t row = top; row < bottom; ++row) {
      std::fill_n(y, SampleBlock::room, static_cast<float>(row) + 0.5f);
      for (std::size_t column = 0; column < width; column += SampleBlock::capacity) {
        const std::size_t count = std::min(SampleBlock::capacity, width - column);
        for (std::size_t i = 0; i < count; ++i) x[i] = static_cast<float>(column + i) + 0.5f;
        const std::size_t first = row * width + column;
        shader.place(pixels.ids.subspan(first, count), x, y);
        work(shader, first);
      }
    }
  });
}

template <class T>
void resize(const PixelSamples& pixels, io::Image<T>& out) {
  out.width = pixels.width;
  out.height = pixels.height;
  out.channels = 3;
  out.pixels.resize(3 * static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height));
}

}  // namespace

void shade_samples(const Subject& subject, const Lighting& lighting, const Samples& samples,
                   std::vector<ShadedSample>& out) {
  const FrameTerms frame(subject, lighting);
  out.resize(samples.ids.size());
  parallel::parallel_ranges(out.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
    BlockShader shader(frame, samples.width_px);
    float x[SampleBlock::room] = {}, y[SampleBlock::room] = {};
    for (std::size_t first = begin; first < end; first += SampleBlock::capacity) {
      const std::size_t count = std::min(SampleBlock::capacity, end - first);
      for (std::size_t k = 0; k < count; ++k) {
        x[k] = samples.places[first + k].x;
        y[k] = samples.places[first + k].y;
      }
      shader.place(samples.ids.subspan(first, count), x, y);
      shader.shade(samples.factors, samples.openness, first);
      const SampleBlock& block = shader.block();
      for (std::size_t k = 0; k < count; ++k) {
        out[first + k] = {{block.color[0][k], block.color[1][k], block.color[2][k]}, block.alpha[k]};
      }
    }
  });
}

void shade_picture(const Subject& subject, const Lighting& lighting, const PixelSamples& pixels,
                   const Display& display, io::Image8& out, std::vector<glm::vec3>* colors) {
  const FrameTerms frame(subject, lighting);
  const LevelTable& table = level_table(display.transfer);
  resize(pixels, out);
  if (colors != nullptr) colors->resize(out.pixels.size() / 3);
  for_each_block(frame, pixels, [&](BlockShader& shader, std::size_t first) {
    shader.shade(pixels.factors, pixels.openness, first);
    const SampleBlock& block = shader.block();
    frame.code.encode(table, display, block, &out.pixels[3 * first]);
    if (colors == nullptr) return;
    for (std::size_t i = 0; i < block.count; ++i)
      (*colors)[first + i] = {block.color[0][i], block.color[1][i], block.color[2][i]};
  });
}

void light_buffer(const Subject& subject, const Lighting& lighting, std::size_t light,
                  const PixelSamples& pixels, io::ImageF& out) {
  const FrameTerms frame(subject, lighting);
  resize(pixels, out);
  for_each_block(frame, pixels, [&](BlockShader& shader, std::size_t first) {
    shader.shade_light(light);
    const SampleBlock& block = shader.block();
    for (std::size_t i = 0; i < block.count; ++i) {
      for (std::size_t c = 0; c < 3; ++c) out.pixels[3 * (first + i) + c] = block.color[c][i];
    }
  });
}

}  // namespace tenebra::shade
