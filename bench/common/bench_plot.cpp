#include "bench/common/bench_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace tenebra::bench {
namespace {

constexpr double width = 760, height = 460, left = 80, right = 210, top = 50, bottom = 70;  // px
constexpr double plot_width = width - left - right, plot_height = height - top - bottom;
// Told apart by colour-blind readers too (Okabe and Ito).
constexpr std::array colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

const char* colour_of(std::size_t series) {
  return colours[series % colours.size()];
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

/// Maps values to 0..1 and knows its ticks.
struct Scale {
  double low = 0, high = 1;
  bool logarithmic = false;
  std::vector<double> ticks{};

  double at(double value) const {
    if (logarithmic) return std::log(value / low) / std::log(high / low);
    return (value - low) / (high - low);
  }
};

Scale logarithmic_scale(double low, double high) {
  Scale scale{std::pow(10, std::floor(std::log10(low))), std::pow(10, std::ceil(std::log10(high))), true};
  if (scale.low == scale.high) scale.high *= 10;
  for (double tick = scale.low; tick <= scale.high * 1.001; tick *= 10) scale.ticks.push_back(tick);
  return scale;
}

/// About five ticks at 1, 2 or 5 times a power of ten.
Scale linear_scale(double low, double high) {
  low = std::min(low, 0.0);
  if (!(high > low)) high = low + 1;
  const double rough = (high - low) / 5, power = std::pow(10, std::floor(std::log10(rough)));
  const double step = power * (rough / power > 5 ? 10 : rough / power > 2 ? 5 : rough / power > 1 ? 2 : 1);
  Scale scale{std::floor(low / step) * step, std::ceil(high / step) * step, false};
  for (int i = 0; scale.low + i * step <= scale.high + 0.5 * step; ++i)
    scale.ticks.push_back(scale.low + i * step);
  return scale;
}

Scale scale_for(std::span<const double> values, bool logarithmic) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : values) {
    if (!std::isfinite(v) || (logarithmic && !(v > 0))) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  if (!(low <= high)) return logarithmic ? logarithmic_scale(1, 10) : linear_scale(0, 1);
  return logarithmic ? logarithmic_scale(low, high) : linear_scale(low, high);
}

double y_pixel(const Scale& scale, double value) {
  return top + plot_height * (1 - scale.at(value));
}
double x_pixel(const Scale& scale, double value) {
  return left + plot_width * scale.at(value);
}

std::string text_at(double x, double y, const char* anchor, const std::string& text, int size = 12,
                    const std::string& more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\"{}>{}</text>\n", x,
                     y, anchor, size, more, escaped(text));
}

std::string line_between(double x0, double y0, double x1, double y1, const char* colour) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x0,
                     y0, x1, y1, colour);
}

std::string head(const std::string& title) {
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
             "font-family=\"sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
             width, height) +
         text_at(left, 28, "start", title, 16);
}

std::string y_axis(const Scale& scale, const std::string& label) {
  std::string svg;
  for (const double tick : scale.ticks) {
    const double y = y_pixel(scale, tick);
    svg += line_between(left, y, left + plot_width, y, "#dddddd");
    svg += text_at(left - 8, y + 4, "end", fmt::format("{:.6g}", tick));
  }
  svg += line_between(left, top, left, top + plot_height, "black");
  const double middle = top + plot_height / 2;
  return svg + text_at(20, middle, "middle", label, 13,
                       fmt::format(" transform=\"rotate(-90 20 {:.1f})\"", middle));
}

std::string x_axis(const Scale& scale, const std::string& label) {
  std::string svg;
  const double base = top + plot_height;
  for (const double tick : scale.ticks) {
    const double x = x_pixel(scale, tick);
    svg += line_between(x, base, x, base + 5, "black");
    svg += text_at(x, base + 20, "middle", fmt::format("{:.6g}", tick));
  }
  svg += line_between(left, base, left + plot_width, base, "black");
  return svg + text_at(left + plot_width / 2, height - 20, "middle", label, 13);
}

std::string legend_entry(std::size_t series, const std::string& name) {
  const double x = width - right + 20, y = top + 10 + 20.0 * static_cast<double>(series);
  return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"12\" height=\"12\" fill=\"{}\"/>\n", x, y,
                     colour_of(series)) +
         text_at(x + 18, y + 10, "start", name);
}

