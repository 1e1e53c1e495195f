// OpenEXR pictures from bytes, as `tenebra compare` reads them.
#include "exr/exr_file.h"
#include "fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const tenebra::fuzz::InputFile input(".exr");
  (void)tenebra::exr::read(input.write(bytes, size));
  return 0;
}
