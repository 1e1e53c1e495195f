// OpenEXR pictures from bytes, as `tenebra compare` reads them.
#include "fuzz/input_file.h"
#include "io/exr/exr_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const tenebra::fuzz::InputFile input(".exr");
  (void)tenebra::io::exr::read(input.write(bytes, size));
  return 0;
}
