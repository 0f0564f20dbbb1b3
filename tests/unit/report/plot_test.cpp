// SPDX-License-Identifier: Apache-2.0
#include "harness/report/plot.hpp"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/support/property.hpp"

namespace armjig {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

Plot plot_of(Shape shape, std::vector<PlotPoint> points) {
  Plot plot{.title = "Speed", .x = {.label = "time / s"}, .y = {.label = "speed / steps/s"}};
  plot.series = {{.points = std::move(points), .shape = shape}};
  return plot;
}

/// The drawing is 10000 wide and 1000 high, y downwards.
auto draws(const std::string& path) { return HasSubstr(" d=\"" + path + "\"/>"); }

TEST(Figure, DrawsALineFromCornerToCorner) {
  EXPECT_THAT(to_figure(plot_of(Shape::kLine, {{0, 0}, {1, 2}, {2, 10}})),
              draws("M0 1000L5000 800L10000 0"));
}

TEST(Figure, HoldsAStepUntilTheNextPoint) {
  EXPECT_THAT(to_figure(plot_of(Shape::kSteps, {{0, 0}, {1, 10}, {2, 5}})),
              draws("M0 1000H5000V0H10000V500"));
}

TEST(Figure, StandsBarsOnZero) {
  EXPECT_THAT(to_figure(plot_of(Shape::kBars, {{0, 5}, {1, 10}, {2, 0}})),
              draws("M0 1000V500H5000V0H10000V1000V1000Z"));
}

TEST(Figure, ShowsEvenOneOnALogarithmicAxis) {
  auto plot = plot_of(Shape::kBars, {{0, 1}, {1, 0}, {2, 1000}, {3, 0}});
  plot.y.scale = Scale::kLog;
  // 3 decades and 0.3 below them: 1 stands 0.3 / 3.3 high, 0 lies on the ground
  EXPECT_THAT(to_figure(plot), draws("M0 1000V909H3333V1000H6667V0H10000V1000V1000Z"));
}

TEST(Figure, DrawsDotsThatDoNotStretch) {
  EXPECT_THAT(to_figure(plot_of(Shape::kDots, {{0, 0}, {2, 10}, {1, 5}})),
              draws("M0 1000h0M10000 0h0M5000 500h0"));
}

TEST(Figure, LeavesAGapWhereThereIsNoValue) {
  EXPECT_THAT(to_figure(plot_of(Shape::kLine, {{0, 0}, {1, 5}, {2, kGap}, {3, 10}, {4, 10}})),
              draws("M0 1000L2500 500M7500 0L10000 0"));
}

TEST(Figure, SpacesDecadesEvenlyOnALogarithmicAxis) {
  auto plot = plot_of(Shape::kLine, {{1, 0}, {10, 5}, {100, 10}, {-1, 10}});
  plot.x.scale = Scale::kLog;
  EXPECT_THAT(to_figure(plot), draws("M0 1000L5000 500L10000 0"));
}

TEST(Figure, DrawsASinglePointInTheMiddle) {
  EXPECT_THAT(to_figure(plot_of(Shape::kLine, {{7, 7}})), draws("M5000 500h0"));
}

TEST(Figure, HasRoundNumbersOnItsAxes) {
  const auto figure = to_figure(plot_of(Shape::kLine, {{0, 0.12}, {59.99, 0.93}}));
  for (const auto* label : {">0<", ">30<", ">60<", ">0.0<", ">0.4<", ">1.0<"}) {
    EXPECT_THAT(figure, HasSubstr(label));
  }
}

TEST(Figure, WritesManyZerosAsPowers) {
  auto plot = plot_of(Shape::kLine, {{0, 1e-6}, {1, 1e6}});
  plot.y.scale = Scale::kLog;
  EXPECT_THAT(to_figure(plot),
              AllOf(HasSubstr(">10⁻⁶<"), HasSubstr(">10000<"), HasSubstr(">10⁶<")));
}

TEST(Figure, HasTicksOnALogarithmicAxisWithoutAPowerOfTen) {
  auto plot = plot_of(Shape::kLine, {{0, 3}, {1, 4}});
  plot.y.scale = Scale::kLog;
  EXPECT_THAT(to_figure(plot), AllOf(HasSubstr(">3.0<"), HasSubstr(">3.6<"), HasSubstr(">4.0<")));
}

TEST(Figure, KeepsExtremesOfAMillionPoints) {
  std::vector<PlotPoint> points;
  for (int i = 0; i < 1'000'000; ++i) points.push_back({i * 1e-3, std::sin(i * 0.01)});
  points[123'456].y = 10;
  points[654'321].y = -10;
  const auto figure = to_figure(plot_of(Shape::kLine, std::move(points)));
  EXPECT_LT(figure.size(), 200'000);
  EXPECT_THAT(figure, AllOf(HasSubstr("L1235 0L"), HasSubstr("L6543 1000L")));
}

TEST(Figure, SaysThatThereIsNoData) {
  EXPECT_THAT(to_figure(Plot{.title = "Empty"}), HasSubstr("no data"));
  EXPECT_THAT(to_figure(plot_of(Shape::kLine, {{kGap, 1}, {1, kGap}})),
              AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
}

TEST(Figure, HasALegendIfSeriesHaveNames) {
  auto plot = plot_of(Shape::kLine, {{0, 0}, {1, 1}});
  EXPECT_THAT(to_figure(plot), Not(HasSubstr("legend")));
  plot.series[0].name = "J1 <fast>";
  EXPECT_THAT(to_figure(plot), HasSubstr("</svg>J1 &lt;fast&gt;</li>"));
}

TEST(Figure, TellsThoseWhoCannotSeeIt) {
  EXPECT_THAT(to_figure(plot_of(Shape::kLine, {{0, -5}, {60, 10}})),
              HasSubstr("aria-label=\"Speed: speed / steps/s from -5 to 10 over time / s from 0 to "
                        "60\""));
}

TEST(Figure, HasNumbersOnlyWhateverTheData) {
  test::for_all([](const std::vector<std::pair<double, double>>& data, bool is_log) {
    for (const auto shape : {Shape::kLine, Shape::kSteps, Shape::kBars, Shape::kDots}) {
      std::vector<PlotPoint> points;
      for (const auto& [x, y] : data) points.push_back({x, y});
      points.push_back({HUGE_VAL, -HUGE_VAL});
      points.push_back({5e-324, 1e308});
      auto plot = plot_of(shape, std::move(points));
      plot.x.scale = is_log ? Scale::kLog : Scale::kLinear;
      plot.y.scale = plot.x.scale;
      const auto figure = to_figure(plot);
      RC_ASSERT(figure.find("nan") == std::string::npos);
      RC_ASSERT(figure.find("inf") == std::string::npos);
    }
  });
}

TEST(Svg, IsAFileOfItsOwnWithTheSameCurves) {
  auto plot = plot_of(Shape::kLine, {{0, 0}, {1, 2}, {2, 10}});
  plot.title = "Speed < 2 & more";
  plot.series.front().name = "j1";
  const auto svg = to_svg(plot);
  EXPECT_THAT(svg, ::testing::StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_THAT(svg, AllOf(draws("M0 1000L5000 800L10000 0"), HasSubstr("Speed &lt; 2 &amp; more"),
                         HasSubstr(">j1</text>"), HasSubstr("time / s")));
}

TEST(Svg, SaysThatThereIsNoData) { EXPECT_THAT(to_svg({.title = "x"}), HasSubstr("no data")); }

}  // namespace
}  // namespace armjig
