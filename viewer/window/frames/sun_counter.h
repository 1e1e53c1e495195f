// How many hours of a day the sun reaches each pixel of a picture, as colours.
#pragma once

#include "window/frames/frame_request.h"
#include "window/frames/one_job.h"
#include "window/frames/sun_day.h"

namespace tenebra::viewer {

struct SunQuestion {
  std::shared_ptr<const Picture> picture;
  SunDay day;
  std::shared_ptr<const sun::Suns> suns;  ///< of that day
};

struct CountedSun {
  SunQuestion asked;
  io::Image8 image;  ///< RGBA of the picture's size, or of a part of its pixels; clear where nothing is seen
  double least_h = 0, most_h = 0, mean_h = 0;  ///< of the pixels; colours go from 0 to most_h
};

using SunCounter = OneJob<SunQuestion, CountedSun>;

/// At most 2^18 points are asked about: of larger pictures each second pixel, or fewer.
Expected<CountedSun> count_sun(const SunQuestion& question, const SunCounter::Progress& progress,
                               const StopFlag& stop);

/// Both see the same triangles from the same place: the hours of one are those of the other.
bool same_hours(const Picture& a, const Picture& b);

}  // namespace tenebra::viewer
