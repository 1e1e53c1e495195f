// What a camera sees of triangles in a picture of few pixels: how far away, and from which side.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

namespace tenebra::stage {

/// A camera: where it stands, right, up and back, and the tangents of half its angles.
struct Lens {
  glm::dvec3 eye{0.0};
  glm::dmat3 basis{1.0};
  glm::dvec2 tan{1.0};
  double near_m = 0;  ///< nothing nearer along the view axis is seen
};

class SmallView {
public:
  struct Pixel {
    float depth_m = std::numeric_limits<float>::infinity();  ///< along the view axis; infinite: nothing
    bool front = false;                                      ///< it turns its front to the camera

    bool held() const { return depth_m < std::numeric_limits<float>::infinity(); }
  };

  SmallView(const Lens& lens, int width, int height);

  /// A triangle, in the pixels whose centres it covers and where it is the nearest.
  void add(const glm::dvec3 (&corners)[3]);
  /// A rectangle that faces the camera, front side forward.
  void add(const glm::dvec3& middle, const glm::dvec2& half_m);

  std::span<const Pixel> pixels() const { return pixels_; }
  /// The share of all pixels that hold something; `other`: and nothing in that picture of the same size.
  double share(const SmallView* other = nullptr) const;
  /// The share of the pixels that hold something that shows a back.
  double share_of_backs() const;

private:
  glm::dvec2 pixel_of(const glm::dvec3& in_view) const;
  glm::dvec3 ray_in_view(int x, int y) const;
  glm::dvec3 in_view(const glm::dvec3& at) const { return glm::transpose(lens_.basis) * (at - lens_.eye); }
  void keep(int x, int y, double depth_m, bool front);

  Lens lens_;
  int width_, height_;
  std::vector<Pixel> pixels_;
};

}  // namespace tenebra::stage
