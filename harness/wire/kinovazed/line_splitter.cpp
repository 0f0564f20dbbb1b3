// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/kinovazed/line_splitter.hpp"

#include <algorithm>
#include <cstring>

namespace armjig::kinovazed {

LineSplitter::Step LineSplitter::step(Bytes in) noexcept {
  if (in.empty()) return {};
  const auto* const text = reinterpret_cast<const char*>(in.data());
  // An LF may stand one behind a full line.
  const auto reach = std::min(in.size(), kLongest - size_ + 1);
  const auto* const end = static_cast<const char*>(std::memchr(text, '\n', reach));
  if (end != nullptr) {
    const auto length = static_cast<std::size_t>(end - text);
    if (size_ == 0) return {length + 1, Found::kLine, {text, length}};
    std::copy_n(text, length, held_.data() + size_);
    const std::string_view line{held_.data(), size_ + length};
    size_ = 0;
    return {length + 1, Found::kLine, line};
  }
  if (size_ == kLongest) {  // and no LF: what is held was a piece
    const std::string_view line{held_.data(), size_};
    size_ = 0;
    return {0, Found::kPieceOfLine, line};
  }
  const auto taken = std::min(in.size(), kLongest - size_);
  std::copy_n(text, taken, held_.data() + size_);
  size_ += taken;
  return {taken, Found::kNothing, {}};
}

}  // namespace armjig::kinovazed
