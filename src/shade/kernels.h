// What is done to a block of samples, sixteen at a time. Internal to shade.
#pragma once

#include <tenebra/simd_level.h>
#include "shade/encoder.h"
#include "shade/light_terms.h"
#include "shade/sample_block.h"
#include "shade/surfaces.h"
#include "shade/triangle_setup.h"

namespace tenebra::shade {

/// Code for one instruction set; all give the same bits.
struct Kernels {
  /// Fills places, normals and colours of samples `first` ... `first + count - 1`, at window places (x, y),
  /// all of one triangle and its surface. May write up to fifteen samples behind them.
  void (*place)(const TriangleSetup& setup, const Surface& surface, const float* x, const float* y,
                std::size_t first, std::size_t count, SampleBlock& block) = nullptr;
  /// Fills to_eye; `towards`: the same unit direction for all (orthographic views), or null.
  void (*look)(const glm::vec3* towards, SampleBlock& block) = nullptr;
  /// color = ambient * openness + emissive; `openness`: one for each sample, or null: all open. What
  /// is glossy mirrors `reflected`, as open.
  void (*begin)(const float* openness, SampleBlock& block) = nullptr;
  /// Adds a light; `factor`: one for each sample, or null: 1.
  void (*light)(const LightTerms& terms, const float* factor, SampleBlock& block) = nullptr;
  /// color * exposure as levels, three for each sample.
  void (*encode)(const LevelTable& table, float exposure, const SampleBlock& block,
                 std::uint8_t* rgb) = nullptr;
};
Kernels kernels(SimdLevel level);

}  // namespace tenebra::shade
