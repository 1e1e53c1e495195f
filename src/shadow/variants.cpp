#include <tenebra/hard_shadows.h>

#include "base/names.h"

namespace tenebra {

namespace {

constexpr base::Names<Variant, 8> variants = {{
    {Variant::tiles, "Tiles"},
    {Variant::precise, "Precise"},
    {Variant::precise_sorted, "PreciseSorted"},
    {Variant::spheres, "Spheres"},
    {Variant::spheres_sorted, "SpheresSorted"},
    {Variant::precise_sea, "PreciseSEA"},
    {Variant::precise_eatp, "PreciseEATP"},
    {Variant::precise_seatp, "PreciseSEATP"},
}};

}  // namespace

std::string_view variant_name(Variant variant) {
  return base::name_in(variants, variant);
}
std::optional<Variant> variant_from_name(std::string_view name) {
  return base::value_in(variants, name);
}

}  // namespace tenebra
