#include "render/antialias/pixel_choice.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include <tenebra/visible_points.h>
#include "parallel/parallel.h"

namespace tenebra::render {
namespace {

constexpr std::size_t square_side = 16, block_side = 4;
constexpr std::uint8_t is_edge = 4, tint_changes = 2, has_contrast = 1;
constexpr std::size_t pixels_at_once = 256;  // compared

/// Calls act(i) for each byte that is not 0. Most are 0, and these are skipped eight at a time.
template <class Act>
void for_each_set(std::span<const std::uint8_t> bytes, Act act) {
  std::size_t first = 0;
  for (; first + 8 <= bytes.size(); first += 8) {
    std::uint64_t all;
    std::memcpy(&all, &bytes[first], 8);
    if (all == 0) continue;
    for (std::size_t i = first; i < first + 8; ++i)
      if (bytes[i] != 0) act(i);
  }
  for (; first < bytes.size(); ++first)
    if (bytes[first] != 0) act(first);
}

class Chooser {
public:
  Chooser(const CentrePicture& centre, std::span<const glm::vec2> offsets, const visibility::PlaceIds& seen,
          const SurfaceMatch& match)
      : centre_(centre),
        offsets_(offsets),
        seen_(seen),
        match_(match),
        width_(static_cast<std::size_t>(centre.width)),
        height_(static_cast<std::size_t>(centre.height)),
        contrast_(least_contrast(offsets.size() + 1)),
        chosen_(width_ * height_) {}

  std::vector<std::uint8_t> run(bool everywhere) && {
    if (everywhere) return std::vector<std::uint8_t>(chosen_.size(), is_edge);
    parallel::parallel_ranges(height_, square_side, [&](std::size_t first, std::size_t last) {
      SurfaceMatch match(match_);
      for (std::size_t y = first; y < last; y += block_side)
        by_geometry(y, std::min(y + block_side, last), match);
      std::vector<std::uint8_t> differs(width_);
      for (std::size_t y = first; y < last; ++y) {
        by_contrast(y, differs, match);
        by_glass(y);
      }
    });
    return std::move(chosen_);
  }

private:
  glm::vec2 centre_of(std::size_t pixel) const {
    return {static_cast<float>(pixel % width_) + 0.5f, static_cast<float>(pixel / width_) + 0.5f};
  }

  /// Marks pixels of a row of blocks that see several surfaces. Nearly always all samples of a block see what
  /// the centres see.
  void by_geometry(std::size_t top, std::size_t bottom, SurfaceMatch& match) {
    for (std::size_t left = 0; left < width_; left += block_side) {
      const std::size_t count = std::min(block_side, width_ - left);
      const visibility::PixelPlaces sees = seen_.of_pixel(static_cast<int>(left), static_cast<int>(top));
      for (std::size_t y = top; y < bottom; ++y) {
        const std::size_t first = y * width_ + left, lane = block_side * (y - top);
        std::uint32_t other[block_side] = {};
        if (sees.ids != nullptr) {
          compare_with(sees.ids + lane, &centre_.ids[first], count, other);
        } else {
          for (std::size_t i = 0; i < count; ++i) other[i] = sees.one ^ centre_.ids[first + i];
        }
        if (sees.layer_ids != nullptr)
          compare_with(sees.layer_ids + lane, &centre_.layer[first], count, other);
        for (std::size_t i = 0; i < count; ++i)
          if (other[i] != 0 && sees_several(first + i, match)) chosen_[first + i] = is_edge;
      }
    }
  }
  /// `other`: not 0 where one of four pixels next to each other, the first `count` of which the picture has,
  /// sees something else than its centre.
  void compare_with(const std::int32_t* ids, const std::uint32_t* centres, std::size_t count,
                    std::uint32_t* other) const {
    std::uint32_t four[block_side] = {};
    std::copy_n(centres, count, four);
    for (std::size_t k = 0; k < seen_.places(); ++k)
      for (std::size_t i = 0; i < block_side; ++i)
        other[i] |= static_cast<std::uint32_t>(ids[16 * k + i]) ^ four[i];
  }

