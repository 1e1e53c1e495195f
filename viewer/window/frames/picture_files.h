// The files of a recording, written beside the next picture.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include <tenebra/expected.h>
#include "parallel/job_queue.h"
#include "window/frames/frame_request.h"

namespace tenebra::viewer {

/// For one thread. After a failure it begins anew. What is left when it is destroyed is written first.
class PictureFiles {
public:
  /// `picture` is written, after those before. Waits while two wait already. Fails with what one of those
  /// before failed with; then those behind that one are not written, nor is this.
  Expected<void> add(std::filesystem::path file, std::shared_ptr<const Picture> picture);
  /// Waits until all are written. Fails likewise, and where memory runs out.
  Expected<void> finish();

private:
  std::optional<parallel::JobQueue> queue_;  // while there is something to write
};

}  // namespace tenebra::viewer
