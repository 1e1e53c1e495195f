#include "stage/cutout/mask_material.h"

#include <algorithm>
#include <cmath>

#include "parallel/parallel.h"
#include "stage/cutout/cross.h"

namespace tenebra::stage {
namespace {

constexpr double full = 255.0;
constexpr double largest_place = 2147483648.0;  // pixels: texture/bilinear.h
constexpr std::size_t most_regions = 8;         // thresholds that share outlines; more are rare
constexpr std::size_t batch = 256;              // triangles between two looks at the limit
constexpr double most_cells = 1 << 20;          // of a sheet made for one triangle

const TextureImage* usable_image(const Scene& scene, const TextureMap& map) {
  if (map.image < 0 || static_cast<std::size_t>(map.image) >= scene.images.size()) return nullptr;
  const TextureImage& image = scene.images[static_cast<std::size_t>(map.image)];
  if (image.width <= 0 || image.height <= 0) return nullptr;
  const auto pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  return image.rgba.size() >= 4 * pixels ? &image : nullptr;
}

/// `count` + 1 lines at equal distances, and one more beyond each end.
std::vector<double> lines(double low, double high, int count) {
  std::vector<double> result;
  for (int i = -1; i <= count + 1; ++i) result.push_back(low + (high - low) * i / count);
  return result;
}

/// Lines beside both edges of pixels `low` to `high`.
std::vector<double> square_lines(double low, double high) {
  std::vector<double> result;
  for (double i = low; i <= high; ++i)
    result.insert(result.end(), {i - 0.5 + edge_width, i + 0.5 - edge_width});
  return result;
}

/// Whether the corners span an area that places between them can be found by.
bool has_area(const std::array<glm::dvec2, 3>& p) {
  const glm::dvec2 u = p[1] - p[0], v = p[2] - p[0], w = p[2] - p[1];
  const double longest = std::max({glm::dot(u, u), glm::dot(v, v), glm::dot(w, w)});
  return std::abs(cross(u, v)) > 1e-9 * longest;
}

void keep(bool inside, CutTriangle& out) {
  out = {};
  out.whole = inside;
}

}  // namespace

double Fineness::texture_tolerance() const {
  return grid_tolerance() * std::ldexp(1.0, level());
}

MaskMaterial::MaskMaterial(const Scene& scene, std::size_t material, std::vector<MaskedTriangle> triangles,
                           const std::vector<std::size_t>& instances)
    : scene_(scene),
      material_(scene.materials[material]),
      image_(usable_image(scene, material_.base_color_map)),
      triangles_(std::move(triangles)),
      instances_(instances) {}

void MaskMaterial::load_grid(int level) {
  grid_ = image_ ? alpha_of(*image_, material_.base_color_map.magnify)
                 : AlphaGrid{1, 1, {static_cast<float>(full)}};
  for (int i = 0; i < level && can_be_coarser(); ++i) grid_ = half_of(grid_);
  const auto [least, most] = std::minmax_element(grid_.alpha.begin(), grid_.alpha.end());
  least_ = *least, most_ = *most;
}

MaskMaterial::Sampled MaskMaterial::sample(const MaskedTriangle& masked) const {
  const Mesh& mesh = scene_.meshes[masked.mesh];
  const TextureMap& map = material_.base_color_map;
  const auto set = static_cast<std::size_t>(std::clamp(map.uv_set, 0, 1));
  const std::vector<glm::vec2>& coordinates = mesh.texture_coordinates[set];
  const glm::dmat3x2 transform(map.transform);
  Sampled sampled;
  sampled.is_placed = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t v = mesh.triangles[masked.triangle][static_cast<int>(k)];
    const double color = v < mesh.colors.size() ? mesh.colors[v].a : 1.0;
    sampled.factor[k] = color * material_.alpha;
    const glm::dvec2 uv(v < coordinates.size() ? coordinates[v] : glm::vec2(0.0f));
    const glm::dvec2 place = transform * glm::dvec3(uv, 1.0);
    sampled.place[k] = {place.x * grid_.width - 0.5, place.y * grid_.height - 0.5};
    sampled.is_placed = sampled.is_placed && std::abs(sampled.place[k].x) < largest_place &&
                        std::abs(sampled.place[k].y) < largest_place;
  }
  return sampled;
}

