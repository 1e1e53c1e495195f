#include "base/statistics.h"

#include <algorithm>
#include <vector>

namespace tenebra::base {
namespace {

/// Nearest rank in whole numbers: no rounding decides which value it is.
double percentile(const std::vector<double>& ascending, std::size_t percent) {
  const std::size_t rank = (ascending.size() * percent + 99) / 100;
  return ascending[std::max<std::size_t>(rank, 1) - 1];
}

}  // namespace

Summary summarize(std::span<const double> values) {
  if (values.empty()) return {};
  std::vector<double> ascending(values.begin(), values.end());
  std::sort(ascending.begin(), ascending.end());
  const std::size_t count = ascending.size();
  Summary summary;
  summary.count = count;
  summary.median = (ascending[(count - 1) / 2] + ascending[count / 2]) / 2;
  summary.percentile_95 = percentile(ascending, 95);
  summary.percentile_99 = percentile(ascending, 99);
  summary.worst = ascending.back();
  summary.worst_at =
      static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
  return summary;
}

}  // namespace tenebra::base
