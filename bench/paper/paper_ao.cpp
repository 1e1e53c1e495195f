// The experiments of Gaitatzes et al. 2010: Figures 4 and 7 (bits), 5 (mappings), 6 (sizes of tables), 8
// (objects), and 1 bit for far objects with 8 for near ones.
#include "bench/paper/paper_ao.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>

#include "bench/ao/ao_race.h"
#include "bench/common/bench_plot.h"
#include "bench/paper/paper_session.h"

namespace tenebra::bench {
namespace {

constexpr FieldLayout paper_layout = FieldLayout::positions_directions;
constexpr int paper_rays = 256;  // per point
constexpr std::array<int, 3> position_counts{289, 1089, 4225};
constexpr std::array<int, 4> direction_sides{16, 32, 64, 128};

/// One object in the paper's corner, with what many rays say of the walls.
struct Corner {
  const Object& object;
  ObjectTree tree;
  AoPeer peer;
  std::vector<Receiver> receivers;
  std::vector<float> truth;
  std::vector<trees::RayBatch> rays;

  Corner(const Object& of, int truth_rays)
      : object(of), tree(of), peer(of), receivers(corner_receivers(tree.ball)) {
    truth = values(CosineRays(truth_rays, 1), peer.packets(false));
    rays = batches_towards(receivers, CosineRays(paper_rays, 2), tree.ball.centre, tree.ball.radius);
  }
  std::vector<float> values(const CosineRays& of, const Tracer& tracer) const {
    return occlusion(receivers, of, static_cast<float>(2 * tree.ball.radius), tracer);
  }
};

Expected<FieldCost> field_cost(const Corner& corner, const ao::FieldSettings& settings, int rounds) {
  const auto built = build_field(corner.object, corner.tree, settings, Inside::first_hit);
  if (!built) return tl::unexpected(built.error());
  FieldCost cost;
  cost.positions = static_cast<int>((*built)->field.shape.positions());
  cost.side = (*built)->field.shape.direction_side, cost.bits = settings.bits;
  cost.name = fmt::format("{} / {}x{}, {} bits", cost.positions, cost.side, cost.side, cost.bits);
  cost.bytes = static_cast<double>((*built)->field.shape.bytes), cost.build_ms = (*built)->build_ms;
  const Tracer tracer = field_tracer(**built);
  const auto values = corner.values(CosineRays(paper_rays, 2), tracer);
  cost.rms = rms_255(values, corner.truth);
  for (std::size_t i = 0; i < values.size(); ++i)
    cost.brighter +=
        255 * static_cast<double>(corner.truth[i] - values[i]) / static_cast<double>(values.size());
  std::vector<double> times;
  for (int i = 0; i < rounds; ++i) times.push_back(trace_ms(corner.rays, tracer));
  cost.lookup_ms = median(times);
  return cost;
}

Expected<void> measure_tables(PaperSession& session, const Corner& corner, AoFindings& found) {
  const int rounds = session.by_effort(1, 3, 5);
  for (const int positions : position_counts) {
    for (const int side : direction_sides) {
      if (session.effort == Effort::tiny && (positions == 4225 || side > 32)) continue;
      if (session.effort == Effort::quick && side > 64) continue;
      progress(fmt::format("{}: {} maps of {}x{}", corner.object.name, positions, side, side));
      auto cost = field_cost(corner, {paper_layout, positions, side * side, 8}, rounds);
      if (!cost) return tl::unexpected(cost.error());
      found.figure6.push_back(std::move(*cost));
    }
  }
  for (const int bits : {32, 8, 1}) {
    const int positions = session.by_effort(289, 4225, 4225), side = session.by_effort(16, 64, 64);
    auto cost = field_cost(corner, {paper_layout, positions, side * side, bits}, rounds);
    if (!cost) return tl::unexpected(cost.error());
    found.bits.push_back(std::move(*cost));
  }
  const int position_side = session.by_effort(17, 33, 33), side = session.by_effort(16, 64, 64);
  for (const DirectionMap map : direction_maps) {
    progress(fmt::format("{}: {} map", corner.object.name, direction_map_name(map)));
    const MappedField field(corner.peer, corner.tree.ball, map, position_side, side);
    const auto values = corner.values(CosineRays(paper_rays, 2),
                                      [&](auto rays, float* distances) { field.nearest(rays, distances); });
    found.maps.push_back({map, rms_255(values, corner.truth)});
  }
  found.unused = unused_cells(DirectionMap::rejection, 128);
  return {};
}

Expected<void> measure_growth_of(PaperSession& session, AoFindings& found) {
  const Object coarse = make_knot(64, 8);  // 1,024 triangles
  for (int times = 0; times <= session.by_effort(1, 3, 5); ++times) {
    const Object object = subdivided(coarse, times);
    progress(fmt::format("knot: {} triangles", object.triangles.size()));
    const Corner corner(object, 256);
    auto cost = field_cost(corner, {paper_layout, session.by_effort(289, 4225, 4225), 1024, 8},
                           session.by_effort(1, 3, 5));
    if (!cost) return tl::unexpected(cost.error());
    found.growth.push_back({static_cast<double>(object.triangles.size()),
                            static_cast<double>(corner.rays.size()) * trees::batch_size, cost->bytes,
                            cost->build_ms, cost->lookup_ms,
                            trace_ms(corner.rays, corner.peer.packets(false))});
  }
  return {};
}

/// Four near and four far objects in a row, three diameters apart, and the points of their corners' floors.
Expected<void> measure_mixed(PaperSession& session, const Corner& corner, AoFindings& found) {
  const int positions = session.by_effort(289, 4225, 4225);
  const auto eight =
      build_field(corner.object, corner.tree, {paper_layout, positions, 1024, 8}, Inside::first_hit);
  const auto one =
      build_field(corner.object, corner.tree, {paper_layout, positions, 1024, 1}, Inside::first_hit);
  if (!eight || !one) return tl::unexpected((!eight ? eight : one).error());
  constexpr int count = 8;
  const auto nearest_hits = ao::field_kernels(SimdLevel::automatic).nearest_hits;
  std::vector<glm::dmat4> places;
  for (int i = 0; i < count; ++i)
    places.push_back(glm::translate(glm::dmat4(1.0), glm::dvec3(6 * corner.tree.ball.radius * i, 0, 0)));
  const auto tracer_of = [&](int near) {
    std::vector<ao::FieldInstance> instances;
    for (int i = 0; i < count; ++i) {
      const auto placed = ao::place_field(i < near ? (*eight)->field : (*one)->field, nullptr,
                                          places[static_cast<std::size_t>(i)], ao::FieldEnds::first);
      if (placed) instances.push_back(*placed);
    }
    return [=](std::span<const trees::RayBatch> rays, float* distances) {
      for (const ao::FieldInstance& instance : instances) nearest_hits(instance, rays, distances);
    };
  };
  const auto exact = [&](std::span<const trees::RayBatch> rays, float* distances) {
    std::vector<trees::RayBatch> moved(rays.begin(), rays.end());
    for (const glm::dmat4& place : places) {
      for (std::size_t b = 0; b < rays.size(); ++b)
        for (int i = 0; i < trees::batch_size; ++i)
          moved[b].set(i, rays[b].origin(i) - glm::vec3(place[3]), rays[b].direction(i));
      corner.peer.packets(false)(moved, distances);
    }
  };
  const auto floor_of = [&](int object) {
    std::vector<Receiver> receivers;
    for (Receiver r : corner.receivers) {
      if (r.normal.y < 0.5f) continue;
      r.position += glm::vec3(places[static_cast<std::size_t>(object)][3]);
      receivers.push_back(r);
    }
    return receivers;
  };
  const CosineRays rays(paper_rays, 2);
  const auto reach = static_cast<float>(2 * corner.tree.ball.radius);
  const auto error = [&](int object, int near) {
    const auto at = floor_of(object);
    return rms_255(occlusion(at, rays, reach, tracer_of(near)), occlusion(at, rays, reach, exact));
  };
  found.mixed = {static_cast<double>((*eight)->field.shape.bytes),
                 static_cast<double>((*one)->field.shape.bytes), error(1, 4), error(6, 4), error(6, count)};
  return {};
}

Rows field_rows(const std::vector<FieldCost>& fields) {
  Rows rows{{"table", "MB", "build s", "look-ups ms", "RMS /255"}};
  for (const FieldCost& f : fields)
    rows.push_back({f.name, fmt::format("{:.2f}", f.bytes / 1e6), fmt::format("{:.2f}", f.build_ms / 1e3),
                    fmt::format("{:.2f}", f.lookup_ms), fmt::format("{:.2f}", f.rms)});
  return rows;
}

PaperSection ao_section_of(const PaperSession& session, const AoFindings& found) {
  PaperSection section;
  section.title = ao_title;
  section.setup = fmt::format(
      "The paper's fields (`--paper ao-layout=positions`): maps of distances at positions on the bounding "
      "sphere. "
      "{} in the paper's corner of three walls of 33x33 points outside of the sphere, 256 rays per point; "
      "errors against {} rays per point, RMS in 1/255. Positions are cells of an octahedral map (the "
      "paper's: "
      "Slater's triangles), so 289, 1,089 and 4,225 stand for 290, 1,090 and 4,226. Figure 5's maps: the "
      "same table in float, with directions laid out in three ways.",
      found.object, counted(session.by_effort(256, 4096, 4096)));
  section.claims = ao_claims(found);
  Rows maps{{"map of directions", "RMS /255"}};
  for (const MapError& m : found.maps)
    maps.push_back({direction_map_name(m.map), fmt::format("{:.2f}", m.rms)});
  Rows growth{{"triangles", "build s", "look-ups ms", "Embree ms"}};
  Curve lookups{"field", {}}, rays{"Embree's packets", {}};
  for (const GrowthCost& g : found.growth) {
    growth.push_back({counted(g.triangles), fmt::format("{:.2f}", g.build_ms / 1e3),
                      fmt::format("{:.2f}", g.lookup_ms), fmt::format("{:.2f}", g.ray_ms)});
    lookups.points.emplace_back(g.triangles, g.lookup_ms), rays.points.emplace_back(g.triangles, g.ray_ms);
  }
  section.tables = {{"Figure 5", maps},
                    {"Figure 6", field_rows(found.figure6)},
                    {"Figures 4 and 7", field_rows(found.bits)},
                    {"Figure 8, one knot subdivided", growth}};
  Bars bars{"RMS", {}};
  std::vector<std::string> names;
  for (const MapError& m : found.maps)
    names.emplace_back(direction_map_name(m.map)), bars.values.push_back(m.rms);
  section.plots.emplace_back("ao_figure5",
                             bar_plot("Figure 5: maps of directions", {"RMS (1/255)"}, names, {bars}));
  std::vector<Curve> sizes;
  for (const FieldCost& f : found.figure6) {
    const std::string name = fmt::format("{} positions", f.positions);
    if (sizes.empty() || sizes.back().name != name) sizes.push_back({name, {}});
    sizes.back().points.emplace_back(f.side, f.rms);
  }
  section.plots.emplace_back(
      "ao_figure6",
      curve_plot("Figure 6: sizes of tables", {"directions each way", true}, {"RMS (1/255)", true}, sizes));
  section.plots.emplace_back("ao_figure8", curve_plot("Figure 8: the corner's rays", {"triangles", true},
                                                      {"time (ms)", true}, {lookups, rays}));
  return section;
}

}  // namespace

Expected<void> measure_paper_ao(PaperSession& session) {
  std::vector<std::string> notes;
  const auto objects = error_objects(session.options.data, notes);
  if (!objects) return tl::unexpected(objects.error());
  const auto bunny =
      std::find_if(objects->begin(), objects->end(), [](const Object& o) { return o.name == "bunny"; });
  const Object& object = bunny != objects->end() && session.effort != Effort::tiny ? *bunny : (*objects)[1];
  AoFindings found;
  found.object = object.name;
  const Corner corner(object, session.by_effort(256, 4096, 4096));
  if (auto done = measure_tables(session, corner, found); !done) return done;
  if (auto done = measure_growth_of(session, found); !done) return done;
  if (auto done = measure_mixed(session, corner, found); !done) return done;
  session.finish(ao_section_of(session, found));
  return {};
}

}  // namespace tenebra::bench
