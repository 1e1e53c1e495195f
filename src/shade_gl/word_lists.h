// Lists of numbers, one after another in one buffer, as shaders read them: `inputs` of shaders/colours.comp.
// Internal to shade_gl.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gl/objects.h"

namespace tenebra::shade_gl {

class WordLists {
public:
  WordLists() : buffer_(gl::Buffer::create()) {}

  void begin() { lists_.clear(), words_ = 0; }
  /// The list's first word. What is added must live until `send`; an empty list gets a word of its own.
  template <class T>
  std::uint32_t add(std::span<const T> values) {
    lists_.push_back({words_, std::as_bytes(values)});
    const std::size_t first = words_;
    words_ += values.size_bytes() / 4 + 1;
    return static_cast<std::uint32_t>(first);
  }
  /// Fails on more words than a shader can number and where there is no memory.
  Expected<void> send(std::size_t& sent_bytes);
  const gl::Buffer& buffer() const { return buffer_; }

private:
  struct List {
    std::size_t first_word;
    std::span<const std::byte> bytes;
  };
  gl::Buffer buffer_;
  std::vector<List> lists_;
  std::size_t words_ = 0;
};

}  // namespace tenebra::shade_gl
