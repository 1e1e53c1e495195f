#include "options/sun_options.h"

#include <algorithm>
#include <initializer_list>
#include <variant>

#include "base/fail.h"
#include "base/lower_case.h"
#include "formats/format_list.h"
#include "options/memory_option.h"
#include "options/settings_names.h"
#include "sun/sky.h"

namespace tenebra::viewer {
namespace {

constexpr const char* output_group = "What to write";
constexpr const char* sun_group = "Suns";
constexpr const char* where_group = "Where";

Expected<sun::Place> parse_place_on_earth(const std::string& text) {
  const auto parts = split(text, ',');
  const auto latitude = finite_from(parts[0]),
             longitude = parts.size() == 2 ? finite_from(parts[1]) : std::nullopt;
  if (!latitude || !longitude)
    return base::fail("found {}, expected degrees of latitude and longitude, like 48.14,11.58", text);
  if (*latitude < -90 || *latitude > 90)
    return base::fail("found the latitude {}, expected -90 to 90 degrees; latitude comes first", *latitude);
  if (*longitude < -180 || *longitude > 180)
    return base::fail("found the longitude {}, expected -180 to 180 degrees, east positive", *longitude);
  return sun::Place{*latitude, *longitude};
}

Expected<std::variant<sun::Days, sun::Season>> parse_days_or_season(const std::string& text) {
  using Days = std::variant<sun::Days, sun::Season>;
  if (const auto season = sun::parse_season(text)) return Days(*season);
  const auto days = sun::parse_days(text);
  if (!days)
    return base::fail(
        "{}; --place takes days of a year, like 2026-04-01:2026-09-30, --epw those of any, like 4:9 or "
        "04-01:09-30",
        days.error().message);
  return Days(*days);
}

Expected<sun::Days> parse_one_day(const std::string& text) {
  return sun::parse_day(text).map([](sun::Day day) { return sun::Days{day, day, 1}; });
}

Expected<double> parse_number_within(const std::string& text, double low, double high, const char* expected) {
  const auto number = finite_from(text);
  if (!number || *number < low || *number > high) return base::fail("found {}, expected {}", text, expected);
  return *number;
}
Expected<double> parse_step(const std::string& text) {
  return parse_number_within(text, 0.1, 240, "0.1 to 240 minutes");
}
Expected<double> parse_turn(const std::string& text) {
  return parse_number_within(text, -360, 360, "-360 to 360 degrees");
}
Expected<double> parse_disc(const std::string& text) {
  return parse_number_within(text, 0, 90, "0 to 90 degrees");
}
Expected<double> parse_height(const std::string& text) {
  return parse_number_within(text, -1e9, 1e9, "a height");
}
Expected<double> parse_cell(const std::string& text) {
  return parse_number_within(text, 1e-3, 1e6, "0.001 to 1000000 metres");
}
Expected<int> parse_epsg(const std::string& text) {
  const auto number = parse_count(text);
  const bool in_degrees = number && (*number == 4326 || *number == 4258 || *number == 4269);
  if (!number || *number < 1024 || *number > 32766 || in_degrees)
    return base::fail("found {}{}, expected the number of a projected system of EPSG's, like 25832", text,
                      in_degrees ? ", which is in degrees" : "");
  return *number;
}
Expected<int> parse_per_face(const std::string& text) {
  const auto number = parse_count(text);
  if (!number || *number < 1 || *number > 65536)
    return base::fail("found {}, expected 1 to 65536 points", text);
  return *number;
}

auto read_seasons(SunOptions& options) {
  return [&options](const std::vector<std::string>& texts) -> Expected<void> {
    for (const std::string& text : texts) {
      auto caster = sun::parse_seasonal(text);
      if (!caster) return tl::unexpected(caster.error());
      options.seasonal.push_back(std::move(*caster));
    }
    return {};
  };
}

void add_outputs(CLI::App& command, SunOptions& options) {
  const AddedOption added[] = {
      add_text(command, "--output,-o", options.model,
               "The model in the colours of its hours, which are the\nattribute _SUN_HOURS of its vertices")
          .type_name("FILE.glb"),
      add_text(command, "--csv", options.csv, "A table").type_name("FILE.csv"),
      add_text(command, "--json", options.json, "The same as JSON").type_name("FILE.json"),
      add_text(command, "--png", options.plan, "A plan of the ground with scale and legend")
          .type_name("FILE"),
      add_text(command, "--tiff", options.raster, "The ground as a GeoTIFF in the file's coordinates")
          .type_name("FILE"),
      add_value(command, "--epsg", options.epsg, parse_epsg, "The coordinates' projection, for --tiff")
          .type_name("N"),
      add_value(command, "--full", options.full, parse_positive,
                "Hours (sum, kWh/m2) that the brightest colour stands for, the\n"
                "same for files that are compared [the most there is]")
          .type_name("H")};
  for (const AddedOption option : added) option.group(output_group);
}

void add_suns(CLI::App& command, SunOptions& options) {
  const AddedOption added[] = {
      add_value(command, "--place", options.place, parse_place_on_earth,
                "Degrees of latitude and longitude, north and east positive")
          .type_name("LAT,LON"),
      add_value(command, "--day", options.days, parse_one_day, "The day, from midnight to midnight of --zone")
          .type_name("YYYY-MM-DD"),
      add_value(command, "--days", options.days, parse_days_or_season,
                "Days from A to B. Of each N days the middle one is computed\n"
                "and counts for all of them [1]. Of --epw 04-01:09-30 or\nmonths, 4:9")
          .type_name("A:B[:N]"),
      add_value(command, "--step", options.step_min, parse_step,
                "Minutes between suns, made to divide the day; each stands in\n"
                "the middle of its step [10, of --epw 60]")
          .type_name("MIN"),
      add_value(command, "--zone", options.zone_min, sun::parse_zone,
                "Hours and minutes ahead of UTC that days and times are given\n"
                "in, as of that day: daylight saving is not looked up [UTC]")
          .type_name("+HH:MM"),
      add_value(
          command, "--north", options.north_deg, parse_turn,
          "How far true north is turned from the file's north (its y if\n"
          "z is up, its -z if y is), clockwise seen from above; in maps\nminus the meridian convergence [0]")
          .type_name("DEG"),
      add_flag(command, "--refraction", options.refraction,
               "Count what air lifts the sun by, half a degree at the horizon"),
      add_text(command, "--suns", options.suns,
               "Suns in place of place and days: columns x, y, z (towards the\n"
               "sun, the file's axes) or azimuth, altitude; weight")
          .type_name("FILE.csv"),
      add_text(command, "--epw", options.weather,
               "A weather file in place of --place: its hours of direct light\n"
               "and theirs on the surface, in kWh/m2")
          .type_name("FILE.epw"),
      add_value(command, "--sky", options.sky_parts, sun::parse_sky,
                "The light of an equally bright sky as well, by 145 patches or\n"
                "about N * N times as many (2 to 8): with --epw that of its\n"
                "hours, else as the share of an open sky's")
          .type_name("tregenza|reinhart[:N]"),
      add_texts(
          command, "--season", read_seasons(options),
          "A node and all below it cast only from month or day A to B,\nlike leaves=4:10; may be repeated")
          .type_name("NODE=A:B"),
      add_value(command, "--disc", options.disc_deg, parse_disc,
                "The sun's diameter in degrees: its visible share counts. The\n"
                "sun has 0.53; 0 is a point [0]")
          .type_name("DEG")};
  for (const AddedOption option : added) option.group(sun_group);
}

void add_where(CLI::App& command, SunOptions& options) {
  const AddedOption added[] = {
      add_texts(command, "--node", options.faces.nodes,
                "Faces of this node and all below it; may be repeated")
          .type_name("NAME"),
      add_texts(command, "--material", options.faces.materials, "Faces of this material; may be repeated")
          .type_name("NAME"),
      add_flag(command, "--upward", options.faces.upward,
               "Only faces that rise at most 60 degrees: roofs and ground"),
      add_flag(command, "--both-sides", options.faces.both_sides,
               "Count the side of a face that the sun is on, of a sky both\ntogether; for files whose faces "
               "do not all point outward"),
      add_value(command, "--per-face", options.faces.per_face, parse_per_face,
                "Points on each face, rounded up to a square number [16]")
          .type_name("N"),
      add_value(command, "--per-m2", options.faces.per_m2, parse_positive,
                "Points per square metre of a face instead, at most 65,536")
          .type_name("D"),
      add_value(command, "--ground", options.ground, parse_height,
                "In place of faces a horizontal plane at this height of the\nfile, below the whole scene as "
                "seen from above")
          .type_name("Z"),
      add_value(command, "--cell", options.cell_m, parse_cell, "Side of the ground's cells in metres [1]")
          .type_name("M"),
      add_text(
          command, "--points", options.points,
          "In place of faces points: columns x, y, z and, if known,\nnx, ny, nz, in the file's coordinates")
          .type_name("FILE.csv")};
  for (const AddedOption option : added) option.group(where_group);
}

Expected<void> check_suns(const CLI::App& command, const SunOptions& options) {
  if (was_given(command, "--day") && was_given(command, "--days")) return base::fail("--day excludes --days");
  const bool season = options.days && std::holds_alternative<sun::Season>(*options.days);
  if (!options.seasonal.empty() && !options.suns.empty())
    return base::fail("--season: found suns without days, expected --place or --epw");
  if (!options.seasonal.empty() && options.sky_parts > 0 && options.weather.empty())
    return base::fail("--season with --sky: found no light of days, expected --epw");
  if (!options.suns.empty()) {
    for (const char* name : {"--epw", "--place", "--day", "--days", "--step", "--zone", "--refraction"})
      if (was_given(command, name)) return base::fail("--suns excludes {}", name);
    return {};
  }
  if (!options.weather.empty()) {
    for (const char* name : {"--place", "--day", "--zone"})
      if (was_given(command, name)) return base::fail("--epw excludes {}", name);
    if (options.days && !season)
      return base::fail(
          "--days: found years, expected months and days of --epw's, like 04-01:09-30; its months may come "
          "from "
          "several years");
    if (options.step_min.value_or(60) > 60)
      return base::fail("--step: found {} minutes, expected at most the hour of --epw", *options.step_min);
    return {};
  }
  if (season) return base::fail("--days: found no year, expected one, like 2026-04-01:2026-09-30");
  if (!options.place || !options.days)
    return base::fail(
        "found no suns, expected --place LAT,LON and --day YYYY-MM-DD (or --days), --epw FILE or --suns "
        "FILE.csv");
  return {};
}

/// Files whose names end otherwise would be taken for something else.
Expected<void> check_names(const SunOptions& options) {
  const auto check = [](const char* option, const std::string& name,
                        std::initializer_list<std::string_view> endings) -> Expected<void> {
    const std::string extension = base::extension_of(name);
    if (name.empty() || std::find(endings.begin(), endings.end(), extension) != endings.end()) return {};
    return base::fail("{}: found {}, expected a name that ends in {}", option, name, *endings.begin());
  };
  if (auto checked = check("-o", options.model, {".glb"}); !checked) return checked;
  if (auto checked = check("--png", options.plan, {".png"}); !checked) return checked;
  return check("--tiff", options.raster, {".tif", ".tiff"});
}

Expected<void> check_where(const CLI::App& command, const SunOptions& options) {
  const bool ground = options.ground.has_value(), points = was_given(command, "--points");
  if (points && options.points.empty()) return base::fail("--points: found nothing, expected a file");
  if (ground && points) return base::fail("--ground excludes --points");
  for (const char* name : {"--node", "--material", "--upward", "--both-sides", "--per-face", "--per-m2"})
    if ((ground || points) && was_given(command, name))
      return base::fail("{} is for faces, which {} takes the place of", name,
                        ground ? "--ground" : "--points");
  for (const char* name : {"--cell", "--png", "--tiff"})
    if (was_given(command, name) && !ground) return base::fail("{} is for --ground", name);
  if (points && !options.model.empty())
    return base::fail("-o is for faces and --ground, which have a shape; --csv and --json are for points");
  if (auto checked = check_names(options); !checked) return checked;
  if (was_given(command, "--epsg") && options.raster.empty()) return base::fail("--epsg is for --tiff");
  if (was_given(command, "--full") && options.model.empty() && options.plan.empty())
    return base::fail("--full is for -o and --png");
  if (was_given(command, "--per-face") && was_given(command, "--per-m2"))
    return base::fail("--per-face excludes --per-m2");
  if (options.sky_parts > 0 && options.weather.empty() && options.csv.empty() && options.json.empty())
    return base::fail("--sky without --epw is a column of --csv and --json, expected one of them or --epw");
  return {};
}

}  // namespace

void add_sun_options(CLI::App& command, SunOptions& options) {
  add_text(command, "SCENE", options.scene.file, "Scene file; tenebra info --formats lists what is read")
      .required();
  add_outputs(command, options);
  add_suns(command, options);
  add_where(command, options);
  add_value(command, "--timeout", options.timeout_s, parse_positive,
            "Stop after this many seconds, as Ctrl-C does")
      .type_name("S");
  add_memory_option(command, options.memory_mb);
  add_flag(command, "--quiet", options.quiet, "No progress, no summary and no warnings");
  add_settings(command, settings::scene_table(), options.scene,
               {"scene", "up-axis", "unit", "offset", "no-cast", "cast-all", "cone-sides", "cutout-limit",
                "texture-path", "file-root", "set-node", "time", "fps", "clip"});
  add_settings(command, settings::method_table(), options.method,
               {"see-through", "soft-memory", "threads", "simd"});
}

Expected<void> settle_sun_options(const CLI::App& command, SunOptions& options) {
  settle_memory(command, options.memory_mb, options.method);
  if (auto checked = check_suns(command, options); !checked) return checked;
  if (auto checked = check_where(command, options); !checked) return checked;
  const formats::FileFormat* format = formats::format_of(options.scene.file);  // null: the import says so
  if (format != nullptr && !format->states_coordinates && !options.scene.import.placement.up)
    return base::fail(
        "{}: its format does not say which axis is up, expected --up-axis z (maps, most CAD) or --up-axis y",
        options.scene.file);
  return {};
}

}  // namespace tenebra::viewer
