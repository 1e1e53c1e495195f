#include "sun/sun_hours.h"

#include <algorithm>

#include "base/fail.h"
#include "parallel/parallel.h"

namespace tenebra::sun {
namespace {

constexpr std::uint32_t most_at_a_time = 1u << 18;  // points, but for receivers that have more

template <class T>
std::span<const T> part_of(std::span<const T> all, std::size_t first, std::size_t count) {
  return all.empty() ? all : all.subspan(first, count);
}
QueryPoints part_of(const QueryPoints& points, std::size_t first, std::size_t count) {
  return {.positions = points.positions.subspan(first, count),
          .triangles = part_of(points.triangles, first, count),
          .normals = part_of(points.normals, first, count),
          .sides = part_of(points.sides, first, count)};
}

/// How much each point sees of a sun, 0 to 1.
class Sight {
public:
  Sight(const Geometry& geometry, const HoursConfig& config) : geometry_(geometry), config_(config) {}

  Expected<void> look(const QueryPoints& points, const Sun& sun, const StopFlag* stop) {
    const std::size_t count = points.positions.size();
    if (config_.disc_deg > 0) {
      const auto disc = make_sun(glm::vec3(sun.to_sun), config_.disc_deg);
      if (!disc) return tl::unexpected(disc.error());
      fractions_.resize(count);
      return tracer_.soft_visibility(geometry_, points, *disc, config_.soft, fractions_, {}, stop);
    }
    mask_.resize(count);
    return tracer_.hard_mask(geometry_, points, {.directional = true, .to_light = glm::vec3(sun.to_sun)},
                             config_.hard, mask_, stop);
  }
  /// Of points [first, end), added up in their order.
  double seen(std::size_t first, std::size_t end) const {
    double sum = 0;
    for (std::size_t i = first; i < end; ++i)
      sum += config_.disc_deg > 0 ? static_cast<double>(fractions_[i]) : mask_[i] != 0 ? 1.0 : 0.0;
    return sum;
  }

private:
  const Geometry& geometry_;
  const HoursConfig& config_;
  PointTracer tracer_;
  std::vector<std::uint8_t> mask_;
  std::vector<float> fractions_;
};

/// Receivers [first, end) and where their points begin.
struct Batch {
  std::size_t first, end;
  std::uint32_t points_begin, points_end;
};
Batch next_batch(std::span<const std::uint32_t> ends, std::size_t first) {
  const std::uint32_t begin = first == 0 ? 0 : ends[first - 1];
  std::size_t end = first + 1;
  while (end < ends.size() && ends[end] - begin <= most_at_a_time) ++end;
  return {first, end, begin, ends[end - 1]};
}

/// Adds what the batch sees of sun `number`.
void add(const Sight& sight, const Batch& batch, std::span<const std::uint32_t> ends, const Sun& sun,
         std::int32_t number, SunHours& out) {
  parallel::parallel_ranges(batch.end - batch.first, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = batch.first + begin; r < batch.first + end; ++r) {
      const std::uint32_t first = r == 0 ? 0 : ends[r - 1];
      const double seen = sight.seen(first - batch.points_begin, ends[r] - batch.points_begin);
      if (!(seen > 0)) continue;
      out.sums[r] += sun.weight * seen;
      if (!out.months.empty()) out.months[12 * r + static_cast<std::size_t>(sun.month)] += sun.weight * seen;
      if (out.first[r] < 0) out.first[r] = number;
      out.last[r] = number;
    }
  });
}

void divide_by_points(std::span<const std::uint32_t> ends, SunHours& out) {
  for (std::size_t r = 0; r < ends.size(); ++r) {
    const double points = ends[r] - (r == 0 ? 0 : ends[r - 1]);
    out.sums[r] /= points;
    for (std::size_t m = 12 * r; m < std::min(12 * r + 12, out.months.size()); ++m) out.months[m] /= points;
  }
}

}  // namespace

Expected<SunHours> sun_hours(const Geometry& geometry, const QueryPoints& points,
                             std::span<const std::uint32_t> ends, std::span<const Sun> suns,
                             const HoursConfig& config, const StopFlag* stop, const QueryProgress& progress) {
  const std::size_t count = ends.size();
  SunHours out{std::vector<double>(count),
               std::vector<std::int32_t>(count, -1),
               std::vector<std::int32_t>(count, -1),
               {}};
  if (config.months) out.months.resize(12 * count);
  Sight sight(geometry, config);
  for (std::size_t first = 0; first < count;) {
    const Batch batch = next_batch(ends, first);
    const QueryPoints asked = part_of(points, batch.points_begin, batch.points_end - batch.points_begin);
    for (std::size_t s = 0; s < suns.size(); ++s) {
      if (auto looked = sight.look(asked, suns[s], stop); !looked) return tl::unexpected(looked.error());
      add(sight, batch, ends, suns[s], static_cast<std::int32_t>(s), out);
      const double part = static_cast<double>(batch.points_end - batch.points_begin) *
                          static_cast<double>(s + 1) / static_cast<double>(suns.size());
      if (progress) progress((batch.points_begin + part) / static_cast<double>(ends.back()));
    }
    first = batch.end;
  }
  divide_by_points(ends, out);
  return out;
}

Expected<SunHours> sun_hours(const Geometry& geometry, const Receivers& receivers, const Suns& suns,
                             const HoursConfig& config, const StopFlag* stop, const QueryProgress& progress) {
  std::vector<std::uint32_t> ends;
  for (const Receiver& receiver : receivers.list) ends.push_back(receiver.end);
  return sun_hours(geometry, receivers.points(), ends, suns.list, config, stop, progress);
}

}  // namespace tenebra::sun
