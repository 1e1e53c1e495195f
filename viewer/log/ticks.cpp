#include "log/ticks.h"

#include <algorithm>
#include <cmath>

namespace tenebra::viewer {

double tick_step(double range, int count) {
  const double rough = std::max(range, 1e-6) / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough) return factor * power;
  return 10 * power;
}

std::vector<double> even_ticks(double first, double last, double step) {
  std::vector<double> ticks;
  const double lowest = std::ceil(first / step);
  for (int i = 0; (lowest + i) * step <= last; ++i) ticks.push_back((lowest + i) * step + 0.0);  // no -0
  return ticks;
}

std::vector<double> logarithmic_ticks(double first, double last) {
  std::vector<double> ticks;
  if (!(first > 0 && std::isfinite(first) && std::isfinite(last))) return ticks;
  const int highest = static_cast<int>(std::floor(std::log10(last)));
  for (int power = static_cast<int>(std::floor(std::log10(first))); power <= highest; ++power)
    for (const double factor : {1.0, 2.0, 5.0})
      if (const double tick = factor * std::pow(10.0, power); tick >= first && tick <= last)
        ticks.push_back(tick);
  return ticks;
}

}  // namespace tenebra::viewer
