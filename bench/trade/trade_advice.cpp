#include "bench/trade/trade_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "settings/quality.h"

namespace tenebra::bench {
namespace {

using Measure = std::function<std::optional<double>(const TradeTable&)>;

/// "3.1 to 14", over the views that have the figure; "-" if none has.
std::string range(const TradeTables& tables, const Measure& measure, const char* unit = "") {
  std::vector<double> values;
  for (const TradeTable* table : tables) {
    if (const auto value = measure(*table)) values.push_back(*value);
  }
  if (values.empty()) return "-";
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const std::string from = short_number(*low), to = short_number(*high);
  return from == to ? from + unit : fmt::format("{} to {}{}", from, to, unit);
}

Measure error(const std::string& name, std::size_t column = 0) {
  return [=](const TradeTable& t) {
    const TradePoint* p = t.find(name);
    return p == nullptr ? std::nullopt : std::optional(p->errors[column]);
  };
}
Measure time(const std::string& name) {
  return [=](const TradeTable& t) {
    const TradePoint* p = t.find(name);
    return p == nullptr ? std::nullopt : std::optional(p->ms());
  };
}
/// Time of one setting over that of another.
Measure times(const std::string& name, const std::string& other) {
  return [=](const TradeTable& t) -> std::optional<double> {
    const TradePoint *a = t.find(name), *b = t.find(other);
    if (a == nullptr || b == nullptr) return std::nullopt;
    return a->ms() / b->ms();
  };
}

constexpr const char* tiles = "default (Tiles)";
constexpr const char* exact_soft = "default (exact)";

/// Views on which no exact setting is faster than `name`.
std::size_t fastest_exact(const TradeTables& tables, const std::string& name) {
  return static_cast<std::size_t>(std::count_if(tables.begin(), tables.end(), [&](const TradeTable* t) {
    const TradePoint* own = t->find(name);
    return own != nullptr && std::none_of(t->points.begin(), t->points.end(), [&](const TradePoint& p) {
             return p.errors[0] <= t->none_below && p.ms() < own->ms();
           });
  }));
}

/// Of the settings of families that begin with `family`, those that err by no more than `error`, the fastest.
std::optional<double> ms_at_error(const TradeTable& table, const std::string& family, double error) {
  std::optional<double> ms;
  for (const TradePoint& p : table.points) {
    if (p.family.starts_with(family) && p.errors[0] <= error && (!ms || p.ms() < *ms)) ms = p.ms();
  }
  return ms;
}

}  // namespace

std::string preset_section() {
  std::string text =
      "## Which to choose: `--quality`\n"
      "\n"
      "Hard shadows are exact in every preset. Options given explicitly win.\n"
      "\n"
      "| preset | soft shadows | ambient occlusion (`--ao adaptive`) | with `--ao field` |\n"
      "|---|---|---|---|\n";
  for (const settings::Quality quality : settings::qualities) {
    const render::RenderSettings q = settings::quality_settings(quality);
    const std::string soft =
        q.soft.error_255 > 0 ? fmt::format("`--soft-error {}`", q.soft.error_255) : "exact";
    const std::string scale =
        q.ao.downscale == 1 ? "" : fmt::format(" --paper ao-downscale={}", q.ao.downscale);
    text += fmt::format("| `{}` | {} | `--ao-error {}` | `--ao-rays {}{}` |\n",
                        settings::quality_name(quality), soft, q.ao.error_255, q.ao.rays, scale);
  }
  return text +
         "\n"
         "The cost and the error of each are given below. While you model, animate or fly through a scene: "
         "`fast`. For final pictures: the defaults, which are `balanced`. For stills whose ambient occlusion "
         "must be right to about one level of 255: `exact`.\n"
         "\n";
}

std::string hard_advice(const TradeTables& tables) {
  const char* culled = "samples from depth, front faces culled";
  return fmt::format(
      "- Keep the default: on {} of {} views no other setting that gives the exact mask is faster. The "
      "paper's variants give the same mask in {} times the default's time.\n"
      "- Front-face culling with samples from depth (`--paper samples=depth`) takes {} of the default's time "
      "and "
      "is wrong at {} pixels: for closed meshes only. Without culling and without a bias depth samples "
      "shadow themselves: {} wrong pixels.\n"
      "- A shadow map of 4096 is wrong at {} pixels with the best bias, one of 1024 at {}; without a bias "
      "one of 4096 would be at {}. Drawing it is for GPUs, which were not measured; its errors stay.\n"
      "- Embree's rays, which start at a bias of their own, differ at {} pixels in {} of the default's time "
      "(tree built for the frame).\n",
      fastest_exact(tables, tiles), tables.size(),
      range(tables, times("variants of the paper, PreciseSorted", tiles)),
      range(tables, times(culled, tiles)), range(tables, error(culled)),
      range(tables, error("samples from depth, all cast, no bias")), range(tables, error("shadow map, 4096")),
      range(tables, error("shadow map, 1024")), range(tables, error("shadow map, 4096, no bias")),
      range(tables, error("Embree, built and traced")),
      range(tables, times("Embree, built and traced", tiles)));
}

std::string soft_advice(const TradeTables& tables) {
  const auto against = [](const char* family, double rms) {
    return [=](const TradeTable& t) -> std::optional<double> {
      const auto ms = ms_at_error(t, family, rms);
      const TradePoint* exact = t.find(exact_soft);
      if (!ms || exact == nullptr) return std::nullopt;
      return *ms / exact->ms();
    };
  };
  return fmt::format(
      "- The default errs by at most {} /255 at the worst pixel; on {} of {} views no other exact solver of "
      "ours is faster.\n"
      "- For a penumbra that is off by less than 1/255 (RMS), Embree's rays take {} of the exact time, "
      "behind shafts {}; by less than 3/255: {} and {}. Views on which that many rays were not tried are "
      "left out.\n"
      "- `--soft-error 4` takes {} of the exact time ({} /255 RMS, {} at the worst pixel), `--soft-error 1` "
      "{} ({} /255).\n"
      "- `--paper soft-points=8` takes {} of the exact time and shows eight steps in each penumbra ({} /255 "
      "RMS, "
      "{} at the worst pixel); 32 points {} ({} /255).\n",
      range(tables, error(exact_soft, 3)), fastest_exact(tables, exact_soft), tables.size(),
      range(tables, against("Embree rays", 1)), range(tables, against("shafts + Embree rays", 1)),
      range(tables, against("Embree rays", 3)), range(tables, against("shafts + Embree rays", 3)),
      range(tables, times("error asked (--soft-error), 4", exact_soft)),
      range(tables, error("error asked (--soft-error), 4")),
      range(tables, error("error asked (--soft-error), 4", 1)),
      range(tables, times("error asked (--soft-error), 1", exact_soft)),
      range(tables, error("error asked (--soft-error), 1")),
      range(tables, times("light points, 8", exact_soft)), range(tables, error("light points, 8")),
      range(tables, error("light points, 8", 1)), range(tables, times("light points, 32", exact_soft)),
      range(tables, error("light points, 32")));
}

std::string ao_advice(const TradeTables& tables) {
  // The fastest of Embree's settings that errs no more than `name` does, over its time.
  const auto embree_for = [](const char* name) {
    return [=](const TradeTable& t) -> std::optional<double> {
      const TradePoint* p = t.find(name);
      const auto ms = p == nullptr ? std::nullopt : ms_at_error(t, "Embree rays", p->errors[0]);
      if (!ms) return std::nullopt;
      return *ms / p->ms();
    };
  };
  return fmt::format(
      "- `--ao adaptive` asked for 5, 2.5 and 1 errs by {}, {} and {} /255 RMS in {}, {} and {} ms. Embree's "
      "rays, with the fastest of their filters and resolutions that errs no more, take {}, {} and {} times "
      "as long; views on which that many rays were not tried are left out (`tenebra-bench ao` tries more, "
      "and interpolates).\n"
      "- Fields answer 64 rays in {} of the time of an error of 2.5, at {} /255 RMS and {} at the worst "
      "pixel, once they and the samples are made; Embree takes {} times as long for an error as large. 256 "
      "rays leave {}: what is left is the tables' and the samples' own error.\n"
      "- So fields are good where moving objects have very many triangles (the crowd: a look-up takes the "
      "same time for any number), and samples where nothing moves (the kitchen), if errors of that size are "
      "acceptable. They are not good where many small objects are within each other's reach (robots, city: a "
      "look-up for each), where an error has to be small or known, for a single picture (its first frame "
      "makes them), for geometry that deforms (rays are cast at it in any case), nor for bodies that touch.\n"
      "- Tables: four times smaller ones (1089x1024) err by {} /255 with 64 rays, the smallest tried "
      "(289x256) by {}, the largest (4225x4096) by {}; one bit per distance instead of eight: {}.\n",
      range(tables, error("adaptive, error 5")), range(tables, error("adaptive, error 2.5")),
      range(tables, error("adaptive, error 1")), range(tables, time("adaptive, error 5")),
      range(tables, time("adaptive, error 2.5")), range(tables, time("adaptive, error 1")),
      range(tables, embree_for("adaptive, error 5")), range(tables, embree_for("adaptive, error 2.5")),
      range(tables, embree_for("adaptive, error 1")),
      range(tables, times("field, 64 rays", "adaptive, error 2.5")), range(tables, error("field, 64 rays")),
      range(tables, error("field, 64 rays", 1)), range(tables, embree_for("field, 64 rays")),
      range(tables, error("field, 256 rays")),
      range(tables, error("other tables, 1089x1024, 8 bits, 64 rays")),
      range(tables, error("other tables, 289x256, 8 bits, 64 rays")),
      range(tables, error("other tables, 4225x4096, 8 bits, 64 rays")),
      range(tables, error("other tables, 4225x1024, 1 bit, 64 rays")));
}

}  // namespace tenebra::bench
