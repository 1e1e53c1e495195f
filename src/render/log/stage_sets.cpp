#include "render/log/stage_sets.h"

#include <initializer_list>

namespace tenebra::render {
namespace {

StageSet set_of(std::initializer_list<double FrameTimings::*> stages) {
  StageSet set;
  for (std::size_t i = 0; i < frame_stages.size(); ++i)
    for (const auto stage : stages)
      if (frame_stages[i].value == stage) set.set(i);
  return set;
}

bool sorts_rays(Variant variant) {
  return variant == Variant::precise_sorted || variant == Variant::spheres_sorted ||
         variant == Variant::precise_sea || variant == Variant::precise_seatp;
}

/// Hard shadows; with soft ones they are for the lights without an area.
StageSet hard_stages(Variant variant) {
  using T = FrameTimings;
  StageSet stages = set_of({&T::points_ms, &T::rays_ms, &T::build_ms, &T::traverse_ms, &T::writeback_ms});
  if (sorts_rays(variant)) stages |= set_of({&T::sort_ms});
  return stages;
}

}  // namespace

StageSet asked_stages(const RenderSettings& settings, bool by_gl) {
  using T = FrameTimings;
  StageSet stages = set_of({&T::evaluate_ms, &T::raster_ms, &T::composite_ms, &T::layer_ms});
  if (by_gl) stages |= set_of({&T::readback_ms});
  if (settings.shadows != ShadowMode::none) stages |= hard_stages(settings.hard.variant);
  if (settings.shadows == ShadowMode::soft && settings.soft_points == 0)
    stages |= set_of({&T::shaft_ms, &T::init_ms, &T::query_ms, &T::irradiance_ms});
  if (settings.shadows != ShadowMode::none && settings.see_through == SeeThrough::tint)
    stages |= set_of({&T::tint_ms});
  if (settings.ao.mode != AoMode::none) stages |= set_of({&T::points_ms, &T::ao_build_ms, &T::ao_ms});
  if (settings.antialias > 1) stages |= set_of({&T::antialias_ms});
  return stages;
}

StageSet stages_run(const FrameTimings& timings) {
  StageSet stages;
  for (std::size_t i = 0; i < frame_stages.size(); ++i) stages.set(i, timings.*frame_stages[i].value > 0);
  return stages;
}

std::string stage_names(StageSet stages) {
  std::string names;
  for (std::size_t i = 0; i < frame_stages.size(); ++i)
    if (stages.test(i)) names.append(names.empty() ? "" : " ").append(frame_stages[i].name);
  return names;
}

}  // namespace tenebra::render
