// tenebra-bench bake: the light of a lightmap, beside stratified rays through Embree at the same error.
#include <array>

#include "bench/bake/bake_session.h"

namespace tenebra::bench {
namespace {

constexpr std::array parts{BenchPart<BakeSession>{"map", measure_bake_map}};

std::vector<LastLine> last_lines(const BakeSession& session) {
  const BakeHeadline& h = session.headline;
  return {{"exact_over_rays", h.exact_over_rays, 3},
          {"within_over_rays", h.within_over_rays, 3},
          {"exact_over_rays_penumbra", h.exact_over_rays_penumbra, 3},
          {"rays", h.rays, 0},
          {"worst_255", h.worst_255, 4}};
}

constexpr const char* footer =
    "The lightmap of scenes/room.glb under its lamp, one sample per texel: from places on triangles to "
    "light,\n"
    "what `tenebra bake` computes. exact_over_rays: the time of exact soft shadows over that of the fewest\n"
    "stratified shadow rays per texel (a power of two) that err by 0.5/255 of white at most, RMS over the\n"
    "map, white being the 99.9th percentile; within_over_rays: that of --soft-error 0.5 over the same;\n"
    "penumbra: the same where the error is that of texels that see a part of the lamp. rays: the\n"
    "number per texel that this takes over the map. Rays go sixteen at a time, from sixteen texels to one\n"
    "cell of the lamp or from one texel to sixteen cells, their sum taken unscaled or scaled by the light\n"
    "of the unoccluded lamp: the quickest counts. Building trees is not counted. worst_255: the largest "
    "error\n"
    "of the exact map against the reference solver.";

}  // namespace

void add_bake_command(CLI::App& program, Run& run) {
  add_session_command<BakeSession>(
      program, run, {"bake", "The light of a lightmap, compared with stratified rays through Embree", footer},
      parts, last_lines);
}

}  // namespace tenebra::bench