  bool sees_several(std::size_t pixel, SurfaceMatch& match) const {
    const visibility::PixelPlaces sees =
        seen_.of_pixel(static_cast<int>(pixel % width_), static_cast<int>(pixel / width_));
    for (std::size_t k = 0; k < offsets_.size(); ++k) {
      const glm::vec2 place = centre_of(pixel) + offsets_[k];
      if (!match.same(centre_.ids[pixel], sees.id(k), place)) return true;
      if (!centre_.layer.empty() && !match.same(centre_.layer[pixel], sees.layer(k), place)) return true;
    }
    return false;
  }

  /// Contrasts behind glass, or where light changes its colour, need the light of their own samples.
  void by_glass(std::size_t y) {
    const std::span row = std::span(chosen_).subspan(y * width_, width_);
    for_each_set(row, [&](std::size_t x) {
      if (row[x] >= is_edge) return;
      const bool contrast = (row[x] & has_contrast) != 0;
      const bool glass = (row[x] & tint_changes) != 0 || has_layer(y * width_ + x);
      row[x] = !contrast ? 0 : glass ? is_edge : has_contrast;
    });
  }
  bool has_layer(std::size_t i) const { return !centre_.layer.empty() && centre_.layer[i] != no_triangle; }

  void by_contrast(std::size_t y, std::vector<std::uint8_t>& differs, SurfaceMatch& match) {
    const std::size_t row = y * width_;
    for (const std::ptrdiff_t dy : {-1, 1}) {
      if ((dy < 0 && y == 0) || (dy > 0 && y + 1 == height_)) continue;
      const std::size_t other = (y + static_cast<std::size_t>(dy)) * width_;
      compare(row, other, width_, differs.data());
      for_each_set(differs, [&](std::size_t x) { mark(differs[x], row + x, other + x, match); });
    }
    if (width_ < 2) return;
    compare(row, row + 1, width_ - 1, differs.data());
    for_each_set(std::span(differs).first(width_ - 1), [&](std::size_t x) {
      mark(differs[x], row + x, row + x + 1, match);
      mark(differs[x], row + x + 1, row + x, match);
    });
  }

  /// Marks pixel i, which differs in this way from pixel j.
  void mark(std::uint8_t differs, std::size_t i, std::size_t j, SurfaceMatch& match) {
    if ((differs & ~chosen_[i]) == 0 || chosen_[i] >= is_edge || !one_surface(i, j, match)) return;
    if (differs == has_contrast && is_ramp(i, j, match)) return;
    chosen_[i] |= differs;
  }

  /// Whether what is drawn goes on from pixel j over i to the next as it began, on one surface: a straight
  /// ramp has the value of its middle for its mean.
  bool is_ramp(std::size_t i, std::size_t j, SurfaceMatch& match) const {
    const std::size_t next = 2 * i - j;  // wraps below 0
    const bool across = i / width_ == j / width_;
    if (next >= chosen_.size() || (across && next / width_ != i / width_)) return false;
    const std::uint8_t* const shown = centre_.picture.pixels.data();
    for (std::size_t c = 0; c < 3; ++c)
      if (std::abs(int{shown[3 * j + c]} - 2 * int{shown[3 * i + c]} + int{shown[3 * next + c]}) > contrast_)
        return false;
    return one_surface(i, next, match);
  }

