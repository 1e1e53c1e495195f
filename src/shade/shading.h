// What samples of a view look like: from triangle ids, lights, shadows (masks, irradiance) and openness to
// linear colours, and on to the 8 bits of a picture. One pass; no OpenGL. The bits do not depend on the
// number of threads or the instruction set.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/frame_geometry.h>
#include <tenebra/simd_level.h>
#include "io/image.h"
#include "shade/display.h"
#include "shade/environment.h"
#include "shade/light_terms.h"
#include "shade/surfaces.h"

namespace tenebra::shade {

/// One instant, seen from one place. Refers to its data, which must live as long.
struct Subject {
  const FrameGeometry& geometry;
  const ViewRays& view;
  const SurfaceTable& surfaces;
  bool smooth_terminator = false;  ///< on smooth triangles light counts by shading normal, not by plane
};

struct Lighting {
  std::span<const DrawnLight> lights;
  glm::vec3 ambient_light{1.0f};
  glm::vec3 background{0.0f};                ///< linear, where no triangle is seen
  const Environment* environment = nullptr;  ///< in place of ambient_light and background
  SimdLevel simd = SimdLevel::automatic;     ///< the same bits with each
};

/// Samples of a view, pixels or not. Which point a sample is follows from its triangle and its place: where
/// the ray through the place meets the triangle's plane, moved into the triangle if it lies beside.
struct Samples {
  std::span<const std::uint32_t> ids;     ///< triangles; out of range: background
  std::span<const glm::vec2> places;      ///< in pixels; (0.5, 0.5) is the centre of the top left one
  std::span<const LightFactors> factors;  ///< one for each of Lighting::lights, by sample
  std::span<const float> openness;        ///< ambient occlusion, 1 open to 0 closed; empty: all open
  float width_px = 1;                     ///< textures are smoothed as widely as for pixels of this width
};

/// A sample's linear colour, before exposure: ambient * ambient_light * openness + emissive + the sum of
/// light * mask / 255 or light * irradiance over the lights; docs/materials.md has the formulas of
/// reflection.
struct ShadedSample {
  glm::vec3 color{0.0f};
  float alpha = 1;  ///< share of the surface that is there (AlphaMode::blend, mask)
};
void shade_samples(const Subject& subject, const Lighting& lighting, const Samples& samples,
                   std::vector<ShadedSample>& out);

/// The samples at the centres of all pixels. Rows stand one after another, row 0 at the top.
struct PixelSamples {
  int width = 0;
  int height = 0;
  std::span<const std::uint32_t> ids;
  std::span<const LightFactors> factors;
  std::span<const float> openness;
};

/// What is shown of their colours, encoded. `out` keeps its capacity. `colors`, if not null, gets the linear
/// colours.
void shade_picture(const Subject& subject, const Lighting& lighting, const PixelSamples& pixels,
                   const Display& display, io::Image8& out, std::vector<glm::vec3>* colors = nullptr);

/// The light buffer: direct diffuse light that light `light` of `lighting` would send from the seen triangles
/// to the eye if nothing were in between; three channels, zero where no triangle is seen. Zero where light
/// and eye lie on different sides of the triangle's plane (smooth terminator: of that across the normal); the
/// shading normal is turned to the eye's side. With albedo c, distance d, angle theta at the surface:
/// - Falloff::inverse_square, photometric: c / pi * I cos(theta) / d^2; directional: c / pi * E cos(theta).
///   Range and cones fade as in KHR_lights_punctual. Area lights act as their centre: I = nits * area *
///   cos(angle from their axis), nothing behind them.
/// - Falloff::none, no unit (BART): c * I cos(theta).
/// With DrawnLight::area it is the same for each unit of the irradiance that light of radiance 1 sends to a
/// point, whatever the sides: c / pi * L, with L = nits of an area light, I / area_m2 of the others.
/// Falloff::none: c * I d^2 / area_m2 with the distance d to the light's centre, which a small light's
/// irradiance, area cos cos' / d^2, makes c * I cos(theta) cos' again. Range and a spot's cone fade as seen
/// from the light's centre. Values are at most 1e30.
void light_buffer(const Subject& subject, const Lighting& lighting, std::size_t light,
                  const PixelSamples& pixels, io::ImageF& out);

}  // namespace tenebra::shade
