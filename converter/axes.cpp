#include "axes.h"

#include <assimp/scene.h>

#include <cmath>
#include <cstdint>
#include <string>

namespace tenebra::converter {
namespace {

/// Sets `row` of `turn` to the axis that `name` states, 0 to 2, with its sign.
bool take_axis(const aiMetadata& stated, const char* name, float* row) {
  std::int32_t axis = -1, sign = 1;
  if (!stated.Get(name, axis) || !stated.Get((std::string(name) + "Sign").c_str(), sign)) return false;
  if (axis < 0 || axis > 2 || std::abs(sign) != 1) return false;
  row[axis] = static_cast<float>(sign);
  return true;
}

/// Versions of Assimp that follow the axes turn the root themselves. The tolerance is that of products of
/// rotations in floats; a turn of axes is a quarter turn at least.
bool is_turned(const aiMatrix4x4& matrix) {
  for (unsigned row = 0; row < 3; ++row)
    for (unsigned column = 0; column < 3; ++column)
      if (row != column && std::abs(matrix[row][column]) > 1e-6f * std::abs(matrix[row][row])) return true;
  return false;
}

}  // namespace

bool turn_upright(const aiScene& scene) {
  if (scene.mRootNode == nullptr || scene.mMetaData == nullptr) return true;
  aiMatrix4x4 turn;
  for (unsigned row = 0; row < 3; ++row) turn[row][row] = 0;
  const aiMetadata& stated = *scene.mMetaData;
  if (!take_axis(stated, "CoordAxis", turn[0]) || !take_axis(stated, "UpAxis", turn[1]) ||
      !take_axis(stated, "FrontAxis", turn[2]))
    return true;
  if (const float volume = turn.Determinant(); volume != 1) return volume == 0;  // 0: not three axes
  aiMatrix4x4& root = scene.mRootNode->mTransformation;
  if (!is_turned(root)) root = turn * root;
  return true;
}

}  // namespace tenebra::converter
