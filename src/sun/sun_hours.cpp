#include "sun/sun_hours.h"

#include <algorithm>
#include <functional>

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

/// How much each point of a batch sees of a sun: marks of a mask, or shares of a disc.
struct Sight {
  std::span<const std::uint8_t> mask;
  std::span<const float> shares;

  /// Of points [first, end), added up in their order.
  double seen(std::size_t first, std::size_t end) const {
    double sum = 0;
    for (std::size_t i = first; i < end; ++i)
      sum += mask.empty() ? static_cast<double>(shares[i]) : mask[i] != 0 ? 1.0 : 0.0;
    return sum;
  }
};

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

using Use = std::function<void(std::size_t sun, const Sight& sight)>;

Expected<void> see_points(PointTracer& tracer, const Geometry& geometry, const QueryPoints& points,
                          std::span<const Sun> suns, const HoursConfig& config, const StopFlag* stop,
                          const Use& use) {
  std::vector<ShadowLight> lights;
  for (const Sun& sun : suns) lights.push_back({.directional = true, .to_light = glm::vec3(sun.to_sun)});
  return tracer.hard_masks(
      geometry, points, lights, config.hard,
      [&](std::size_t sun, std::span<const std::uint8_t> mask) {
        use(sun, {mask, {}});
      },
      stop);
}

Expected<void> see_discs(PointTracer& tracer, const Geometry& geometry, const QueryPoints& points,
                         std::span<const Sun> suns, const HoursConfig& config, const StopFlag* stop,
                         const Use& use) {
  std::vector<float> shares(points.positions.size());
  for (std::size_t s = 0; s < suns.size(); ++s) {
    const auto disc = make_sun(glm::vec3(suns[s].to_sun), config.disc_deg);
    if (!disc) return tl::unexpected(disc.error());
    auto done = tracer.soft_visibility(geometry, points, *disc, config.soft, shares, {}, stop);
    if (!done) return done;
    use(s, {{}, shares});
  }
  return {};
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
  PointTracer tracer;
  for (std::size_t first = 0; first < count;) {
    const Batch batch = next_batch(ends, first);
    const QueryPoints asked = part_of(points, batch.points_begin, batch.points_end - batch.points_begin);
    const auto use = [&](std::size_t s, const Sight& sight) {
      add(sight, batch, ends, suns[s], static_cast<std::int32_t>(s), out);
      const double part = static_cast<double>(batch.points_end - batch.points_begin) *
                          static_cast<double>(s + 1) / static_cast<double>(suns.size());
      if (progress) progress((batch.points_begin + part) / static_cast<double>(ends.back()));
    };
    const auto see = config.disc_deg > 0 ? see_discs : see_points;
    auto seen = see(tracer, geometry, asked, suns, config, stop, use);
    if (!seen) return tl::unexpected(seen.error());
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
