// SPDX-License-Identifier: Apache-2.0
#include "harness/report/plot.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "harness/report/wording.hpp"

namespace armjig {
namespace {

// The drawing stretches with the page, but its text must not. So the curves stand in an inner <svg>
// of these units that is stretched, and all text stands beside it, placed in percent and pixels.
constexpr double kUnitsWide = 10'000;
constexpr double kUnitsHigh = 1'000;
constexpr double kPixelsHigh = 260;
/// More columns than a screen has pixels there.
constexpr int kColumns = 2'000;
constexpr std::size_t kStyles = 8;  ///< that the style sheet has for series

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(double value) noexcept {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] bool is_empty() const noexcept { return !(low <= high); }
};

struct Tick {
  double place{};  ///< 0 to 1 along the axis
  std::string label;
};

/// `2000`, but `2·10⁶` where nobody wants to count zeros.
std::string power_label(double factor, int power) {
  if (power > -4 && power < 6) return fmt::format("{:g}", factor * std::pow(10, power));
  constexpr std::array<std::string_view, 10> kRaised{"⁰", "¹", "²", "³", "⁴",
                                                     "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string label = factor > 1 ? fmt::format("{:g}·10", factor) : "10";
  for (const char c : std::to_string(power)) {
    label += c == '-' ? "⁻" : kRaised[static_cast<std::size_t>(c - '0')];
  }
  return label;
}

/// Whether an axis of that scale has the value. The bound keeps differences finite.
bool is_on(Scale scale, double value) noexcept {
  return std::abs(value) < 1e300 && (scale == Scale::kLinear || value > 0);
}

/// An axis with its length known. Works on the logarithms if it has that scale.
class Ruler {
 public:
  /// `parts` is about how many ticks it should have.
  Ruler(Scale scale, Range values, int parts)
      : scale_{scale}, parts_{parts}, low_{raw(values.low)}, high_{raw(values.high)} {
    if (high_ - low_ < kLeast) {  // one value only: it stands in the middle
      const bool is_small = scale == Scale::kLog || std::abs(low_) < kLeast;
      const double half = is_small ? 0.5 : std::abs(low_) / 2;
      low_ -= half;
      high_ += half;
    }
  }

  /// Makes room for the feet of bars: on a logarithmic axis even the least bar is to be seen.
  void add_foot() noexcept {
    if (scale_ == Scale::kLog) low_ -= 0.3;
  }

  /// Lengthens the axis to whole ticks, at each end by no more than `most` of its length.
  void round_out(double most) noexcept {
    if (scale_ == Scale::kLog && high_ - low_ < 1) return;
    const double step = scale_ == Scale::kLog ? 1 : linear_step();
    const double length = high_ - low_;
    const double low = std::floor(low_ / step) * step;
    const double high = std::ceil(high_ / step) * step;
    if (scale_ == Scale::kLinear && low_ - low <= most * length) low_ = low;
    if (high - high_ <= most * length) high_ = high;
  }

  /// 0 to 1 along the axis; beyond it for values out of range; none if the axis has no such value.
  [[nodiscard]] std::optional<double> place(double value) const noexcept {
    if (!is_on(scale_, value)) return std::nullopt;
    return (raw(value) - low_) / (high_ - low_);
  }

  [[nodiscard]] std::vector<Tick> ticks() const {
    if (scale_ == Scale::kLinear) return linear_ticks();
    return high_ - low_ < kFewDecades ? linear_ticks_on_log() : log_ticks();
  }

 private:
  [[nodiscard]] double raw(double value) const noexcept {
    return scale_ == Scale::kLog ? std::log10(value) : value;
  }

  /// 1, 2 or 5 times a power of ten.
  [[nodiscard]] double linear_step() const noexcept {
    const double rough = (high_ - low_) / parts_;
    const double power = std::pow(10, std::floor(std::log10(rough)));
    for (const double factor : {1., 2., 5.}) {
      if (rough <= factor * power * 1.001) return factor * power;
    }
    return 10 * power;
  }

  [[nodiscard]] std::vector<Tick> linear_ticks() const {
    std::vector<Tick> ticks;
    const double step = linear_step();
    const auto decimals = static_cast<int>(std::clamp(-std::floor(std::log10(step)), 0., 9.));
    const bool is_plain = std::max(std::abs(low_), std::abs(high_)) < 1e9 && step >= 1e-4;
    const auto first = std::ceil(low_ / step - 1e-9);
    const auto count = static_cast<int>(std::floor(high_ / step + 1e-9) - first) + 1;
    for (int i = 0; i < count; ++i) {
      const double value = (first + i) * step;
      ticks.push_back(
          {(value - low_) / (high_ - low_),
           is_plain ? fmt::format("{:.{}f}", value, decimals) : fmt::format("{:.6g}", value)});
    }
    return ticks;
  }

  /// Where there is no room for powers of ten.
  [[nodiscard]] std::vector<Tick> linear_ticks_on_log() const {
    const Range range{std::pow(10, low_), std::pow(10, high_)};
    auto ticks = Ruler{Scale::kLinear, range, parts_}.linear_ticks();
    for (auto& tick : ticks) {
      const double value = range.low + tick.place * (range.high - range.low);
      tick.place = (std::log10(value) - low_) / (high_ - low_);
    }
    return ticks;
  }

  /// Powers of ten; between them 2 and 5 too if there are few, every second or third if many.
  [[nodiscard]] std::vector<Tick> log_ticks() const {
    std::vector<Tick> ticks;
    const auto first = static_cast<int>(std::floor(low_));
    const auto last = static_cast<int>(std::ceil(high_));
    const int stride = std::max(1, (last - first) / 7);
    const bool are_few = high_ - low_ < 2.5;
    for (int power = first; power <= last; power += stride) {
      for (const double factor : {1., 2., 5.}) {
        if (factor > 1 && !are_few) break;
        const double value = factor * std::pow(10, power);
        const double at = (std::log10(value) - low_) / (high_ - low_);
        if (at > -1e-9 && at < 1 + 1e-9) ticks.push_back({at, power_label(factor, power)});
      }
    }
    return ticks;
  }

  static constexpr double kLeast = 1e-290;  ///< an axis is longer, or its steps would vanish
  static constexpr double kFewDecades = 0.7;

  Scale scale_;
  int parts_;
  double low_;
  double high_;
};

struct Ranges {
  Range x;
  Range y;
};

Ranges ranges_of(const Plot& plot) {
  Ranges ranges;
  for (const auto& series : plot.series) {
    const bool is_bars = series.shape == Shape::kBars;
    for (const auto& [x, y] : series.points) {
      if (is_on(plot.x.scale, x)) ranges.x.include(x);
      if (is_on(plot.y.scale, y)) ranges.y.include(y);
    }
    if (is_bars && plot.y.scale == Scale::kLinear && !series.points.empty()) ranges.y.include(0);
  }
  return ranges;
}

/// A place in the drawing, y downwards.
struct Spot {
  int x{};
  int y{};
};

using Strokes = std::vector<std::vector<Spot>>;  ///< unbroken pieces of a curve

/// Of all spots in one column of the drawing, first, lowest, highest and last look like all of
/// them (Jugel et al., M4, VLDB 2014).
std::vector<Spot> thinned(std::span<const Spot> spots) {
  constexpr auto kUnits = static_cast<int>(kUnitsWide) / kColumns;
  const auto column = [](const Spot& spot) { return spot.x / kUnits; };
  std::vector<Spot> out;
  for (auto from = spots.begin(); from != spots.end();) {
    const auto to = std::find_if(from, spots.end(),
                                 [&](const Spot& spot) { return column(spot) != column(*from); });
    if (to - from <= 4) {
      out.insert(out.end(), from, to);
    } else {
      auto [least, most] =
          std::minmax_element(from, to, [](const Spot& a, const Spot& b) { return a.y < b.y; });
      if (most < least) std::swap(least, most);
      for (const auto kept : {from, least, most, to - 1}) out.push_back(*kept);
    }
    from = to;
  }
  return out;
}

/// The curve of a series. Bars leave the values that a logarithmic axis lacks on the ground.
Strokes strokes_of(const Series& series, const Ruler& x, const Ruler& y) {
  Strokes strokes(1);
  for (const auto& point : series.points) {
    const auto across = x.place(point.x);
    auto up = y.place(point.y);
    const bool is_bar = series.shape == Shape::kBars && is_on(Scale::kLinear, point.y);
    if (is_bar) up = std::max(up.value_or(0), 0.);
    if (!across || !up) {
      if (!strokes.back().empty()) strokes.emplace_back();
      continue;
    }
    strokes.back().push_back({static_cast<int>(std::lround(*across * kUnitsWide)),
                              static_cast<int>(std::lround((1 - *up) * kUnitsHigh))});
  }
  for (auto& stroke : strokes) {
    if (series.shape != Shape::kDots) stroke = thinned(stroke);
  }
  return strokes;
}

/// A line of no length has round ends: a dot that does not stretch.
std::string path_of(const Strokes& strokes, Shape shape) {
  std::string path;
  const auto ground = static_cast<int>(kUnitsHigh);
  for (const auto& stroke : strokes) {
    if (stroke.empty()) continue;
    if (shape == Shape::kDots) {
      for (const auto& [x, y] : stroke) path += fmt::format("M{} {}h0", x, y);
      continue;
    }
    path += shape == Shape::kBars ? fmt::format("M{} {}V{}", stroke[0].x, ground, stroke[0].y)
                                  : fmt::format("M{} {}", stroke[0].x, stroke[0].y);
    for (const auto& [x, y] : std::span{stroke}.subspan(1)) {
      path += shape == Shape::kLine ? fmt::format("L{} {}", x, y) : fmt::format("H{}V{}", x, y);
    }
    if (shape == Shape::kBars) path += fmt::format("V{}Z", ground);
    if (stroke.size() == 1 && shape != Shape::kBars) path += "h0";
  }
  return path;
}

std::string_view class_of(Shape shape) noexcept {
  constexpr std::array<std::string_view, 4> kClasses{"line", "line", "bars", "dots"};
  return kClasses[static_cast<std::size_t>(shape)];
}

std::string label(std::string_view text) { return wording::html(wording::line(text)); }

std::string grid(const std::vector<Tick>& x_ticks, const std::vector<Tick>& y_ticks) {
  std::string svg = "<g class=\"grid\">\n";
  for (const auto& [place, _] : y_ticks) {
    const double y = (1 - place) * kPixelsHigh;
    svg += fmt::format("<line x1=\"0\" x2=\"100%\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/>\n", y);
  }
  for (const auto& [place, _] : x_ticks) {
    svg += fmt::format("<line x1=\"{0:.2f}%\" x2=\"{0:.2f}%\" y1=\"0\" y2=\"{1:.0f}\"/>\n",
                       place * 100, kPixelsHigh);
  }
  return svg + "</g>\n";
}

/// Every second label of x leaves where there is no room for it: class "odd".
std::string tick_labels(const std::vector<Tick>& x_ticks, const std::vector<Tick>& y_ticks) {
  std::string svg = "<g class=\"ticks\">\n";
  for (const auto& [place, text] : y_ticks) {
    svg += fmt::format("<text class=\"y\" x=\"-8\" y=\"{:.1f}\">{}</text>\n",
                       (1 - place) * kPixelsHigh + 4, text);
  }
  for (std::size_t i = 0; i < x_ticks.size(); ++i) {
    svg += fmt::format("<text class=\"x{}\" x=\"{:.2f}%\" y=\"{:.0f}\">{}</text>\n",
                       i % 2 == 1 ? " odd" : "", x_ticks[i].place * 100, kPixelsHigh + 18,
                       x_ticks[i].label);
  }
  return svg + "</g>\n";
}

/// Each dot by itself, a link to its row.
std::string linked_dots(const Series& series, std::string_view classes, const Ruler& x,
                        const Ruler& y) {
  std::string svg;
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    const Series one{.points = {series.points[i]}, .shape = series.shape};
    const auto path = path_of(strokes_of(one, x, y), one.shape);
    if (path.empty()) continue;
    svg += fmt::format(
        "<a href=\"#{0}-{1}\" aria-label=\"{2} {1}\"><path class=\"{3}\" d=\"{4}\"/></a>\n",
        series.opens, i + 1, label(series.name), classes, path);
  }
  return svg;
}

std::string curves(const Plot& plot, const Ruler& x, const Ruler& y) {
  auto svg = fmt::format(
      "<svg viewBox=\"0 0 {:.0f} {:.0f}\" width=\"100%\" height=\"{:.0f}\" "
      "preserveAspectRatio=\"none\">\n",
      kUnitsWide, kUnitsHigh, kPixelsHigh);
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const auto& series = plot.series[i];
    const auto classes = fmt::format("{} s{}", class_of(series.shape), i % kStyles);
    svg += series.opens.empty() ? fmt::format("<path class=\"{}\" d=\"{}\"/>\n", classes,
                                              path_of(strokes_of(series, x, y), series.shape))
                                : linked_dots(series, classes, x, y);
  }
  return svg + "</svg>\n";
}

