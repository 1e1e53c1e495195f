// Further samples for the pixels that need them: their ids, lights and colours, by the same stages as those
// of the pixels' centres, and the means.
#pragma once

#include <vector>

#include "render/antialias/borrowed_light.h"
#include "render/antialias/edge_shadows.h"
#include "render/antialias/mask_means.h"
#include "render/antialias/pixel_choice.h"
#include "render/antialias/sample_picture.h"
#include "render/antialias/sample_stages.h"
#include "render/antialias/shading_list.h"

namespace tenebra::render {

/// Keeps its buffers from frame to frame.
class AntiAliaser {
public:
  /// Adds further samples to the picture in `result`, which has what the centres show, and to the means of
  /// masks.
  Expected<void> run(const SampleStages& stages, FrameResult& result);

private:
  /// Some of the samples of chosen pixels: those at the places of the pattern from `place` on.
  struct Round {
    const SampleStages& stages;
    std::span<const glm::vec2> offsets;  // of the places
    std::size_t place;
    MaskMeans& masks;
  };
  ChosenPixels choose(const Round& round, const io::Image8& picture) const;
  /// Puts those edges last that can do without samples in a picture of their own: no glass is near, and all
  /// lights have hard shadows, or none. Returns how many are before them.
  std::size_t part_edges(const Round& round, ChosenPixels& chosen) const;
  /// The samples of chosen pixels; edges from `shared` on need no picture of their own.
  Expected<void> add_samples(const Round& round, const ChosenPixels& chosen, std::size_t shared);
  /// Edges, chosen pixels from `first` on: further samples with points and shadows of their own.
  Expected<void> add_edges(const Round& round, std::span<const std::uint32_t> edges, std::size_t first);
  /// Edges whose samples have the shadows of centres nearby, or get hard ones of their own.
  Expected<void> add_shared(const Round& round, std::span<const std::uint32_t> edges, std::size_t first);
  /// Contrasts: a few places of each pixel, in the light of its centre.
  Expected<void> add_contrasts(const Round& round, std::span<const std::uint32_t> pixels, std::size_t first);

  /// The light of packed samples.
  Expected<void> light_packed(const Round& round, std::span<const std::uint32_t> edges);
  /// The hard shadows of packed samples: of centres nearby where these agree, else their own.
  Expected<void> light_sparsely(const Round& round, std::span<const std::uint32_t> edges);
  /// Shades what is listed, whose `from` are places in `lit`, and adds it to chosen pixels from `first` on.
  Expected<void> add_listed(const SampleStages& stages, const SampleLights& lit, float texture_px,
                            std::size_t first);
  /// The same of packed samples, some of which are behind something see-through.
  Expected<void> add_behind_layer(const SampleStages& stages, const SampleLights& lit, float texture_px,
                                  std::size_t first);
  SampleShares shares_of_listed(std::size_t first) const {
    return {first, listed_.pixels, listed_.shares, listed_.centres};
  }

  visibility::PlaceIds seen_;  // what pixels see at the places of a round
  SamplePicture packed_;
  LitSamples lit_;  // `packed_`
  EdgeShadows edge_shadows_;
  BorrowedLight borrowed_;
  ShadingList listed_;
  std::vector<shade::ShadedSample> shaded_;
};

}  // namespace tenebra::render
