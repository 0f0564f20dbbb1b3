// SPDX-License-Identifier: Apache-2.0
#include "harness/report/timeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include "harness/report/wording.hpp"

namespace armjig {
namespace {

constexpr double kStripUnits = 1000;     // of all strips, whatever they show
constexpr std::size_t kCurveStyles = 8;  // that the style sheet has for curves

std::string safe(std::string_view text) { return wording::html(wording::line(text)); }

auto end_of(std::string& text) { return std::back_inserter(text); }

std::string strip_begin(double seconds, std::string_view label) {
  return fmt::format(
      "<div class=\"strip\"><svg viewBox=\"0 0 {:.9g} {:g}\" preserveAspectRatio=\"none\" "
      "role=\"img\" aria-label=\"{}\">\n",
      seconds, kStripUnits, label);
}

std::string chart_html(const TimelineChart& chart, double seconds) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const auto& curve : chart.curves) {
    for (const auto& stretch : curve.stretches) {
      low = std::min(low, stretch.least);
      high = std::max(high, stretch.most);
    }
  }
  const auto height = [&](double value) {
    return high > low ? kStripUnits * (high - value) / (high - low) : kStripUnits / 2;
  };
  auto html = fmt::format("<div class=\"track chart\"><div><h4>{}</h4><ul class=\"legend\">\n",
                          safe(chart.title));
  std::string paths;
  for (std::size_t i = 0; i < chart.curves.size(); ++i) {
    const auto& curve = chart.curves[i];
    fmt::format_to(end_of(html),
                   "<li><svg width=\"18\" height=\"8\" aria-hidden=\"true\"><path class=\"line "
                   "s{0}\" d=\"M0 4H18\"/></svg>{1}</li>\n",
                   i % kCurveStyles, safe(curve.name));
    fmt::format_to(end_of(paths), "<path class=\"line s{}\" d=\"", i % kCurveStyles);
    char command = 'M';
    for (const auto& stretch : curve.stretches) {
      fmt::format_to(end_of(paths), "{}{:.7g} {:.4g}", std::exchange(command, 'L'), stretch.seconds,
                     height(stretch.least));
      if (stretch.most > stretch.least)
        fmt::format_to(end_of(paths), "V{:.4g}", height(stretch.most));
    }
    paths += "\"/>\n";
  }
  html += "</ul></div>\n" + strip_begin(seconds, safe(chart.title)) + paths;
  return html + fmt::format(
                    "</svg><span class=\"high\">{:.6g}</span><span class=\"low\">{:.6g}</span>"
                    "</div></div>\n",
                    high, low);
}

std::string lane_html(const TimelineLane& lane, double seconds) {
  auto html = fmt::format("<div class=\"track lane{}\"><h4>{}</h4>\n", lane.is_bad ? " fail" : "",
                          safe(lane.title)) +
              strip_begin(seconds, safe(lane.title));
  for (const auto& mark : lane.marks) {
    fmt::format_to(
        end_of(html),
        "<a href=\"#m{0}\"><title>{1:.6f} s {2}</title><path d=\"M{1:.9g} 100V900H{3:.9g}"
        "V100Z\"/></a>\n",
        mark.message, mark.begin, safe(mark.text), mark.end);
  }
  return html + "</svg></div></div>\n";
}

std::string messages_html(const Timeline& timeline) {
  std::string html{
      "<div class=\"messages card\" tabindex=\"-1\"><table>\n<thead><tr><th scope=\"col\" "
      "class=\"number\">time / s</th><th scope=\"col\">direction</th><th scope=\"col\">message</th>"
      "</tr></thead>\n<tbody>\n"};
  for (const auto& message : timeline.messages) {
    fmt::format_to(
        end_of(html),
        "<tr id=\"m{0}\"{1}><td class=\"number\"><a href=\"#m{0}\">{2:.6f}</a></td><td>{3}"
        "</td><td>{4}</td></tr>\n",
        message.number, message.is_bad ? " class=\"fail\"" : "", message.seconds,
        safe(message.direction), safe(message.text));
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace

std::string to_figure(const Timeline& timeline) {
  const auto seconds = std::max(timeline.seconds, 1e-6);
  auto html = fmt::format(
      "<figure class=\"timeline\" data-seconds=\"{0:.9g}\">\n<div class=\"plot card\">"
      "<figcaption>{1}</figcaption>\n<div class=\"steer\" role=\"group\" aria-label=\"Time line\">"
      "<button type=\"button\" data-key=\"+\">Zoom in ( + )</button>\n"
      "<button type=\"button\" data-key=\"-\">Zoom out ( - )</button>\n"
      "<button type=\"button\" data-key=\"ArrowLeft\">Earlier ( &larr; )</button>\n"
      "<button type=\"button\" data-key=\"ArrowRight\">Later ( &rarr; )</button>\n"
      "<button type=\"button\" data-key=\"0\">All ( 0 )</button>\n<output></output></div>\n",
      seconds, safe(timeline.title));
  for (const auto& chart : timeline.charts) html += chart_html(chart, seconds);
  for (const auto& lane : timeline.lanes) html += lane_html(lane, seconds);
  fmt::format_to(end_of(html),
                 "<div class=\"track\"><h4>time / s</h4><div class=\"axis\"><span "
                 "style=\"left:0\">0</span><span style=\"left:100%\">{:.6g}</span></div></div>\n"
                 "</div>\n",
                 seconds);
  if (!timeline.left_out.empty()) {
    fmt::format_to(end_of(html), "<p class=\"words\">{}</p>\n", safe(timeline.left_out));
  }
  return html + messages_html(timeline) + "</figure>\n";
}

}  // namespace armjig
