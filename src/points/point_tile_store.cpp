#include <memory>

#include "points/point_tiles.h"

namespace tenebra {

PointTileStore::PointTileStore() = default;
PointTileStore::PointTileStore(PointTileStore&&) noexcept = default;
PointTileStore& PointTileStore::operator=(PointTileStore&&) noexcept = default;
PointTileStore::~PointTileStore() = default;

PointTileStore::PointTileStore(const PointTileStore& other)
    : tiles_(other.tiles_ ? std::make_unique<points::PointTiles>(*other.tiles_) : nullptr) {}

PointTileStore& PointTileStore::operator=(const PointTileStore& other) {
  if (this != &other) *this = PointTileStore(other);
  return *this;
}

bool PointTileStore::empty() const {
  return !tiles_ || tiles_->empty();
}

void PointTileStore::clear() {
  tiles_.reset();
}

points::PointTiles& PointTileStore::operator*() {
  if (!tiles_) tiles_ = std::make_unique<points::PointTiles>();
  return *tiles_;
}

}  // namespace tenebra
