#include "trade/trade_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "log/page_pictures.h"
#include "log/page_text.h"
#include "log/report_style.h"
#include "log/ticks.h"
#include "trade/trade_choice.h"

namespace tenebra::viewer {
namespace {

constexpr double width = 960, height = 360, left = 64, right = 24, top = 26, bottom = 46;

constexpr const char* crop_style =
    ".crops { display: flex; flex-wrap: wrap; gap: 14px; } .crops figure { margin: 0; width: 230px; }"
    ".crops img { width: 100%; image-rendering: pixelated; border-radius: 4px; display: block; }"
    ".crops figcaption { font-size: 13px; } code { font-size: 13px; } circle.front { fill: var(--a); }"
    "circle.other { fill: none; stroke: var(--dim); }";

bool is_on_front(const TradeResult& result, std::size_t i) {
  return std::find(result.front.begin(), result.front.end(), i) != result.front.end();
}

/// Milliseconds, on a logarithmic scale, and errors to places in the plot.
struct Axes {
  double first_ms = 1, last_ms = 10, highest = 1;

  explicit Axes(const TradeResult& result) {
    first_ms = HUGE_VAL, last_ms = 0, highest = 0;
    for (const TradedSetting& setting : result.measured) {
      first_ms = std::min(first_ms, setting.point.ms);
      last_ms = std::max(last_ms, setting.point.ms);
      highest = std::max(highest, setting.point.error);
    }
    first_ms = std::max(first_ms, 1e-3) / 1.15, last_ms = std::max(last_ms, first_ms) * 1.15;
    highest = std::max(highest * 1.1, 0.1);
  }
  double x(double ms) const {
    return left +
           std::log(std::max(ms, 1e-3) / first_ms) / std::log(last_ms / first_ms) * (width - left - right);
  }
  double y(double error) const { return height - bottom - error / highest * (height - top - bottom); }
};

std::string grid_of(const Axes& axes) {
  std::string text;
  for (const double error : even_ticks(0, axes.highest, tick_step(axes.highest, 5)))
    text += fmt::format(
        "<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/><text x=\"{}\" y=\"{:.1f}\" "
        "text-anchor=\"end\">{:.3g}</text>\n",
        left, width - right, axes.y(error), axes.y(error), left - 6, axes.y(error) + 4, error);
  for (const double ms : logarithmic_ticks(axes.first_ms, axes.last_ms))
    text += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/><text x=\"{0:.1f}\" "
        "y=\"{3}\" "
        "text-anchor=\"middle\">{4:g}</text>\n",
        axes.x(ms), top, height - bottom, height - bottom + 16, ms);
  return text + fmt::format(
                    "<text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">ms per frame</text><text "
                    "class=\"label\" x=\"{}\" y=\"{}\">error, RMS in levels of 255</text>\n",
                    (left + width - right) / 2, height - 8, left, top - 4);
}

std::string plot_of(const TradeResult& result) {
  const Axes axes(result);
  std::string line, dots;
  for (const std::size_t i : result.front) {
    const TradePoint& point = result.measured[i].point;
    line += fmt::format("{:.1f},{:.1f} ", axes.x(point.ms), axes.y(point.error));
  }
  for (std::size_t i = 0; i < result.measured.size(); ++i) {
    const TradePoint& point = result.measured[i].point;
    const std::string options = options_of(result.axes, point.setting);
    dots += fmt::format(
        "<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\"><title>{}: {:.4g} ms, {:.3g}</title>"
        "</circle>\n",
        is_on_front(result, i) ? "front" : "other", axes.x(point.ms), axes.y(point.error), page_text(options),
        point.ms, point.error);
    if (is_on_front(result, i))
      dots += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", axes.x(point.ms) + 8,
                          axes.y(point.error) - 7, i + 1);
  }
  return fmt::format(
      "<svg viewBox=\"0 0 {} {}\" role=\"img\">\n{}<polyline class=\"line0\" points=\"{}\"/>\n{}</svg>\n",
      width, height, grid_of(axes), line, dots);
}

std::string table_of(const TradeHeading& heading, const TradeResult& result) {
  std::string text = fmt::format("<p>After <code>{}</code>:</p>\n", page_text(heading.command)) +
                     "<div class=\"scroll\"><table>\n"
                     "<tr><th>setting</th><th>ms per frame</th><th>first frame</th><th>error</th><th>worst "
                     "frame</th><th>memory, MB</th></tr>\n";
  for (const std::size_t i : result.front) {
    const TradedSetting& setting = result.measured[i];
    text += fmt::format(
        "<tr><td>{}. "
        "<code>{}</code></td><td>{:.1f}</td><td>{:.1f}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.0f}</td>"
        "</tr>\n",
        i + 1, page_text(options_of(result.axes, setting.point.setting)), setting.point.ms,
        setting.first_frame_ms, setting.point.error, setting.worst_error, setting.peak_mb);
  }
  return text + "</table></div>\n";
}

