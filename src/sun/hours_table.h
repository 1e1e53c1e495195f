// The hours as tables for other programs: CSV and JSON. Places are in the coordinates of the scene's file.
#pragma once

#include <string>

#include "sun/seasons.h"

namespace tenebra::sun {

/// What was asked and answered; the parts must live as long.
struct Study {
  const Scene& scene;
  const FrameGeometry& frame;
  const Receivers& receivers;
  const Suns& suns;
  const SunHours& hours;
  const SkyLight* sky = nullptr;  ///< null: not asked for
};

/// What is counted, for people and programs.
struct Quantity {
  const char* name;       ///< of its column
  const char* unit;       ///< empty: none
  const char* attribute;  ///< of vertices
  double per;             ///< how much of SunHours is 1 of it
};
Quantity quantity_of(const Suns& suns);
/// How much of it receiver `i` got.
double value_of(const Study& study, std::size_t i);

/// A line of names, then a row for each receiver, in order: face (number of the triangle in the scene), cell
/// or point; of a face its node and material; x, y, z of its middle; its area; `hours`, `sum` where suns have
/// no time or `kwh_m2` where they have light; what a sky adds to that, `sky_kwh_m2`, or else `sky`, the share
/// of an open one's; `hours` where suns have light; when the first and the last sun are seen; minutes, or
/// the light, of each month, where they were asked for: N days that one stands for count in its month, and
/// years are added up.
std::string csv_of(const Study& study);
/// {"columns": [...], "rows": [[...], ...]} of the same, with what a reader must know beside it: the model,
/// the unit, the zone.
std::string json_of(const Study& study);

}  // namespace tenebra::sun
