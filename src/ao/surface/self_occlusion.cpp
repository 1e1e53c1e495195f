#include "ao/surface/self_occlusion.h"

#include <algorithm>
#include <cmath>

#include "ao/surface/surface_layout_inline.h"
#include "base/sort_unique.h"
#include "parallel/parallel.h"

namespace tenebra::ao {
namespace {

// A value is unknown, or 8 x (0..most) + three flags: something is near by the measure of the wide grid, of
// the half one; the sample is buried.
using Value = std::uint16_t;
constexpr Value unknown = SurfaceSamples::unknown, near_wide = 1, near_half = 2, buried = 4;
constexpr int flag_bits = 3;
constexpr float most = 8190;
constexpr float disagreement = 0.1f;  // neighbours that differ by more have their cell divided
constexpr double near_steps = 1.5;    // in steps of a grid: nearer things ask for a finer one
constexpr std::size_t fewest_cells = 8;

// What is missing is a sample, by its number, or one of these, by its number and a bit:
constexpr std::uint64_t is_side = std::uint64_t{1} << 62;  // 2 x triangle + side: a small triangle's
constexpr std::uint64_t is_cell = std::uint64_t{1} << 63;  // a cell's division

/// The values of three samples.
struct Values {
  Value v[3];
  bool lacking() const { return std::max({v[0], v[1], v[2]}) == unknown; }
  int any() const { return v[0] | v[1] | v[2]; }
  /// Some buried, some not.
  bool mixed() const { return ((v[0] ^ v[1]) | (v[0] ^ v[2])) & buried; }
  /// By so much that linear interpolation between them does not hold.
  bool disagree() const {
    const int spread = std::max({v[0], v[1], v[2]}) - std::min({v[0], v[1], v[2]});
    return mixed() || static_cast<float>(spread) > most * (1 << flag_bits) * disagreement;
  }
  float blend(const float weights[3]) const {
    float sum = 0;
    for (int k = 0; k < 3; ++k) sum += weights[k] * static_cast<float>(v[k] >> flag_bits);
    return std::clamp(sum / most, 0.0f, 1.0f);
  }
  SelfOcclusion::Answer answer(const float weights[3]) const {
    if (mixed()) return {SelfOcclusion::State::mixed, 0};
    return {SelfOcclusion::State::known, blend(weights)};
  }
};

/// A point inside the triangle, on this side of it.
SurfacePoint middle_of(std::uint64_t side) {
  return {static_cast<std::uint32_t>(side / 2), 0.25f, 0.25f, side % 2 == 0};
}

constexpr SelfOcclusion::Answer missing_answer{SelfOcclusion::State::missing, 0};
constexpr SelfOcclusion::Answer by_rays{SelfOcclusion::State::mixed, 0};

/// Of so many divided cells.
std::size_t cell_bytes(std::size_t cells) {
  return CellNumbers::bytes_for(cells) + cells * SurfaceLayout::cell_samples * sizeof(Value);
}

}  // namespace

SelfOcclusion::SelfOcclusion(const ObjectShape& shape, const trees::TriangleBvh& casters, double reach,
                             std::size_t cells, MemoryBudget* budget)
    : shape_(shape), reach_(reach), rays_(shape, casters, reach), most_cells_(cells) {
  if (budget != nullptr) share_ = MemoryShare(*budget);
}

void SelfOcclusion::prepare(const StopFlag* stop) {
  if (laid() || prepared_ || needed_bytes_ != 0) return;
  prepared_.emplace(shape_, reach_, stop);
  if (stop_requested(stop)) prepared_.reset();
}

bool SelfOcclusion::lay(const StopFlag* stop) {
  if (laid()) return true;
  prepare(stop);
  if (stop_requested(stop)) return false;
  if (needed_bytes_ == 0) {
    const auto count = static_cast<std::uint32_t>(shape_.triangles.size());
    bool any_small = false;
    for (std::uint32_t t = 0; t < count && !any_small; ++t) any_small = prepared_->is_small(t);
    sides_needed_ = any_small ? std::size_t{2} * count : 0;
    needed_bytes_ = prepared_->bytes() + prepared_->samples() * sizeof(Value) + sides_needed_ * sizeof(Side);
  }
  refused_ = !share_.take(needed_bytes_);
  if (!refused_) {
    if (!prepared_) prepared_.emplace(shape_, reach_, stop);
    layout_.emplace(std::move(*prepared_));
    if (!make_room(stop)) drop();
  }
  prepared_.reset();
  return laid();
}

/// For all samples, none known. False: a stop was requested.
bool SelfOcclusion::make_room(const StopFlag* stop) {
  constexpr std::size_t step = std::size_t{1} << 20;
  values_.clear();
  values_.reserve(layout_->samples());
  while (values_.size() < layout_->samples()) {
    if (stop_requested(stop)) return false;
    values_.resize(std::min(values_.size() + step, layout_->samples()), unknown);
  }
  sides_.resize(sides_needed_);
  return !stop_requested(stop);
}

void SelfOcclusion::drop() {
  layout_.reset();
  values_ = std::vector<Value>();  // = {} would keep the memory
  sides_ = std::vector<Side>();
  cells_ = CellNumbers();
  cell_values_ = std::vector<Value>();
  known_ = 0;
  share_.give_back(share_.bytes());
}

SelfOcclusion::Answer SelfOcclusion::find(const SurfacePoint& point,
                                          std::vector<std::uint64_t>& missing) const {
  if (!laid()) return by_rays;
  return layout_->is_small(point.triangle) ? find_small(point, missing) : find_large(point, missing);
}

SelfOcclusion::Answer SelfOcclusion::find_small(const SurfacePoint& point,
                                                std::vector<std::uint64_t>& missing) const {
  const std::size_t index = std::size_t{2} * point.triangle + (point.front ? 0 : 1);
  const Side& side = sides_[index];
  if (side.kind == Side::corners) {
    const float v = std::clamp(point.v, 0.0f, 1.0f), w = std::clamp(point.w, 0.0f, 1.0f - v);
    const float weights[3] = {1 - v - w, v, w};
    return Values{{side.values[0], side.values[1], side.values[2]}}.answer(weights);
  }
  if (side.kind == Side::divided)
    return find_in_cell(point, side.values[0] | std::uint32_t{side.values[1]} << 16, missing);
  if (full_) {
    const SampleTriple corners = layout_->corners(point);
    const Values values{{values_[corners.at[0]], values_[corners.at[1]], values_[corners.at[2]]}};
    if (!values.lacking() && values.disagree()) return by_rays;
  }
  missing.push_back(is_side | index);
  return missing_answer;
}

SelfOcclusion::Answer SelfOcclusion::find_large(const SurfacePoint& point,
                                                std::vector<std::uint64_t>& missing) const {
  for (int level = 0;; ++level) {
    const SampleTriple around = layout_->around(point, level);
    const Values values{{values_[around.at[0]], values_[around.at[1]], values_[around.at[2]]}};
    if (values.lacking()) {
      for (int k = 0; k < 3; ++k)
        if (values.v[k] == unknown) missing.push_back(around.at[k]);
      return missing_answer;
    }
    const bool last = level + 1 == layout_->levels(point.triangle);
    const int too_near = last ? 0 : buried | (level == 0 ? near_wide : near_half);
    if ((values.any() & too_near) == 0 && !values.disagree()) return values.answer(around.weights);
    if (!last) continue;
    const std::uint64_t key = layout_->cell_key(point);
    const std::uint32_t cell = cells_.find(key);
    if (cell != CellNumbers::none) return find_in_cell(point, cell, missing);
    if (full_) return by_rays;
    missing.push_back(is_cell | key);
    return missing_answer;
  }
}

SelfOcclusion::Answer SelfOcclusion::find_in_cell(const SurfacePoint& point, std::uint32_t cell,
                                                  std::vector<std::uint64_t>& missing) const {
  const SampleTriple around = layout_->in_cell(point);
  const std::size_t first = std::size_t{cell} * SurfaceLayout::cell_samples;
  const Value* in_cell = &cell_values_[first];
  const Values values{{in_cell[around.at[0]], in_cell[around.at[1]], in_cell[around.at[2]]}};
  if (!values.lacking()) return values.answer(around.weights);
  for (int k = 0; k < 3; ++k)
    if (values.v[k] == unknown) missing.push_back(values_.size() + first + around.at[k]);
  return missing_answer;
}

SurfacePoint SelfOcclusion::place(std::uint32_t sample) const {
  if (sample < values_.size()) return layout_->place(sample);
  const std::size_t number = sample - values_.size();
  return layout_->place_in_cell(cells_.keys()[number / SurfaceLayout::cell_samples],
                                static_cast<std::uint32_t>(number % SurfaceLayout::cell_samples));
}

/// False where there is no room.
bool SelfOcclusion::add_cell(std::uint64_t key, Cell cell) {
  if (cells_.find(key) != CellNumbers::none) return true;
  if (cells_.keys().size() == cells_.capacity() && !grow_cells(cell)) return false;
  cells_.add(key);
  cell_values_.resize(cell_values_.size() + SurfaceLayout::cell_samples, unknown);
  return true;
}

/// The smaller tables are still there while they are copied to the larger ones.
bool SelfOcclusion::grow_cells(Cell cell) {
  const std::size_t before = cells_.capacity(),
                    after = std::min(most_cells_, std::max(fewest_cells, 2 * before));
  const auto granted = [&](std::size_t bytes) {
    return cell == Cell::needed ? share_.take(bytes) : share_.offer(bytes);
  };
  full_ = full_ || after == before || !granted(cell_bytes(after));
  if (full_) return false;
  cells_.reserve(after);
  cell_values_.reserve(after * SurfaceLayout::cell_samples);
  share_.give_back(cell_bytes(before));
  return true;
}

/// Keeps what the corners of a small triangle say beside it, or divides it; what can be neither stays as it
/// is.
void SelfOcclusion::settle(std::uint64_t index, bool may_divide) {
  Side& side = sides_[index];
  const SurfacePoint middle = middle_of(index);
  const SampleTriple corners = layout_->corners(middle);
  const Values values{{values_[corners.at[0]], values_[corners.at[1]], values_[corners.at[2]]}};
  if (values.lacking()) return;
  if (!values.disagree()) {
    side = {{values.v[0], values.v[1], values.v[2]}, Side::corners};
    return;
  }
  const std::uint64_t key = layout_->cell_key(middle);
  if (may_divide && !add_cell(key, Cell::needed)) return;
  const std::uint32_t number = cells_.find(key);
  if (number == CellNumbers::none) return;
  side = {{static_cast<Value>(number & 0xffff), static_cast<Value>(number >> 16), 0}, Side::divided};
}

SelfOcclusion::Value& SelfOcclusion::value(std::uint32_t sample) {
  return sample < values_.size() ? values_[sample] : cell_values_[sample - values_.size()];
}

bool SelfOcclusion::fill(std::span<const std::uint64_t> missing, const RayKernels& kernels,
                         const std::function<void(double)>& progress, const StopFlag* stop) {
  const auto sides = std::lower_bound(missing.begin(), missing.end(), is_side);
  const auto cells = std::lower_bound(sides, missing.end(), is_cell);
  std::vector<std::uint32_t> samples;
  const auto want = [&](std::uint32_t sample) {
    const std::uint32_t shared = sample < values_.size() ? layout_->shared(sample) : sample;
    if (value(shared) == unknown) samples.push_back(shared);
  };
  for (auto sample = missing.begin(); sample != sides; ++sample) want(static_cast<std::uint32_t>(*sample));
  for (auto side = sides; side != cells; ++side)
    for (const std::uint32_t corner : layout_->corners(middle_of(*side & ~is_side)).at) want(corner);
  base::sort_unique(samples);
  if (!cast(samples, kernels, progress, stop)) return false;
  for (auto sample = missing.begin(); sample != sides; ++sample) {
    if (*sample >= values_.size() || values_[*sample] != unknown) continue;
    values_[*sample] = values_[layout_->shared(static_cast<std::uint32_t>(*sample))];
    ++known_;
  }
  for (auto side = sides; side != cells; ++side) settle(*side & ~is_side, true);
  for (auto key = cells; key != missing.end(); ++key) add_cell(*key & ~is_cell, Cell::needed);
  return true;
}

bool SelfOcclusion::cast(const std::vector<std::uint32_t>& samples, const RayKernels& kernels,
                         const std::function<void(double)>& progress, const StopFlag* stop) {
  constexpr std::size_t step = 8192, grain = 32;
  const double wide = near_steps * layout_->spacing();
  const auto stored = [wide](const SurfaceRays::Seen& seen) {
    return static_cast<Value>(std::lround(seen.occlusion * most) << flag_bits | (seen.buried ? buried : 0) |
                              (seen.nearest < wide ? near_wide : 0) |
                              (seen.nearest < wide / 2 ? near_half : 0));
  };
  for (std::size_t first = 0; first < samples.size(); first += step) {
    if (stop_requested(stop)) return false;
    if (progress) progress(static_cast<double>(first) / static_cast<double>(samples.size()));
    const auto part = std::span(samples).subspan(first, std::min(step, samples.size() - first));
    parallel::parallel_ranges(part.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end && !stop_requested(stop); ++i)
        value(part[i]) = stored(rays_.look(place(part[i]), kernels));
    });
    const auto cast = static_cast<std::uint64_t>(
        std::count_if(part.begin(), part.end(), [&](std::uint32_t s) { return value(s) != unknown; }));
    filled_ += cast;  // a stop leaves some out
    known_ += cast;
  }
  return !stop_requested(stop);
}

