// The hours as tables for other programs: CSV and JSON. Places are in the coordinates of the scene's file.
#pragma once

#include <string>

#include "sun/sun_hours.h"

namespace tenebra::sun {

/// What was asked and answered; the parts must live as long.
struct Study {
  const Scene& scene;
  const FrameGeometry& frame;
  const Receivers& receivers;
  const Suns& suns;
  const SunHours& hours;
};

/// Hours or, where suns have no time, the sum that receiver `i` got.
double value_of(const Study& study, std::size_t i);
/// "hours" or "sum".
const char* what_of(const Study& study);

/// A line of names, then a row for each receiver, in order: face (number of the triangle in the scene), cell
/// or point; of a face its node and material; x, y, z of its middle; its area; `hours` or, where suns have no
/// time, `sum`; when the first and the last sun are seen; minutes for each month,
/// where they were asked for: N days that one stands for count in its month, and years are added up.
std::string csv_of(const Study& study);
/// {"columns": [...], "rows": [[...], ...]} of the same, with what a reader must know beside it.
std::string json_of(const Study& study);

}  // namespace tenebra::sun
