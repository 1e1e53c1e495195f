// The sky as patches, each seen or not by its centre.
#pragma once

#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "sun/suns.h"

namespace tenebra::sun {

/// Words for people: "tregenza", "reinhart" (2) or "reinhart:N", 2 to 8. The parts that each of Tregenza's
/// rows is cut into.
Expected<int> parse_sky(const std::string& text);

/// Patches of a sky that is equally bright everywhere, as suns in their centres that have light: on an open
/// horizontal surface all of it is 1 Wh/m2. Rows from the horizon up of equal height, the zenith's patch half
/// as high: Tregenza's 145 patches, or each of his rows cut into `parts` rows and `parts` times as many
/// patches (Reinhart). Each has the light of its solid angle; all are divided by what their centres send onto
/// that surface, which is within 0.6 % of pi.
std::vector<Sun> sky_patches(int parts, double north_deg);

}  // namespace tenebra::sun
