// What is shaded of the pixels that need several samples.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/antialias/sample_picture.h"
#include "render/antialias/surface_match.h"
#include "shade/light_terms.h"

namespace tenebra::render {

/// Samples to shade, one value of each after another.
struct ShadingList {
  std::vector<std::uint32_t> ids;
  std::vector<glm::vec2> places;      ///< in the window, pixels
  std::vector<std::uint32_t> from;    ///< where what lights it stands: a slot of the picture of samples, or a
                                      ///< pixel of the frame
  std::vector<std::uint32_t> pixels;  ///< number among the chosen pixels
  std::vector<float> shares;          ///< how many samples of the pixel it stands for
  std::vector<float> centres;         ///< by chosen pixel: how many samples its centre stands for

  void clear() { resize(0), centres.clear(); }
  /// Of all lists but `centres`.
  void resize(std::size_t count) {
    ids.resize(count), places.resize(count), from.resize(count), pixels.resize(count), shares.resize(count);
  }
  void add(std::uint32_t id, glm::vec2 place, std::size_t lit_from, std::size_t pixel, float share) {
    resize(ids.size() + 1);
    set(ids.size() - 1, id, place, lit_from, pixel, share);
  }
  void set(std::size_t i, std::uint32_t id, glm::vec2 place, std::size_t lit_from, std::size_t pixel,
           float share) {
    ids[i] = id, places[i] = place, shares[i] = share;
    from[i] = static_cast<std::uint32_t>(lit_from), pixels[i] = static_cast<std::uint32_t>(pixel);
  }
};

/// What lights samples, and how open they lie.
struct SampleLights {
  std::span<const shade::LightFactors> lights;
  std::span<const float> openness;

  /// Whether the same is left of all lights (but for tints) at sample `a` of these and sample `b` of others.
  bool same(std::size_t a, const SampleLights& other, std::size_t b) const;
};

/// One sample for all samples of a pixel that see one surface in the same light: where they differ is decided
/// exactly, what they look like is taken once, at the sample that is nearest to their mean place, or at the
/// pixel's centre if it is one of them.
void list_groups(std::span<const std::uint32_t> chosen, const SamplePicture& samples, const SampleLights& lit,
                 std::span<const std::uint32_t> centre_ids, const SampleLights& centre_lit,
                 const SurfaceMatch& match, ShadingList& out);

/// Each sample by itself.
void list_samples(std::span<const std::uint32_t> chosen, const SamplePicture& samples, ShadingList& out);

/// Each sample by itself, lit as the pixel's centre is, and as many of them as `offsets`: each stands for
/// `share` samples, and so does the centre, which counts as one already.
void list_as_centres(std::span<const std::uint32_t> chosen, int width, std::span<const glm::vec2> offsets,
                     const visibility::PlaceIds& seen, float share, ShadingList& out);

/// Lists one after another, but for `centres`.
void join(std::span<const ShadingList> parts, ShadingList& to);

}  // namespace tenebra::render
