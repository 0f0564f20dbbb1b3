// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <deque>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "harness/mealy/drawing.hpp"
#include "harness/mealy/steps.hpp"
#include "harness/report/wording.hpp"

namespace armjig::mealy {
namespace {

// In units of the picture, which are pixels unless somebody scales it.
constexpr double kLine = 14;
constexpr double kLetter = 6.2;  ///< width of a letter of the small text
constexpr double kMargin = 8;
constexpr double kBetweenColumns = 170;
constexpr double kBetweenRows = 46;
constexpr double kTitle = 34;
constexpr std::size_t kLongestLine = 44;

struct Box {
  double x{};
  double y{};
  double width{};
  double height{};
  std::vector<std::string> lines{};

  [[nodiscard]] double middle_x() const { return x + width / 2; }
  [[nodiscard]] double middle_y() const { return y + height / 2; }
};

/// In pieces of at most `kLongestLine`, broken at blanks.
std::vector<std::string> folded(const std::vector<std::string>& lines) {
  std::vector<std::string> pieces;
  for (auto line : lines) {
    while (line.size() > kLongestLine) {
      const auto blank = line.rfind(' ', kLongestLine);
      if (blank == line.npos || blank < 4) break;
      pieces.push_back(line.substr(0, blank));
      line = "  " + line.substr(blank + 1);
    }
    pieces.push_back(std::move(line));
  }
  return pieces;
}

/// Of each state, how many arrows lead to it from the first one.
std::vector<std::size_t> layers_of(const Machine& machine, const ToldMachine& told) {
  constexpr auto kFar = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> layers(machine.states.size(), kFar);
  layers[0] = 0;
  std::size_t last = 0;
  for (std::deque<std::size_t> waiting{0}; !waiting.empty(); waiting.pop_front()) {
    for (const auto& arrow : told.arrows) {
      if (arrow.from != waiting.front() || layers[arrow.to] != kFar) continue;
      layers[arrow.to] = last = layers[arrow.from] + 1;
      waiting.push_back(arrow.to);
    }
  }
  std::ranges::replace(layers, kFar, last + 1);  // where only steps lead that have no arrow
  return layers;
}

class Picture {
 public:
  Picture(const Drawing& drawing, double top) : told_{mealy::told(drawing)}, top_{top} {
    place(drawing.machine);
  }

  [[nodiscard]] double right() const { return right_; }
  [[nodiscard]] double bottom() const { return bottom_; }

  void draw(const std::string& title, std::string& text) const {
    text += fmt::format(R"(<text x="{}" y="{}" font-size="16" font-weight="bold">{}</text>)"
                        "\n",
                        kMargin, top_ + 20, wording::html(title));
    for (const auto& arrow : told_.arrows) draw_line(arrow, text);
    for (std::size_t i = 0; i < boxes_.size(); ++i) draw(boxes_[i], told_.is_marked[i], text);
    for (const auto& arrow : told_.arrows) draw_label(arrow, text);
  }

 private:
  void place(const Machine& machine) {
    const auto layers = layers_of(machine, told_);
    const auto last = std::ranges::max(layers);
    boxes_.resize(machine.states.size());
    double x = kMargin;
    for (std::size_t layer = 0; layer <= last; ++layer) {
      double y = top_ + kTitle + (layer % 2 == 0 ? 0 : kBetweenRows / 2);
      double width = 0;
      for (std::size_t i = 0; i < boxes_.size(); ++i) {
        if (layers[i] != layer) continue;
        boxes_[i] = box_of(machine.states[i].name, told_.notes[i]);
        boxes_[i].x = x;
        boxes_[i].y = y;
        y += boxes_[i].height + kBetweenRows;
        width = std::max(width, boxes_[i].width);
      }
      bottom_ = std::max(bottom_, y);
      x += width + kBetweenColumns;
    }
    right_ = x;
  }

  static Box box_of(const std::string& name, const std::vector<std::string>& notes) {
    Box box{.lines = folded(notes)};
    box.lines.insert(box.lines.begin(), name);
    const auto longest = std::ranges::max(box.lines, {}, &std::string::size).size();
    box.width = static_cast<double>(longest) * kLetter + 2 * kMargin;
    box.height = static_cast<double>(box.lines.size()) * kLine + 2 * kMargin;
    return box;
  }