std::string curve(const Curve& c, std::size_t series, const Scale& x, const Scale& y) {
  std::string path, marks;
  for (const auto& [vx, vy] : c.points) {
    if ((x.logarithmic && !(vx > 0)) || (y.logarithmic && !(vy > 0))) continue;
    const double px = x_pixel(x, vx), py = y_pixel(y, vy);
    path += fmt::format("{:.1f},{:.1f} ", px, py);
    if (c.points.size() <= 100)
      marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", px, py,
                           colour_of(series));
  }
  return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n", path,
                     colour_of(series)) +
         marks;
}

std::string bar(double x, double from_y, double to_y, double bar_width, std::size_t series) {
  return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n", x,
                     to_y, bar_width, std::max(from_y - to_y, 0.0), colour_of(series));
}

double value_at(const Bars& bars, std::size_t category) {
  return category < bars.values.size() ? bars.values[category] : 0.0;
}

/// Highest ends of the bars.
std::vector<double> bar_ends(std::size_t categories, const std::vector<Bars>& bars, bool stacked) {
  std::vector<double> ends;
  for (std::size_t c = 0; c < categories; ++c) {
    double sum = 0;
    for (const Bars& b : bars) {
      sum += value_at(b, c);
      ends.push_back(stacked ? sum : value_at(b, c));
    }
  }
  return ends;
}

std::string bar_group(std::size_t category, double x, double group_width, const std::vector<Bars>& bars,
                      const Scale& scale, bool stacked) {
  std::string svg;
  const double each = stacked ? group_width : group_width / static_cast<double>(bars.size());
  double sum = 0;
  for (std::size_t s = 0; s < bars.size(); ++s) {
    const double value = value_at(bars[s], category), from = stacked ? sum : scale.low;
    sum += value;
    const double to = stacked ? sum : value;
    if (scale.logarithmic && !(to > 0)) continue;
    const double bar_x = stacked ? x : x + each * static_cast<double>(s);
    svg += bar(bar_x, y_pixel(scale, std::max(from, scale.low)), y_pixel(scale, to), each * 0.9, s);
    if (!stacked)
      svg += text_at(bar_x + each * 0.45, y_pixel(scale, to) - 3, "middle", fmt::format("{:.3g}", value), 9);
  }
  return svg;
}

/// From a round number (1, 2 or 5 times a power of ten) to another, ticks at all of them or, over many
/// decades, at powers of ten.
Scale tight_scale(double low, double high) {
  constexpr int many_decades = 3;
  Scale scale{0, 0, true, {}};
  const bool wide = high / low > std::pow(10, many_decades);
  for (int power = static_cast<int>(std::floor(std::log10(low))); !(scale.high >= high); ++power) {
    for (const int digit : {1, 2, 5}) {
      if (wide && digit != 1) continue;
      const double tick = digit * std::pow(10, power);
      if (scale.high >= high) break;
      if (tick <= low) scale.low = tick, scale.ticks.clear();
      scale.high = tick;
      scale.ticks.push_back(tick);
    }
  }
  return scale;
}

/// Values above `floor` on a logarithmic scale, what is not above it on a line of its own at the foot, if
/// there is any.
struct FootedScale {
  Scale scale;
  double floor;
  double foot_px;  // of the foot below the scale; 0: none

  double pixel(double value) const {
    if (!(value > floor)) return top + plot_height;
    return top + (plot_height - foot_px) * (1 - scale.at(value));
  }
};

FootedScale footed_scale(const std::vector<Curve>& families, double floor) {
  double low = std::numeric_limits<double>::infinity(), high = 0, foot_px = 0;
  for (const Curve& c : families) {
    for (const auto& [x, y] : c.points) {
      if (!(y > floor)) foot_px = 34;
      if (!(y > floor)) continue;
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  return {low < high ? tight_scale(low, high) : tight_scale(1, 10), floor, foot_px};
}

std::string footed_axis(const FootedScale& y, const std::string& label) {
  std::string svg;
  const auto line = [&](double at, const std::string& text) {
    svg += line_between(left, at, left + plot_width, at, "#dddddd") + text_at(left - 8, at + 4, "end", text);
  };
  for (const double tick : y.scale.ticks) line(y.pixel(tick), fmt::format("{:.7g}", tick));
  if (y.foot_px > 0) line(top + plot_height, y.floor > 0 ? fmt::format("\u2264 {:.7g}", y.floor) : "0");
  svg += line_between(left, top, left, top + plot_height, "black");
  const double middle = top + plot_height / 2;
  return svg + text_at(20, middle, "middle", label, 13,
                       fmt::format(" transform=\"rotate(-90 20 {:.1f})\"", middle));
}

/// One of a few shapes, so that families differ in more than colour.
std::string mark(std::size_t family, double x, double y) {
  constexpr double r = 4;
  const char* colour = colour_of(family);
  switch (family % 4) {
    case 0:
      return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n", x, y, r, colour);
    case 1:
      return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n", x - r,
                         y - r, 2 * r, 2 * r, colour);
    case 2:
      return fmt::format("<polygon points=\"{:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f}\" fill=\"{}\"/>\n", x,
                         y - 1.2 * r, x - 1.2 * r, y + r, x + 1.2 * r, y + r, colour);
    default:
      return fmt::format(
          "<polygon points=\"{:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f}\" fill=\"{}\"/>\n", x,
          y - 1.3 * r, x - 1.3 * r, y, x, y + 1.3 * r, x + 1.3 * r, y, colour);
  }
}

std::string ring(double x, double y) {
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\" fill=\"none\" stroke=\"#444444\"/>\n", x,
                     y);
}