Expected<std::string> crops_of(const TradeResult& result) {
  std::string text = "<div class=\"crops\">\n";
  const auto add = [&](const io::Image8& crop, const std::string& caption) -> Expected<void> {
    const auto image = data_uri(crop);
    if (!image) return tl::unexpected(image.error());
    text += fmt::format("<figure><img alt=\"\" src=\"{}\"><figcaption>{}</figcaption></figure>\n", *image,
                        caption);
    return {};
  };
  for (const std::size_t i : result.front) {
    const TradePoint& point = result.measured[i].point;
    const auto added =
        add(result.measured[i].crop,
            fmt::format("{}. {}: {:.1f} ms, {:.2f}", i + 1, page_text(options_of(result.axes, point.setting)),
                        point.ms, point.error));
    if (!added) return tl::unexpected(added.error());
  }
  if (auto added = add(result.reference_crop, "the finest setting, the reference for errors"); !added)
    return tl::unexpected(added.error());
  return text + "</div>\n";
}

}  // namespace

std::string options_of(const TradeAxes& axes, const TradeSetting& setting) {
  std::string text;
  const auto add = [&](std::string_view name, double value) {
    text += fmt::format("{}{} {:g}", text.empty() ? "" : " ", name, value);
  };
  if (axes.antialias.size() > 1) add("--antialias", setting.antialias);
  if (axes.soft_errors.size() > 1) add("--soft-error", setting.soft_error);
  if (axes.ao_errors.size() > 1) add("--ao-error", setting.ao_error);
  return text;
}

std::string trade_table(const TradeResult& result) {
  std::string text = fmt::format("{:>10}{:>13}{:>10}{:>13}{:>9}  setting\n", "ms", "first frame", "error",
                                 "worst frame", "MB");
  for (const std::size_t i : result.front) {
    const TradedSetting& setting = result.measured[i];
    text += fmt::format("{:>10.1f}{:>13.1f}{:>10.2f}{:>13.2f}{:>9.0f}  {}\n", setting.point.ms,
                        setting.first_frame_ms, setting.point.error, setting.worst_error, setting.peak_mb,
                        options_of(result.axes, setting.point.setting));
  }
  return text;
}

std::string trade_json(const TradeHeading& heading, const TradeResult& result) {
  nlohmann::ordered_json json{{"scene", heading.scene},     {"machine", heading.machine},
                              {"command", heading.command}, {"width", heading.width},
                              {"height", heading.height},   {"threads", heading.threads},
                              {"frames", result.frames},    {"settings", nlohmann::ordered_json::array()}};
  for (std::size_t i = 0; i < result.measured.size(); ++i) {
    const TradedSetting& setting = result.measured[i];
    json["settings"].push_back({{"options", options_of(result.axes, setting.point.setting)},
                                {"frame_ms", setting.point.ms},
                                {"first_frame_ms", setting.first_frame_ms},
                                {"error_255", setting.point.error},
                                {"worst_frame_error_255", setting.worst_error},
                                {"promised_error_255", promised_error(result, setting)},
                                {"frames_ms", setting.frames_ms},
                                {"frame_errors_255", setting.frame_errors},
                                {"peak_mb", setting.peak_mb},
                                {"front", is_on_front(result, i)}});
  }
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Expected<std::string> trade_page(const TradeHeading& heading, const TradeResult& result) {
  const auto crops = crops_of(result);
  if (!crops) return crops;
  std::string frames;
  for (const int frame : result.frames) frames += fmt::format("{}{}", frames.empty() ? "" : ", ", frame);
  return fmt::format(
             "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
             "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
             "<title>Time and error: {0}</title>\n<style>{1}{2}</style></head><body>\n<h1>Time and "
             "error</h1>\n"
             "<p>{0}, {3}x{4} pixels, frames {5} <span class=\"dim\">{6}, {7}</span></p>\n",
             page_text(heading.scene), report_style, crop_style, heading.width, heading.height, frames,
             page_text(heading.machine),
             heading.threads == 0 ? "all threads" : fmt::format("threads: {}", heading.threads)) +
         plot_of(result) +
         "<p class=\"dim\">Errors compare the whole picture as it is shown with that of the finest setting: "
         "RMS over its pixels and the frames. Rings were measured too, but others are better. The first "
         "frame also builds what later ones keep.</p>\n" +
         table_of(heading, result) + "<h2>What the errors look like</h2>\n" +
         fmt::format(
             "<p class=\"dim\">The part where the quickest differs most from the finest: {} x {} pixels at "
             "({}, {}).</p>\n",
             result.reference_crop.width, result.reference_crop.height, result.crop_x, result.crop_y) +
         *crops + "</body></html>\n";
}

}  // namespace tenebra::viewer
