#include "bench/hash/hash_frame.h"

#include <fmt/format.h>

#include "bench/common/bench_frame.h"
#include "bench/hash/plain_raster.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

constexpr std::array pictures{HashPicture::hard, HashPicture::wide, HashPicture::soft, HashPicture::ambient};

}  // namespace

std::string setting_name(const HashSetting& setting) {
  return fmt::format("{}, {} thread{}", simd_level_name(setting.level), setting.threads,
                     setting.threads == 1 ? "" : "s");
}

std::vector<HashSetting> hash_settings() {
  std::vector<HashSetting> settings;
  for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!simd_level_supported(level)) continue;
    for (const int threads : {1, 2}) settings.push_back({level, threads});
  }
  return settings;
}

std::vector<HashSetting> few_hash_settings() {
  std::vector<HashSetting> few;
  for (const HashSetting& setting : hash_settings()) {
    const bool even = few.size() % 2 == 0;
    if (setting.threads == (even ? 2 : 1) && (few.empty() || few.back().level != setting.level))
      few.push_back(setting);
  }
  return few;
}

HashSize hash_size(HashPicture picture, int scale) {
  constexpr std::array<HashSize, 4> sizes{{{48, 48}, {256, 256}, {32, 18}, {24, 14}}};
  const HashSize size = sizes[static_cast<std::size_t>(picture)];
  return {size.width * scale, size.height * scale};
}

HashFrame make_hash_frame(const Scene& scene, int number, int scale) {
  HashFrame frame{.number = number, .scale = scale, .ids = {}};
  const auto [clip, time_s] = frame_instant(scene, number);
  FrameGeometry geometry;
  evaluate_frame(scene, clip, time_s, geometry);
  for (const HashPicture picture : pictures) {
    const auto [width, height] = hash_size(picture, scale);
    const ViewRays view = evaluate_camera(scene, clip, time_s, 0, width, height);
    frame.ids[static_cast<std::size_t>(picture)] =
        plainly_seen_triangles(triangle_view(geometry), view, width, height);
  }
  return frame;
}

}  // namespace tenebra::bench
