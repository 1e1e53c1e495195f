#include "ao/field/displacement_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ao/cast/sphere_maps.h"
#include "ao/field/field_chords.h"
#include "ao/field/near_cells.h"
#include "base/fail.h"
#include "parallel/parallel.h"

namespace tenebra::ao {

namespace {

constexpr int fewest_samples = 4, most_samples = 1 << 20;
constexpr std::size_t most_bytes = std::size_t{1} << 30, most_entries = most_bytes;  // 32-bit offsets
constexpr int progress_steps = 32;

int root(double square) {
  return static_cast<int>(std::floor(std::sqrt(square) + 1e-9));
}

}  // namespace

Expected<FieldShape> field_shape(const FieldSettings& settings) {
  const auto in_range = [](int count) { return fewest_samples <= count && count <= most_samples; };
  if (!in_range(settings.positions))
    return base::fail("positions of a field: found {}, expected {} to {}", settings.positions, fewest_samples,
                      most_samples);
  if (!in_range(settings.directions))
    return base::fail("directions of a field: found {}, expected {} to {}", settings.directions,
                      fewest_samples, most_samples);
  if (settings.bits != 1 && settings.bits != 8 && settings.bits != 32)
    return base::fail("bits of a field: found {}, expected 1, 8 or 32", settings.bits);
  FieldShape shape{root(settings.positions), root(settings.directions), 0, 0};
  if (settings.layout == FieldLayout::chords) {
    const double entries = static_cast<double>(settings.positions) * settings.directions;
    shape.position_side = shape.direction_side = root(std::sqrt(entries));
  }
  shape.entries = shape.positions() * shape.directions();
  shape.bytes = (shape.entries * static_cast<std::size_t>(settings.bits) + 7) / 8;
  if (shape.entries > most_entries || shape.bytes > most_bytes)
    return base::fail("size of a field: found {} samples of {} bits, expected at most {} and {} bytes",
                      shape.entries, settings.bits, most_entries, most_bytes);
  return shape;
}

std::size_t field_memory(const FieldSettings& settings, const FieldShape& shape) {
  const std::size_t means = settings.bits == 1 ? shape.positions() : 0;
  return shape.bytes + field_padding + near_words * sizeof(std::uint32_t) + means * sizeof(float);
}

DisplacementField empty_field(const FieldSettings& settings, const FieldShape& shape) {
  DisplacementField field;
  field.layout = settings.layout;
  field.bits = settings.bits;
  field.shape = shape;
  field.table.resize(shape.bytes + field_padding);
  field.close.resize(near_words);
  if (field.bits == 1) field.mean.resize(shape.positions());
  return field;
}

Chord sample_chord(const DisplacementField& field, std::size_t position, std::size_t direction) {
  const auto place = [&](std::size_t cell) {
    return direction_from_square(cell_point(static_cast<int>(cell), field.shape.position_side));
  };
  const glm::vec3 entry = place(position);
  if (field.layout == FieldLayout::chords) return {entry, place(direction) - entry};
  const glm::vec3 inward = -entry;
  const Frame frame = frame_around(inward);
  const glm::vec3 h =
      hemisphere_from_square(cell_point(static_cast<int>(direction), field.shape.direction_side));
  return {entry, 2 * h.z * (h.x * frame.x + h.y * frame.y + h.z * inward)};
}

float DisplacementField::cell() const {
  return static_cast<float>(std::sqrt(4 * M_PI / std::sqrt(static_cast<double>(shape.entries))));
}

namespace {

// The view from one position: s of every direction, `no_hit` where there is none.
class RowTracer {
public:
  RowTracer(const DisplacementField& field, const trees::TriangleBvh& bvh)
      : field_(field), bvh_(bvh), kernels_(trees::bvh_kernels(SimdLevel::automatic)) {}