  static void draw(const Box& box, bool is_marked, std::string& text) {
    text += fmt::format(
        R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" rx="8" fill="{}" stroke="{}"/>)"
        "\n",
        box.x, box.y, box.width, box.height, is_marked ? "#fdd" : "#f4f7fb", stroke(is_marked));
    auto y = box.y + kMargin + kLine - 3;
    for (std::size_t i = 0; i < box.lines.size(); ++i) {
      text += fmt::format(R"(<text x="{:.1f}" y="{:.1f}"{}>{}</text>)"
                          "\n",
                          box.x + kMargin, y, i == 0 ? R"( font-weight="bold")" : "",
                          wording::html(box.lines[i]));
      y += kLine;
    }
  }

  struct Curve {
    std::array<double, 8> points{};  ///< x and y: begin, two handles, end
    [[nodiscard]] double x() const { return at(0); }
    [[nodiscard]] double y() const { return at(1); }

   private:
    /// In its middle.
    [[nodiscard]] double at(std::size_t axis) const {
      return (points[axis] + 3 * points[axis + 2] + 3 * points[axis + 4] + points[axis + 6]) / 8;
    }
  };

  /// To the right from side to side, otherwise out of the bottom and round to the top or bottom.
  [[nodiscard]] Curve curve_of(const Arrow& arrow) const {
    const auto& from = boxes_[arrow.from];
    const auto& to = boxes_[arrow.to];
    if (from.x < to.x) {
      const auto begin = from.x + from.width;
      const auto handle = (to.x - begin) / 2;
      return {{begin, from.middle_y(), begin + handle, from.middle_y(), to.x - handle,
               to.middle_y(), to.x, to.middle_y()}};
    }
    const auto begin = from.y + from.height;
    const auto end = to.y + to.height;
    const auto below = std::max(begin, end) + kBetweenRows;
    return {{from.middle_x() - kMargin, begin, from.middle_x() - kMargin, below,
             to.middle_x() + kMargin, below, to.middle_x() + kMargin, end}};
  }

  void draw_line(const Arrow& arrow, std::string& text) const {
    const auto p = curve_of(arrow).points;
    text += fmt::format(
        R"svg(<path d="M{:.1f} {:.1f}C{:.1f} {:.1f} {:.1f} {:.1f} {:.1f} {:.1f}" fill="none" stroke="{}" marker-end="url(#{})"/>)svg"
        "\n",
        p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], stroke(arrow.is_marked),
        arrow.is_marked ? "off" : "tip");
  }

  void draw_label(const Arrow& arrow, std::string& text) const {
    const auto curve = curve_of(arrow);
    const auto lines = folded(arrow.lines);
    auto y = curve.y() - static_cast<double>(lines.size() - 1) * kLine / 2 + 4;
    for (const auto& line : lines) {
      text += fmt::format(
          R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle" class="l" fill="{}">{}</text>)"
          "\n",
          curve.x(), y, arrow.is_marked ? "#c00" : "#235", wording::html(line));
      y += kLine;
    }
  }

  static const char* stroke(bool is_marked) { return is_marked ? "#c00" : "#567"; }

  ToldMachine told_;
  double top_;
  double right_ = 0;
  double bottom_ = 0;
  std::vector<Box> boxes_;
};

}  // namespace

std::string to_svg(std::span<const Drawing> drawings) {
  std::string body;
  double width = 0;
  double height = 0;
  for (const auto& drawing : drawings) {
    const Picture picture{drawing, height};
    picture.draw(drawing.title, body);
    width = std::max(width, picture.right());
    height = picture.bottom() + kBetweenRows;
  }
  return fmt::format(
             R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0:.0f}" height="{1:.0f}" viewBox="0 0 {0:.0f} {1:.0f}" font-family="sans-serif" font-size="11">)"
             "\n",
             width, height) +
         R"(<style>.l{paint-order:stroke;stroke:#fff;stroke-width:3px}</style>
<defs><marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" markerHeight="8" orient="auto"><path d="M0 0L8 4L0 8z" fill="#567"/></marker>
<marker id="off" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" markerHeight="8" orient="auto"><path d="M0 0L8 4L0 8z" fill="#c00"/></marker></defs>
)" + body +
         "</svg>\n";
}

}  // namespace armjig::mealy
