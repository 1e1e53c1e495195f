// The triangles of one material whose alpha cuts, and the cut parts of each.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include <tenebra/scene.h>
#include "stage/cutout/alpha_sheet.h"
#include "stage/cutout/cut_triangle.h"

namespace tenebra::stage {

struct MaskedTriangle {
  std::uint32_t mesh;
  std::uint32_t triangle;
};

/// How finely a material is cut. Step 0 is the tolerance asked for; 1 half a pixel; each further one half a
/// pixel of a picture half as large.
struct Fineness {
  int step = 0;
  double tolerance_px = 1.0 / 8;  ///< of step 0

  int level() const { return step < 2 ? 0 : step - 1; }
  double grid_tolerance() const { return step == 0 ? tolerance_px : 0.5; }  ///< in pixels of the level
  double texture_tolerance() const;                                         ///< in pixels of the picture
};

class MaskMaterial {
public:
  MaskMaterial(const Scene& scene, std::size_t material, std::vector<MaskedTriangle> triangles,
               const std::vector<std::size_t>& instances);

  /// Cuts all triangles. False where more than `most_added` triangles would be added, or a limit of the work
  /// was met; the results are then unfinished. Never false once can_be_coarser() is.
  bool cut(const Fineness& fineness, std::size_t most_added);
  bool can_be_coarser() const { return grid_.width > 1 || grid_.height > 1; }

  const std::vector<MaskedTriangle>& triangles() const { return triangles_; }
  const std::vector<CutTriangle>& results() const { return results_; }
  std::size_t triangles_before() const;
  std::size_t triangles_after() const;

private:
  /// A triangle's alpha but for the texture's, and where it lies in the texture.
  struct Sampled {
    std::array<double, 3> factor{1, 1, 1};  ///< of the material and the vertices
    std::array<glm::dvec2, 3> place;        ///< in pixels of the grid
    bool is_placed = false;                 ///< coordinates are finite and within 2^31 pixels
    bool varies() const { return factor[0] != factor[1] || factor[0] != factor[2]; }
  };

  struct Bounds {
    double tolerance;            ///< pixels of the grid
    std::size_t most_triangles;  ///< that one may become
  };

  void load_grid(int level);
  Sampled sample(const MaskedTriangle& masked) const;
  double threshold(const Sampled& sampled) const;
  void prepare_regions(double tolerance);
  bool cut_one(const Sampled& sampled, const Bounds& bounds, CutTriangle& out) const;
  bool cut_varying(const Sampled& sampled, const Bounds& bounds, CutTriangle& out) const;
  bool cut_flat(const Sampled& sampled, const Bounds& bounds, CutTriangle& out) const;
  std::size_t added(std::size_t first, std::size_t last) const;

  const Scene& scene_;
  const Material& material_;
  const TextureImage* image_ = nullptr;
  std::vector<MaskedTriangle> triangles_;
  const std::vector<std::size_t>& instances_;  ///< of each mesh
  AlphaGrid grid_;
  float least_ = 0, most_ = 255;  ///< of the grid
  std::map<double, Region> regions_;
  std::vector<CutTriangle> results_;
};

}  // namespace tenebra::stage