/// The texture's alpha at which the material cuts, where the other factors are the same all over the
/// triangle.
double MaskMaterial::threshold(const Sampled& sampled) const {
  return full * material_.alpha_cutoff / sampled.factor[0];
}

/// Outlines that several triangles share: those of the first thresholds that occur.
void MaskMaterial::prepare_regions(double tolerance) {
  regions_.clear();
  const TextureMap& map = material_.base_color_map;
  std::optional<TiledSheet> tiled;
  for (const MaskedTriangle& masked : triangles_) {
    const Sampled sampled = sample(masked);
    if (sampled.varies() || !(sampled.factor[0] > 0) || regions_.size() == most_regions) continue;
    const double at = threshold(sampled);
    if (!(at > least_ && at <= most_) || regions_.contains(at)) continue;
    if (!tiled) tiled = wrap_sheet(grid_, map.wrap_u, map.wrap_v);
    regions_.emplace(at, Region{build_tree(trace_outline(tiled->sheet, at, tolerance)), tiled->tiling});
  }
}

bool MaskMaterial::cut_one(const Sampled& sampled, const Bounds& bounds, CutTriangle& out) const {
  const double cutoff = full * material_.alpha_cutoff;
  const auto [low, high] = std::minmax({sampled.factor[0], sampled.factor[1], sampled.factor[2]});
  if (!std::isfinite(low) || !std::isfinite(high) || std::isnan(cutoff)) return keep(true, out), true;
  // The least and the most that any place can have; factors may be negative.
  const auto [least, most] = std::minmax({low * least_, low * most_, high * least_, high * most_});
  if (least >= cutoff || most < cutoff) return keep(least >= cutoff, out), true;
  if (!sampled.is_placed || least_ == most_ || !has_area(sampled.place))
    return cut_flat(sampled, bounds, out);
  const auto region = sampled.varies() ? regions_.end() : regions_.find(threshold(sampled));
  if (region == regions_.end() || !(low > 0)) return cut_varying(sampled, bounds, out);
  return !region->second.tree.outline.too_long &&
         cut_triangle(sampled.place, region->second, bounds.most_triangles, out);
}

/// An outline of its own: alpha times the factor, which is linear over the triangle, at the grid's lines
/// around the triangle and at lines between them.
bool MaskMaterial::cut_varying(const Sampled& sampled, const Bounds& bounds, CutTriangle& out) const {
  const auto& p = sampled.place;
  const glm::dvec2 low = glm::floor(glm::min(p[0], glm::min(p[1], p[2]))) - 1.0;
  const glm::dvec2 high = glm::ceil(glm::max(p[0], glm::max(p[1], p[2]))) + 1.0;
  const glm::dvec2 size = high - low;
  if (size.x * size.y > most_cells) return !can_be_coarser() && cut_flat(sampled, bounds, out);
  const int between = size.x * size.y * 16 <= 65536 ? 4 : 1;
  const double area = cross(p[1] - p[0], p[2] - p[0]);
  const TextureMap& map = material_.base_color_map;
  const auto value = [&](double x, double y) {
    const glm::dvec2 at(x, y);
    const double b = cross(at - p[0], p[2] - p[0]) / area, c = cross(p[1] - p[0], at - p[0]) / area;
    const double factor = sampled.factor[0] * (1 - b - c) + sampled.factor[1] * b + sampled.factor[2] * c;
    return factor * sample_alpha(grid_, map.wrap_u, map.wrap_v, at);
  };
  const auto along = [&](int axis) {
    return grid_.in_squares ? square_lines(low[axis], high[axis])
                            : lines(low[axis], high[axis], static_cast<int>(size[axis]) * between);
  };
  const AlphaSheet sheet = sample_sheet(along(0), along(1), value);
  Region region{build_tree(trace_outline(sheet, full * material_.alpha_cutoff, bounds.tolerance)), {}};
  return !region.tree.outline.too_long && cut_triangle(p, region, bounds.most_triangles, out);
}