  /// How pixels from `i` on differ from those from `j` on.
  void compare(std::size_t i, std::size_t j, std::size_t count, std::uint8_t* differs) const {
    for (std::size_t first = 0; first < count; first += pixels_at_once)
      compare_levels(i + first, j + first, std::min(pixels_at_once, count - first), differs + first);
    compare_masks(i, j, count, differs);
    for (const shade::TintFactors& tint : centre_.tints) compare_tints(tint, i, j, count, differs);
  }
  /// Compares the top bits: of soft masks, whether half of the light is seen. Where a penumbra is narrow, the
  /// picture's contrast shows it.
  void compare_masks(std::size_t i, std::size_t j, std::size_t count, std::uint8_t* differs) const {
    for (const auto mask : centre_.masks)
      for (std::size_t x = 0; x < count; ++x)
        differs[x] = static_cast<std::uint8_t>(differs[x] | ((mask[i + x] ^ mask[j + x]) >> 7 << 2));
  }
  void compare_levels(std::size_t i, std::size_t j, std::size_t count, std::uint8_t* differs) const {
    const std::uint8_t* const a = centre_.picture.pixels.data() + 3 * i;
    const std::uint8_t* const b = centre_.picture.pixels.data() + 3 * j;
    const auto contrast = static_cast<std::uint8_t>(contrast_);
    std::uint8_t unlike[3 * pixels_at_once], any = 0;
    for (std::size_t k = 0; k < 3 * count; ++k) {
      const auto gap = static_cast<std::uint8_t>(std::max(a[k], b[k]) - std::min(a[k], b[k]));
      unlike[k] = gap > contrast ? has_contrast : 0;
      any |= unlike[k];
    }
    std::fill_n(differs, count, std::uint8_t{0});
    for (std::size_t k = 0; any != 0 && k < count; ++k)
      differs[k] = static_cast<std::uint8_t>(unlike[3 * k] | unlike[3 * k + 1] | unlike[3 * k + 2]);
  }
  static void compare_tints(const shade::TintFactors& tint, std::size_t i, std::size_t j, std::size_t count,
                            std::uint8_t* differs) {
    constexpr std::size_t run = shade::TintFactors::run;
    for (std::size_t first = 0, end = 0; first < count; first = end) {
      const std::size_t a = i + first, b = j + first;
      end = std::min({count, first + run - a % run, first + run - b % run});  // of both runs
      if (tint.coloured[a / run] == 0 && tint.coloured[b / run] == 0) continue;
      for (std::size_t x = first; x < end; ++x) {
        const glm::vec3 gap = glm::abs(tint.factors[i + x] - tint.factors[j + x]);
        const float size = std::max({gap.r, gap.g, gap.b});
        if (size > 0) differs[x] |= size > 0.125f ? is_edge : tint_changes;
      }
    }
  }

  bool one_surface(std::size_t i, std::size_t j, SurfaceMatch& match) const {
    const glm::vec2 between = (centre_of(i) + centre_of(j)) * 0.5f;
    return match.same(centre_.ids[i], centre_.ids[j], between);
  }

  const CentrePicture& centre_;
  std::span<const glm::vec2> offsets_;
  const visibility::PlaceIds& seen_;
  const SurfaceMatch& match_;
  std::size_t width_, height_;
  int contrast_;
  std::vector<std::uint8_t> chosen_;
};

/// Pixels of a row of squares, in order.
void list_squares(std::span<const std::uint8_t> chosen, std::size_t width, std::size_t top,
                  std::size_t bottom, ChosenPixels& out) {
  for (std::size_t left = 0; left < width; left += square_side) {
    const std::size_t right = std::min(left + square_side, width);
    for (std::size_t block_y = top; block_y < bottom; block_y += block_side) {
      for (std::size_t block_x = left; block_x < right; block_x += block_side) {
        for (std::size_t y = block_y; y < std::min(block_y + block_side, bottom); ++y) {
          const std::size_t first = y * width + block_x, count = std::min(block_side, right - block_x);
          for_each_set(chosen.subspan(first, count), [&](std::size_t x) {
            const std::size_t i = first + x;
            (chosen[i] >= is_edge ? out.edges : out.contrasts).push_back(static_cast<std::uint32_t>(i));
          });
        }
      }
    }
  }
}

}  // namespace

ChosenPixels choose_pixels(const CentrePicture& centre, std::span<const glm::vec2> offsets,
                           const visibility::PlaceIds& seen, const SurfaceMatch& match, bool everywhere) {
  const std::vector<std::uint8_t> chosen = Chooser(centre, offsets, seen, match).run(everywhere);
  const auto width = static_cast<std::size_t>(centre.width), height = static_cast<std::size_t>(centre.height);
  const std::size_t bands = (height + square_side - 1) / square_side;
  std::vector<ChosenPixels> parts(bands);
  parallel::parallel_tasks(static_cast<int>(bands), [&](int band) {
    const std::size_t top = static_cast<std::size_t>(band) * square_side;
    list_squares(chosen, width, top, std::min(top + square_side, height),
                 parts[static_cast<std::size_t>(band)]);
  });
  ChosenPixels out;
  for (const ChosenPixels& part : parts) {
    out.edges.insert(out.edges.end(), part.edges.begin(), part.edges.end());
    out.contrasts.insert(out.contrasts.end(), part.contrasts.begin(), part.contrasts.end());
  }
  return out;
}

}  // namespace tenebra::render
