// Round numbers for the axes of plots.
#pragma once

#include <vector>

namespace tenebra::viewer {

/// 1, 2 or 5 times a power of ten, so that about `count` of them make up `range`.
double tick_step(double range, int count);

/// The multiples of `step` > 0 from `first` to `last`, both finite.
std::vector<double> even_ticks(double first, double last, double step);

/// For a logarithmic axis: 1, 2 and 5 times each power of ten, of those within `first` to `last` > 0; none if
/// an end is not finite.
std::vector<double> logarithmic_ticks(double first, double last);

}  // namespace tenebra::viewer
