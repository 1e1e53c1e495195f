// Ambient occlusion.
#include "base/fail.h"
#include "settings/method_rows.h"

namespace tenebra::settings {
namespace {

constexpr std::array bit_choices{Choice<int>{"1", 1}, Choice<int>{"8", 8}, Choice<int>{"32", 32}};
constexpr std::string_view any_count = "a whole number from 1 to 1000000";
constexpr Range any_range{1, 1e6};

Expected<std::filesystem::path> parse_cache(const std::string& text) {
  if (text.empty()) return base::fail("found an empty name, expected a folder or none");
  return text == "none" ? std::filesystem::path() : std::filesystem::path(text);
}

Setting<MethodSettings> ao_distance() {
  const auto read = [](MethodSettings& method, const std::string& text) -> Expected<void> {
    const auto metres = parse_positive(text);
    if (!metres) return tl::unexpected(metres.error());
    method.render.ao.distance_m = *metres;
    return {};
  };
  const auto texts = [](const MethodSettings& method) -> std::vector<std::string> {
    if (method.render.ao.distance_m <= 0) return {};
    return {fmt::format("{}", method.render.ao.distance_m)};
  };
  return MethodRow::own(
      {.name = "ao-distance",
       .value = "D",
       .help = "Reach D in metres: occlusion is the mean of max(0, 1 - d / D) over rays distributed by the "
               "cosine to the normal, each of which first meets a triangle at d",
       .standard = "a twentieth of the scene's diagonal",
       .group = Group::ao,
       .used = Used::with_ao},
      read, texts);
}

void add_ao_method(MethodRows& rows) {
  rows.push_back(MethodRow::words(
      {.name = "ao",
       .help = "Ambient occlusion. adaptive: by rays where the picture needs them, as many as --ao-error "
               "takes, filtered; field: by displacement fields of the rigid objects; rays: by casting rays "
               "everywhere, for comparison"},
      [](auto& method) -> auto& { return method.render.ao.mode; }, ao_choices));
  rows.push_back(MethodRow::number(
      {.name = "ao-error",
       .value = "E",
       .help = "adaptive: the error aimed at, RMS over the picture, in 1/255; the log has the estimate",
       .group = Group::ao,
       .used = Used::with_adaptive,
       .range = {0.1, 255},
       .expected = "0.1 to 255",
       .by_quality = {"5", "2.5", "1"}},
      [](auto& method) -> auto& { return method.render.ao.error_255; }));
  rows.push_back(MethodRow::words(
      {.name = "ao-at",
       .help = "Where occlusion is computed; in the paper: at vertices",
       .audience = Audience::paper,
       .used = Used::with_other_ao},
      [](auto& method) -> auto& { return method.render.ao.place; }, place_choices));
  rows.push_back(MethodRow::words(
      {.name = "ao-layout",
       .help = "What a field stores: chords from entry to exit, or as in the paper positions x directions",
       .audience = Audience::paper,
       .used = Used::with_fields},
      [](auto& method) -> auto& { return method.render.ao.layout; }, layout_choices));
}

void add_ao_rays(MethodRows& rows) {
  rows.push_back(MethodRow::number(
      {.name = "ao-rays",
       .value = "N",
       .help = "field and rays: rays per point",
       .group = Group::ao,
       .used = Used::with_other_ao,
       .range = any_range,
       .expected = any_count,
       .by_quality = {"16", "64", "256"}},
      [](auto& method) -> auto& { return method.render.ao.rays; }));
  rows.push_back(MethodRow::number(
      {.name = "ao-downscale",
       .value = "N",
       .help = "Computes one of N x N pixels and blurs the others from similar ones",
       .standard = "1: every pixel",
       .audience = Audience::paper,
       .used = Used::with_other_ao,
       .range = {1, 8},
       .expected = "1 (every pixel) to 8",
       .by_quality = {"2", "1", "1"}},
      [](auto& method) -> auto& { return method.render.ao.downscale; }));
  rows.push_back(ao_distance());
}

void add_ao_fields(MethodRows& rows) {
  rows.push_back(MethodRow::number(
      {.name = "ao-positions",
       .value = "P",
       .help = "Samples on an object's bounding sphere",
       .audience = Audience::paper,
       .used = Used::with_fields,
       .range = any_range,
       .expected = any_count},
      [](auto& method) -> auto& { return method.render.ao.positions; }));
  rows.push_back(MethodRow::value(
      {.name = "ao-directions",
       .value = "D",
       .help = "Directions per sample, 1024 or 32x32",
       .audience = Audience::paper,
       .used = Used::with_fields},
      [](auto& method) -> auto& { return method.render.ao.directions; }, parse_square_count,
      [](int directions) { return fmt::format("{}", directions); }));
  rows.push_back(MethodRow::words(
      {.name = "ao-bits",
       .help = "Bits per stored distance",
       .audience = Audience::paper,
       .used = Used::with_fields},
      [](auto& method) -> auto& { return method.render.ao.bits; }, bit_choices));
  rows.push_back(MethodRow::words(
      {.name = "ao-deforming",
       .help = "Objects that deform have no field: cast rays at them, or leave them out",
       .audience = Audience::paper,
       .used = Used::with_ao},
      [](auto& method) -> auto& { return method.render.ao.deforming; }, deforming_choices));
}

void add_ao_memory(MethodRows& rows) {
  rows.push_back(MethodRow::value(
      {.name = "ao-cache",
       .value = "FOLDER|none",
       .help = "Folder that keeps trees of triangles, fields and surface samples for the next run; any "
               "number of processes may share it",
       .standard = "$XDG_CACHE_HOME/tenebra or ~/.cache/tenebra",
       .group = Group::ao,
       .affects = Affects::speed,
       .used = Used::with_ao},
      [](auto& method) -> auto& { return method.render.ao.cache; }, parse_cache,
      [](const std::filesystem::path& cache) {
        return cache.empty() ? std::string("none") : cache.string();
      }));
  rows.push_back(MethodRow::number(
      {.name = "ao-memory",
       .value = "MB",
       .help = "Memory for fields and surface samples, in MB; the least recently used are dropped first. For "
               "bodies without room rays are cast, which takes longer",
       .group = Group::run,
       .used = Used::with_other_ao,
       .range = any_range,
       .expected = any_count,
       .as = "--memory ao:"},
      [](auto& method) -> auto& { return method.render.ao.memory_mb; }));
}

}  // namespace

void add_ao_rows(MethodRows& rows) {
  add_ao_method(rows);
  add_ao_rays(rows);
  add_ao_fields(rows);
  add_ao_memory(rows);
}

}  // namespace tenebra::settings
