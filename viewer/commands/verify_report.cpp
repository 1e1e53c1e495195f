#include "commands/verify_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace tenebra::viewer {
namespace {

constexpr std::size_t most_printed = 10;

template <class Checked>
double check_seconds(const std::vector<Checked>& all) {
  double sum = 0;
  for (const Checked& checked : all) sum += checked.check_s;
  return sum;
}

double a_second(std::uint64_t count, double seconds) {
  return seconds > 0 ? static_cast<double>(count) / seconds : 0;
}

/// Column and row of a sample.
template <class Checked, class Wrong>
std::array<std::size_t, 2> pixel_of(const Checked& checked, const Wrong& wrong) {
  const auto width = static_cast<std::size_t>(checked.width);
  return {wrong.pixel % width, wrong.pixel / width};
}

template <class Checked, class Wrong>
std::string sample_of(const Checked& checked, const Wrong& wrong) {
  const auto [column, row] = pixel_of(checked, wrong);
  return fmt::format("frame {}, light {}, pixel ({}, {}), triangle {}", checked.frame, checked.light, column,
                     row, wrong.triangle);
}

std::string place_of(const CheckedMask& mask, const oracle::WrongSample& wrong) {
  return fmt::format("{}: the mask says {}, exact is {}", sample_of(mask, wrong), wrong.said,
                     wrong.exact.value);
}

std::string place_of(const CheckedFractions& light, const oracle::WrongFraction& wrong) {
  return fmt::format("{}: the fraction is {:.9g}, exact is {:.9g}", sample_of(light, wrong), wrong.said,
                     wrong.exact);
}

nlohmann::ordered_json json_of(const oracle::FractionStats& stats) {
  return {{"samples", stats.samples},
          {"penumbra", stats.penumbra},
          {"skipped", stats.skipped},
          {"occluders", stats.occluders},
          {"largest_error", stats.largest_error}};
}

nlohmann::ordered_json json_of(const CheckedFractions& light) {
  nlohmann::ordered_json json{{"frame", light.frame}, {"light", light.light}, {"promise", light.promise}};
  json.update(json_of(light.check.stats));
  json["seconds"] = light.check_s;
  json["wrong"] = light.check.wrong_count;
  if (light.check.wrong.empty()) return json;
  json["wrong_samples"] = nlohmann::ordered_json::array();
  for (const oracle::WrongFraction& wrong : light.check.wrong) {
    json["wrong_samples"].push_back({{"pixel", pixel_of(light, wrong)},
                                     {"triangle", wrong.triangle},
                                     {"fraction", wrong.said},
                                     {"exact", wrong.exact}});
  }
  return json;
}

nlohmann::ordered_json json_of(const oracle::ExactMaskStats& stats) {
  return {{"samples", stats.samples},
          {"lit_or_blocked", stats.active},
          {"blocked", stats.shadowed},
          {"pairs_of_sample_and_triangle", stats.pairs},
          {"decided_by_integers", stats.exact}};
}

nlohmann::ordered_json json_of(const CheckedMask& mask) {
  nlohmann::ordered_json json{{"frame", mask.frame}, {"light", mask.light}};
  json.update(json_of(mask.check.stats));
  json["seconds"] = mask.check_s;
  json["wrong"] = mask.check.wrong_count;
  if (mask.check.wrong.empty()) return json;
  json["wrong_samples"] = nlohmann::ordered_json::array();
  for (const oracle::WrongSample& wrong : mask.check.wrong) {
    nlohmann::ordered_json named{{"pixel", pixel_of(mask, wrong)},
                                 {"triangle", wrong.triangle},
                                 {"mask", wrong.said},
                                 {"exact", wrong.exact.value}};
    if (wrong.exact.blocker != no_triangle) named["blocked_by"] = wrong.exact.blocker;
    json["wrong_samples"].push_back(named);
  }
  return json;
}

}  // namespace

std::uint64_t Verification::wrong() const {
  std::uint64_t sum = 0;
  for (const CheckedMask& mask : masks) sum += mask.check.wrong_count;
  for (const CheckedFractions& light : fractions) sum += light.check.wrong_count;
  return sum;
}

oracle::FractionStats Verification::fraction_stats() const {
  oracle::FractionStats sum;
  for (const CheckedFractions& light : fractions) sum += light.check.stats;
  return sum;
}

