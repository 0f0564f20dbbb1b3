// SPDX-License-Identifier: Apache-2.0
#include "cli/program.hpp"
#include "device.hpp"

int main(int argc, char** argv) { return armjig::cli::run_program(argc, argv, gripper::devices()); }
