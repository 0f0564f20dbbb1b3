// SPDX-License-Identifier: Apache-2.0
#include "emulators/lab/tty_calls.hpp"

#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <asm/termios.h>

#include <cerrno>
#include <span>

namespace armjig::lab {
namespace {

/// What a host sets.
constexpr int kOutgoing = TIOCM_DTR | TIOCM_RTS;
/// What the board sets; of CTS cdc-acm always says so.
constexpr int kIncoming = TIOCM_CTS | TIOCM_DSR | TIOCM_CD;

/// Takes `change(lines, said)` of what a program says of its lines. An error number.
template <class Change>
int change_lines(SerialLines& lines, const ClientMemory& argument, Change change) {
  const auto said = argument.behind(0, sizeof(int));
  if (!said) return EFAULT;
  lines.modem = change(lines.modem.load(), said.as<int>() & kOutgoing);
  return 0;
}

int tell_lines(const SerialLines& lines, const ClientMemory& argument) {
  auto place = argument.behind(0, sizeof(int));
  if (!place) return EFAULT;
  const int all = lines.modem | kIncoming;
  place.set(std::as_bytes(std::span{&all, 1}));
  return 0;
}

void note_baud(SerialLines& lines, const ClientMemory& argument) {
  const auto modes = argument.behind(0, sizeof(termios2));
  if (modes) lines.baud = modes.as<termios2>().c_ospeed;
}

void hand_on(UMockdevIoctlClient* client) {
  gint error = 0;
  const auto result = umockdev_ioctl_client_execute(client, &error, nullptr);
  umockdev_ioctl_client_complete(client, result, error);
}

gboolean on_tty_ioctl(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer data) {
  auto& lines = *static_cast<SerialLines*>(data);
  const ClientMemory argument{
      static_cast<UMockdevIoctlData*>(g_object_ref(umockdev_ioctl_client_get_arg(client)))};
  int error = 0;
  switch (umockdev_ioctl_client_get_request(client)) {
    case TIOCMGET:
      error = tell_lines(lines, argument);
      break;
    case TIOCMSET:
      error = change_lines(lines, argument, [](int /*before*/, int said) { return said; });
      break;
    case TIOCMBIS:
      error = change_lines(lines, argument, [](int before, int said) { return before | said; });
      break;
    case TIOCMBIC:
      error = change_lines(lines, argument, [](int before, int said) { return before & ~said; });
      break;
    case TCSETS2:
      note_baud(lines, argument);
      hand_on(client);
      return TRUE;
    default:
      hand_on(client);
      return TRUE;
  }
  umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
  return TRUE;
}

}  // namespace

GObjectRef<UMockdevIoctlBase> answer_tty_calls(SerialLines& lines) {
  lines.modem = kOutgoing;  // opening a port turns them on
  GObjectRef<UMockdevIoctlBase> calls{umockdev_ioctl_base_new()};
  g_signal_connect(calls.get(), "handle-ioctl", G_CALLBACK(on_tty_ioctl), &lines);
  return calls;
}

}  // namespace armjig::lab
