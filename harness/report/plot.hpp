// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace armjig {

/// A point of a series. One that is not finite, or not positive on a logarithmic axis, is a gap.
struct PlotPoint {
  double x{};
  double y{};
};

/// How the points of a series are drawn.
enum class Shape : std::uint8_t {
  kLine,
  kSteps,  ///< each value holds until the next point
  kBars,  ///< as steps, filled down to the axis: a histogram. The last point only ends the last bar
  kDots,
};

struct Series {
  std::string name{};               ///< for the legend; may be empty if it is the only one
  std::vector<PlotPoint> points{};  ///< x ascending, except for dots
  Shape shape = Shape::kLine;
  std::string opens{};  ///< of dots: the table that has a row for each, in their order; empty: none
};

enum class Scale : std::uint8_t { kLinear, kLog };

struct Axis {
  std::string label{};  ///< with its unit: `round trip / ms`
  Scale scale = Scale::kLinear;
};

/// Some series over one pair of axes, which are as long as the data asks for.
struct Plot {
  std::string title{};
  Axis x{};
  Axis y{};
  std::vector<Series> series{};
};

/// The plot as a `<figure>` of HTML with inline SVG: for our page, whose style sheet has the
/// colours. It is as wide as its place, and its text keeps its size. A series of millions of points
/// costs some thousand, and looks the same.
[[nodiscard]] std::string to_figure(const Plot& plot);

/// The same as an SVG file of its own, 760 pixels wide, light or dark as its reader has it.
[[nodiscard]] std::string to_svg(const Plot& plot);

}  // namespace armjig
