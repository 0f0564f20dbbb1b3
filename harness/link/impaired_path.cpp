// SPDX-License-Identifier: Apache-2.0
#include "harness/link/impaired_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

namespace armjig {
namespace {

using Grouping = PathImpairment::Grouping;

constexpr std::array kCounts{
    PathCount{"chunks_in", &PathStatistics::chunks_in},
    PathCount{"bytes_in", &PathStatistics::bytes_in},
    PathCount{"chunks_out", &PathStatistics::chunks_out},
    PathCount{"bytes_out", &PathStatistics::bytes_out},
    PathCount{"chunks_lost", &PathStatistics::chunks_lost},
    PathCount{"bytes_lost", &PathStatistics::bytes_lost},
    PathCount{"chunks_doubled", &PathStatistics::chunks_doubled},
    PathCount{"bytes_doubled", &PathStatistics::bytes_doubled},
    PathCount{"chunks_reordered", &PathStatistics::chunks_reordered},
    PathCount{"bits_flipped", &PathStatistics::bits_flipped},
    PathCount{"splits", &PathStatistics::splits},
    PathCount{"merges", &PathStatistics::merges},
    PathCount{"stalls", &PathStatistics::stalls},
    PathCount{"disconnects", &PathStatistics::disconnects},
    PathCount{"chunks_cut_off", &PathStatistics::chunks_cut_off},
    PathCount{"bytes_cut_off", &PathStatistics::bytes_cut_off},
};
static_assert(sizeof(PathStatistics) == kCounts.size() * sizeof(std::uint64_t));

std::string to_string(const PathStatistics& statistics) {
  std::string text;
  for (const auto& [name, place] : kCounts) {
    if (statistics.*place == 0) continue;
    if (!text.empty()) text += ", ";
    text += fmt::format("{} {}", statistics.*place, name);
  }
  return text.empty() ? "nothing" : text;
}

/// `factor` times `unit` to the nanosecond. Nothing is added to the product, which a compiler could
/// fuse into something that rounds differently.
Duration scaled(Duration unit, double factor) noexcept {
  return Duration{std::llround(static_cast<double>(unit.count()) * factor)};
}

template <std::size_t... Index>
std::array<RandomSource, sizeof...(Index)> forks(const RandomSource& random,
                                                 std::index_sequence<Index...> /*effects*/) {
  return {random.fork(Index)...};
}

}  // namespace

std::span<const PathCount> path_counts() noexcept { return kCounts; }

std::string to_string(const ImpairmentStatistics& statistics) {
  return fmt::format("out: {}; in: {}", to_string(statistics.out), to_string(statistics.in));
}

Duration draw(const DurationLaw& law, RandomSource& random) noexcept {
  switch (law.kind) {
    case DurationLaw::Kind::kConstant:
      break;
    case DurationLaw::Kind::kUniform: {
      const auto width = static_cast<std::uint64_t>((law.second - law.first).count());
      return law.first + Duration{static_cast<Duration::rep>(random.below(width + 1))};
    }
    case DurationLaw::Kind::kNormal:
      return std::max(Duration::zero(), law.first + scaled(law.second, random.normal()));
    case DurationLaw::Kind::kExponential:
      return scaled(law.first, random.exponential());
  }
  return law.first;
}

ImpairedPath::ImpairedPath(const PathImpairment& impairment, RandomSource random)
    : impairment_{impairment}, random_{forks(random, std::make_index_sequence<kEffectCount>{})} {}

void ImpairedPath::push(Instant time, Bytes bytes) {
  const auto limit = impairment_.chunk == 0 ? bytes.size() : impairment_.chunk;
  while (!bytes.empty()) {
    const auto size = std::min(limit, bytes.size());
    take_chunk(time, bytes.first(size));
    bytes = bytes.subspan(size);
  }
}

void ImpairedPath::take_chunk(Instant time, Bytes chunk) {
  ++statistics_.chunks_in;
  statistics_.bytes_in += chunk.size();
  if (end_ == End::kOpen && random(kDisconnect).happens(impairment_.disconnect)) break_off(time);
  if (end_ != End::kOpen) return cut_off(1, chunk.size());

  const auto limit = impairment_.disconnect_after;
  const auto room = limit == 0 ? chunk.size() : limit - handed_over_;
  const auto carried = static_cast<std::size_t>(std::min<std::uint64_t>(room, chunk.size()));
  handed_over_ += carried;
  carry(time, chunk.first(carried));
  if (limit == 0 || handed_over_ < limit) return;
  break_off(time);
  cut_off(0, chunk.size() - carried);
}

void ImpairedPath::carry(Instant time, Bytes chunk) {
  if (random(kStall).happens(impairment_.stall.rate)) {
    ++statistics_.stalls;
    free_ = std::max(free_, time) + draw(impairment_.stall.length, random(kStallLength));
  }
  // Drawn for each chunk, needed or not, so that one defect does not shift another one.
  const bool is_lost = random(kLoss).happens(impairment_.loss);
  const bool is_doubled = random(kDoubling).happens(impairment_.doubling);
  const bool is_held = random(kReordering).happens(impairment_.reordering.rate);
  if (is_lost) {
    ++statistics_.chunks_lost;
    statistics_.bytes_lost += chunk.size();
    std::ignore = transmit(time, chunk.size());
    return;
  }
  if (is_doubled) {
    ++statistics_.chunks_doubled;
    statistics_.bytes_doubled += chunk.size();
  }
  for (int copies = is_doubled ? 2 : 1; copies > 0; --copies) {
    auto pieces = pieces_of(time, chunk);
    if (is_held) {
      hold_back(std::move(pieces));
    } else {
      send(std::move(pieces));
    }
  }
}

void ImpairedPath::break_off(Instant time) {
  ++statistics_.disconnects;
  close(time);
  end_ = End::kBroken;
}

void ImpairedPath::cut_off(std::size_t chunks, std::size_t bytes) noexcept {
  statistics_.chunks_cut_off += chunks;
  statistics_.bytes_cut_off += bytes;
}

/// When the last of `size` bytes that come at `time` is through.
Instant ImpairedPath::transmit(Instant time, std::size_t size) noexcept {
  free_ = std::max(free_, time);
  if (const auto bandwidth = impairment_.bandwidth; bandwidth > 0) {
    constexpr std::uint64_t kSecond = 1'000'000'000;
    free_ += std::chrono::seconds{size / bandwidth};
    free_ += Duration{(size % bandwidth * kSecond + bandwidth - 1) / bandwidth};
  }
  return free_;
}

std::vector<ImpairedPath::Piece> ImpairedPath::pieces_of(Instant time, Bytes chunk) {
  std::vector<std::byte> bytes{chunk.begin(), chunk.end()};
  flip_bits(bytes);
  std::vector<Piece> pieces;
  for (auto rest = Bytes{bytes}; !rest.empty();) {
    auto size = rest.size();
    if (impairment_.split.kind == Grouping::kFixed) size = std::min(size, impairment_.split.size);
    if (impairment_.split.kind == Grouping::kRandom) size = 1 + random(kSplit).below(size);
    const auto due = transmit(time, size) + draw(impairment_.delay, random(kDelay));
    pieces.push_back(
        {due, {rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(size)}, false});
    rest = rest.subspan(size);
  }
  pieces.front().begins_chunk = true;
  statistics_.splits += pieces.size() - 1;
  return pieces;
}

void ImpairedPath::flip_bits(std::span<std::byte> bytes) noexcept {
  if (impairment_.bit_errors <= 0) return;
  for (auto& byte : bytes) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      if (!random(kBitErrors).happens(impairment_.bit_errors)) continue;
      byte ^= std::byte{1} << bit;
      ++statistics_.bits_flipped;
    }
  }
}