std::string front_line(const Curve& front, const Scale& x, const FootedScale& y) {
  std::string path, rings;
  for (const auto& [vx, vy] : front.points) {
    path += fmt::format("{:.1f},{:.1f} ", x_pixel(x, vx), y.pixel(vy));
    rings += ring(x_pixel(x, vx), y.pixel(vy));
  }
  return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"#888888\" stroke-dasharray=\"5 4\"/>\n",
                     path) +
         rings;
}

}  // namespace

std::string scatter_plot(const std::string& title, const std::string& x_label, const std::string& y_label,
                         double floor, const std::vector<Curve>& families, const Curve& front) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const Curve& c : families) {
    for (const auto& [x, y] : c.points) low = std::min(low, x), high = std::max(high, x);
  }
  const Scale x = low > 0 && low < high ? tight_scale(low, high) : tight_scale(1, 10);
  const FootedScale y = footed_scale(families, floor);
  std::string svg = head(title) + footed_axis(y, y_label) + x_axis(x, x_label) + front_line(front, x, y);
  for (std::size_t s = 0; s < families.size(); ++s) {
    for (const auto& [vx, vy] : families[s].points) svg += mark(s, x_pixel(x, vx), y.pixel(vy));
  }
  double legend_y = top + 16;
  const double legend_x = width - right + 26;
  const auto explain = [&](const std::string& shape, const std::string& name) {
    svg += shape + text_at(legend_x + 12, legend_y + 4, "start", name);
    legend_y += 20;
  };
  for (std::size_t s = 0; s < families.size(); ++s) explain(mark(s, legend_x, legend_y), families[s].name);
  explain(ring(legend_x, legend_y), front.name);
  return svg + "</svg>\n";
}

std::string curve_plot(const std::string& title, const Axis& x, const Axis& y,
                       const std::vector<Curve>& curves) {
  std::vector<double> xs, ys;
  for (const Curve& c : curves) {
    for (const auto& [vx, vy] : c.points) {
      xs.push_back(vx);
      ys.push_back(vy);
    }
  }
  const Scale x_scale = scale_for(xs, x.logarithmic), y_scale = scale_for(ys, y.logarithmic);
  std::string svg = head(title) + y_axis(y_scale, y.label) + x_axis(x_scale, x.label);
  for (std::size_t s = 0; s < curves.size(); ++s)
    svg += curve(curves[s], s, x_scale, y_scale) + legend_entry(s, curves[s].name);
  return svg + "</svg>\n";
}

std::string bar_plot(const std::string& title, const Axis& y, const std::vector<std::string>& categories,
                     const std::vector<Bars>& bars, bool stacked) {
  std::vector<double> ends = bar_ends(categories.size(), bars, stacked);
  const bool logarithmic = y.logarithmic && !stacked;
  for (std::size_t i = 0; logarithmic && i < categories.size() * bars.size(); ++i)
    ends.push_back(0.5 * ends[i]);  // no bar vanishes on the axis
  const Scale scale = scale_for(ends, logarithmic);
  std::string svg = head(title) + y_axis(scale, y.label);
  const double base = top + plot_height;
  svg += line_between(left, base, left + plot_width, base, "black");
  const double pitch = plot_width / static_cast<double>(std::max<std::size_t>(categories.size(), 1));
  for (std::size_t c = 0; c < categories.size(); ++c) {
    const double x = left + pitch * static_cast<double>(c);
    svg += bar_group(c, x + 0.1 * pitch, 0.8 * pitch, bars, scale, stacked);
    svg += text_at(x + pitch / 2, base + 20, "middle", categories[c]);
  }
  for (std::size_t s = 0; s < bars.size(); ++s) svg += legend_entry(s, bars[s].name);
  return svg + "</svg>\n";
}

}  // namespace tenebra::bench