void SurfaceSamples::set_values(std::span<const std::uint16_t> all) {
  runs.clear();
  values.clear();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] == unknown) continue;
    if (i == 0 || all[i - 1] == unknown) runs.push_back({static_cast<std::uint32_t>(i), 0});
    ++runs.back().count;
    values.push_back(all[i]);
  }
}

std::size_t SelfOcclusion::held_bytes() const {
  return (layout_ ? layout_->bytes() : 0) + values_.capacity() * sizeof(Value) +
         sides_.capacity() * sizeof(Side) + cells_.bytes() + cell_values_.capacity() * sizeof(Value);
}

SurfaceSamples SelfOcclusion::samples() const {
  SurfaceSamples samples{{}, {}, cells_.keys(), cell_values_};
  samples.set_values(values_);
  return samples;
}

void SelfOcclusion::learn(const SurfaceSamples& others) {
  const auto take = [&](Value& to, Value from) {
    if (to != unknown || from == unknown) return;
    to = from, ++known_;
  };
  const Value* from = others.values.data();
  for (const SurfaceSamples::Run& run : others.runs)
    for (std::uint32_t i = 0; i < run.count; ++i) take(values_[run.first + i], *from++);
  // This frame may need none of the cells that others divided: half of the room is left for those that it
  // needs.
  const std::size_t most = std::min(others.cells.size(), most_cells_ / 2);
  for (std::size_t c = 0; c < most && add_cell(others.cells[c], Cell::learned); ++c) {
    const std::size_t to = std::size_t{cells_.find(others.cells[c])} * SurfaceLayout::cell_samples;
    for (std::size_t k = 0; k < SurfaceLayout::cell_samples; ++k)
      take(cell_values_[to + k], others.cell_values[c * SurfaceLayout::cell_samples + k]);
  }
  full_ = false;
  for (std::uint32_t t = 0; t < sides_.size() / 2; ++t) {
    for (const std::uint32_t side : {2 * t, 2 * t + 1})
      if (layout_->is_small(t) && sides_[side].kind == Side::unknown) settle(side, false);
  }
}

}  // namespace tenebra::ao
