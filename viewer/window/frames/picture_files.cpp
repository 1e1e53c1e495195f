#include "window/frames/picture_files.h"

#include <utility>

#include "window/frames/within_memory.h"

namespace tenebra::viewer {
namespace {

constexpr std::size_t most_files_waiting = 2;

}  // namespace

Expected<void> PictureFiles::add(std::filesystem::path file, std::shared_ptr<const Picture> picture) {
  auto added = within_memory(
      [&] {
        if (!queue_) queue_.emplace(most_files_waiting);
        return queue_->add([to = std::move(file), of = std::move(picture)] {
          return io::write_png(to, of->a.result.image);
        });
      },
      [] {});
  if (!added) queue_.reset();
  return added;
}

Expected<void> PictureFiles::finish() {
  if (!queue_) return {};
  auto done = within_memory([&] { return queue_->finish(); }, [] {});
  queue_.reset();
  return done;
}

}  // namespace tenebra::viewer
