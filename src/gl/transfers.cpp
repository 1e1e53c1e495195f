#include "gl/transfers.h"

#include <glad/gl.h>

#include <algorithm>
#include <cassert>
#include <cstring>

#include "base/fail.h"

namespace tenebra::gl {
namespace {

constexpr std::size_t run = std::size_t{1} << 14;  // bytes that are compared, and sent, together

GLsync sync_of(void* fence) {
  return static_cast<GLsync>(fence);
}

}  // namespace

Expected<void> SentBuffer::send(std::span<const std::byte> bytes, std::size_t& sent_bytes) {
  if (bytes.size() != held_.size()) {
    held_.clear();
    if (auto all = buffer_.upload(bytes); !all) return all;
    held_.assign(bytes.begin(), bytes.end());
    sent_bytes += bytes.size();
    return {};
  }
  const auto differs = [&](std::size_t first) {
    return std::memcmp(&bytes[first], &held_[first], std::min(run, bytes.size() - first)) != 0;
  };
  for (std::size_t first = 0, end = 0; first < bytes.size(); first = end) {
    end = first;
    while (end < bytes.size() && differs(end)) end += run;
    end = std::min(end, bytes.size());
    if (end == first) {
      end += run;
      continue;
    }
    std::memcpy(&held_[first], &bytes[first], end - first);
    buffer_.update(first, bytes.subspan(first, end - first));
    sent_bytes += end - first;
  }
  return {};
}

Download::~Download() {
  if (fence_ != nullptr) glDeleteSync(sync_of(fence_));
}

Expected<void> Download::start(const Buffer& from, std::size_t bytes) {
  if (bytes > room_) {
    glGetError();  // an older error is not ours
    staging_ = Buffer::create();
    mapped_ = nullptr;
    room_ = 0;
    const GLbitfield read = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    const auto size = static_cast<GLsizeiptr>(bytes);
    glNamedBufferStorage(staging_.name(), size, nullptr, read | GL_CLIENT_STORAGE_BIT);
    if (glGetError() == GL_NO_ERROR)
      mapped_ = static_cast<const std::byte*>(glMapNamedBufferRange(staging_.name(), 0, size, read));
    if (mapped_ == nullptr)
      return base::fail(ErrorKind::device, "OpenGL: found no memory to read {} bytes back", bytes);
    room_ = bytes;
  }
  bytes_ = bytes;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(from.name(), staging_.name(), 0, 0, static_cast<GLsizeiptr>(bytes));
  if (fence_ != nullptr) glDeleteSync(sync_of(fence_));
  fence_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
  return {};
}

Expected<std::span<const std::byte>> Download::finish() {
  assert(fence_ != nullptr);
  constexpr GLuint64 second_ns = 1000000000;
  constexpr int patience_s = 60;  // of software OpenGL on a busy machine, too
  GLenum state = GL_TIMEOUT_EXPIRED;
  for (int i = 0; i < patience_s && state == GL_TIMEOUT_EXPIRED; ++i)
    state = glClientWaitSync(sync_of(fence_), GL_SYNC_FLUSH_COMMANDS_BIT, second_ns);
  glDeleteSync(sync_of(std::exchange(fence_, nullptr)));
  if (state == GL_TIMEOUT_EXPIRED)
    return base::fail(ErrorKind::device, "OpenGL: found no answer of the GPU after {} s", patience_s);
  const GLenum error = glGetError();
  if (error == GL_OUT_OF_MEMORY)
    return base::fail(ErrorKind::device, "OpenGL: found no memory left on the GPU");
  if (state == GL_WAIT_FAILED || error != GL_NO_ERROR)
    return base::fail(ErrorKind::device, "OpenGL: found a lost context or a failed pass (error {:#x})",
                      error);
  return std::span(mapped_, bytes_);
}

}  // namespace tenebra::gl
