// The oracle of the hard shadows: the exact answer by the definition in tenebra/hard_shadows.h, decided for
// all triangles that a ray could meet. Signs come from doubles with carried error bounds, and from unbounded
// integers where those cannot tell. Shares no code with src/.
#pragma once

#include <cstdint>
#include <vector>

#include <tenebra/hard_shadows.h>
#include "oracle/triangle_boxes.h"

namespace tenebra::oracle {

/// Work of an oracle: how often doubles did not suffice.
struct ExactMaskStats {
  std::uint64_t samples = 0;   ///< pixels with a triangle
  std::uint64_t active = 0;    ///< of these, those that light and eye see from one side
  std::uint64_t shadowed = 0;  ///< of these, those blocked
  std::uint64_t pairs = 0;     ///< pairs of sample and triangle decided
  std::uint64_t exact = 0;     ///< of these, pairs that needed unbounded integers

  ExactMaskStats& operator+=(const ExactMaskStats& other) {
    samples += other.samples, active += other.active, shadowed += other.shadowed;
    pairs += other.pairs, exact += other.exact;
    return *this;
  }
};

/// The exact mask's value at one sample.
struct ExactAnswer {
  std::uint8_t value = 0;               ///< as ShadowMask: 255 lit
  bool active = false;                  ///< gets a ray at all
  std::uint32_t blocker = no_triangle;  ///< a triangle that blocks it
};

/// The exact answer for one light. Keeps references to what `triangles` refers to.
class ExactShadow {
public:
  ExactShadow(const ViewRays& view, const OracleTriangles& triangles, const ShadowLight& light,
              const HardShadowConfig& config);

  /// The sample's value, counted in `stats`. `id`: not no_triangle.
  ExactAnswer answer(const glm::dvec3& point, std::uint32_t id, ExactMaskStats& stats) const;
  /// Whether the sample gets a ray at all.
  bool active(const glm::dvec3& point, std::uint32_t id) const;
  /// A triangle that blocks the sample, or no_triangle. Does not check whether the sample is active.
  std::uint32_t blocker(const glm::dvec3& point, std::uint32_t id, ExactMaskStats& stats) const;
  /// A blocker found among all triangles, without the candidate search.
  std::uint32_t blocker_among_all(const glm::dvec3& point, std::uint32_t id, ExactMaskStats& stats) const;
  /// Whether triangle `occluder` blocks the sample.
  bool blocks(std::uint32_t occluder, const glm::dvec3& point, std::uint32_t id, ExactMaskStats& stats) const;

private:
  struct Corners {
    glm::dvec3 a, b, c;
  };
  Corners corners(std::uint32_t id) const;
  int light_side(std::uint32_t id) const;
  int eye_side(std::uint32_t id) const;
  bool in_reach(const glm::dvec3& point) const;

  ViewRays view_;
  OracleTriangles triangles_;
  ShadowLight light_;
  HardShadowConfig config_;
  std::vector<int> light_sides_;    ///< side of the triangle's plane that the light is on; 0: none
  std::vector<std::int8_t> casts_;  ///< 1: may block
  TriangleBoxes boxes_;
};

/// The whole mask, on all cores.
ShadowMask exact_mask(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
                      const ShadowLight& light, const HardShadowConfig& config,
                      ExactMaskStats* stats = nullptr);

/// tau of a triangle and theta of a pair, by the formulas of tenebra/hard_shadows.h.
double vertex_rounding(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);
double contact_height(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double tau_sum);

}  // namespace tenebra::oracle