std::string legend(const Plot& plot) {
  const bool says_nothing =
      std::ranges::all_of(plot.series, [](const Series& series) { return series.name.empty(); });
  if (says_nothing) return {};
  std::string html = "<ul class=\"legend\">\n";
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const auto& series = plot.series[i];
    html += fmt::format(
        "<li><svg width=\"26\" height=\"12\" aria-hidden=\"true\"><path class=\"{} s{}\" "
        "d=\"{}\"/></svg>{}</li>\n",
        class_of(series.shape), i % kStyles,
        series.shape == Shape::kBars   ? "M3 12V2H23V12Z"
        : series.shape == Shape::kDots ? "M13 6h0"
                                       : "M1 6H25",
        label(series.name));
  }
  return html + "</ul>\n";
}

/// What somebody hears who cannot see it.
std::string spoken(const Plot& plot, const Ranges& ranges) {
  return label(fmt::format("{}: {} from {:.4g} to {:.4g} over {} from {:.4g} to {:.4g}", plot.title,
                           plot.y.label, ranges.y.low, ranges.y.high, plot.x.label, ranges.x.low,
                           ranges.x.high));
}

/// Pixels that the widest label takes, and a little.
double room_for(const std::vector<Tick>& ticks) {
  std::size_t most = 4;
  for (const auto& tick : ticks) most = std::max(most, wording::width_of(tick.label));
  return 14 + 7.2 * static_cast<double>(most);
}

