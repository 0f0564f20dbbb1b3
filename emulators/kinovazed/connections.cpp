// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/connections.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace armjig::kinovazed::emulation {

ConnectionId Connections::connect() {
  waiting_.push_back({.id = next_id_});
  return next_id_++;
}

void Connections::receive(ConnectionId id, Bytes bytes) {
  auto* const client = find(id);
  if (client == nullptr || client->has_ended) return;
  auto& inbox = client->inbox;
  inbox.erase(inbox.begin(),
              inbox.begin() + static_cast<std::ptrdiff_t>(std::exchange(client->taken, 0)));
  inbox.insert(inbox.end(), bytes.begin(), bytes.end());
}

void Connections::half_close(ConnectionId id) {
  if (auto* const client = find(id)) client->has_ended = true;
}

void Connections::close(ConnectionId id) {
  if (auto* const client = find(id)) client->has_ended = client->is_gone = true;
}

bool Connections::reset(ConnectionId id) {
  auto* const client = find(id);
  if (client == nullptr) return false;
  client->has_ended = client->is_gone = client->has_reset = true;
  return !client->was_told && id == (served_ ? served_->id : waiting_.front().id);
}

std::size_t Connections::unread(ConnectionId id) const noexcept {
  const auto size = [](const Client& client) { return client.inbox.size() - client.taken; };
  if (served_ && served_->id == id) return size(*served_);
  const auto waiting = std::ranges::find(waiting_, id, &Client::id);
  return waiting == waiting_.end() ? 0 : size(*waiting);
}

Connections::Accepted Connections::accept() {
  assert(!served_ && !waiting_.empty());
  served_ = std::move(waiting_.front());
  waiting_.pop_front();
  return served_->has_reset ? Accepted::kWasReset : Accepted::kServed;
}

bool Connections::is_readable() const noexcept {
  return served_ && (served_->taken < served_->inbox.size() || served_->has_ended);
}

bool Connections::is_at_end() const noexcept {
  return served_ && served_->taken == served_->inbox.size() && served_->has_ended;
}

Bytes Connections::read(std::size_t most) {
  const auto unread = Bytes{served_->inbox}.subspan(served_->taken);
  const auto bytes = unread.first(std::min(most, unread.size()));
  served_->taken += bytes.size();
  return bytes;
}

bool Connections::write(Instant time, std::string_view text) {
  if (!served_ || served_->has_reset) return false;
  if (served_->is_gone) {
    served_->has_reset = true;  // the answer to bytes that nobody wants
    return true;
  }
  served_->was_told = true;
  add(time, served_->id, SessionEvent::Kind::kData, std::as_bytes(std::span{text}));
  return true;
}

void Connections::drop(Instant time) {
  if (served_) tell(time, *served_, SessionEvent::Kind::kEnd);
  served_.reset();
}

void Connections::drop_all(Instant time) {
  drop(time);
  for (const auto& client : waiting_) tell(time, client, SessionEvent::Kind::kReset);
  waiting_.clear();
}

Connections::Client* Connections::find(ConnectionId id) noexcept {
  if (served_ && served_->id == id) return &*served_;
  const auto waiting = std::ranges::find(waiting_, id, &Client::id);
  return waiting == waiting_.end() ? nullptr : &*waiting;
}

void Connections::tell(Instant time, const Client& client, SessionEvent::Kind kind) {
  if (!client.is_gone) add(time, client.id, kind, {});
}

void Connections::add(Instant time, ConnectionId id, SessionEvent::Kind kind, Bytes bytes) {
  if (sent_count_ == sent_.size()) sent_.emplace_back();
  auto& event = sent_[sent_count_++];
  event.time = time;
  event.connection = id;
  event.kind = kind;
  event.bytes.assign(bytes.begin(), bytes.end());
}

}  // namespace armjig::kinovazed::emulation
