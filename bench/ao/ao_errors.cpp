// Figure 6 of the paper as a table and picture sheets, and what smaller tables cost in error.
#include <fmt/core.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "bench/ao/ao_contestants.h"
#include "bench/ao/ao_race.h"
#include "bench/ao/ao_session.h"
#include "bench/ao/ao_sheet.h"
#include "bench/common/bench_plot.h"

namespace tenebra::bench {
namespace {

constexpr int ray_count = 256;  // per point
constexpr std::array position_counts{289, 1089, 4225};
constexpr std::array direction_sides{16, 32, 64, 128};

/// One object with its receivers and what Embree says of them.
struct Subject {
  const Object& object;
  ObjectTree tree;
  AoPeer peer;
  std::vector<Receiver> corner, floor, air;
  std::vector<float> corner_truth, floor_truth, air_truth;
  std::vector<trees::RayBatch> corner_rays;  // those that may meet the sphere

  Subject(const Object& of, const AoSession& session) : object(of), tree(of), peer(of) {
    const CosineRays many(session.by_effort(256, 4096, 4096), 1), few(ray_count, 2);
    corner = corner_receivers(tree.ball);
    floor = floor_receivers(object, tree.ball);
    air = air_receivers(tree.ball, peer, session.by_effort(50, 1000, 1000), 3);
    const auto truth = [&](const std::vector<Receiver>& at) {
      return occlusion(at, many, diameter(), peer.packets(false));
    };
    corner_truth = truth(corner), floor_truth = truth(floor), air_truth = truth(air);
    corner_rays = batches_towards(corner, few, tree.ball.centre, tree.ball.radius);
  }
  float diameter() const { return static_cast<float>(2 * tree.ball.radius); }
};

struct Errors {
  double outside = 0, floor = 0, air = 0, inside = 0;
  std::vector<float> corner;  // what was found there
  double lookup_ms = 0;
};

/// Values have to be 0..1; says so where they are not.
void check_range(AoSession& session, const std::string& where, std::span<const float> values) {
  const auto bad = std::count_if(values.begin(), values.end(), [](float v) { return !(v >= 0 && v <= 1); });
  if (bad != 0) session.notes.push_back(fmt::format("{}: {} values are not within 0..1", where, bad));
}

Errors errors_of(AoSession& session, const Subject& subject, const Tracer& tracer, const std::string& name) {
  const CosineRays few(ray_count, 2);
  const auto found = [&](const std::vector<Receiver>& at) {
    auto values = occlusion(at, few, subject.diameter(), tracer);
    check_range(session, subject.object.name + ", " + name, values);
    return values;
  };
  Errors e;
  e.corner = found(subject.corner);
  e.outside = rms_255(e.corner, subject.corner_truth);
  e.floor = rms_255(found(subject.floor), subject.floor_truth);
  e.air = rms_255(found(subject.air), subject.air_truth);
  const auto floors = static_cast<double>(subject.floor.size()),
             airs = static_cast<double>(subject.air.size());
  e.inside = std::sqrt((floors * e.floor * e.floor + airs * e.air * e.air) / (floors + airs));
  std::vector<double> times;
  for (int i = 0; i < session.by_effort(1, 3, 5); ++i) times.push_back(trace_ms(subject.corner_rays, tracer));
  e.lookup_ms = median(times);
  return e;
}

void add_figures(AoSession& session, const std::string& experiment, const Subject& subject,
                 const std::string& name, const BuiltField* built, const Errors& e) {
  const auto add = [&](const char* quantity, double value, const char* unit) {
    session.report.add({experiment, subject.object.name, name, "rays=256", quantity, value, unit});
  };
  if (built != nullptr) {
    add("build", built->build_ms, "ms");
    add("bytes", static_cast<double>(built->field.bytes()), "bytes");
  }
  add("lookup", e.lookup_ms, "ms");
  add("rms outside", e.outside, "1/255");
  add("rms floor", e.floor, "1/255");
  add("rms air", e.air, "1/255");
  add("rms inside", e.inside, "1/255");
}

std::vector<std::string> row_of(const std::string& name, const BuiltField* built, const Errors& e) {
  const auto number = [](double v) { return fmt::format("{:.2f}", v); };
  return {name,
          built == nullptr ? "" : number(static_cast<double>(built->field.bytes()) / 1e6),
          built == nullptr ? "" : number(built->build_ms / 1e3),
          number(e.lookup_ms),
          number(e.outside),
          number(e.floor),
          number(e.air),
          number(e.inside)};
}
const std::vector<std::string> head{"table",   "MB",    "build s", "look-up ms",
                                    "outside", "floor", "air",     "inside"};

/// Error of 256 exact rays: what no table can fall below.
void add_noise(AoSession& session, const Subject& subject, std::vector<std::vector<std::string>>& rows) {
  const Errors e = errors_of(session, subject, subject.peer.packets(false), "embree");
  add_figures(session, "figure6", subject, "embree, 256 rays", nullptr, e);
  rows.push_back(row_of("embree, 256 rays", nullptr, e));
}

/// Whether this cell is among those of a quick run: all of them for the first object, what the promises
/// speak of for the others.
bool wanted(const AoSession& session, bool first, int positions, int side) {
  const bool promised = positions == 4225 && side == 32;
  if (session.effort == Effort::tiny) return positions == 289 && side == 16;
  return promised || session.effort == Effort::full || (first && side <= 64);
}

Expected<void> figure6_layout(AoSession& session, const Subject& subject, bool first, FieldLayout layout,
                              std::vector<std::vector<std::string>>& rows, Curve& curve) {
  Sheet sheet(subject.tree.ball, subject.peer, subject.corner_truth);
  for (const int positions : position_counts) {
    for (const int side : direction_sides) {
      if (!wanted(session, first, positions, side)) continue;
      const auto built = build_field(subject.object, subject.tree, {layout, positions, side * side, 8});
      if (!built) return tl::unexpected(built.error());
      const std::string name = shape_name((*built)->field);
      const auto known = [&](const std::vector<std::string>& row) { return row[0] == name; };
      if (std::any_of(rows.begin(), rows.end(), known)) continue;  // 1,089 x 16^2 chords are 289 x 32^2
      const Errors e = errors_of(session, subject, field_tracer(**built), name);
      add_figures(session, "figure6", subject, name, built->get(), e);
      rows.push_back(row_of(name, built->get(), e));
      curve.points.emplace_back(static_cast<double>((*built)->field.bytes()) / 1e6, e.outside);
      sheet.add(e.corner, fmt::format("{} {}x{}", positions, side, side),
                fmt::format("{:.2f}s {:.1f}ms {:.2f}", (*built)->build_ms / 1e3, e.lookup_ms, e.outside));
    }
  }
  std::string file =
      fmt::format("figure6_{}_{}", subject.object.name, layout == FieldLayout::chords ? "chords" : "paper");
  std::replace(file.begin(), file.end(), ' ', '_');
  session.pictures.emplace_back(file, sheet.picture());
  return {};
}

struct Variant {
  std::string name;
  ao::FieldSettings settings;
  Inside inside = Inside::near_rays;
};
std::vector<Variant> variants() {
  constexpr FieldLayout chords = FieldLayout::chords, paper = FieldLayout::positions_directions;
  return {{"chords 8 bit (default)", {chords, 4225, 1024, 8}},
          {"chords 1 bit", {chords, 4225, 1024, 1}},
          {"chords 32 bit", {chords, 4225, 1024, 32}},
          {"chords sparse, 8 bit", ao::sparse_field},
          {"chords 8 bit, no near rays", {chords, 4225, 1024, 8}, Inside::both_ends},
          {"chords 8 bit, first hit only", {chords, 4225, 1024, 8}, Inside::first_hit},
          {"paper 8 bit", {paper, 4225, 1024, 8}},
          {"paper 1 bit", {paper, 4225, 1024, 1}},
          {"paper 32 bit", {paper, 4225, 1024, 32}},
          {"paper 8 bit, no near rays", {paper, 4225, 1024, 8}, Inside::both_ends},
          {"paper 8 bit, first hit only", {paper, 4225, 1024, 8}, Inside::first_hit}};
}

/// The promises are for all objects but the hard one.
void keep_headline(AoSession& session, const std::string& variant, const BuiltField& built, const Errors& e) {
  if (variant == "chords 8 bit (default)") {
    keep_largest(session.headline.outside_rms_255, e.outside);
    keep_largest(session.headline.inside_rms_255, e.inside);
    keep_largest(session.headline.bytes, static_cast<double>(built.field.bytes()));
  } else if (variant == "paper 8 bit") {
    keep_largest(session.headline.paper_rms_255, e.outside);
  }
}

Expected<void> memory_table(AoSession& session, const Subject& subject) {
  std::vector<std::vector<std::string>> rows{head};
  for (const Variant& variant : variants()) {
    ao::FieldSettings settings = variant.settings;
    if (session.effort == Effort::tiny) settings.positions = 64, settings.directions = 64;
    const auto built = build_field(subject.object, subject.tree, settings, variant.inside);
    if (!built) return tl::unexpected(built.error());
    const Errors e = errors_of(session, subject, field_tracer(**built), variant.name);
    add_figures(session, "memory", subject, variant.name, built->get(), e);
    rows.push_back(row_of(variant.name, built->get(), e));
    if (subject.object.name != "flake") keep_headline(session, variant.name, **built, e);
  }
  print_table(fmt::format("Bytes and errors (RMS in 1/255), {}", subject.object.name), rows);
  return {};
}

}  // namespace

Expected<void> measure_errors(AoSession& session) {
  const auto objects = error_objects(session.options.data, session.notes);
  if (!objects) return tl::unexpected(objects.error());
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < objects->size(); ++i) {
    if (session.effort == Effort::tiny && i != 1) continue;
    const Object& object = (*objects)[i];
    progress(fmt::format("errors: {}, {} triangles", object.name, object.triangles.size()));
    const Subject subject(object, session);
    std::vector<std::vector<std::string>> rows{head};
    add_noise(session, subject, rows);
    for (const FieldLayout layout : {FieldLayout::chords, FieldLayout::positions_directions}) {
      curves.push_back({object.name + (layout == FieldLayout::chords ? ", chords" : ", paper"), {}});
      if (auto done = figure6_layout(session, subject, i == 0, layout, rows, curves.back()); !done)
        return done;
    }
    print_table(fmt::format("Figure 6: {} ({} triangles); RMS in 1/255 against {} rays", object.name,
                            object.triangles.size(), session.by_effort(256, 4096, 4096)),
                rows);
    if (auto done = memory_table(session, subject); !done) return done;
  }
  session.report.add_plot(
      "figure6", curve_plot("Error outside the sphere", {"table (MB)", true}, {"RMS (1/255)", true}, curves));
  return {};
}

}  // namespace tenebra::bench
