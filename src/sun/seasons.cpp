#include "sun/seasons.h"

#include <algorithm>
#include <map>

#include "base/fail.h"
#include "scene/frame_parts.h"

namespace tenebra::sun {
namespace {

/// For each seasonal caster whether it casts.
using Casting = std::vector<bool>;

Casting casting_on(const std::vector<SeasonalCaster>& seasonal, std::chrono::month_day day) {
  Casting casting;
  for (const SeasonalCaster& caster : seasonal) casting.push_back(caster.season.holds(day));
  return casting;
}

/// The nodes that do not cast, with all below them.
Expected<std::vector<bool>> bare_nodes(const SeasonalScene& s, const Casting& casting) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < casting.size(); ++i)
    if (!casting[i]) names.push_back(s.seasonal[i].node);
  return nodes_called(s.scene, names);
}

Expected<void> check_nodes(const SeasonalScene& s) {
  return bare_nodes(s, Casting(s.seasonal.size(), false)).map([](const auto&) {});
}

/// Which triangles cast, and which let light pass.
struct Casters {
  std::vector<std::uint8_t> casts_shadow, see_through;
};

Casters casters_without(const SeasonalScene& s, const std::vector<bool>& bare) {
  Casters out{s.frame.casts_shadow, s.frame.see_through};
  std::size_t part = 0;
  for (std::size_t node = 0; node < s.scene.nodes.size(); ++node) {
    if (s.scene.nodes[node].mesh < 0) continue;
    const auto [first, end] = scene::triangles_of_part(s.frame, part++);
    for (std::size_t t = first; bare[node] && t < end; ++t) {
      out.casts_shadow[t] = 0;
      // 2: drawn as see-through still, but it dims nothing (FrameGeometry::see_through).
      if (!out.see_through.empty() && out.see_through[t] == 1) out.see_through[t] = 2;
    }
  }
  return out;
}

/// Of suns of a time with these casters.
Expected<SunHours> hours_when(const SeasonalScene& s, const Casting& casting, const Receivers& receivers,
                              std::span<const Sun> suns, HoursConfig config, const StopFlag* stop,
                              const QueryProgress& progress) {
  const auto bare = bare_nodes(s, casting);
  if (!bare) return tl::unexpected(bare.error());
  const Casters casters = casters_without(s, *bare);
  const auto geometry = Geometry::create(s.frame.positions, s.frame.triangles, casters.casts_shadow);
  if (!geometry) return tl::unexpected(geometry.error());
  const auto glass = glass_of(s.scene, s.frame, casters.see_through);
  if (glass) config.glass = &glass->surfaces;
  return sun_hours(*geometry, receivers.points(), receivers.ends(), suns, config, stop, progress);
}

/// `more`: of the suns that follow `before` others.
void add_hours(SunHours& to, const SunHours& more, std::int32_t before) {
  const auto add = [](std::vector<double>& sums, const std::vector<double>& others) {
    for (std::size_t i = 0; i < others.size(); ++i) sums[i] += others[i];
  };
  add(to.sums, more.sums), add(to.months, more.months), add(to.light, more.light);
  for (std::size_t i = 0; i < to.first.size(); ++i) {
    if (more.first[i] < 0) continue;
    if (to.first[i] < 0) to.first[i] = before + more.first[i];
    to.last[i] = before + more.last[i];
  }
}

/// The part that is done, where [first, end) of `all` is being done.
QueryProgress progress_within(const QueryProgress& progress, std::size_t first, std::size_t end,
                              std::size_t all) {
  if (!progress) return {};
  return [=](double done) {
    progress((static_cast<double>(first) + done * static_cast<double>(end - first)) /
             static_cast<double>(all));
  };
}

}  // namespace

std::unique_ptr<const FrameGlass> glass_of(const Scene& scene, const FrameGeometry& frame,
                                           std::span<const std::uint8_t> see_through) {
  if (std::ranges::count(see_through, 1) == 0) return nullptr;
  auto glass = std::make_unique<FrameGlass>();
  glass->coordinates = surface_coordinates(scene);
  glass->surfaces = see_through_surfaces(scene, frame, glass->coordinates);
  glass->surfaces.see_through = see_through;
  return glass;
}

Expected<SeasonalCaster> parse_seasonal(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals == text.npos || equals == 0)
    return base::fail("found {}, expected NODE=FIRST:LAST, like leaves=4:10", text);
  return parse_season(text.substr(equals + 1)).map([&](Season season) {
    return SeasonalCaster{text.substr(0, equals), season};
  });
}

Expected<SunHours> hours_of(const SeasonalScene& scene, const Receivers& receivers, const Suns& suns,
                            HoursConfig config, const StopFlag* stop, const QueryProgress& progress) {
  config.light = suns.kind == SunKind::radiation;
  if (auto checked = check_nodes(scene); !checked) return tl::unexpected(checked.error());
  const auto casting_of = [&](std::size_t sun) {
    return casting_on(scene.seasonal, day_of_year(suns.list[sun].utc_s, suns.zone_min));
  };
  const std::size_t count = suns.list.size();
  if (count == 0)
    return hours_when(scene, Casting(scene.seasonal.size(), true), receivers, {}, config, stop, progress);
  Expected<SunHours> all;
  for (std::size_t first = 0, end = 0; first < count; first = end) {
    const Casting casting = casting_of(first);
    while (end < count && casting_of(end) == casting) ++end;
    auto hours = hours_when(scene, casting, receivers, std::span(suns.list).subspan(first, end - first),
                            config, stop, progress_within(progress, first, end, count));
    if (!hours) return hours;
    if (first == 0)
      all = std::move(hours);
    else
      add_hours(*all, *hours, static_cast<std::int32_t>(first));
  }
  return all;
}

Expected<SkyLight> sky_of(const SeasonalScene& scene, const Receivers& receivers, const Suns& suns,
                          const std::vector<Sun>& patches, HoursConfig config, const StopFlag* stop,
                          const QueryProgress& progress) {
  if (auto checked = check_nodes(scene); !checked) return tl::unexpected(checked.error());
  std::map<Casting, double> lights;  // of the days with these casters
  for (const auto& [day, light] : suns.diffuse_wh_m2) lights[casting_on(scene.seasonal, day)] += light;
  if (suns.kind != SunKind::radiation) lights[Casting(scene.seasonal.size(), true)] = 1;
  SkyLight sky{std::vector<double>(receivers.list.size()), patches.size()};
  config.disc_deg = 0, config.months = false, config.light = true;
  std::size_t number = 0;
  for (const auto& [casting, light] : lights) {
    const auto share = hours_when(scene, casting, receivers, patches, config, stop,
                                  progress_within(progress, number, number + 1, lights.size()));
    if (!share) return tl::unexpected(share.error());
    for (std::size_t i = 0; i < sky.light.size(); ++i) sky.light[i] += light * share->light[i];
    ++number;
  }
  return sky;
}

}  // namespace tenebra::sun
