#include "window/frames/sun_counter.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <tenebra/threads.h>
#include "session/session.h"
#include "sun/colour_scale.h"
#include "sun/seasons.h"

namespace tenebra::viewer {
namespace {

constexpr int most_pixels = 1 << 18;

/// The pixels that are asked about: all, or those at whole multiples of `step`.
struct Lattice {
  int step = 1, width = 0, height = 0;

  explicit Lattice(Size size) {
    const int most_step = std::max(std::min(size.width, size.height), 1);  // narrow pictures keep a column
    while (step < most_step && (size.width / step + 1) * (size.height / step + 1) > most_pixels) ++step;
    width = size.width / step, height = size.height / step;
  }
  std::size_t pixel(int x, int y, int picture_width) const {
    const int middle = step / 2;
    return static_cast<std::size_t>(y * step + middle) * static_cast<std::size_t>(picture_width) +
           static_cast<std::size_t>(x * step + middle);
  }
};

/// Points of the lattice that see a triangle, and where in it they are.
struct SeenPoints {
  std::vector<glm::dvec3> positions;
  std::vector<std::uint32_t> triangles;
  std::vector<std::int8_t> sides;
  std::vector<std::uint32_t> cells;
};

SeenPoints points_of(const Picture& picture, const Lattice& lattice, const FrameGeometry& geometry) {
  const std::vector<std::uint32_t>& ids = picture.evidence.ids;
  const int width = picture.a.result.image.width, height = picture.a.result.image.height;
  const TriangleView triangles = triangle_view(geometry);
  VisiblePoints visible;
  compute_visible_points(ids, width, height, picture.view, triangles, visible);
  SeenPoints out;
  for (int y = 0; y < lattice.height; ++y)
    for (int x = 0; x < lattice.width; ++x) {
      const std::size_t pixel = lattice.pixel(x, y, width);
      if (visible.triangles[pixel] >= geometry.triangles.size()) continue;
      const int side = visible_side(visible, triangles, pixel);
      if (side == 0) continue;
      out.positions.push_back(visible_position(visible, triangles, pixel));
      out.triangles.push_back(visible.triangles[pixel]);
      out.sides.push_back(static_cast<std::int8_t>(side));
      out.cells.push_back(static_cast<std::uint32_t>(y * lattice.width + x));
    }
  return out;
}

void paint(const SeenPoints& points, const std::vector<double>& minutes, CountedSun& out) {
  double sum = 0;
  out.least_h = minutes.empty() ? 0 : HUGE_VAL;
  for (const double each : minutes) {
    sum += each / 60;
    out.least_h = std::min(out.least_h, each / 60), out.most_h = std::max(out.most_h, each / 60);
  }
  out.mean_h = minutes.empty() ? 0 : sum / static_cast<double>(minutes.size());
  const sun::ColourScale scale{out.most_h > 0 ? out.most_h : 1};
  for (std::size_t i = 0; i < minutes.size(); ++i) {
    const glm::vec3 colour = 255.0f * scale(minutes[i] / 60) + 0.5f;
    std::uint8_t* const pixel = &out.image.pixels[std::size_t{4} * points.cells[i]];
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(colour[c]);
    pixel[3] = 255;
  }
}

Expected<CountedSun> count(const SunQuestion& question, const SunCounter::Progress& progress,
                           const StopFlag& stop) {
  const Picture& picture = *question.picture;
  const PictureEvidence& evidence = picture.evidence;
  render::FrameInput input;
  session::evaluate(picture.scene->scene, evidence.edits, evidence.clip, evidence.time_s, input);
  FrameGeometry& frame = input.geometry;
  cast_see_through(evidence.settings.see_through, frame);
  const Size size{picture.a.result.image.width, picture.a.result.image.height};
  const Lattice lattice(size);
  const SeenPoints points = points_of(picture, lattice, frame);
  const auto geometry = Geometry::create(frame.positions, frame.triangles, frame.casts_shadow);
  if (!geometry) return tl::unexpected(geometry.error());
  const auto glass = sun::glass_of(picture.scene->scene, frame, frame.see_through);
  sun::HoursConfig config;
  config.hard = evidence.settings.hard;
  if (glass) config.glass = &glass->surfaces;
  std::vector<std::uint32_t> ends;
  for (std::size_t i = 0; i < points.positions.size(); ++i) ends.push_back(static_cast<std::uint32_t>(i + 1));
  const QueryPoints asked{
      .positions = points.positions, .triangles = points.triangles, .sides = points.sides};
  const auto hours = sun::sun_hours(*geometry, asked, ends, question.suns->list, config, &stop, progress);
  if (!hours) return tl::unexpected(hours.error());
  CountedSun out{question, {lattice.width, lattice.height, 4, {}}};
  out.image.pixels.resize(std::size_t{4} * static_cast<std::size_t>(lattice.width) *
                          static_cast<std::size_t>(lattice.height));
  out.covered = {static_cast<float>(lattice.width * lattice.step) / static_cast<float>(size.width),
                 static_cast<float>(lattice.height * lattice.step) / static_cast<float>(size.height)};
  paint(points, hours->sums, out);
  return out;
}

}  // namespace

Expected<CountedSun> count_sun(const SunQuestion& question, const SunCounter::Progress& progress,
                               const StopFlag& stop) {
  Expected<CountedSun> counted;
  with_threads(question.picture->evidence.settings.threads,
               [&] { counted = count(question, progress, stop); });
  return counted;
}

bool same_casters(const Picture& a, const Picture& b) {
  const PictureEvidence &e = a.evidence, &f = b.evidence;
  const auto rules = [](const render::RenderSettings& of) {
    return std::tuple(of.see_through, of.hard.cull_front, of.hard.contact);
  };
  return a.scene == b.scene && e.clip == f.clip && e.time_s == f.time_s && e.edits.nodes == f.edits.nodes &&
         rules(e.settings) == rules(f.settings);
}

bool same_hours(const Picture& a, const Picture& b) {
  const ViewRays &v = a.view, &w = b.view;
  return same_casters(a, b) && v.eye == w.eye && v.d0 == w.d0 && v.dx == w.dx && v.dy == w.dy &&
         v.orthographic == w.orthographic && a.evidence.ids.size() == b.evidence.ids.size();
}

}  // namespace tenebra::viewer
