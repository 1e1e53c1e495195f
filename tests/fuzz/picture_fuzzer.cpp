// Pictures from bytes: PNG and JPEG as textures, PNG and PFM as `tenebra compare` reads them, Radiance.
#include "fuzz/input_file.h"
#include "io/image.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace tenebra;
  static const fuzz::InputFile input(".png");
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  constexpr std::uint64_t most_pixels = 1 << 20;  // what is larger takes time and finds nothing more
  const auto path = input.write(bytes, size);
  if (text.starts_with("P")) {
    (void)io::read_pfm(path);
    return 0;
  }
  if (!text.starts_with("#?")) {
    const auto stated = io::stated_size(text);
    if (!stated || stated->width * stated->height > most_pixels) return 0;
    if (io::decode_rgba(text) && text.starts_with("\x89PNG")) (void)io::read_png(path);
    return 0;
  }
  (void)io::read_hdr(path);
  return 0;
}