/// A triangle without area in its texture, or without texture: its own corners span the plane.
bool MaskMaterial::cut_flat(const Sampled& sampled, const Bounds& bounds, CutTriangle& out) const {
  const auto& p = sampled.place;
  const TextureMap& map = material_.base_color_map;
  const bool constant = !sampled.is_placed || least_ == most_;
  int count = 1;
  if (!constant) {
    const glm::dvec2 size = glm::max(p[0], glm::max(p[1], p[2])) - glm::min(p[0], glm::min(p[1], p[2]));
    count = static_cast<int>(std::clamp(4.0 * std::max(size.x, size.y), 1.0, 256.0));
  }
  const auto value = [&](double b, double c) {
    const double factor = sampled.factor[0] * (1 - b - c) + sampled.factor[1] * b + sampled.factor[2] * c;
    const glm::dvec2 at = p[0] + b * (p[1] - p[0]) + c * (p[2] - p[0]);
    return factor * (constant ? grid_.alpha[0] : sample_alpha(grid_, map.wrap_u, map.wrap_v, at));
  };
  if (constant && !sampled.varies()) return keep(value(0, 0) >= full * material_.alpha_cutoff, out), true;
  AlphaSheet sheet = sample_sheet(lines(0, 1, count), lines(0, 1, count), value);
  Region region{build_tree(trace_outline(sheet, full * material_.alpha_cutoff, bounds.tolerance / count)),
                {}};
  return cut_triangle({glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1)}, region, bounds.most_triangles,
                      out);
}

std::size_t MaskMaterial::added(std::size_t first, std::size_t last) const {
  std::size_t sum = 0;
  for (std::size_t i = first; i < last; ++i) {
    const std::size_t now = results_[i].triangles.size();
    if (now > 1) sum += (now - 1) * instances_[triangles_[i].mesh];
  }
  return sum;
}

bool MaskMaterial::cut(const Fineness& fineness, std::size_t most_added) {
  load_grid(fineness.level());
  const double tolerance = fineness.grid_tolerance();
  prepare_regions(tolerance);
  results_.assign(triangles_.size(), {});
  std::vector<std::uint8_t> failed(triangles_.size(), 0);
  std::size_t sum = 0;
  for (std::size_t first = 0; first < triangles_.size(); first += batch) {
    const std::size_t count = std::min(batch, triangles_.size() - first);
    parallel::parallel_ranges(count, 8, [&](std::size_t a, std::size_t b) {
      for (std::size_t i = first + a; i < first + b; ++i) {
        const std::size_t instances = std::max<std::size_t>(1, instances_[triangles_[i].mesh]);
        const Bounds bounds{tolerance, can_be_coarser() ? most_added / instances + 1 : most_gates};
        failed[i] = !cut_one(sample(triangles_[i]), bounds, results_[i]);
      }
    });
    const auto begin = failed.begin() + static_cast<std::ptrdiff_t>(first);
    if (std::find(begin, begin + static_cast<std::ptrdiff_t>(count), 1) !=
        begin + static_cast<std::ptrdiff_t>(count))
      return false;
    sum += added(first, first + count);
    if (sum > most_added && can_be_coarser()) return false;
  }
  return true;
}

std::size_t MaskMaterial::triangles_before() const {
  std::size_t sum = 0;
  for (const MaskedTriangle& masked : triangles_) sum += instances_[masked.mesh];
  return sum;
}

std::size_t MaskMaterial::triangles_after() const {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < triangles_.size(); ++i)
    sum += (results_[i].whole ? 1 : results_[i].triangles.size()) * instances_[triangles_[i].mesh];
  return sum;
}

}  // namespace tenebra::stage
