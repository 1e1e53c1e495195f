#include "bench/hash/hash_bits.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace tenebra::bench {

struct BitHash::State {
  XXH3_state_t xxh;
};

BitHash::BitHash() : state_(std::make_unique<State>()) {
  XXH3_64bits_reset(&state_->xxh);
}
BitHash::~BitHash() = default;

void BitHash::add_bytes(std::span<const std::byte> bytes) {
  const std::uint64_t size = bytes.size();
  XXH3_64bits_update(&state_->xxh, &size, sizeof size);
  XXH3_64bits_update(&state_->xxh, bytes.data(), bytes.size());
}

std::uint64_t BitHash::value() const {
  return XXH3_64bits_digest(&state_->xxh);
}

}  // namespace tenebra::bench
