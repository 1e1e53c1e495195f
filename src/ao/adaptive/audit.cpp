#include "ao/adaptive/audit.h"

#include <cmath>

namespace tenebra::ao {
namespace {

constexpr double judged_pixels = 512;

std::uint32_t hashed(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

}  // namespace

Audit::Audit(PixelLooks& looks, const PixelSurfaces& surfaces, std::span<const Settled> settled,
             const RaySets& sets, AuditRoom& room) {
  double number_of[3] = {}, judged_of[3] = {};
  for (const Settled kind : settled) ++number_of[static_cast<int>(kind)];
  const bool mixed = number_of[static_cast<int>(Settled::by_neighbours)] > 0 &&
                     number_of[static_cast<int>(Settled::by_rays)] > 0;
  const double of_each = mixed ? judged_pixels / 2 : judged_pixels;
  const auto tiles = static_cast<std::size_t>(looks.tiles().count());
  if (room.of_tile.size() < tiles) room.of_tile.resize(tiles);
  const auto of_tile = std::span(room.of_tile).first(tiles);
  for (std::vector<Judged>& some : of_tile) some.clear();
  looks.look(
      1, sets,
      [&](int tile, std::vector<std::uint32_t>& pixels) {
        looks.tiles().each(tile, 1, [&](int x, int y) {
          const std::size_t i = surfaces.index(x, y);
          if (settled[i] == Settled::none) return;
          const double share = of_each / number_of[static_cast<int>(settled[i])];
          if (hashed(static_cast<std::uint32_t>(i)) * 0x1p-32 < share)
            pixels.push_back(static_cast<std::uint32_t>(i));
        });
      },
      [&](std::uint32_t pixel, const Openness& found) {
        const int x = static_cast<int>(pixel) % surfaces.width, y = static_cast<int>(pixel) / surfaces.width;
        const int tile = y / PixelTiles::side * looks.tiles().columns + x / PixelTiles::side;
        of_tile[static_cast<std::size_t>(tile)].push_back({pixel, found.open, 0});
      });
  std::vector<Judged>& judged = room.all;
  judged.clear();
  for (const std::vector<Judged>& some : of_tile) judged.insert(judged.end(), some.begin(), some.end());
  for (const Judged& one : judged) ++judged_of[static_cast<int>(settled[one.pixel])];
  const double all =
      number_of[static_cast<int>(Settled::by_neighbours)] + number_of[static_cast<int>(Settled::by_rays)];
  for (Judged& one : judged) {
    const int kind = static_cast<int>(settled[one.pixel]);
    one.weight = number_of[kind] / all / judged_of[kind];
  }
  judged_ = judged;
}

double Audit::Errors::rms_255() const {
  return 255 * std::sqrt(by_neighbours + by_rays);
}

Audit::Errors Audit::errors(std::span<const float> values, std::span<const Settled> settled) const {
  Errors errors;
  for (const Judged& one : judged_) {
    const double off = double{values[one.pixel]} - double{one.open};
    (settled[one.pixel] == Settled::by_rays ? errors.by_rays : errors.by_neighbours) +=
        one.weight * off * off;
  }
  return errors;
}

}  // namespace tenebra::ao
