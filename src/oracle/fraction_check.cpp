#include "oracle/fraction_check.h"

#include <algorithm>
#include <cmath>

#include "parallel/parallel.h"

namespace tenebra::oracle {
namespace {

constexpr std::size_t fractions_of_a_round = 4096;  // whose answers are all kept meanwhile

/// The larger of both sides' answers: no point sees both.
SoftAnswer answer_of(const FractionRequest& request, const glm::dvec3& point, std::uint32_t id) {
  const auto asked = [&](const ExactSoft& side) {
    return side.answer(point, id, glm::vec3(0), SweepNumbers::long_double, request.most_occluders);
  };
  SoftAnswer answer = asked(*request.front);
  if (request.back == nullptr) return answer;
  SoftAnswer back = asked(*request.back);
  back.skipped = back.skipped || answer.skipped;
  back.at_plane = back.at_plane || answer.at_plane;
  return back.visible_fraction > answer.visible_fraction || back.skipped ? back : answer;
}

void check_sample(const FractionRequest& request, const VisiblePoints& points, float said, std::size_t pixel,
                  FractionCheck& part) {
  const std::uint32_t id = points.triangles[pixel];
  const glm::dvec3& point = points.positions[pixel];
  const SoftAnswer answer = answer_of(request, point, id);
  if (answer.skipped || answer.at_plane) {
    ++part.stats.skipped;
    return;
  }
  const double error = std::abs(double(said) - answer.visible_fraction);
  ++part.stats.samples;
  part.stats.penumbra += answer.visible_fraction > 0 && answer.visible_fraction < 1;
  part.stats.occluders += answer.occluders;
  part.stats.largest_error = std::max(part.stats.largest_error, error);
  const double distance_part = 0x1p-48 * request.front->distance_in_sizes(point);
  if (error <= std::max(request.promise, distance_part) + answer.error_bound) return;
  ++part.wrong_count;
  part.wrong.push_back({pixel, id, said, answer.visible_fraction});
}

}  // namespace

FractionStats& FractionStats::operator+=(const FractionStats& other) {
  samples += other.samples, penumbra += other.penumbra, skipped += other.skipped;
  occluders += other.occluders;
  largest_error = std::max(largest_error, other.largest_error);
  return *this;
}

FractionCheck check_fractions(const FractionRequest& request, const VisiblePoints& points,
                              std::span<const float> fractions, std::span<const std::size_t> pixels,
                              const StopFlag* stop) {
  FractionCheck all;
  std::vector<FractionCheck> parts;
  for (std::size_t begin = 0; begin < pixels.size(); begin += fractions_of_a_round) {
    const auto round = pixels.subspan(begin, std::min(fractions_of_a_round, pixels.size() - begin));
    parts.assign(round.size(), {});
    parallel::parallel_ranges(round.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        if (stop != nullptr && stop->requested()) return;
        check_sample(request, points, fractions[round[i]], round[i], parts[i]);
      }
    });
    for (const FractionCheck& part : parts) {
      all.stats += part.stats;
      all.wrong_count += part.wrong_count;
      if (!part.wrong.empty() && all.wrong.size() < FractionCheck::most_named)
        all.wrong.push_back(part.wrong.front());
    }
  }
  return all;
}

}  // namespace tenebra::oracle
