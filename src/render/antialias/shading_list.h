// The samples that are shaded for pixels that need several.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/visible_points.h>
#include "render/antialias/sample_picture.h"
#include "render/antialias/surface_match.h"
#include "shade/light_terms.h"

namespace tenebra::render {

/// Samples to shade, as one list for each value, those of a pixel together.
struct ShadingList {
  std::vector<std::uint32_t> ids;
  std::vector<glm::vec2> places;      ///< in the window, pixels
  std::vector<std::uint32_t> from;    ///< what lights it: a slot of the picture of samples, a pixel of the
                                      ///< frame, or LitBits (list_edges)
  std::vector<std::uint32_t> pixels;  ///< number among the chosen pixels
  std::vector<float> shares;          ///< how many samples of the pixel it stands for
  std::vector<float> centres;         ///< by chosen pixel: how many more samples its centre stands for

  void clear() { resize(0), centres.clear(); }
  /// Sets the size of all lists but `centres`.
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

/// The light and the openness at samples.
struct SampleLights {
  std::span<const shade::LightFactors> lights;
  std::span<const float> openness;

  /// Whether sample `a` of these and sample `b` of others have the same light.
  bool same(std::size_t a, const SampleLights& other, std::size_t b) const;
};

/// What the pixels' centres see, and what lights them.
struct CentreSamples {
  std::span<const std::uint32_t> ids;
  std::span<const std::uint32_t> layer;  ///< see-through triangles before them; empty: none
  SampleLights lit;

  bool has_layer(std::size_t pixel) const { return !layer.empty() && layer[pixel] != no_triangle; }
};

/// One sample for all samples of a pixel that see one surface in the same light: where they differ is decided
/// exactly, what they look like is taken once, at the sample that is nearest to their mean place, or at the
/// pixel's centre if it is one of them. Samples that see something see-through before their surface stand for
/// themselves.
void list_groups(std::span<const std::uint32_t> chosen, const SamplePicture& samples, const SampleLights& lit,
                 const CentreSamples& centres, const SurfaceMatch& match, ShadingList& out);

/// Each sample by itself.
void list_samples(std::span<const std::uint32_t> chosen, const SamplePicture& samples, ShadingList& out);

/// Places that stand for the samples of pixels that see one surface.
struct StandIns {
  std::span<const glm::vec2> offsets;  ///< of the samples, seen at the places of `seen`
  std::span<const glm::vec2> places;   ///< from the pixel's centre
  float centre_counts = 0;             ///< how many samples the centre counts for already: taken off again
};
/// The places, lit as the pixel's centre is; together they stand for all samples. Each sees what the nearest
/// sample, or the centre, sees: the surface is one, and the place next to it.
void list_as_centres(std::span<const std::uint32_t> chosen, int width, const StandIns& stand_ins,
                     std::span<const std::uint32_t> centre_ids, const visibility::PlaceIds& seen,
                     ShadingList& out);

/// Lists one after another, but for `centres`.
void join(std::span<const ShadingList> parts, ShadingList& to);

}  // namespace tenebra::render
