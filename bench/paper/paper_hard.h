// The seven variants of Olsson and Assarsson 2011 on frames, with front-face culling as the paper had it, and
// what follows for its claims.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bench/hard/hard_views.h"
#include "bench/paper/paper_claims.h"

namespace tenebra::bench {

/// Of the paper's Table 1, in the order of its text.
inline constexpr std::array paper_variants{
    Variant::spheres,     Variant::spheres_sorted, Variant::precise,      Variant::precise_sorted,
    Variant::precise_sea, Variant::precise_seatp,  Variant::precise_eatp,
};

/// What one variant took for a mask.
struct VariantCost {
  double ms = 0, sort_ms = 0, traverse_ms = 0;
  double nodes = 0;  ///< tests after the root's: of nodes below it, each with one triangle
};

struct VariantFrame {
  int frame = 0;
  double rays = 0;
  double triangles = 0;                ///< that cast, each tested at the root
  std::array<VariantCost, 7> costs{};  ///< by paper_variants
  bool same_masks = true;              ///< of all seven
  double nodes_unculled = 0;           ///< PreciseSorted, triangles of both sides
  double culled_differing = 0;         ///< pixels of the mask that culling changes
  double lit_differing = 0;            ///< of these, lit with culling and dark without

  const VariantCost& of(Variant variant) const;
};

/// What culling changes where all meshes are closed: a knot over a slab, three lights. Of pixels whose
/// triangle faces the light; the others are dark by their shading.
struct ClosedMeshes {
  double pixels = 0, shadowed = 0;  ///< in shadow: without culling
  double differing = 0;             ///< masks with and without culling
};
ClosedMeshes measure_closed_meshes(PictureSize size);

/// What the figures and Table 2 are made of.
struct HardFindings {
  std::string figures_scene, table_scene;
  std::vector<VariantFrame> figures, table;
  ClosedMeshes closed;
};

/// The first light's masks by all variants; times are medians of `rounds`. `tracers` keep their buffers.
VariantFrame measure_variants(int number, const HardView& view, int rounds,
                              std::array<ShadowTracer, 7>& tracers);

/// Claims that counts decide, then those that times decide, then the rest.
std::vector<Claim> hard_claims(const HardFindings& found);

}  // namespace tenebra::bench