  void trace(std::size_t position, std::span<float> row) const {
    for (std::size_t d = 0; d < row.size(); d += trees::batch_size) {
      trees::RayBatch rays{};
      float t[trees::batch_size], length[trees::batch_size];
      const std::size_t count = std::min<std::size_t>(trees::batch_size, row.size() - d);
      for (std::size_t i = 0; i < count; ++i) {
        const Chord chord = sample_chord(field_, position, d + i);
        rays.set(static_cast<int>(i),
                 glm::vec3(field_.bound.centre + field_.bound.axes * glm::dvec3(chord.entry)),
                 glm::vec3(field_.bound.axes) * chord.along);
        length[i] = glm::length(chord.along);
      }
      std::fill(t, t + trees::batch_size, 2.0f);
      kernels_.closest_batch(bvh_, rays, t);
      for (std::size_t i = 0; i < count; ++i)
        row[d + i] = t[i] <= 1 ? std::clamp((t[i] - 0.5f) * length[i], -1.0f, 1.0f) : no_hit;
    }
  }

private:
  const DisplacementField& field_;
  const trees::TriangleBvh& bvh_;
  trees::BvhKernels kernels_;
};

void store_row(DisplacementField& field, std::size_t position, std::span<const float> row) {
  const std::size_t first = position * row.size();
  double sum = 0;
  std::size_t hits = 0;
  for (std::size_t d = 0; d < row.size(); ++d) {
    const bool hit = row[d] <= 1;
    if (field.bits == 32) std::memcpy(&field.table[4 * (first + d)], &row[d], 4);
    if (field.bits == 8)
      field.table[first + d] = hit ? static_cast<std::uint8_t>(std::lround((row[d] + 1) * 127)) : 255;
    if (hit) sum += row[d], ++hits;
  }
  if (field.bits != 1) return;
  field.mean[position] = hits ? static_cast<float>(sum / static_cast<double>(hits)) : 0.0f;
}

// Rows of bits share bytes: a thread packs eight rows at a time, which end on a byte.
void store_bits(DisplacementField& field, std::size_t position, std::span<const float> row) {
  for (std::size_t d = 0; d < row.size(); ++d) {
    const std::size_t entry = position * row.size() + d;
    if (row[d] <= 1) field.table[entry / 8] |= static_cast<std::uint8_t>(1u << entry % 8);
  }
}

}  // namespace

Expected<DisplacementField> build_field(std::span<const glm::vec3> positions,
                                        std::span<const glm::uvec3> triangles, const trees::TriangleBvh& bvh,
                                        const FieldSettings& settings, const FieldProgress& progress,
                                        const StopFlag* stop) {
  const Expected<FieldShape> shape = field_shape(settings);
  if (!shape) return tl::unexpected(shape.error());
  if (bvh.triangles == 0) return base::fail("mesh for a field: found no triangle with an area, expected one");
  DisplacementField field = empty_field(settings, *shape);
  field.bound = bounding_ellipsoid(positions, triangles, settings.layout);
  field.close = close_cells(positions, triangles, field.bound, field.cell() / 4);
  const std::size_t rows = shape->positions(), directions = shape->directions();
  const RowTracer tracer(field, bvh);
  // Eight rows end on a byte whatever their length.
  constexpr std::size_t grain = 8;
  const std::size_t step = std::max(grain, (rows / progress_steps + grain - 1) / grain * grain);
  for (std::size_t first = 0; first < rows; first += step) {
    if (progress) progress(static_cast<double>(first) / static_cast<double>(rows));
    parallel::parallel_ranges(std::min(step, rows - first), grain, [&](std::size_t from, std::size_t to) {
      std::vector<float> row(directions);
      for (std::size_t p = first + from; p < first + to && !stop_requested(stop); ++p) {
        tracer.trace(p, row);
        store_row(field, p, row);
        if (field.bits == 1) store_bits(field, p, row);
      }
    });
    if (stop_requested(stop)) return base::stopped();
  }
  if (progress) progress(1);
  return field;
}

}  // namespace tenebra::ao
