#include <tenebra/host_frame.h>

#include <algorithm>

#include "base/fail.h"
#include "host/host_rows.h"

namespace tenebra {
namespace host {
namespace {

template <class T>
void turn_over(std::vector<T>& pixels, int width, int height) {
  const auto row = [&](int y) { return pixels.begin() + std::ptrdiff_t{y} * width; };
  for (int y = 0; y < height / 2; ++y) std::swap_ranges(row(y), row(y + 1), row(height - 1 - y));
}

}  // namespace

void arrange(const HostLayout& layout, HostFrame& frame) {
  if (layout.first_id != 0)
    for (std::uint32_t& id : frame.ids) id = id < layout.first_id ? no_triangle : id - layout.first_id;
  if (!layout.bottom_row_first) return;
  turn_over(frame.ids, frame.width, frame.height);
  if (!frame.depth.empty()) turn_over(frame.depth, frame.width, frame.height);
}

}  // namespace host

Expected<void> take_host_frame(std::span<const std::uint32_t> ids, std::span<const float> depth, int width,
                               int height, const HostLayout& layout, HostFrame& out) {
  if (width < 1 || height < 1)
    return base::fail("host's frame: found size {}x{}, expected at least 1x1", width, height);
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (ids.size() != pixels)
    return base::fail("host's frame: found {} ids, expected {}x{}", ids.size(), width, height);
  if (!depth.empty() && depth.size() != pixels)
    return base::fail("host's frame: found {} depths, expected {}x{} or none", depth.size(), width, height);
  out.width = width;
  out.height = height;
  out.ids.assign(ids.begin(), ids.end());
  out.depth.assign(depth.begin(), depth.end());
  host::arrange(layout, out);
  return {};
}

}  // namespace tenebra