oracle::ExactMaskStats Verification::stats() const {
  oracle::ExactMaskStats sum;
  for (const CheckedMask& mask : masks) sum += mask.check.stats;
  return sum;
}

int exit_code_of(const Verification& verification) {
  return verification.wrong() > 0 ? 2 : 0;
}

namespace {

std::string dumped(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string mask_text(const Verification& verification) {
  const oracle::ExactMaskStats stats = verification.stats();
  const double seconds = check_seconds(verification.masks);
  return fmt::format(
      "samples: {}, of which {} face the light and are in its range, of which {} are blocked\n"
      "pairs of sample and triangle: {}, of which {} were decided by integers of any length, the others by "
      "doubles with a bound\n"
      "time: {:.1f} s, of which {:.1f} s for exact answers, {:.0f} samples a second\n",
      stats.samples, stats.active, stats.shadowed, stats.pairs, stats.exact, verification.seconds, seconds,
      a_second(stats.samples, seconds));
}

std::string fraction_text(const Verification& verification) {
  const oracle::FractionStats stats = verification.fraction_stats();
  const double seconds = check_seconds(verification.fractions);
  return fmt::format(
      "lights with an area, of all frames: {}, samples: {}, of which {} in penumbra, {:.1f} occluders each; "
      "skipped: {} (more than {} occluders, or in the light's own plane)\n"
      "largest error: {:.3g}, at most {:.3g} is promised\n"
      "time: {:.1f} s, of which {:.1f} s for exact answers, {:.0f} samples a second\n",
      verification.fractions.size(), stats.samples, stats.penumbra,
      a_second(stats.occluders, double(stats.samples)), stats.skipped,
      oracle::FractionRequest{}.most_occluders, stats.largest_error, verification.fractions.front().promise,
      verification.seconds, seconds, a_second(stats.samples, seconds));
}

/// The first few that are wrong.
template <class Checked>
void add_wrong(const std::vector<Checked>& all, std::string& text) {
  std::size_t printed = 0;
  for (const Checked& checked : all) {
    for (const auto& wrong : checked.check.wrong) {
      if (printed++ < most_printed) text += "wrong: " + place_of(checked, wrong) + "\n";
    }
  }
  if (printed > most_printed) text += fmt::format("... and {} more\n", printed - most_printed);
}

}  // namespace

std::string verification_text(const Verification& verification) {
  std::string text;
  for (const render::LogSetting& setting : verification.settings)
    text += fmt::format("{}: {}\n", setting.name, setting.value);
  text += fmt::format("frames: {} of {}, masks: {}\n", verification.frames, verification.planned_frames,
                      verification.masks.size());
  if (verification.rounding_m)
    text += fmt::format(
        "coordinates are far from the origin and rounded by up to {:.3g} m: hard masks are compared with the "
        "file's own numbers\n",
        *verification.rounding_m);
  if (!verification.masks.empty() || verification.fractions.empty()) text += mask_text(verification);
  if (!verification.fractions.empty()) text += fraction_text(verification);
  add_wrong(verification.masks, text);
  add_wrong(verification.fractions, text);
  return text + fmt::format("wrong: {}\n", verification.wrong());
}

std::string verification_json(const Verification& verification) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["settings"] = Json::array();
  for (const render::LogSetting& setting : verification.settings)
    json["settings"].push_back({{"name", setting.name}, {"value", setting.value}});
  json["frames"] = verification.frames;
  json["planned_frames"] = verification.planned_frames;
  const oracle::ExactMaskStats stats = verification.stats();
  json["all"] = json_of(stats);
  json["all"]["wrong"] = verification.wrong();
  if (verification.rounding_m) json["rounding_m"] = *verification.rounding_m;
  json["seconds"] = verification.seconds;
  json["samples_a_second"] = a_second(stats.samples, check_seconds(verification.masks));
  json["masks"] = Json::array();
  for (const CheckedMask& mask : verification.masks) json["masks"].push_back(json_of(mask));
  if (verification.fractions.empty()) return dumped(json);
  json["all_fractions"] = json_of(verification.fraction_stats());
  json["fractions"] = Json::array();
  for (const CheckedFractions& light : verification.fractions) json["fractions"].push_back(json_of(light));
  return dumped(json);
}

}  // namespace tenebra::viewer
