// SPDX-License-Identifier: Apache-2.0
#include "cli/devices/devices.hpp"
#include "cli/program.hpp"

int main(int argc, char** argv) {
  return armjig::cli::run_program(argc, argv, armjig::cli::shipped_devices());
}
