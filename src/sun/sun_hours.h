// What places see of many suns: sums of weights, the first and the last sun.
#pragma once

#include <span>
#include <vector>

#include <tenebra/queries.h>
#include <tenebra/tint.h>
#include "sun/receivers.h"
#include "sun/suns.h"

namespace tenebra::sun {

struct HoursConfig {
  /// The sun's diameter, 0 to 90; 0: a point. Of a disc the visible share of its area counts.
  double disc_deg = 0;
  bool light = false;                         ///< what their surfaces get of the suns' light too
  bool months = false;                        ///< what each month adds too
  const SeeThroughSurfaces* glass = nullptr;  ///< of the geometry's triangles: they dim; null: there is none
  HardShadowConfig hard;
  SoftShadowConfig soft;
};

/// One for each receiver.
struct SunHours {
  std::vector<double> sums;         ///< mean over its points of the weights of the suns that they see
  std::vector<std::int32_t> first;  ///< the first sun of the list that one of its points sees; -1: none
  std::vector<std::int32_t> last;   ///< the last one
  std::vector<double> months;       ///< twelve each, of `light` or, where that is empty, `sums`; empty: not
                                    ///< asked for
  std::vector<double> light;        ///< Wh/m2 on its surface: mean over its points of the light of the suns
                                    ///< that they see times the cosine to the normal; empty: not asked for
};

/// Whether light can be counted: fails on a point that has no triangle and no normal.
Expected<void> check_facings(const QueryPoints& points);

/// The same bytes for any number of threads and vector level. `ends`: one past the last point of each
/// receiver, ascending; the last one is the number of points. With `ends` takes 20 bytes for each
/// receiver, 8 more with light and 96 with months, and for 2^18 points at a time (or all of a receiver that
/// has more) 32 bytes with light and what PointTracer and, with glass, TintTracer take. Fails as PointTracer
/// does, with "stopped" soon after `stop`, and where light is asked for as check_facings() does. A point's
/// normal is the given one, else that of its side of the triangle.
Expected<SunHours> sun_hours(const Geometry& geometry, const QueryPoints& points,
                             std::span<const std::uint32_t> ends, std::span<const Sun> suns,
                             const HoursConfig& config, const StopFlag* stop = nullptr,
                             const QueryProgress& progress = {});

/// The same of receivers, with light where the suns have it.
Expected<SunHours> sun_hours(const Geometry& geometry, const Receivers& receivers, const Suns& suns,
                             HoursConfig config, const StopFlag* stop = nullptr,
                             const QueryProgress& progress = {});

}  // namespace tenebra::sun