/// Grid, curves and labels, in pixels of height and percent of width.
struct Drawing {
  std::string body;
  double left{};  ///< pixels for the labels of y
};

Drawing draw(const Plot& plot, const Ranges& ranges) {
  const bool has_bars =
      std::ranges::find(plot.series, Shape::kBars, &Series::shape) != plot.series.end();
  Ruler x{plot.x.scale, ranges.x, 8};
  x.round_out(0.02);
  Ruler y{plot.y.scale, ranges.y, 5};
  if (has_bars) y.add_foot();
  y.round_out(1);
  const auto x_ticks = x.ticks();
  const auto y_ticks = y.ticks();
  return {grid(x_ticks, y_ticks) + curves(plot, x, y) + tick_labels(x_ticks, y_ticks),
          room_for(y_ticks)};
}

std::string axes(const Plot& plot, const Ranges& ranges) {
  const auto [body, left] = draw(plot, ranges);
  return fmt::format(
      "<div class=\"axes\" style=\"padding-left: {:.0f}px\"><svg role=\"img\" aria-label=\"{}\" "
      "width=\"100%\" height=\"{:.0f}\">\n"
      "{}</svg></div>\n",
      left, spoken(plot, ranges), kPixelsHigh + 26, body);
}

constexpr auto kFileStyle = R"css(
svg { --card: #fff; --ink: #1a2330; --soft: #566274; --line: #dbe1e9; overflow: visible;
  --c0: #1f62c9; --c1: #c2500a; --c2: #0d7d6c; --c3: #9c2f8f;
  font: 13px system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
@media (prefers-color-scheme: dark) { svg { --card: #161b23; --ink: #e5eaf1; --soft: #9ba8b9;
  --line: #2b3440; --c0: #78aefc; --c1: #ffa45c; --c2: #4fd1bb; --c3: #eb92df; } }
.card { fill: var(--card); stroke: var(--line); }
text { fill: var(--ink); } .title { font-weight: 600; font-size: 15px; }
.grid line { stroke: var(--line); } .soft, .ticks text { fill: var(--soft); font-size: 12px; }
.ticks .x { text-anchor: middle; } .ticks .y, .end { text-anchor: end; }
path { fill: none; stroke: var(--s); stroke-width: 1.75; stroke-linejoin: round;
  stroke-linecap: round; vector-effect: non-scaling-stroke; }
.bars { fill: var(--s); fill-opacity: .28; stroke-width: 1; } .dots { stroke-width: 5; }
.s0, .s4 { --s: var(--c0); } .s1, .s5 { --s: var(--c1); } .s2, .s6 { --s: var(--c2); }
.s3, .s7 { --s: var(--c3); } .line:is(.s4, .s5, .s6, .s7) { stroke-dasharray: 6 5; }
)css";

/// Names of series side by side, from `x` on.
std::string file_legend(const Plot& plot, double x, double y) {
  std::string svg;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const auto& series = plot.series[i];
    if (series.name.empty()) continue;
    svg += fmt::format(
        "<path class=\"{} s{}\" d=\"M{:.0f} {:.0f}h24\"/><text x=\"{:.0f}\" "
        "y=\"{:.0f}\">{}</text>\n",
        class_of(series.shape), i % kStyles, x, y - 4, x + 32, y, label(series.name));
    x += 56 + 7.5 * static_cast<double>(wording::width_of(wording::line(series.name)));
  }
  return svg;
}

}  // namespace

