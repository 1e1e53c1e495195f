// The entry of the AFF importer: no exception leaves it.
#include <exception>
#include <new>

#include "formats/aff/reader.h"

#include "base/fail.h"
#include "formats/import_failure.h"

namespace tenebra::formats {

Expected<Scene> import_aff(const std::filesystem::path& path, const ImportOptions& options) {
  try {
    return AffReader(options).read(path);
  } catch (const AffFailure& failure) {
    return base::fail("{}", failure.message);
  } catch (const ImportFailure& failure) {
    return base::fail("{}: {}.", path.string(), failure.what());
  } catch (const std::bad_alloc&) {
    return base::fail("{}: found more than fits into memory, expected a smaller scene.", path.string());
  } catch (const std::exception& error) {
    return base::fail("{}: found {}, expected a readable AFF file.", path.string(), error.what());
  }
}

}  // namespace tenebra::formats
