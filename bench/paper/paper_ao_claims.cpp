#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/paper/paper_ao.h"

namespace tenebra::bench {
namespace {

constexpr double comparable = 2;  // errors of one order: at most twice the other

double map_rms(const AoFindings& found, DirectionMap map) {
  const auto at =
      std::find_if(found.maps.begin(), found.maps.end(), [&](const MapError& m) { return m.map == map; });
  return at == found.maps.end() ? 0 : at->rms;
}
const FieldCost& of_bits(const AoFindings& found, int bits) {
  return *std::find_if(found.bits.begin(), found.bits.end(),
                       [&](const FieldCost& f) { return f.bits == bits; });
}
const FieldCost* of_size(const AoFindings& found, int positions, int side) {
  const auto at = std::find_if(found.figure6.begin(), found.figure6.end(), [&](const FieldCost& f) {
    return f.positions == positions && f.side == side;
  });
  return at == found.figure6.end() ? nullptr : &*at;
}

void add_maps(const AoFindings& found, std::vector<Claim>& claims) {
  const double polar = map_rms(found, DirectionMap::polar),
               rejection = map_rms(found, DirectionMap::rejection),
               concentric = map_rms(found, DirectionMap::concentric);
  const std::string all =
      fmt::format("RMS {:.2f} against {:.2f}; by rejection {:.2f}.", concentric, polar, rejection);
  claims.push_back({"gaitatzes.concentric_is_better", "Figure 5",
                    "The concentric map gives much better results than uniform sampling.",
                    verdict_of(concentric < 0.8 * polar), all});
  claims.push_back({"gaitatzes.concentric_is_best", "section 3",
                    "Of the three maps the concentric is the best.",
                    verdict_of(concentric <= std::min(polar, rejection)), all});
  claims.push_back({"gaitatzes.rejection_wastes", "section 3", "Rejection leaves 21.5 % of a map unused.",
                    verdict_of(std::abs(found.unused - 0.215) < 0.005),
                    fmt::format("{:.1f} % of 128x128 cells.", 100 * found.unused)});
}

void add_sizes(const AoFindings& found, std::vector<Claim>& claims) {
  const auto& all = found.figure6;
  const FieldCost &few = all.front(), &many = all.back();
  const FieldCost* more_positions = of_size(found, many.positions, few.side);
  const FieldCost* more_directions = of_size(found, few.positions, many.side);
  if (more_positions == nullptr || more_directions == nullptr || few.positions == many.positions) return;
  const double positions = few.rms / more_positions->rms, directions = few.rms / more_directions->rms;
  claims.push_back({"gaitatzes.positions_lower_the_error", "Figure 6",
                    "The error drops quickly with positions.", verdict_of(positions > 1.25),
                    fmt::format("{:.2f} to {:.2f} from {} to {} positions of {}x{}.", few.rms,
                                more_positions->rms, few.positions, many.positions, few.side, few.side)});
  claims.push_back(
      {"gaitatzes.directions_do_not", "Figure 6", "With directions it does not decrease significantly.",
       verdict_of(directions < positions),
       fmt::format("{:.2f} to {:.2f} from {}x{} to {}x{} at {} positions; at {} {:.2f} to {:.2f}.", few.rms,
                   more_directions->rms, few.side, few.side, many.side, many.side, few.positions,
                   many.positions, more_positions->rms, many.rms)});
  const FieldCost* chosen = of_size(found, 4225, 32);
  if (chosen != nullptr)
    claims.push_back({"gaitatzes.a_good_compromise", "Figure 6", "4226 maps of 32x32 are a good compromise.",
                      verdict_of(chosen->rms < 1.5 * many.rms),
                      fmt::format("RMS {:.2f} in {:.1f} MB; {} have {:.2f} in {:.1f} MB.", chosen->rms,
                                  chosen->bytes / 1e6, many.name, many.rms, many.bytes / 1e6)});
  const bool exact = std::all_of(all.begin(), all.end(), [](const FieldCost& f) {
    return f.bytes == static_cast<double>(f.positions) * f.side * f.side;
  });
  claims.push_back({"gaitatzes.a_byte_a_ray", "section 4",
                    "Tables take one byte per direction, whatever the object.", verdict_of(exact),
                    fmt::format("All {} tables.", all.size())});
}

void add_bits(const AoFindings& found, std::vector<Claim>& claims) {
  const FieldCost &four = of_bits(found, 32), &byte = of_bits(found, 8), &bit = of_bits(found, 1);
  claims.push_back({"gaitatzes.a_byte_is_enough", "Figure 4", "One byte per ray looks the same as four.",
                    verdict_of(std::abs(byte.rms - four.rms) < 0.25),
                    fmt::format("RMS {:.2f} against {:.2f}.", byte.rms, four.rms)});
  claims.push_back({"gaitatzes.a_bit_saves", "section 4", "One bit per direction saves 87.5 %.",
                    verdict_of(std::abs(bit.bytes / byte.bytes - 0.125) < 1e-3),
                    fmt::format("{:.2f} MB against {:.2f}.", bit.bytes / 1e6, byte.bytes / 1e6)});
  claims.push_back({"gaitatzes.a_bit_is_comparable", "Figure 7",
                    "With one bit results are comparable with those of 8 bits.",
                    verdict_of(bit.rms <= comparable * byte.rms),
                    fmt::format("RMS {:.2f} against {:.2f}: {:.2f} times (true up to {:g}). The paper's 4.40 "
                                "is of other pictures.",
                                bit.rms, byte.rms, bit.rms / byte.rms, comparable)});
  const double brighter = bit.brighter - byte.brighter;
  claims.push_back({"gaitatzes.a_bit_is_brighter", "Figure 7", "But they are slightly brighter.",
                    verdict_of(brighter > 0 && bit.brighter < 2),
                    fmt::format("Brighter by {:.2f}/255 in the mean than many rays, with 8 bits by {:.2f}; "
                                "slightly: less than 2.",
                                bit.brighter, byte.brighter)});
  const MixedBits& m = found.mixed;
  claims.push_back(
      {"gaitatzes.a_bit_for_far_objects", "section 4",
       "One bit per direction is enough for objects farther from the viewer: comparable results.",
       verdict_of(m.far_rms <= comparable * m.far_rms_8),
       fmt::format("Four near objects of 8 bits and four far ones of 1: RMS {:.2f} at the floor under far "
                   "ones, {:.2f} were these of 8 bits: {:.2f} times; {:.2f} under near ones. {:.2f} MB for "
                   "both tables, of which the far ones read {:.2f}.",
                   m.far_rms, m.far_rms_8, m.far_rms / m.far_rms_8, m.near_rms, (m.all_8 + m.mixed) / 1e6,
                   m.mixed / 1e6)});
}

void add_growth_of(const AoFindings& found, std::vector<Claim>& claims) {
  if (found.growth.size() < 2) return;
  const GrowthCost &small = found.growth.front(), &large = found.growth.back();
  claims.push_back(
      {"gaitatzes.size_does_not_matter", "Figure 8",
       "The cost of looking up hardly grows with the object's triangles.",
       verdict_of(large.bytes == small.bytes && std::abs(large.rays / small.rays - 1) < 0.05),
       fmt::format("{} to {} triangles: the same table and rays; {:.2f} to {:.2f} ms (Embree's rays: "
                   "{:.2f} to {:.2f}). The verdict is of tables and rays.",
                   counted(small.triangles), counted(large.triangles), small.lookup_ms, large.lookup_ms,
                   small.ray_ms, large.ray_ms)});
  claims.push_back({"gaitatzes.fields_cost_what_objects_do", "Figures 6 and 8",
                    "Making a field depends on its size and the object.",
                    verdict_of(large.build_ms > small.build_ms),
                    fmt::format("{:.2f} s at {} triangles, {:.2f} at {}.", small.build_ms / 1e3,
                                counted(small.triangles), large.build_ms / 1e3, counted(large.triangles))});
  claims.push_back(
      {"gaitatzes.far_faster_than_rays", "Figure 8",
       "Looking up is hundreds of times faster than casting rays (196 s against 0.24).",
       verdict_of(large.ray_ms / large.lookup_ms > 100),
       fmt::format("{:.1f} to {:.1f} times faster than Embree's packets, a better ray caster than theirs.",
                   small.ray_ms / small.lookup_ms, large.ray_ms / large.lookup_ms)});
}

}  // namespace

std::vector<Claim> ao_claims(const AoFindings& found) {
  std::vector<Claim> claims;
  if (found.maps.empty() || found.figure6.empty() || found.bits.size() < 3) return claims;
  add_maps(found, claims);
  add_sizes(found, claims);
  add_bits(found, claims);
  add_growth_of(found, claims);
  claims.push_back({"gaitatzes.interactive", "Figure 8", "Near real-time on a Pentium 4 and dual Xeons.",
                    Verdict::not_here, "Other processors; `tenebra-bench ao` has present-day frames."});
  return claims;
}

}  // namespace tenebra::bench
