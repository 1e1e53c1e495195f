// Where the API of this folder begins: what a reader throws becomes one sentence.
#pragma once

#include <exception>
#include <filesystem>
#include <new>
#include <string_view>

#include <tenebra/scene.h>
#include "base/fail.h"
#include "formats/import_failure.h"

namespace tenebra::formats {

/// The scene that `read` returns, or a sentence with the file's name. `expected`: "an OBJ file".
template <class Read>
Expected<Scene> guarded_import(const std::filesystem::path& path, std::string_view expected, Read read) {
  try {
    return read();
  } catch (const ImportFailure& failure) {
    return base::fail("{}: {}.", path.string(), failure.what());
  } catch (const std::bad_alloc&) {
    return base::fail("{}: found more than the memory can hold, expected a smaller scene.", path.string());
  } catch (const std::exception& error) {
    return base::fail("{}: found a fault ({}), expected {}.", path.string(), error.what(), expected);
  }
}

}  // namespace tenebra::formats
