// Nodes that cast in a part of the year, and the sun and sky of a scene that has some.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sun/sun_hours.h"

namespace tenebra::sun {

/// A node and all below it, and the days on which they cast.
struct SeasonalCaster {
  std::string node;
  Season season;
};
/// NODE=A:B, as parse_season().
Expected<SeasonalCaster> parse_seasonal(const std::string& text);

/// What is asked of a scene at one instant.
struct SeasonalScene {
  const Scene& scene;
  const FrameGeometry& frame;
  std::vector<SeasonalCaster> seasonal;
};

/// What HoursConfig::glass is of a frame; it stays where it is.
struct FrameGlass {
  SurfaceCoordinates coordinates;
  SeeThroughSurfaces surfaces;
};
/// `see_through`: as FrameGeometry's, and must live as long. Null: no triangle lets light pass.
std::unique_ptr<const FrameGlass> glass_of(const Scene& scene, const FrameGeometry& frame,
                                           std::span<const std::uint8_t> see_through);

/// As sun_hours() of receivers, with see-through surfaces that dim: suns that follow each other with the same
/// casters share one geometry. Fails on a node that the scene does not have.
Expected<SunHours> hours_of(const SeasonalScene& scene, const Receivers& receivers, const Suns& suns,
                            HoursConfig config, const StopFlag* stop = nullptr,
                            const QueryProgress& progress = {});

/// Light that receivers get from a sky.
struct SkyLight {
  std::vector<double> light;  ///< Wh/m2 where suns are a weather file's, else the share of an open sky's
  std::size_t patches = 0;
};
/// Of patches as sky_patches() makes them. Without a weather file casters are those of every day.
Expected<SkyLight> sky_of(const SeasonalScene& scene, const Receivers& receivers, const Suns& suns,
                          const std::vector<Sun>& patches, HoursConfig config, const StopFlag* stop = nullptr,
                          const QueryProgress& progress = {});

}  // namespace tenebra::sun