/// All pieces wait as long as the last one, so that the chunk stays together.
void ImpairedPath::hold_back(std::vector<Piece> chunk) {
  const auto earliest = held_.empty() ? last_due_ : held_.back().due;
  const auto due = std::max(earliest, chunk.back().due + impairment_.reordering.wait);
  for (auto& piece : chunk) {
    piece.due = due;
    held_.push_back(std::move(piece));
  }
}

void ImpairedPath::send(std::vector<Piece> chunk) {
  release_held(std::max(last_due_, chunk.front().due));
  for (auto& piece : chunk) append(std::move(piece));
  for (auto& piece : std::exchange(held_, {})) {
    statistics_.chunks_reordered += piece.begins_chunk ? 1 : 0;
    piece.due = last_due_;
    append(std::move(piece));
  }
}

/// Lets the chunks go that nothing has overtaken in time.
void ImpairedPath::release_held(Instant until) {
  const auto later =
      std::ranges::find_if(held_, [until](const Piece& piece) { return piece.due > until; });
  std::for_each(held_.begin(), later, [this](Piece& piece) { append(std::move(piece)); });
  held_.erase(held_.begin(), later);
}

/// From here on, order and times of pieces are settled.
void ImpairedPath::append(Piece piece) {
  last_due_ = std::max(last_due_, piece.due);
  if (joint_ && joint_->wait_until <= last_due_) release_joint(joint_->wait_until);
  if (!joint_) joint_ = Joint{{}, 0, last_due_ + impairment_.merge.wait};
  auto& joined = joint_->delivery.bytes;
  joined.insert(joined.end(), piece.bytes.begin(), piece.bytes.end());
  ++joint_->pieces;
  if (is_joint_complete()) release_joint(last_due_);
}

