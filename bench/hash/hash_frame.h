// One frame whose values are hashed: which, how large, and at which settings.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <tenebra/scene.h>
#include <tenebra/simd_level.h>
#include <tenebra/visible_points.h>

namespace tenebra::bench {

/// How the values are computed; none of it may change them.
struct HashSetting {
  SimdLevel level = SimdLevel::automatic;
  int threads = 0;
};
std::string setting_name(const HashSetting& setting);  ///< "avx2, 2 threads"

/// All vector levels of this machine on one thread and on two.
std::vector<HashSetting> hash_settings();
/// All vector levels, on one thread and on two in turn.
std::vector<HashSetting> few_hash_settings();

/// Pictures are smaller where a pixel takes longer; `wide` has hard shadows by the fast variants only.
enum class HashPicture { hard, wide, soft, ambient };
struct HashSize {
  int width, height;
};
/// Both sides times `scale`.
HashSize hash_size(HashPicture picture, int scale);

/// A frame and the triangles that the pixels of each HashPicture see.
struct HashFrame {
  int number = 0;
  int scale = 1;
  std::array<std::vector<std::uint32_t>, 4> ids;
};
HashFrame make_hash_frame(const Scene& scene, int number, int scale);

}  // namespace tenebra::bench
