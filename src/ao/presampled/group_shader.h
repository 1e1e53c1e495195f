// The openness of a group of neighbouring receivers, from existing fields and samples; missing ones are
// named, to be made before the group is shaded again.
//
// A point is hidden by its own body (sampled on the surface once, self_occlusion.h) and by the rest, ray by
// ray: moving objects through their fields, static and deforming geometry by cast rays (field_occluders.h).
// The two are taken as independent: the openness is (1 - own) (1 - others).
#pragma once

#include "ao/presampled/bodies.h"
#include "ao/presampled/field_occluders.h"
#include "ao/receivers/point_rays.h"
#include "ao/receivers/receiver_sets.h"

namespace tenebra::ao {

/// Which parts of a receiver's occlusion are computed.
enum class AoPart {
  all,
  own,     ///< by its own body
  others,  ///< by all but its own body
};

/// What one group of receivers needs, and the work that it took.
struct GroupReport {
  std::vector<int> bodies;  ///< objects (or standing) that have no samples yet
  std::vector<int> own;     ///< numbers of the bodies that receivers lie on
  std::vector<MissingSample> samples;
  std::vector<int> occluders;  ///< not ready
  std::vector<int> reached;    ///< occluders that some receiver is in reach of
  OccluderCounts counts;
  std::uint64_t points = 0;
  bool complete() const { return bodies.empty() && samples.empty() && occluders.empty(); }
  void clear() {
    bodies.clear(), own.clear(), samples.clear(), occluders.clear(), reached.clear();
    counts = {};
    points = 0;
  }
};

/// For one thread.
class GroupShader {
public:
  /// Keeps references to all but the last until the next call.
  void begin(const FieldOccluders& occluders, const Bodies& bodies, const PointRays& rays,
             const RayKernels& kernels) {
    occluders_ = &occluders, bodies_ = &bodies, rays_ = &rays;
    kernels_ = kernels;
  }

  /// Openness, 0..1, to values[receiver.index], if the report is complete; else nothing.
  void shade(const ReceiverSet& set, AoPart part, int group, std::span<float> values, GroupReport& report);

private:
  void find_own(GroupReport& report);
  void find_near(GroupReport& report);
  void cast_others(GroupReport& report);
  void meet_near(std::span<const std::size_t> asked, GroupReport& report);

  const FieldOccluders* occluders_ = nullptr;
  const Bodies* bodies_ = nullptr;
  const PointRays* rays_ = nullptr;
  RayKernels kernels_;
  std::vector<Receiver> receivers_;
  std::vector<float> own_, others_;  ///< hidden shares, one per receiver
  std::vector<std::size_t> mixed_;   ///< receivers whose own body is met by cast rays
  std::vector<std::uint64_t> missing_;
  std::vector<int> near_;              ///< occluders in reach of some receiver
  std::vector<std::uint8_t> reached_;  ///< one per occluder and receiver
  std::vector<std::size_t> asked_;     ///< receivers with something in reach
  std::vector<trees::RayBatch> batches_;
  std::vector<float> distances_;
};

}  // namespace tenebra::ao
