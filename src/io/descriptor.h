// An open file of the system that closes itself.
#pragma once

#include <unistd.h>

#include <utility>

namespace tenebra::io {

class Descriptor {
public:
  static constexpr int none = -1;

  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() {
    if (number_ != none) ::close(number_);
  }

  explicit operator bool() const { return number_ != none; }
  int number() const { return number_; }
  int release() { return std::exchange(number_, none); }

private:
  int number_ = none;
};

}  // namespace tenebra::io
