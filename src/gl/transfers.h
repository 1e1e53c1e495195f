// Data on its way to OpenGL's memory and back: only what changed, and without waiting before it is needed.
// All of it needs a current gl::Context, destructors included.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <tenebra/expected.h>
#include "gl/objects.h"

namespace tenebra::gl {

/// A buffer whose contents are mostly those of the last frame.
class SentBuffer {
public:
  SentBuffer() : buffer_(Buffer::create()) {}
  /// Sends what differs from what the buffer holds; adds what was sent to `sent_bytes`.
  Expected<void> send(std::span<const std::byte> bytes, std::size_t& sent_bytes);
  const Buffer& buffer() const { return buffer_; }

private:
  Buffer buffer_;
  std::vector<std::byte> held_;
};

/// A buffer's bytes on their way back: a copy in memory that both see, and a fence behind it.
class Download {
public:
  Download() = default;
  Download(Download&& other) noexcept
      : staging_(std::move(other.staging_)),
        fence_(std::exchange(other.fence_, nullptr)),
        mapped_(std::exchange(other.mapped_, nullptr)),
        room_(std::exchange(other.room_, 0)),
        bytes_(other.bytes_) {}
  ~Download();

  /// Copies the first `bytes` bytes once the passes before are done. Fails if there is no memory for it.
  Expected<void> start(const Buffer& from, std::size_t bytes);
  /// Waits for them. Valid until the next start. Fails if the context is lost or the GPU hangs.
  Expected<std::span<const std::byte>> finish();

private:
  Buffer staging_;
  void* fence_ = nullptr;  // a GLsync
  const std::byte* mapped_ = nullptr;
  std::size_t room_ = 0, bytes_ = 0;
};

}  // namespace tenebra::gl
