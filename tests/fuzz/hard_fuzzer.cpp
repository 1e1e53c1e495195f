// Hard shadows of triangles from bytes: every variant at every vector level gives the mask of the oracle.
#include <tenebra/hard_shadows.h>
#include "fuzz/soup_bytes.h"
#include "oracle/exact_mask.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tenebra;
  fuzz::InputBytes bytes(data, size);
  const int how = bytes.byte();
  fuzz::SoupCase c = fuzz::soup_case(bytes, 24);
  ShadowLight light;
  light.directional = (how & 1) != 0;
  light.position = bytes.vector(c.unit);
  light.to_light = bytes.vector(1);
  if (light.directional && light.to_light == glm::vec3(0)) return 0;
  if ((how & 6) == 6) light.position *= std::ldexp(1.0f, bytes.below(40));  // far
  HardShadowConfig config;
  config.contact = (how & 8) != 0 ? ContactRule::none : ContactRule::triangle_ids;
  const ShadowMask expected = oracle::exact_mask(c.points, c.view, c.soup.view(), light, config);
  for (int variant = 0; variant <= static_cast<int>(Variant::precise_seatp); ++variant)
    for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
      if (!simd_level_supported(level)) continue;
      config.variant = static_cast<Variant>(variant);
      config.simd = level;
      ShadowMask mask;
      ShadowTracer().trace_shadow_mask(c.points, c.soup.view(), light, config, mask);
      if (mask != expected)
        fuzz::found(std::string(variant_name(config.variant)) + " at " + std::string(simd_level_name(level)) +
                    fuzz::describe(c));
    }
  return 0;
}
