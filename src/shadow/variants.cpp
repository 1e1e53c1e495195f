#include <array>
#include <utility>

#include <tenebra/hard_shadows.h>

namespace tenebra {

namespace {

template <class T>
using Names = std::pair<T, std::string_view>;

constexpr std::array<Names<Variant>, 8> variants = {{
    {Variant::tiles, "Tiles"},
    {Variant::precise, "Precise"},
    {Variant::precise_sorted, "PreciseSorted"},
    {Variant::spheres, "Spheres"},
    {Variant::spheres_sorted, "SpheresSorted"},
    {Variant::precise_sea, "PreciseSEA"},
    {Variant::precise_eatp, "PreciseEATP"},
    {Variant::precise_seatp, "PreciseSEATP"},
}};

template <class T, std::size_t N>
std::string_view name_in(const std::array<Names<T>, N>& names, T value) {
  for (const auto& [candidate, name] : names) {
    if (candidate == value) return name;
  }
  return {};
}

template <class T, std::size_t N>
std::optional<T> value_in(const std::array<Names<T>, N>& names, std::string_view name) {
  for (const auto& [value, candidate] : names) {
    if (candidate == name) return value;
  }
  return std::nullopt;
}

}  // namespace

std::string_view variant_name(Variant variant) {
  return name_in(variants, variant);
}
std::optional<Variant> variant_from_name(std::string_view name) {
  return value_in(variants, name);
}

}  // namespace tenebra