bool ImpairedPath::is_joint_complete() {
  switch (impairment_.merge.kind) {
    case Grouping::kNone:
      break;
    case Grouping::kFixed:
      return joint_->delivery.bytes.size() >= impairment_.merge.size;
    case Grouping::kRandom:
      return random(kMerge).happens(0.5);
  }
  return true;
}

void ImpairedPath::release_joint(Instant due) {
  joint_->delivery.due = due;
  statistics_.merges += joint_->pieces - 1;
  ready_.push_back(std::move(joint_->delivery));
  joint_.reset();
}

void ImpairedPath::close(Instant time) {
  if (end_ != End::kOpen) return;
  end_ = End::kClosed;
  release_held(Instant::max());
  end_due_ = std::max(time, last_due_);
  if (joint_) release_joint(std::min(joint_->wait_until, end_due_));
}

std::optional<ImpairedPath::Delivery> ImpairedPath::pop(Instant now) {
  release_held(now);
  if (joint_ && joint_->wait_until <= now) release_joint(joint_->wait_until);
  if (ready_.empty() || ready_.front().due > now) return std::nullopt;
  auto delivery = std::move(ready_.front());
  ready_.pop_front();
  ++statistics_.chunks_out;
  statistics_.bytes_out += delivery.bytes.size();
  return delivery;
}

std::optional<Instant> ImpairedPath::next_due(Instant now) const noexcept {
  if (!ready_.empty()) return ready_.front().due;
  std::optional<Instant> next;
  if (end_ != End::kOpen && end_due_ > now) next = end_due_;
  if (joint_) next = joint_->wait_until;
  if (!held_.empty()) next = next ? std::min(*next, held_.front().due) : held_.front().due;
  return next;
}

ImpairedPath::End ImpairedPath::end(Instant now) const noexcept {
  const bool is_over = ready_.empty() && end_due_ <= now;
  return is_over ? end_ : End::kOpen;
}

void ImpairedPath::drop() noexcept {
  for (const auto& delivery : ready_) cut_off(1, delivery.bytes.size());
  if (joint_) cut_off(joint_->pieces, joint_->delivery.bytes.size());
  for (const auto& piece : held_) cut_off(1, piece.bytes.size());
  ready_.clear();
  joint_.reset();
  held_.clear();
}

void ImpairedPath::reopen() noexcept {
  drop();
  handed_over_ = 0;
  free_ = {};
  last_due_ = {};
  end_ = End::kOpen;
  end_due_ = {};
}

Instant ImpairedPaths::next_due(Instant now, Instant deadline) const noexcept {
  return std::min(
      {deadline, out.next_due(now).value_or(deadline), in.next_due(now).value_or(deadline)});
}

std::size_t ImpairedPaths::take(std::span<std::byte> into, Instant until) {
  if (taken_.empty()) {
    if (const auto delivery = in.pop(until)) taken_.add(delivery->bytes);
  }
  return taken_.take(into);
}

PathStatistics& operator+=(PathStatistics& sum, const PathStatistics& part) noexcept {
  for (const auto& count : path_counts()) sum.*count.place += part.*count.place;
  return sum;
}

}  // namespace armjig
