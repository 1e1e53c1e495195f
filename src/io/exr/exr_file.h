// OpenEXR pictures: any number of named channels in half, float or whole numbers, and a header that says how
// they were made. The one place that knows the library.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tenebra/expected.h>
#include "io/image.h"

namespace tenebra::io::exr {

enum class Precision { half, full };  ///< floats of 16 or 32 bits
enum class Compression { zip, piz };  ///< neither loses a bit

/// Pixel i is values[i * step], row 0 at the top. In halves, what is beyond 65504 is stored as that.
struct Floats {
  std::span<const float> values;
  std::size_t step = 1;
  Precision precision = Precision::half;
};
/// Pixel i is values[i]; stored as it is, in 32 bits.
using Numbers = std::span<const std::uint32_t>;

/// A dot in the name parts layer and channel: "N.X".
struct Channel {
  std::string name;
  std::variant<Floats, Numbers> values;
};

/// Matrices as OpenEXR's header has them: rows one after another, for row vectors (p' = p M).
struct CameraMatrices {
  std::array<float, 16> world_to_camera{};  ///< x to the right, y up, z the way the camera looks
  std::array<float, 16>
      world_to_ndc{};  ///< after division by w: (0,0) the upper left corner, (1,1) the lower right
};

struct Text {
  std::string name;
  std::string value;
};

struct Picture {
  int width = 0;
  int height = 0;
  std::vector<Channel> channels;  ///< names differ
  CameraMatrices camera;
  std::vector<Text> texts;  ///< of the header, by names that differ
  Compression compression = Compression::zip;
};

/// The bytes of a file of one part, in rows. The same picture gives the same bytes. Fails with a phrase.
Expected<std::string> encode(const Picture& picture);

/// One or three channels as floats, of the first part of the file: R, G, B, or Y alone, where `layer` is
/// empty; else layer.R or layer.X and so on, or the one channel of that name. Whole numbers beyond 2^24 are
/// rounded. What a damaged header states is held against the size of the file before memory is taken. Refuses
/// deep pictures and more than 2^26 pixels.
Expected<io::ImageF> read(const std::filesystem::path& path, std::string_view layer = "");

}  // namespace tenebra::io::exr