std::string to_figure(const Plot& plot) {
  const auto ranges = ranges_of(plot);
  const bool is_empty = ranges.x.is_empty() || ranges.y.is_empty();
  return fmt::format(
      "<figure class=\"plot card\">\n<figcaption>{}</figcaption>\n{}<p class=\"y-label\">{}</p>\n{}"
      "<p class=\"x-label\">{}</p>\n</figure>\n",
      label(plot.title), legend(plot), label(plot.y.label),
      is_empty ? "<p class=\"no-data\">no data</p>\n" : axes(plot, ranges), label(plot.x.label));
}

std::string to_svg(const Plot& plot) {
  constexpr double kWide = 760;
  constexpr double kTop = 96;     // title, legend, label of y
  constexpr double kBottom = 48;  // labels of x
  constexpr double kMargin = 20;
  const auto ranges = ranges_of(plot);
  const bool is_empty = ranges.x.is_empty() || ranges.y.is_empty();
  const auto drawing =
      is_empty ? Drawing{"<text class=\"soft\">no data</text>", 0} : draw(plot, ranges);
  const double left = kMargin + drawing.left;
  const double high = kTop + kPixelsHigh + kBottom;
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" role=\"img\" aria-label=\"{2}\">\n<style>{3}</style>\n"
      "<rect class=\"card\" x=\".5\" y=\".5\" width=\"{4:.0f}\" height=\"{5:.0f}\" rx=\"10\"/>\n"
      "<text class=\"title\" x=\"{6:.0f}\" y=\"30\">{7}</text>\n{8}"
      "<text class=\"soft\" x=\"{6:.0f}\" y=\"{9:.0f}\">{10}</text>\n"
      "<svg x=\"{11:.0f}\" y=\"{12:.0f}\" width=\"{13:.0f}\" height=\"{14:.0f}\">\n{15}</svg>\n"
      "<text class=\"soft end\" x=\"{16:.0f}\" y=\"{17:.0f}\">{18}</text>\n</svg>\n",
      kWide, high, is_empty ? label(plot.title) : spoken(plot, ranges), kFileStyle, kWide - 1,
      high - 1, kMargin, label(plot.title), file_legend(plot, kMargin, 54), kTop - 16,
      label(plot.y.label), left, kTop, kWide - left - kMargin, kPixelsHigh, drawing.body,
      kWide - kMargin, high - 10, label(plot.x.label));
}

}  // namespace armjig
