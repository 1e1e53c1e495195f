// The options of `tenebra sun`.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "options/method_options.h"
#include "options/scene_options.h"
#include "sun/seasons.h"

namespace tenebra::viewer {

struct SunOptions {
  SceneOptions scene;
  std::optional<sun::Place> place;
  std::optional<std::variant<sun::Days, sun::Season>> days;  ///< a season of a weather file's
  std::optional<double> step_min;
  std::optional<int> zone_min;  ///< none: UTC
  double north_deg = 0;
  bool refraction = false;
  std::string suns;     ///< a file in place of place and days; empty: not given
  std::string weather;  ///< an EPW file in place of the place; empty: not given
  double disc_deg = 0;
  int sky_parts = 0;  ///< of sun::sky_patches; 0: no sky
  std::vector<sun::SeasonalCaster> seasonal;

  sun::FaceChoice faces;
  std::optional<double> ground;  ///< height of a plane, in the file's unit
  double cell_m = 1;
  std::string points;  ///< a file; empty: not given

  MethodOptions method;
  std::string csv, json, model, plan, raster;  ///< files to write; empty: not asked for
  double full = 0;                             ///< what the brightest colour stands for; 0: the most
  int epsg = 0;                                ///< of the file's coordinates; 0: not known
  double timeout_s = std::numeric_limits<double>::infinity();
  std::optional<int> memory_mb;  ///< of the whole program
  bool quiet = false;
};

void add_sun_options(CLI::App& command, SunOptions& options);

/// Checks what single options cannot.
Expected<void> settle_sun_options(const CLI::App& command, SunOptions& options);

}  // namespace tenebra::viewer
