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
  glm::vec2 covered{1.0f};  ///< by `image`, of the picture's width and height, from its left and top
  double least_h = 0, most_h = 0, mean_h = 0;  ///< of the pixels; colours go from 0 to most_h
};

using SunCounter = OneJob<SunQuestion, CountedSun>;

/// At most 2^18 points are asked about: of larger pictures each second pixel, or fewer. See-through surfaces,
/// hard shadows and threads are as the picture's settings say.
Expected<CountedSun> count_sun(const SunQuestion& question, const SunCounter::Progress& progress,
                               const StopFlag& stop);

/// The same triangles cast the same shadows in both.
bool same_casters(const Picture& a, const Picture& b);
/// And they see them through the same pixels: the hours of one are those of the other.
bool same_hours(const Picture& a, const Picture& b);

}  // namespace tenebra::viewer
