#include "ao/presampled/presampled_occlusion.h"

#include <fmt/format.h>

namespace tenebra::ao {

void PresampledOcclusion::reset(const SceneObjects& objects) {
  occluders_.reset(objects);
  fresh_ = true;
}

void PresampledOcclusion::begin_frame(const AoConfig& config, double reach, const RayKernels& kernels,
                                      const StopFlag* stop) {
  constexpr std::size_t megabyte = std::size_t{1} << 20;
  if (fresh_ || reach != reach_) bodies_.reset(casters_.objects(), reach);
  fresh_ = false;
  reach_ = reach;
  kernels_ = kernels;
  stop_ = stop;
  memory_mb_ = config.memory_mb;
  ++frame_;
  occluders_.begin_frame({config.layout, config.positions, config.directions, config.bits}, config.cache,
                         config.simd, frame_, stop);
  bodies_.begin_frame(frame_, config.cache);
  budget_.begin_frame(static_cast<std::size_t>(config.memory_mb) * megabyte);
}

/// Of one shape, samples are dropped before its field.
bool PresampledOcclusion::drop_oldest() {
  const auto samples = bodies_.oldest(), field = occluders_.fields().oldest();
  if (samples && (!field || *samples <= *field)) {
    bodies_.drop_oldest();
  } else if (field) {
    occluders_.drop_field(field->object);
  }
  return samples || field;
}

Expected<void> PresampledOcclusion::compute(const ReceiverSet& set, AoPart part, const PointRays& rays,
                                            std::vector<float>& values, AoStats& stats, FrameTimings& timings,
                                            const AoProgress& progress) {
  return FieldPass{casters_, occluders_, bodies_, rays, kernels_, stats, timings, room_}.run(
      set, part, values, progress, stop_);
}

void PresampledOcclusion::end_frame(AoStats& stats, std::vector<std::string>& notes) {
  bodies_.save_grown();
  stats.fields_built = occluders_.fields().built();
  stats.field_bytes = occluders_.fields().bytes();
  stats.sample_bytes = bodies_.bytes();
  stats.peak_bytes = budget_.peak();
  stats.cache_cells = bodies_.known();
  if (!noted_memory_ && budget_.refused()) {
    noted_memory_ = true;
    notes.push_back(
        fmt::format("A frame's fields and surface samples found no room within {} MB: rays are cast for "
                    "bodies without room, which takes longer; --memory ao:MB gives more.",
                    memory_mb_));
  }
  for (std::string& note : occluders_.fields().take_notes()) notes.push_back(std::move(note));
  for (std::string& note : bodies_.take_notes()) notes.push_back(std::move(note));
}

}  // namespace tenebra::ao
