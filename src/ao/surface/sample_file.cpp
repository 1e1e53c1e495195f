#include "ao/surface/sample_file.h"

#include <algorithm>
#include <array>
#include <string>

#include "base/fail.h"

namespace tenebra::ao {
namespace {

namespace fs = std::filesystem;

constexpr CacheKind kind{{'t', 'e', 'n', 'e', 's', 'm', 'p', '\n'}, 1, "samples"};
constexpr std::size_t each = SurfaceLayout::cell_samples;

/// Stands in front of the lists of SurfaceSamples, which follow in their order.
struct Sizes {
  std::uint64_t runs = 0, values = 0, cells = 0;
  std::size_t bytes() const {
    return sizeof(Sizes) + runs * sizeof(SurfaceSamples::Run) + values * sizeof(std::uint16_t) +
           cells * (sizeof(std::uint64_t) + each * sizeof(std::uint16_t));
  }
};

auto lists(Sizes& sizes, SurfaceSamples& samples) {
  return std::array{
      std::as_writable_bytes(std::span(&sizes, 1)), std::as_writable_bytes(std::span(samples.runs)),
      std::as_writable_bytes(std::span(samples.values)), std::as_writable_bytes(std::span(samples.cells)),
      std::as_writable_bytes(std::span(samples.cell_values))};
}

/// Whether the runs lie apart, in a layout of `count` samples, and hold as many as there are values.
bool hold(const std::vector<SurfaceSamples::Run>& runs, std::size_t values, std::size_t count) {
  std::uint64_t end = 0, sum = 0;
  for (const auto& [first, length] : runs) {
    if (first < end) return false;
    end = std::uint64_t{first} + length;
    sum += length;
  }
  return end <= count && sum == values;
}

/// Whether they may be keys, each once.
bool are_keys(std::vector<std::uint64_t> cells) {
  std::sort(cells.begin(), cells.end());
  return (cells.empty() || cells.back() >> 63 == 0) &&
         std::adjacent_find(cells.begin(), cells.end()) == cells.end();
}

std::vector<std::uint16_t> spread(const SurfaceSamples& samples, std::size_t count) {
  std::vector<std::uint16_t> values(count, SurfaceSamples::unknown);
  auto from = samples.values.begin();
  for (const auto& [first, length] : samples.runs) {
    std::copy(from, from + length, values.begin() + first);
    from += length;
  }
  return values;
}

void take(std::uint16_t& to, std::uint16_t from) {
  if (to == SurfaceSamples::unknown) to = from;
}

void join_cells(SurfaceSamples& samples, const SurfaceSamples& others) {
  CellNumbers numbers;
  for (const std::uint64_t cell : samples.cells) numbers.add(cell);
  for (std::size_t c = 0; c < others.cells.size(); ++c) {
    std::uint32_t number = numbers.find(others.cells[c]);
    if (number == CellNumbers::none) {
      if (samples.cells.size() == SelfOcclusion::most_cells) continue;
      number = static_cast<std::uint32_t>(samples.cells.size());
      numbers.add(others.cells[c]);
      samples.cells.push_back(others.cells[c]);
      samples.cell_values.resize(samples.cell_values.size() + each, SurfaceSamples::unknown);
    }
    for (std::size_t k = 0; k < each; ++k)
      take(samples.cell_values[number * each + k], others.cell_values[c * each + k]);
  }
}

/// Adds the samples that only `others` has.
void join(SurfaceSamples& samples, const SurfaceSamples& others, std::size_t count) {
  std::vector<std::uint16_t> values = spread(samples, count);
  const std::vector<std::uint16_t> more = spread(others, count);
  for (std::size_t i = 0; i < count; ++i) take(values[i], more[i]);
  samples.set_values(values);
  join_cells(samples, others);
}

}  // namespace

CacheKey sample_key(const ObjectShape& shape, double reach) {
  const std::uint32_t method[] = {kind.version, SurfaceRays::rays};
  return cache_key({std::as_bytes(std::span(method)), std::as_bytes(std::span(&reach, 1)),
                    std::as_bytes(std::span(shape.positions)), std::as_bytes(std::span(shape.normals)),
                    std::as_bytes(std::span(shape.triangles)), std::as_bytes(std::span(shape.casts))});
}

fs::path sample_path(const fs::path& folder, const CacheKey& key) {
  return cache_path(folder, kind, key);
}

Expected<void> save_samples(const fs::path& folder, const CacheKey& key, SurfaceSamples samples,
                            std::size_t count) {
  if (const auto others = load_samples(folder, key, count)) join(samples, *others, count);
  Sizes sizes{samples.runs.size(), samples.values.size(), samples.cells.size()};
  std::string bytes;
  bytes.reserve(sizes.bytes());
  for (const auto& list : lists(sizes, samples))
    bytes.append(reinterpret_cast<const char*>(list.data()), list.size());
  return save_cache_file(folder, kind, key, bytes);
}

Expected<SurfaceSamples> load_samples(const fs::path& folder, const CacheKey& key, std::size_t count) {
  const Sizes most{count, count, SelfOcclusion::most_cells};
  const auto file = CacheReader::open(folder, kind, key, sizeof(Sizes), most.bytes());
  if (!file) return tl::unexpected(file.error());
  const auto foreign = [&] {
    return base::fail("{}: found lists of other sizes, expected those of {} samples",
                      sample_path(folder, key).string(), count);
  };
  Sizes sizes;
  if (auto done = file->read(std::array{std::as_writable_bytes(std::span(&sizes, 1))}); !done)
    return tl::unexpected(done.error());
  if (sizes.runs > most.runs || sizes.values > most.values || sizes.cells > most.cells ||
      sizes.bytes() != file->bytes())
    return foreign();
  SurfaceSamples samples;
  samples.runs.resize(sizes.runs);
  samples.values.resize(sizes.values);
  samples.cells.resize(sizes.cells);
  samples.cell_values.resize(sizes.cells * each);
  if (auto done = file->read(lists(sizes, samples)); !done) return tl::unexpected(done.error());
  if (!hold(samples.runs, samples.values.size(), count) || !are_keys(samples.cells)) return foreign();
  return samples;
}

}  // namespace tenebra::ao
