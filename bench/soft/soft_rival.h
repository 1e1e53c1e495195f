// The sampler that a rival would write today: four rays tell lit and dark tiles from the rest, more rays only
// for the rest, scrambled Sobol points, the light's closed form times the visible share of the rays, and a
// filter along the surfaces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tenebra/soft_config.h>
#include "bench/soft/soft_embree.h"
#include "bench/soft/soft_views.h"

namespace tenebra::bench {

/// One view's rival, with buffers kept from run to run. Its tree is given.
class RivalSampler {
public:
  static constexpr std::size_t probe_rays = 4;

  RivalSampler(const SoftView& view, const EmbreeScene& casters, std::span<const SampledReceiver> receivers);

  /// Irradiance of all pixels by this many rays for each, a power of two from probe_rays on; points on the
  /// light are drawn when a number is first asked for. `passes`: of the filter, 0 to 2, each over 5x5 pixels,
  /// the second twice as far apart (Dammertz et al. 2010). On all threads; the same bits for any number of
  /// them.
  void trace(std::size_t rays, int passes, std::vector<float>& irradiance);

private:
  struct Tile;
  void look(const LightSamples& samples, std::size_t tile, std::size_t from, std::size_t to);
  void decide();
  void light_up(std::vector<float>& irradiance);
  void filter(int step);
  const LightSamples& samples_of(std::size_t rays);

  const SoftView& view_;
  const EmbreeScene& casters_;
  std::span<const SampledReceiver> receivers_;
  PacketKernels kernels_;
  std::size_t columns_, rows_;                  ///< of tiles of 4x4
  std::vector<LightSamples> samples_;           ///< by the logarithm of their number
  std::vector<float> all_, seen_;               ///< weights: tile by tile, sixteen lanes
  std::vector<std::uint8_t> states_, decided_;  ///< of each tile
  std::vector<float> share_, smooth_;           ///< of each pixel: what is visible
  std::vector<std::uint8_t> undecided_;         ///< of each pixel
  SoftMask mask_;                               ///< what nothing hides
  std::vector<std::uint8_t> classes_;           ///< that the closed form writes beside it
};

}  // namespace tenebra::bench
